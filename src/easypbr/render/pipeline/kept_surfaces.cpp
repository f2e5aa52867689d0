#include "easypbr/render/pipeline/kept_surfaces.h"

#include <utility>

#include "easypbr/core/error.h"
#include "easypbr/core/parallel.h"
#include "easypbr/scene/draw_style.h"
#include "easypbr/scene/resolve.h"

namespace easypbr::render {
namespace {

/// Which part each face of a mesh is in.
std::vector<uint32_t> parts_of_faces(const MeshData& mesh) {
    std::vector<uint32_t> parts(mesh.parts.size() > 1 ? size_t(mesh.F.rows()) : 0);
    for (size_t p = 0; p < mesh.parts.size() && !parts.empty(); ++p)
        for (int i = 0; i < mesh.parts[p].face_count; ++i)
            parts[size_t(mesh.parts[p].first_face) + size_t(i)] = uint32_t(p);
    return parts;
}

/// Points beside discs or splats have no shape of their own.
VertexShape vertex_shape_of(const MeshData& mesh, const DrawStyle& style, SplatDepth splats) {
    if (style.show_points) return VertexShape::none;
    const DrawMode drawn = primitive_of(mesh, style);
    if (draws_discs(drawn)) return VertexShape::disc;
    const bool is_splat = drawn == DrawMode::splats && splats != SplatDepth::expected;
    return is_splat ? VertexShape::splat : VertexShape::none;
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

KeptSurfaces::KeptSurfaces(const SceneSnapshot& scene, DrawableScene drawable,
                           const ResolvedSettings& resolved, Vec2i size, const Material& textures,
                           const ShaderFiles& shader_files)
    : scene_(scene), drawable_(std::move(drawable)), resolved_(resolved), size_(size) {
    const DrawList all = draw_list(drawable_, resolved_.settings, textures, shader_files);
    list_ = all.as_surfaces();
    shapes_ = all.as_shapes();
    blended_.resize(drawable_.scene.objects.size());
    for (const auto& [kind, items] : all.items)
        for (const DrawItem& item : items)
            if (item.alpha == AlphaMode::blend) blended_[place_of(item)] = true;
}

size_t KeptSurfaces::place_of(const DrawItem& item) const {
    return size_t(item.object - drawable_.scene.objects.data());
}

Shot KeptSurfaces::shot() const {
    return {.scene = &drawable_.scene, .resolved = &resolved_, .size = size_, .picture_size = size_};
}

void KeptSurfaces::draw(Pipeline& pipeline) const {
    const Frame frame = make_frame(shot(), 0, resolved_.camera, pipeline.bounds_of(drawable_.scene),
                                   list_.reaches_beyond_vertices());
    pipeline.draw_surfaces(frame, list_, {.ids = true, .nearest_alone = true});
}

SurfaceFrame KeptSurfaces::read(const GBuffer& targets, Transfers& transfers) const {
    if (!targets.id) throw ArgumentError("read_surfaces: the last picture was drawn without surfaces");
    SurfaceFrame frame;
    frame.size = targets.size();
    frame.camera = resolved_.camera;
    frame.scene = scene_;
    frame.depth = targets.depth.read<float>(transfers);
    frame.object = targets.id.read<uint32_t>(transfers);
    frame.element = targets.element.read<uint32_t>(transfers);
    frame.part.resize(frame.depth.size());
    frame.is_face.resize(frame.depth.size());
    std::vector<std::vector<uint32_t>> parts;
    for (const auto& object : drawable_.scene.objects) parts.push_back(parts_of_faces(*object.mesh));
    std::vector<uint8_t> as_mesh;
    for (const auto& object : frame.scene.objects) {
        const DrawStyle style = resolve_style(*object.mesh, resolved_.settings.style);
        as_mesh.push_back(style.mode == DrawMode::mesh);
        frame.only_faces.push_back(style.mode == DrawMode::mesh && !style.show_points);
        frame.vertex_shapes.push_back(vertex_shape_of(*object.mesh, style, resolved_.settings.splats.depth));
    }
    for (const ElementSources& source : drawable_.sources) frame.voxel_sizes.push_back(source.voxel_size);
    const float near = float(frame.camera.near), far = float(frame.camera.far);
    const bool orthographic = frame.camera.projection == Projection::orthographic;
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
        frame.element[i] = drawable_.sources[object].own(drawn);
    });
    return frame;
}

std::vector<uint8_t> KeptSurfaces::coverage(Pipeline& pipeline, const PixelRect& area,
                                            const std::function<bool(size_t, int)>& wanted) const {
    const DrawList list =
        shapes_.without([&](const DrawItem& item) { return !wanted(place_of(item), item.part.first_face); });
    Frame frame = make_frame(shot(), 0, resolved_.camera, Box3d(), true);
    frame.clip_from_view = crop(area, frame.size) * frame.clip_from_view;
    frame.size = {area.width, area.height};
    frame.origin = {area.x, area.y};
    frame.covered = frame.whole();
    return pipeline.surfaces().coverage(frame, list);
}

std::vector<ScreenReach> KeptSurfaces::reaches(Pipeline& pipeline) const {
    const Frame frame = make_frame(shot(), 0, resolved_.camera, Box3d(), true);
    std::vector<ScreenReach> reaches =
        pipeline.surfaces().reaches(frame, list_, drawable_.scene.objects.size());
    // Cells are counted from the first vertex that a cut has left: they may be others than those of all.
    const ClipSettings& clip = resolved_.settings.clip;
    if (clip.planes.empty() && clip.box.empty()) return reaches;
    for (size_t i = 0; i < reaches.size(); ++i)
        reaches[i].world +=
            drawable_.sources[i].voxel_size * drawable_.scene.objects[i].T_world_mesh.linear().norm();
    return reaches;
}

}  // namespace easypbr::render
