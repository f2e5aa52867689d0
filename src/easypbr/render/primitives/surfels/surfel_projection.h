// The ellipses of surfels on the screen.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "easypbr/core/parallel.h"
#include "easypbr/native/ellipse_projection.h"
#include "easypbr/native/shaders.h"
#include "easypbr/render/drawables/draw_list.h"
#include "easypbr/render/frame/frame.h"
#include "easypbr/render/raster/batch_cache.h"
#include "easypbr/render/raster/culling.h"
#include "easypbr/render/raster/point_batches.h"

namespace easypbr::render {

struct SurfelProjection : native::ProjectedEllipse<float> {
    /// Of a pixel's centre: the squared radius in the ellipse, above 1 outside, and the axial distance.
    struct Hit {
        float r2, z;
    };
    Hit at(float x, float y) const {
        const float dx = x - centre_x, dy = y - centre_y;
        const float far = std::max(std::abs(dx), std::abs(dy)) * per_least;
        const float screen = far * far;
        const float q = qx * dx + qy * dy + qz;
        const float scale = wc / q;
        const float u = (by * dx - bx * dy) * scale, v = (tx * dy - ty * dx) * scale;
        const float r2 = u * u + v * v;
        // Not a number where the surfel is seen edge-on.
        if (r2 < screen) return {r2, z_c + u * z_t + v * z_b};
        return {screen, z_c};
    }
};

/// Smooth from 1 in the middle to almost nothing at the rim, so that rims leave no trace.
inline float surfel_weight(float r2) {
    const float f = std::max(0.0f, 1 - r2);
    return std::max(f * f, 1e-4f);
}

/// Semi-axes of a surfel in the mesh's frame. `towards`: the direction that it faces where it has no normal;
/// `radius`: its size where the mesh has no tangents; `scale`: a factor.
struct SurfelAxes {
    Vec3 t, b;
};
SurfelAxes surfel_axes(const MeshData& mesh, Eigen::Index i, const Vec3& towards, float radius, float scale);

/// Surfels that do not turn with the viewer, in batches of neighbours.
class SurfelBatches {
  public:
    static constexpr size_t most = native::EllipseBatch::most_ellipses;

    /// On all cores. Empty where a surfel has no normal: it faces the viewer.
    SurfelBatches(const MeshData& mesh, float radius, float scale);

    /// Of batches.
    size_t count() const { return spheres_.size(); }
    bool empty() const { return spheres_.empty(); }
    native::EllipseBatch batch(size_t i) const;
    /// The vertex that a surfel is; surfels are numbered through all batches.
    uint32_t vertex_of(size_t surfel) const { return vertices_[surfel]; }
    native::EllipseVectors<float> vectors_of(size_t surfel) const;
    /// Around all that they cover; infinite where one is not finite.
    using Sphere = PointBatches::Sphere;
    const Sphere& sphere_of(size_t batch) const { return spheres_[batch]; }

  private:
    static constexpr size_t components = native::EllipseBatch::components;

    std::vector<uint32_t> vertices_;
    std::vector<float> vectors_;
    std::vector<Sphere> spheres_;
};

/// The batches of meshes, by the revisions of what surfels are made from, their radius and their scale.
class BatchedSurfels {
  public:
    /// Null until there are any, and where surfels turn with the viewer.
    const SurfelBatches* draw(const DrawItem& item, float radius);
    void evict_unused() { batches_.evict_unused(); }

  private:
    /// Surfels that are drawn in a few milliseconds.
    static constexpr Eigen::Index few_surfels = 1 << 13;

    using Key = std::pair<std::array<uint64_t, 4>, std::array<float, 2>>;
    BatchCache<Key, SurfelBatches> batches_;
};

/// All surfels of an item in a frame. They are numbered as the batches number them, if there are any, or as
/// the mesh does.
class SurfelProjector {
  public:
    /// `spacing`: mean distance of the points, for items without tangents. `batches`: of the item, may be
    /// null; they must outlive this one.
    SurfelProjector(const DrawItem& item, const Frame& frame, double spacing, BatchedSurfels& batches);

    /// The vertex that a surfel is.
    size_t vertex_of(size_t surfel) const { return batches_ ? batches_->vertex_of(surfel) : surfel; }

    /// Nothing for a surfel before the near plane or outside of the picture.
    std::optional<SurfelProjection> project(size_t surfel) const;

    /// Calls visit(surfel, projection) for those that project() finds, on all cores.
    template <class Visit>
    void project_all(const Visit& visit) const;

    /// Asks for what project() reads of a surfel.
    void prefetch(size_t surfel) const;

  private:
    native::EllipseVectors<float> vectors_of(Eigen::Index vertex) const;

    const DrawItem* item_;
    const SurfelBatches* batches_;
    native::EllipseView view_;
    float radius_;
};

template <class Visit>
void SurfelProjector::project_all(const Visit& visit) const {
    constexpr size_t grain = 1 << 13;
    if (!batches_) {
        parallel_for(size_t(item_->mesh().V.rows()), grain, [&](size_t i) {
            if (const auto projection = project(i)) visit(i, *projection);
        });
        return;
    }
    const Vec2i size(int(view_.width), int(view_.height));
    const Frustum frustum(Eigen::Map<const Mat4>(view_.clip_from_mesh[0]), size, {0, 0, size.x(), size.y()});
    parallel_chunks(batches_->count(), grain / SurfelBatches::most, [&](size_t begin, size_t end) {
        native::EllipseScreen screen;
        for (size_t i = begin; i < end; ++i) {
            const SurfelBatches::Sphere& sphere = batches_->sphere_of(i);
            if (frustum.drops(sphere.center, sphere.radius)) continue;
            native::EllipseBatch batch = batches_->batch(i);
            batch.view = &view_;
            const int kept = native::set_up_ellipses(batch, screen);
            for (int k = 0; k < kept; ++k) {
                const int at = screen.kept[k];
                SurfelProjection projection;
                const auto members = projection.all();
                for (size_t m = 0; m < members.size(); ++m) *members[m] = screen.ellipses[m][at];
                visit(i * SurfelBatches::most + size_t(at), projection);
            }
        }
    });
}

}  // namespace easypbr::render
