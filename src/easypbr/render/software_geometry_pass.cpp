#include "easypbr/render/software_geometry_pass.h"

#include <algorithm>
#include <cmath>

#include "easypbr/core/color.h"
#include "easypbr/core/octahedral.h"
#include "easypbr/core/parallel.h"
#include "easypbr/gpu/facing.h"
#include "easypbr/scene/normals.h"

namespace easypbr::render {
namespace {

/// Small meshes are left to the driver; where exactly the two break even has not been measured.
constexpr int64_t smallest_face_count = 5000;

uint16_t unorm16(float v) {
    return uint16_t(std::lrintf(std::clamp(v, 0.0f, 1.0f) * 65535.0f));
}
uint8_t unorm8(float v) {
    return uint8_t(std::lrintf(std::clamp(v, 0.0f, 1.0f) * 255.0f));
}

/// The frames of one picture are jittered by up to a pixel, and edges are smoothed one pixel beyond them.
PixelRect with_margin(const PixelRect& r, Vec2i size) {
    constexpr int margin = 2;
    if (r.width == 0) return {};
    const int x0 = std::max(0, r.x - margin), y0 = std::max(0, r.y - margin);
    return {x0, y0, std::min(size.x(), r.x + r.width + margin) - x0,
            std::min(size.y(), r.y + r.height + margin) - y0};
}

/// A pixel on a triangle: weights of the corners, right under perspective, and the depth.
struct Hit {
    Vec3 weights;
    float depth;
    bool front;  ///< counter-clockwise on the screen
};

/// Clip coordinates of a mesh's vertices in double precision: not the snapped ones that decide visibility.
struct ClipTransform {
    double m[4][4];

    explicit ClipTransform(const Mat4d& matrix) {
        for (int row = 0; row < 4; ++row)
            for (int column = 0; column < 4; ++column) m[row][column] = matrix(row, column);
    }

    double operator()(int row, const float* p) const {
        return m[row][0] * double(p[0]) + m[row][1] * double(p[1]) + m[row][2] * double(p[2]) + m[row][3];
    }

    /// Weights solve sum b_i (x_i - X w_i, y_i - Y w_i) = 0 for the pixel (X, Y) (Olano and Greer 1997).
    Hit intersect(const float* const (&corner)[3], double ndc_x, double ndc_y) const {
        double x[3], y[3], z[3], w[3];
        for (int k = 0; k < 3; ++k) {
            w[k] = (*this)(3, corner[k]);
            x[k] = (*this)(0, corner[k]) - ndc_x * w[k];
            y[k] = (*this)(1, corner[k]) - ndc_y * w[k];
            z[k] = (*this)(2, corner[k]);
        }
        double b[3] = {x[1] * y[2] - y[1] * x[2], x[2] * y[0] - y[2] * x[0], x[0] * y[1] - y[0] * x[1]};
        const double sum = b[0] + b[1] + b[2];
        const double scale = sum != 0 ? 1 / sum : 0;
        if (sum == 0) b[0] = b[1] = b[2] = 1.0 / 3;
        const double depth =
            (b[0] * z[0] + b[1] * z[1] + b[2] * z[2]) / (b[0] * w[0] + b[1] * w[1] + b[2] * w[2]);
        if (sum == 0) return {Vec3::Constant(1.0f / 3), float(depth), true};
        return {Vec3(float(b[0] * scale), float(b[1] * scale), float(b[2] * scale)), float(depth), sum > 0};
    }
};

}  // namespace

/// An item with all that its pixels need.
struct SoftwareGeometryPass::Surface {
    const DrawItem* item;
    const Knowledge* mesh;
    ClipTransform clip;
    Mat3 normal_from_mesh;
    bool mirrored;
    uint32_t first_id;

    Vec3 face_normal(const int32_t* f) const {
        const Array3f& V = item->mesh().V;
        const Vec3 a = V.row(f[0]), b = V.row(f[1]), c = V.row(f[2]);
        return normal_from_mesh * (b - a).cross(c - a);
    }

    /// Unit normal in world space on the side that is seen.
    Vec3 normal(const int32_t* f, const Hit& hit) const {
        const bool back = hit.front == mirrored;
        if (item->flat) return face_normal(f).normalized() * (back ? -1.0f : 1.0f);
        const float* N = mesh->N.data();
        const float *n0 = N + 3 * size_t(f[0]), *n1 = N + 3 * size_t(f[1]), *n2 = N + 3 * size_t(f[2]);
        Vec3 mean;
        for (int k = 0; k < 3; ++k)
            mean[k] = n0[k] * hit.weights[0] + n1[k] * hit.weights[1] + n2[k] * hit.weights[2];
        const Vec3 world = normal_from_mesh * mean;
        const Vec3 n = world * (1 / std::max(world.norm(), 1e-30f));
        if (!item->two_sided) return n;
        if (mesh->normals_agree) return back ? Vec3(-n) : n;
        const Vec3 towards_viewer = face_normal(f) * (back ? -1.0f : 1.0f);
        return n.dot(towards_viewer) < 0 ? Vec3(-n) : n;
    }

    Vec3 albedo(const int32_t* f, const Hit& hit) const {
        if (!item->with_colors) return item->material.base_color;
        const ArrayXf& C = item->mesh().C;
        Vec3 color = Vec3::Zero();
        for (int k = 0; k < 3; ++k) color += hit.weights[k] * linear_from_srgb(Vec3(C.row(f[k]).head<3>()));
        return color.cwiseProduct(item->material.base_color);
    }
};

void SoftwareGeometryPass::Pixels::resize(size_t count) {
    albedo.resize(count * 4);
    normal.resize(count * 2);
    material.resize(count * 4);
    depth.resize(count);
}

bool SoftwareGeometryPass::handles(const std::vector<DrawItem>& items) {
    int64_t faces = 0;
    for (const DrawItem& item : items) {
        if (item.textured() || item.emits() || item.material.alpha_mode != AlphaMode::opaque) return false;
        faces += item.part.face_count;
    }
    return faces >= smallest_face_count && faces < int64_t(UINT32_MAX);
}

const SoftwareGeometryPass::Knowledge& SoftwareGeometryPass::knowledge_of(const MeshData& mesh) {
    Knowledge& known = knowledge_[{mesh.V.revision(), mesh.N.revision(), mesh.F.revision()}];
    known.used = true;
    if (known.N.empty()) {
        known.N = mesh.N.empty() ? smooth_normals(mesh) : mesh.N;
        known.normals_agree = mesh.N.empty() || gpu::normals_agree_with_winding(mesh.V, known.N, mesh.F);
    }
    // A serial pass over the faces that a single picture would not earn back: a still of one sample goes
    // without.
    if (++known.frames == 2) known.closed_outward = gpu::is_closed_outward(mesh.V, mesh.F);
    return known;
}

void SoftwareGeometryPass::evict_unused() {
    std::erase_if(knowledge_, [](const auto& item) { return !item.second.used; });
    for (auto& [key, known] : knowledge_) known.used = false;
}

bool SoftwareGeometryPass::draw(Frame& frame, const std::vector<DrawItem>& items, const GBuffer& targets) {
    visibility_.clear(frame.size, frame.covered);
    std::vector<Surface> surfaces;
    uint32_t next_id = 0;
    for (const DrawItem& item : items) {
        const Mat4d mesh_matrix = item.object->T_world_mesh.matrix();
        const Mat3d linear = mesh_matrix.topLeftCorner<3, 3>();
        const Mat4d clip_from_mesh = frame.clip_from_view * frame.camera.view() * mesh_matrix;
        const Knowledge& known = knowledge_of(item.mesh());
        const Mat3 normal_from_mesh = linear.inverse().transpose().cast<float>();
        surfaces.push_back({&item, &known, ClipTransform(clip_from_mesh), normal_from_mesh,
                            linear.determinant() < 0, next_id});
        const MeshData& mesh = item.mesh();
        if (!visibility_.draw(
                mesh.V, mesh.F, item.part.first_face, item.part.face_count, clip_from_mesh.cast<float>(),
                next_id, item.two_sided && (item.flat || !known.closed_outward), surfaces.back().mirrored))
            return false;
        next_id += uint32_t(item.part.face_count);
    }
    visibility_.crop();
    resolve(frame, surfaces);
    upload(targets);
    frame.covered = with_margin(visibility_.area(), frame.size);
    return true;
}

void SoftwareGeometryPass::resolve(const Frame& frame, const std::vector<Surface>& surfaces) {
    const PixelRect& area = visibility_.area();
    pixels_.resize(visibility_.pixels().size());
    const double step_x = 2.0 / frame.size.x(), step_y = 2.0 / frame.size.y();
    const auto resolve_pixel = [&](size_t i, int x, int y) {
        const uint64_t pixel = visibility_.pixels()[i];
        pixels_.depth[i] = 0;
        if (pixel == 0) return;
        const uint32_t id = VisibilityBuffer::id_of(pixel);
        const Surface& s =
            *std::prev(std::upper_bound(surfaces.begin(), surfaces.end(), id,
                                        [](uint32_t v, const Surface& t) { return v < t.first_id; }));
        const MeshData& mesh = s.item->mesh();
        const int32_t* f = mesh.F.data() + 3 * (size_t(s.item->part.first_face) + (id - s.first_id));
        const float* V = mesh.V.data();
        const float* const corners[3] = {V + 3 * size_t(f[0]), V + 3 * size_t(f[1]), V + 3 * size_t(f[2])};
        const Hit hit = s.clip.intersect(corners, (x + 0.5) * step_x - 1, 1 - (y + 0.5) * step_y);
        const Vec3 albedo = s.albedo(f, hit);
        const Vec2 normal = oct_encode(s.normal(f, hit)) * 0.5f + Vec2(0.5f, 0.5f);
        const Material& m = s.item->material;
        pixels_.depth[i] = hit.depth;
        for (size_t c = 0; c < 3; ++c) pixels_.albedo[4 * i + c] = unorm16(albedo[Eigen::Index(c)]);
        pixels_.albedo[4 * i + 3] = 65535;
        pixels_.normal[2 * i] = unorm16(normal.x());
        pixels_.normal[2 * i + 1] = unorm16(normal.y());
        const uint8_t material[4] = {unorm8(m.metallic), unorm8(m.roughness), 255, 0};
        std::copy_n(material, 4, &pixels_.material[4 * i]);
    };
    parallel_for(size_t(area.height), 4, [&](size_t row) {
        for (int x = 0; x < area.width; ++x)
            resolve_pixel(row * size_t(area.width) + size_t(x), area.x + x, area.y + int(row));
    });
}

void SoftwareGeometryPass::upload(const GBuffer& targets) {
    const PixelRect& r = visibility_.area();
    const float zero[4] = {0, 0, 0, 0};
    targets.surface.allow_depth_writes();
    targets.surface.clear_color(3, zero);
    targets.surface.clear_depth(0);
    targets.lit.clear_color(0, zero);
    if (r.width == 0 || r.height == 0) return;
    const auto put = [&](const gl::Texture& texture, const auto& values) {
        texture.upload_area(r.x, r.y, r.width, r.height, std::as_bytes(std::span(values)));
    };
    put(targets.albedo, pixels_.albedo);
    put(targets.normal, pixels_.normal);
    put(targets.material, pixels_.material);
    put(targets.depth, pixels_.depth);
    put(targets.depth_test, pixels_.depth);
}

}  // namespace easypbr::render
