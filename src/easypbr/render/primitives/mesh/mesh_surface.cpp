#include "easypbr/render/primitives/mesh/mesh_surface.h"

#include <algorithm>
#include <cmath>

#include "easypbr/core/color.h"

namespace easypbr::render {

/// A pixel on a triangle: weights of the corners, right under perspective, and the depth.
struct MeshSurface::Hit {
    Vec3 weights;
    float depth;
    bool front;  ///< counter-clockwise on the screen
};

MeshSurface::MeshSurface(const DrawItem& item, const MeshFacts& facts, const Mat4d& clip_from_mesh)
    : item_(&item), facts_(&facts) {
    // In double precision: not the snapped coordinates that decide visibility.
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column) clip_[row][column] = clip_from_mesh(row, column);
    const Mat3d linear = item.object->T_world_mesh.linear();
    normal_from_mesh_ = linear.inverse().transpose().cast<float>();
    mirrored_ = linear.determinant() < 0;
}

double MeshSurface::clip(int row, const float* p) const {
    return clip_[row][0] * double(p[0]) + clip_[row][1] * double(p[1]) + clip_[row][2] * double(p[2]) +
           clip_[row][3];
}

/// Weights solve sum b_i (x_i - X w_i, y_i - Y w_i) = 0 for the pixel (X, Y) (Olano and Greer 1997).
MeshSurface::Hit MeshSurface::intersect(const float* const (&corner)[3], double ndc_x, double ndc_y) const {
    double x[3], y[3], z[3], w[3];
    for (int k = 0; k < 3; ++k) {
        w[k] = clip(3, corner[k]);
        x[k] = clip(0, corner[k]) - ndc_x * w[k];
        y[k] = clip(1, corner[k]) - ndc_y * w[k];
        z[k] = clip(2, corner[k]);
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

Vec3 MeshSurface::face_normal(const int32_t* f) const {
    const Array3f& V = item_->mesh().V;
    const Vec3 a = V.row(f[0]), b = V.row(f[1]), c = V.row(f[2]);
    return normal_from_mesh_ * (b - a).cross(c - a);
}

Vec3 MeshSurface::normal(const int32_t* f, const Hit& hit) const {
    const bool back = hit.front == mirrored_;
    if (item_->style.flat) return face_normal(f).normalized() * (back ? -1.0f : 1.0f);
    const float* N = facts_->N.data();
    const float *n0 = N + 3 * size_t(f[0]), *n1 = N + 3 * size_t(f[1]), *n2 = N + 3 * size_t(f[2]);
    Vec3 mean;
    for (int k = 0; k < 3; ++k)
        mean[k] = n0[k] * hit.weights[0] + n1[k] * hit.weights[1] + n2[k] * hit.weights[2];
    const Vec3 world = normal_from_mesh_ * mean;
    const Vec3 n = world * (1 / std::max(world.norm(), 1e-30f));
    if (!item_->two_sided) return n;
    if (facts_->normals_agree) return back ? Vec3(-n) : n;
    const Vec3 towards_viewer = face_normal(f) * (back ? -1.0f : 1.0f);
    return n.dot(towards_viewer) < 0 ? Vec3(-n) : n;
}

Vec3 MeshSurface::albedo(const int32_t* f, const Hit& hit) const {
    if (!item_->with_colors) return item_->material.base_color;
    const ArrayXf& C = item_->mesh().C;
    Vec3 color = Vec3::Zero();
    for (int k = 0; k < 3; ++k) color += hit.weights[k] * linear_from_srgb(Vec3(C.row(f[k]).head<3>()));
    return color.cwiseProduct(item_->material.base_color);
}

SurfacePixel MeshSurface::at(uint32_t face, double ndc_x, double ndc_y, float) const {
    const MeshData& mesh = item_->mesh();
    const uint32_t element = uint32_t(item_->part.first_face) + face;
    const int32_t* f = mesh.F.data() + 3 * size_t(element);
    const float* V = mesh.V.data();
    const float* const corners[3] = {V + 3 * size_t(f[0]), V + 3 * size_t(f[1]), V + 3 * size_t(f[2])};
    const Hit hit = intersect(corners, ndc_x, ndc_y);
    SurfacePixel pixel;
    pixel.albedo = albedo(f, hit);
    pixel.normal = normal(f, hit);
    pixel.depth = hit.depth;
    pixel.element = element;
    return pixel;
}

bool MeshSurface::resolve(const Frame& frame, const DrawItem& item,
                          std::span<const native::VisiblePixel> pixels, int y, SurfaceWriter& writer) const {
    if (item.with_colors) return false;
    native::VisibleTriangles triangles =
        writer.target_of({.albedo = item.material.base_color,
                          .metallic = item.material.metallic,
                          .roughness = item.material.roughness,
                          .kind = item.kind,
                          .object = uint32_t(item.object - frame.scene->objects.data())});
    const MeshData& mesh = item.mesh();
    triangles.V = mesh.V.data();
    triangles.N = facts_->N.data();
    triangles.F = mesh.F.data();
    triangles.first_face = uint32_t(item.part.first_face);
    std::copy_n(&clip_[0][0], 16, &triangles.clip_from_mesh[0][0]);
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            triangles.normal_from_mesh[row][column] = normal_from_mesh_(row, column);
    triangles.flat = item.style.flat;
    triangles.two_sided = item.two_sided;
    triangles.normals_agree = facts_->normals_agree;
    triangles.mirrored = mirrored_;
    triangles.pixel_width = 2.0 / frame.size.x();
    triangles.pixel_height = 2.0 / frame.size.y();
    native::resolve_triangles(triangles, pixels, y, writer.index(writer.area().x, y), writer.area().x);
    return true;
}

}  // namespace easypbr::render
