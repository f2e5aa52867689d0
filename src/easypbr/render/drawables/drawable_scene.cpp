#include "easypbr/render/drawables/drawable_scene.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "easypbr/core/parallel.h"
#include "easypbr/scene/crease.h"
#include "easypbr/scene/cut.h"
#include "easypbr/scene/draw_style.h"
#include "easypbr/scene/material_table.h"
#include "easypbr/scene/mesh_arrays.h"
#include "easypbr/scene/resolve.h"
#include "easypbr/scene/voxels.h"

namespace easypbr::render {
namespace {

constexpr size_t drawable_grain = 1 << 15;

ArrayXf colors_of(const std::vector<Rgba8>& colors) {
    ArrayXf::Dense C(Eigen::Index(colors.size()), 4);
    parallel_for(colors.size(), drawable_grain, [&](size_t i) {
        for (int c = 0; c < 4; ++c) C(Eigen::Index(i), c) = float(colors[i][size_t(c)]) / 255.0f;
    });
    return ArrayXf(std::move(C));
}

Array1i flattened(const Array3i& F) {
    return Array1i(Array1i::Dense(Eigen::Map<const Array1i::Dense>(F.data(), F.size())));
}

/// What a plan makes of a mesh.
struct Colored {
    MeshData mesh;
    Texture table = {};   ///< of values or texture coordinates; empty for colours
    Array1i points = {};  ///< for each vertex that of the given mesh; empty: the same
};

/// Faces of other vertices: row i is `rows[i]` of the given ones. Vertices that were one stay one for normals
/// (source_vertex).
Colored with_vertices(const MeshData& mesh, const Array1i& rows, const Array3i& F) {
    const std::span<const int32_t> from(rows.data(), size_t(rows.size()));
    MeshData out = without_arrays(mesh);
    out.V = rows_of(mesh.V, from);
    out.N = rows_of(mesh.N, from);
    out.UV = rows_of(mesh.UV, from);
    out.uv_tangents = rows_of(mesh.uv_tangents, from);
    out.parts = mesh.parts;
    out.voxel_size = mesh.voxel_size;
    out.source_face = mesh.source_face;
    out.F = F;
    out.source_vertex = mesh.source_vertex.empty() ? rows : rows_of(mesh.source_vertex, from);
    return {std::move(out), {}, rows};
}

/// Each face with three vertices of its own.
Colored with_face_colors(const MeshData& mesh, const std::vector<Rgba8>& colors) {
    std::vector<Rgba8> corners(3 * colors.size());
    Array3i::Dense F(mesh.F.rows(), 3);
    for (size_t i = 0; i < corners.size(); ++i) {
        corners[i] = colors[i / 3];
        F.data()[i] = int32_t(i);
    }
    Colored out = with_vertices(mesh, flattened(mesh.F), Array3i(std::move(F)));
    out.mesh.C = colors_of(corners);
    return out;
}

/// Places of values are this many ranges away from the table at most, so that their interpolation stays
/// finite.
constexpr float farthest = 1e18f;

/// The colours of a table in the first row, the colour of what is not a number in the second.
Texture table_texture(const ElementColors& values) {
    auto image = std::make_shared<Image>(256, 2, 4, PixelType::u8);
    uint8_t* to = image->pixels<uint8_t>().data();
    for (size_t i = 0; i < 512; ++i)
        std::ranges::copy(i < 256 ? values.table[i] : values.nan_color, to + 4 * i);
    Texture texture;
    texture.image = image;
    texture.filter = Filter::nearest;
    texture.wrap_u = texture.wrap_v = Wrap::clamp;
    return texture;
}

/// Texture coordinates (v up) as red and green; it repeats.
Texture coordinates_texture() {
    auto image = std::make_shared<Image>(256, 256, 4, PixelType::u8);
    for (int y = 0; y < 256; ++y)
        for (int x = 0; x < 256; ++x)
            std::ranges::copy(Rgba8{uint8_t(x), uint8_t(255 - y), 0, 255}, image->at<uint8_t>(x, y));
    Texture texture;
    texture.image = image;
    texture.filter = Filter::nearest;
    return texture;
}

/// A value's place in its table, from 0 to the part of the table that its range takes.
float place_of(float value, const ValueRange& range) {
    return std::clamp(place_on_scale(value, range) * (float(range.parts) / 256), -farthest, farthest);
}

/// Places of values at the vertices of lines; NaN stays so.
MeshData with_places(const MeshData& mesh, const ElementColors& values) {
    MeshData out = mesh;
    Array2f::Dense UV(out.V.rows(), 2);
    parallel_for(size_t(UV.rows()), drawable_grain, [&](size_t i) {
        const auto row = Eigen::Index(i);
        const float value = values.values(row);
        UV.row(row) << (std::isnan(value) ? value : place_of(value, values.range)), 0.75f;
    });
    out.UV = Array2f(std::move(UV));
    out.C = {};
    return out;
}

/// A face with a corner that is not a number has no value at all: other corners of it that have one are
/// repeated behind the mesh's own vertices, for all such faces once.
Colored with_repeated_corners(const MeshData& mesh, const Array1f& values) {
    const auto is_number = [&](int32_t vertex) { return std::isfinite(values(vertex)); };
    constexpr int32_t none = -1;
    std::vector<int32_t> rows(size_t(mesh.V.rows())), repeated(rows.size(), none);
    std::iota(rows.begin(), rows.end(), 0);
    Array3i::Dense F = mesh.F;
    for (Eigen::Index f = 0; f < F.rows(); ++f) {
        int32_t* const corners = F.data() + 3 * f;
        if (std::all_of(corners, corners + 3, is_number)) continue;
        for (int k = 0; k < 3; ++k) {
            if (!is_number(corners[k])) continue;
            int32_t& own = repeated[size_t(corners[k])];
            if (own == none) {
                own = int32_t(rows.size());
                rows.push_back(corners[k]);
            }
            corners[k] = own;
        }
    }
    const Eigen::Map<const Array1i::Dense> whole(rows.data(), Eigen::Index(rows.size()));
    return with_vertices(mesh, Array1i(Array1i::Dense(whole)), Array3i(std::move(F)));
}

/// Values as texture coordinates (v up) of their table: interpolated before they become colours, beyond the
/// table's ends too. A face with a corner that is not a number has no values at all.
Colored with_values(const MeshData& mesh, const ElementColors& values) {
    const bool has_nan = !values.values.array().isFinite().all();
    Colored out = has_nan ? with_repeated_corners(mesh, values.values) : Colored{mesh};
    Array2f::Dense UV(out.mesh.V.rows(), 2);
    parallel_for(size_t(UV.rows()), drawable_grain, [&](size_t i) {
        const auto row = Eigen::Index(i);
        // What is repeated is of faces without a value.
        const float value =
            row < mesh.V.rows() ? values.values(row) : std::numeric_limits<float>::quiet_NaN();
        if (std::isfinite(value))
            UV.row(row) << place_of(value, values.range), 0.75f;
        else
            UV.row(row) << 0.5f, 0.25f;
    });
    out.mesh.UV = Array2f(std::move(UV));
    out.mesh.C = {};
    return out;
}

/// The table in place of all that a material's textures say.
void show_table(Material& material, const Texture& table) {
    for (const MaterialTexture& row : replaceable_textures()) material.*row.texture = {};
    material.base_color_texture = table;
}

Colored with_colors(const MeshData& mesh, const ColorPlan& plan) {
    if (plan.source == ColorSource::coordinates) {
        Colored out{mesh, coordinates_texture()};
        out.mesh.C = {};
        return out;
    }
    const ElementColors colors = element_colors(mesh, plan);
    if (plan.source == ColorSource::values) {
        Colored out =
            plan.mode == DrawMode::lines ? Colored{with_places(mesh, colors)} : with_values(mesh, colors);
        out.table = table_texture(colors);
        return out;
    }
    if (plan.element == PerElement::face) return with_face_colors(mesh, colors.colors);
    Colored out{mesh};
    out.mesh.C = colors_of(colors.colors);
    return out;
}

/// The clip planes and the sides of the crop box in the mesh's frame.
std::vector<Eigen::Vector4d> planes_of(const ClipSettings& clip, const Eigen::Affine3d& T_world_mesh) {
    std::vector<Eigen::Vector4d> planes;
    for (size_t i = 0; i + 3 < clip.planes.size(); i += 4) planes.emplace_back(&clip.planes[i]);
    for (size_t axis = 0; axis < 3 && clip.box.size() == 6; ++axis)
        for (const double side : {1.0, -1.0}) {
            Eigen::Vector4d plane(0, 0, 0, side > 0 ? -clip.box[axis] : clip.box[axis + 3]);
            plane[Eigen::Index(axis)] = side;
            planes.push_back(plane);
        }
    const Mat4d transposed = T_world_mesh.matrix().transpose();
    for (Eigen::Vector4d& plane : planes) plane = transposed * plane;
    return planes;
}

/// Where `second` says what `first` came from.
Array1i composed(const Array1i& second, const Array1i& first) {
    if (first.empty()) return second;
    if (second.empty()) return first;
    Array1i::Dense both(second.rows());
    for (Eigen::Index i = 0; i < both.size(); ++i) both[i] = first(second(i));
    return Array1i(std::move(both));
}

/// All that a cached drawing replaces of an object, and so what it is valid for. Materials are those of the
/// object as it is drawn so far: a table of values has replaced them.
std::string arrays_of(const MeshData& mesh) {
    std::string key = fmt::format("{} {}", fmt::join(array_revisions(mesh), " "), mesh.voxel_size);
    for (const MeshPart& part : mesh.parts)
        key += fmt::format(" {}+{}:{}", part.first_face, part.face_count, part.material);
    return key;
}

ColorMeaning meaning_of(const ColorPlan& plan) {
    return {.from_data = plan.source != ColorSource::material,
            .exact = plan.exact,
            .labels = plan.by == ColorBy::label,
            .values = plan.source == ColorSource::values,
            .textured = plan.textured || plan.source == ColorSource::values ||
                        plan.source == ColorSource::coordinates,
            .vertex_colors = plan.vertex_colors};
}

/// The points that the faces and corners of voxels came from.
ElementSources of_voxels(const MeshData& cubes) {
    Array1i::Dense corners(cubes.V.rows());
    for (Eigen::Index f = 0; f < cubes.F.rows(); ++f)
        for (int k = 0; k < 3; ++k) corners[cubes.F(f, k)] = cubes.source_face(f);
    return {cubes.source_face, Array1i(std::move(corners))};
}

}  // namespace

template <class Make>
std::shared_ptr<const MeshData> DrawableCache::get(const std::string& key, const MeshData& current,
                                                   ElementSources& sources, Make&& make) {
    const Entry& entry = entries_.get(key, [&] {
        Entry made;
        made.arrays = std::make_shared<const MeshData>(make(made));
        return made;
    });
    sources = {composed(entry.sources.faces, sources.faces), composed(entry.sources.points, sources.points)};
    auto mesh = std::make_shared<MeshData>(current);
    replace_arrays(*mesh, *entry.arrays);
    if (!entry.table) return mesh;
    if (mesh->materials.empty()) mesh->materials.emplace_back();
    for (Material& material : mesh->materials) show_table(material, entry.table);
    return mesh;
}

void DrawableCache::evict_unused() {
    entries_.evict_unused();
    creases_.evict_unused();
    kept_creases_.evict_unused();
}

DrawableScene DrawableCache::apply(const SceneSnapshot& scene, const InferredSettings& settings) {
    require_colors(scene, settings.style);
    const size_t count = scene.objects.size();
    DrawableScene drawable{scene, std::vector<ColorMeaning>(count), std::vector<ElementSources>(count),
                           std::vector<PointsOnTop>(count)};
    for (size_t i = 0; i < count; ++i) apply(drawable, i, settings);
    return drawable;
}

void DrawableCache::apply(DrawableScene& drawable, size_t index, const InferredSettings& settings) {
    SceneSnapshot::Object& object = drawable.scene.objects[index];
    SceneSnapshot::Object own = object;
    object.half_voxel = object.point_radius = 0;  // kinds of primitives tell how far they reach
    const DrawStyle style = resolve_style(*own.mesh, settings.style);
    const auto plan_for = [&](DrawMode mode) {
        return plan_colors(*own.mesh, settings.style, mode, own.T_world_mesh, parse_up(settings.camera.up),
                           drawable.scene.origin);
    };
    const ColorPlan plan = plan_for(style.mode);
    drawable.meanings[index] = drawable.points[index].meaning = meaning_of(plan);
    if (!style.visible || own.mesh->V.empty()) return;
    const std::vector<Eigen::Vector4d> planes = planes_of(settings.clip, own.T_world_mesh);
    const bool by_vertex = style.mode != DrawMode::mesh && style.mode != DrawMode::lines;
    const std::shared_ptr<const MeshData> given = own.mesh;
    ElementSources split;
    if (style.mode == DrawMode::mesh && !style.flat) own.mesh = creased(own, settings.load.crease_deg, split);
    const auto dressed = [&](const ColorPlan& by, ElementSources& sources) {
        const auto whole = colored(own, by, sources);
        return planes.empty() ? whole : clipped(whole, planes, by_vertex, by.by == ColorBy::label, sources);
    };
    ElementSources& sources = drawable.sources[index] = split;
    object.mesh = dressed(plan, sources);
    if (style.mode == DrawMode::voxels && !object.mesh->V.empty()) {
        const double spacing = style.voxel_size ? 0 : spacings_.get(own.mesh->V);
        const double size = style.voxel_size ? double(*style.voxel_size) : spacing > 0 ? spacing : 1;
        object.mesh = as_voxels(object.mesh, size, sources);
    }
    if (!style.show_points) return;
    const ColorPlan of_points = plan_for(DrawMode::points);
    PointsOnTop& points = drawable.points[index];
    points.meaning = meaning_of(of_points);
    if (of_points.key == plan.key && own.mesh == given) return;
    own.mesh = given;  // vertices are drawn once each, with the normals that they have
    ElementSources of_vertices;
    points.mesh = dressed(of_points, of_vertices);
    sources.points = of_vertices.points;
}

std::shared_ptr<const MeshData> DrawableCache::colored(const SceneSnapshot::Object& object,
                                                       const ColorPlan& plan, ElementSources& sources) {
    if (plan.source == ColorSource::material) return object.mesh;
    const MeshData& own = *object.mesh;
    return get(fmt::format("{} {}", arrays_of(own), plan.key), own, sources, [&](Entry& entry) {
        Colored made = with_colors(own, plan);
        entry.table = made.table;
        entry.sources.points = made.points;
        return std::move(made.mesh);
    });
}

std::shared_ptr<const MeshData> DrawableCache::creased(const SceneSnapshot::Object& object, float angle_deg,
                                                       ElementSources& sources) {
    const MeshData& whole = *object.mesh;
    if (whole.F.empty() || !whole.N.empty()) return object.mesh;
    const uint64_t F = whole.F.revision(), source = whole.source_vertex.revision();
    const auto found = [&](const Array3f& V) {
        return creases_.get({V.revision(), F, source, angle_deg},
                            [&] { return std::make_shared<const Creases>(find_creases(whole, angle_deg)); });
    };
    const std::optional<Array3f> rest = rest_positions(whole);
    const SharedCreases shared =
        rest ? found(*rest)
             : kept_creases_.get({object.node, F, source, angle_deg}, [&] { return found(whole.V); });
    const Creases& creases = *shared;
    if (creases.empty()) return object.mesh;
    const std::string key = fmt::format("crease {} {}", creases.F.revision(), arrays_of(whole));
    return get(key, whole, sources, [&](Entry& entry) {
        MeshData mesh = whole;
        const std::vector<int32_t> rows = split_creases(mesh, creases);
        entry.sources.points =
            Array1i::Dense(Eigen::Map<const Eigen::VectorXi>(rows.data(), Eigen::Index(rows.size())));
        return mesh;
    });
}

std::shared_ptr<const MeshData> DrawableCache::clipped(const std::shared_ptr<const MeshData>& whole,
                                                       const std::vector<Eigen::Vector4d>& planes,
                                                       bool by_vertex, bool labels, ElementSources& sources) {
    std::string key = fmt::format("cut {} {}", by_vertex, arrays_of(*whole));
    for (const Eigen::Vector4d& plane : planes) key += fmt::format(" {}", fmt::join(plane, " "));
    const auto made = get(key, *whole, sources, [&](Entry& entry) {
        MeshData rest = cut(*whole, planes, by_vertex, entry.sources.faces, entry.sources.points);
        const Array1i& from = entry.sources.points;
        // Colours of labels are never mixed: a vertex that a cut makes has that of the nearer one.
        if (labels && !from.empty()) rest.C = rows_of(whole->C, {from.data(), size_t(from.size())});
        return rest;
    });
    if (by_vertex) spacings_.share_discs(whole->V, made->V);
    return made;
}

std::shared_ptr<const MeshData> DrawableCache::as_voxels(const std::shared_ptr<const MeshData>& centres,
                                                         double size, ElementSources& sources) {
    ElementSources cubes;
    const auto made =
        get(fmt::format("voxels {} {}", arrays_of(*centres), size), *centres, cubes, [&](Entry& entry) {
            MeshData mesh = voxel_mesh(*centres, size);
            entry.sources = of_voxels(mesh);
            return mesh;
        });
    sources = {composed(cubes.faces, sources.points), composed(cubes.points, sources.points), size};
    return made;
}

}  // namespace easypbr::render
