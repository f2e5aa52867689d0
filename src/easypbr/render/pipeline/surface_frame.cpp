// The part of Renderer that reads surfaces back and draws parts of them alone.
#include "easypbr/render/pipeline/surface_frame.h"

#include <fmt/format.h>

#include "easypbr/core/parallel.h"
#include "easypbr/gl/context.h"
#include "easypbr/render/pipeline/renderer.h"
#include "easypbr/scene/draw_style.h"

namespace easypbr::render {
namespace {

template <class T>
std::vector<T> read_target(const gl::Framebuffer& framebuffer, unsigned index, gl::Format format) {
    std::vector<T> values(size_t(framebuffer.width()) * size_t(framebuffer.height()));
    framebuffer.read(index, format, 0, 0, framebuffer.width(), framebuffer.height(),
                     std::as_writable_bytes(std::span(values)));
    return values;
}

/// Which part each face of a mesh is in.
std::vector<uint32_t> parts_of_faces(const MeshData& mesh) {
    std::vector<uint32_t> parts(mesh.parts.size() > 1 ? size_t(mesh.F.rows()) : 0);
    for (size_t p = 0; p < mesh.parts.size() && !parts.empty(); ++p)
        for (int i = 0; i < mesh.parts[p].face_count; ++i)
            parts[size_t(mesh.parts[p].first_face + i)] = uint32_t(p);
    return parts;
}

/// A projection to a rectangle of the picture's pixels.
Mat4d crop(const PixelRect& area, Vec2i size) {
    const double sx = double(size.x()) / area.width, sy = double(size.y()) / area.height;
    Mat4d matrix = Mat4d::Identity();
    matrix(0, 0) = sx;
    matrix(1, 1) = sy;
    // Row 0 is the top: y of the device runs against the rows.
    matrix(0, 3) = (size.x() - 2.0 * area.x) / area.width - 1;
    matrix(1, 3) = 1 - (size.y() - 2.0 * area.y) / area.height;
    return matrix;
}

}  // namespace

SurfaceFrame Renderer::read_surfaces() const {
    if (!drawn_ || drawn_->scene.objects.size() != element_sources_.size() || !targets_.id)
        throw ArgumentError("read_surfaces: the last picture was drawn without surfaces");
    SurfaceFrame frame;
    frame.size = targets_.size();
    frame.camera = camera_;
    frame.scene = drawn_->scene;
    frame.depth = read_target<float>(targets_.surface, 3, gl::Format::r32f);
    frame.object = read_target<uint32_t>(targets_.surface_ids, 5, gl::Format::r32ui);
    frame.element = read_target<uint32_t>(targets_.surface_ids, 6, gl::Format::r32ui);
    frame.part.resize(frame.depth.size());
    frame.is_face.resize(frame.depth.size());
    std::vector<std::vector<uint32_t>> parts;
    for (const auto& object : drawn_->drawable.scene.objects) parts.push_back(parts_of_faces(*object.mesh));
    std::vector<uint8_t> as_mesh;
    for (const auto& object : frame.scene.objects) {
        const DrawStyle style = resolve_style(*object.mesh, drawn_->resolved.settings.style);
        as_mesh.push_back(style.mode == DrawMode::mesh);
        frame.only_faces.push_back(style.mode == DrawMode::mesh && !style.show_points);
    }
    const float near = float(camera_.near), far = float(camera_.far);
    const bool orthographic = camera_.projection == Projection::orthographic;
    parallel_for(frame.depth.size(), 1 << 14, [&](size_t i) {
        if (!(frame.depth[i] > 0)) {
            frame.depth[i] = 0;
            frame.object[i] = frame.element[i] = 0;
            return;
        }
        frame.depth[i] = orthographic ? far + (near - far) * frame.depth[i] : near / frame.depth[i];
        const size_t object = frame.object[i] - 1;
        const uint32_t drawn = frame.element[i];
        frame.is_face[i] = as_mesh[object] && !(drawn & point_element);
        if (frame.is_face[i] && !parts[object].empty()) frame.part[i] = parts[object][drawn - 1];
        frame.element[i] = element_sources_[object].own(drawn);
    });
    return frame;
}

std::vector<uint8_t> Renderer::coverage(const PixelRect& area,
                                        const std::function<bool(size_t, int)>& wanted) {
    if (!drawn_ || drawn_->scene.objects.size() != element_sources_.size())
        throw ArgumentError("coverage: the last picture was drawn without surfaces");
    const SceneSnapshot::Object* first = drawn_->drawable.scene.objects.data();
    const DrawList list = drawn_->surfaces.without(
        [&](const DrawItem& item) { return !wanted(size_t(item.object - first), item.part.first_face); });
    std::vector<uint8_t> covered(size_t(area.width) * size_t(area.height));
    if (list.empty() || covered.empty()) return covered;
    Frame frame;
    frame.scene = &drawn_->drawable.scene;
    frame.resolved = &drawn_->resolved;
    frame.camera = drawn_->resolved.camera;
    frame.size = frame.picture_size = drawn_->size;
    frame.with_ids = true;
    prepare_frame(frame, Box3d(), true);
    frame.clip_from_view = crop(area, frame.size) * frame.clip_from_view;
    frame.size = {area.width, area.height};
    frame.covered = {0, 0, area.width, area.height};
    const bool native = native_geometry_ && gl::Context::current().info().software;
    if (native && software_geometry_.cover(frame, list, covered)) return covered;
    if (!coverage_targets_.albedo || coverage_targets_.size() != frame.size)
        coverage_targets_ = GBuffer(frame.size);
    coverage_targets_.add_ids();
    draw_geometry(frame, list, coverage_targets_);
    const auto depth = read_target<float>(coverage_targets_.surface, 3, gl::Format::r32f);
    for (size_t i = 0; i < depth.size(); ++i) covered[i] = depth[i] > 0;
    return covered;
}

}  // namespace easypbr::render
