#include "easypbr/drawing/line_drawing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "easypbr/app/session.h"
#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "easypbr/core/log.h"
#include "easypbr/core/parallel.h"
#include "easypbr/core/suggest.h"
#include "easypbr/drawing/sight.h"
#include "easypbr/render/drawables/draw_list.h"
#include "easypbr/scene/draw_style.h"
#include "easypbr/scene/resolve.h"
#include "easypbr/scene/settings.h"

namespace easypbr::drawing {
namespace {

/// How far a polyline may be from the edges that it stands for, and the length of a bent line's straight
/// parts; pixels.
constexpr double tolerance_px = 0.05, straight_px = 4;

using Object = SceneSnapshot::Object;

/// Whether the faces of a part hide what lies behind them.
bool occludes(const MeshData& mesh, int material, const MaterialSettings& settings) {
    const Material own = mesh.materials.empty() ? Material() : mesh.materials[size_t(material)];
    const Material drawn = render::overridden(own, settings, {});
    return drawn.transmittance(drawn.alpha_mode_for(has_transparent_colors(mesh.C))).isZero();
}

Occluder occluder_of(const Object& object, DrawMode mode, const MaterialSettings& settings) {
    Occluder occluder{object.mesh, object.T_world_mesh, {}};
    if (mode != DrawMode::mesh || object.mesh->F.empty()) return occluder;
    std::vector<MeshPart> parts = object.mesh->parts;
    if (parts.empty()) parts = {{"", 0, int(object.mesh->F.rows()), 0}};
    for (const MeshPart& part : parts) {
        if (!occludes(*object.mesh, part.material, settings)) continue;
        for (int i = 0; i < part.face_count; ++i) occluder.faces.push_back(part.first_face + i);
    }
    return occluder;
}

class Draftsman {
  public:
    Draftsman(const SceneSnapshot& scene, const ResolvedSettings& resolved, const Vec2i& size,
              bool with_hidden)
        : scene_(scene),
          resolved_(resolved),
          sight_(resolved.camera, size, resolved.settings.outline.width),
          modes_(modes()),
          occluders_(occluders()),
          with_hidden_(with_hidden) {}

    std::vector<DrawnObject> objects() const {
        std::vector<DrawnObject> objects;
        for (size_t i = 0; i < scene_.objects.size(); ++i) {
            DrawnObject object = drawn(i);
            if (!object.visible.empty() || !object.hidden.empty()) objects.push_back(std::move(object));
        }
        return objects;
    }

  private:
    std::vector<DrawMode> modes() const {
        std::vector<DrawMode> modes;
        for (const Object& object : scene_.objects) {
            const MeshData& mesh = *object.mesh;
            modes.push_back(primitive_of(mesh, resolve_style(mesh, resolved_.settings.style)));
        }
        return modes;
    }

    std::vector<Occluder> occluders() const {
        std::vector<Occluder> occluders;
        for (size_t i = 0; i < scene_.objects.size(); ++i)
            occluders.push_back(occluder_of(scene_.objects[i], modes_[i], resolved_.settings.material));
        return occluders;
    }

    std::vector<FeatureEdge> edges(size_t index) const {
        const Object& object = scene_.objects[index];
        const MeshData& mesh = *object.mesh;
        const auto& outline = resolved_.settings.outline;
        if (modes_[index] == DrawMode::lines) return line_segments(mesh, object.T_world_mesh);
        if (modes_[index] == DrawMode::mesh && !mesh.F.empty())
            return feature_edges(
                mesh, object.T_world_mesh, sight_.eye(),
                {outline.silhouettes || outline.objects, outline.creases, outline.crease_angle_deg});
        if (!mesh.V.empty())
            log_warning(fmt::format("'{}' has no edges for a line drawing: it is not drawn as faces or lines",
                                    object.name));
        return {};
    }

    DrawnObject drawn(size_t index) const {
        const std::vector<FeatureEdge> found = edges(index);
        std::vector<std::vector<Stretch>> stretches(found.size());
        parallel_for(found.size(), 16,
                     [&](size_t i) { stretches[i] = sight_.stretches(found[i], index, occluders_); });
        std::vector<Piece> visible, hidden;
        for (size_t i = 0; i < found.size(); ++i)
            for (const Stretch& stretch : stretches[i])
                if (stretch.visible || with_hidden_)
                    (stretch.visible ? visible : hidden).push_back(piece(found[i], stretch));
        return {scene_.objects[index].name, joined(visible, tolerance_px), joined(hidden, tolerance_px)};
    }

    Piece piece(const FeatureEdge& edge, const Stretch& stretch) const {
        const Vec3d along = edge.ends[1] - edge.ends[0];
        const Vec3d begin = edge.ends[0] + stretch.begin * along, end = edge.ends[0] + stretch.end * along;
        Piece piece;
        const double length = (sight_.pixel(end) - sight_.pixel(begin)).norm();
        const int parts = sight_.bends_lines() ? std::max(1, int(std::ceil(length / straight_px))) : 1;
        for (int i = 0; i <= parts; ++i)
            piece.points.push_back(sight_.pixel(begin + double(i) / parts * (end - begin)));
        if (stretch.begin == 0) piece.places[0] = edge.places[0];
        if (stretch.end == 1) piece.places[1] = edge.places[1];
        return piece;
    }

    const SceneSnapshot& scene_;
    const ResolvedSettings& resolved_;
    Sight sight_;
    std::vector<DrawMode> modes_;
    Occluders occluders_;
    bool with_hidden_;
};

}  // namespace

LineDrawing line_drawing(const SceneSnapshot& scene, const ResolvedSettings& resolved, const Vec2i& size,
                         bool with_hidden) {
    return {size, Draftsman(scene, resolved, size, with_hidden).objects()};
}

app::HiddenLines hidden_lines_named(const std::string& name) {
    static const std::vector<std::string> names{"none", "dashed", "solid"};
    const auto found = std::ranges::find(names, name);
    if (found == names.end())
        throw NameError(fmt::format("hidden lines '{}'{}: expected none, dashed or solid", name,
                                    did_you_mean(name, names)));
    return app::HiddenLines(found - names.begin());
}

void check_line_drawing(const std::filesystem::path& path) {
    if (extension_of(path) != "svg")
        throw ArgumentError(fmt::format(
            "a line drawing is written as SVG: expected a file named .svg, got '{}'", path.string()));
    check_writable(path);
}

std::filesystem::path save_line_drawing(app::Session& session, const std::filesystem::path& path,
                                        const app::LineDrawingOptions& options) {
    check_line_drawing(path);
    const ResolvedSettings resolved = session.resolve(options.size);
    const LineDrawing drawing = line_drawing(session.scene().snapshot(), resolved,
                                             options.size.value_or(resolved.settings.image.size),
                                             options.hidden != app::HiddenLines::none);
    write_file(path, svg_text(drawing, resolved, options.hidden));
    return path;
}

}  // namespace easypbr::drawing
