#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "easypbr/core/parallel.h"
#include "easypbr/io/image/texture_loader.h"
#include "easypbr/io/mesh/mesh_readers.h"
#include "easypbr/io/mesh/ply/compressed_splats.h"
#include "easypbr/io/mesh/ply/ply_header.h"
#include "easypbr/io/tables/attributes.h"
#include "easypbr/io/tables/splat_columns.h"
#include "easypbr/io/tables/vertex_arrays.h"

namespace easypbr::io {
namespace {

using Names = std::vector<std::string_view>;

/// Positions of the named scalar properties; empty unless all are there.
std::vector<size_t> find_scalars(const Element& element, const Names& names) {
    std::vector<size_t> found;
    for (const std::string_view name : names) {
        const auto is_it = [&](const Property& p) { return p.name == name && !p.count_type; };
        const auto it = std::find_if(element.properties.begin(), element.properties.end(), is_it);
        if (it == element.properties.end()) return {};
        found.push_back(size_t(it - element.properties.begin()));
    }
    return found;
}

/// Reads one file.
class PlyReader {
  public:
    PlyReader(const Source& source, PlyHeader header) : source_(source), header_(std::move(header)) {}

    MeshData read() {
        check_counts();
        plan_elements();
        if (header_.format == PlyFormat::ascii) {
            const TextRows rows(source_, header_.body, {});
            vertices_.recentre(sample_text_positions(rows, header_.elements, position_));
            read_text_elements(source_, rows, plans_);
        } else {
            const auto endian =
                header_.format == PlyFormat::binary_little_endian ? std::endian::little : std::endian::big;
            vertices_.recentre(
                sample_binary_positions(source_, header_.body, endian, header_.elements, position_));
            read_binary_elements(source_, header_.body, endian, plans_);
        }
        check();
        split_vertices();
        split_by_color_of_faces();
        make_mesh();
        add_materials();
        set_front();
        if (strip_triangles_.empty())
            face_values_.move_into(mesh_, source_);
        else
            face_values_.leave_out(source_, beside_strips);
        return std::move(mesh_);
    }

  private:
    /// Nothing is allocated for rows that cannot be in the file.
    void check_counts() const {
        if (header_.format == PlyFormat::ascii)
            return check_text_rows(source_, header_.body, header_.elements);
        size_t left = size_t(source_.end() - header_.body);
        for (const Element& element : header_.elements) {
            const size_t least = smallest_row(element);
            if (element.count > left / least)
                fail(source_,
                     fmt::format(
                         "truncated: {} rows of '{}' take at least {} bytes each, but {} bytes are left",
                         element.count, element.name, least, left));
            left -= element.count * least;
        }
    }

    void plan_elements() {
        bool has_vertices = false, has_faces = false, has_strips = false, has_edges = false,
             has_camera = false;
        for (const Element& element : header_.elements) {
            plans_.push_back({&element, std::vector<Column>(element.properties.size())});
            ElementPlan& plan = plans_.back();
            const auto is_first = [&](std::string_view name, bool& seen) {
                return element.name == name && !std::exchange(seen, true);
            };
            if (is_first("vertex", has_vertices)) plan_vertices(plan);
            if (is_first("face", has_faces)) plan_faces(plan);
            if (is_first("tristrips", has_strips))
                plan_list(plan, {"vertex_indices", "vertex_index"}, strips_);
            if (is_first("edge", has_edges)) plan_edges(plan);
            if (is_first("camera", has_camera) && element.count == 1) plan_camera(plan);
        }
        if (vertices_.count() == 0) fail(source_, "no vertices: an element 'vertex' with x, y, z expected");
    }

    void plan_vertices(ElementPlan& plan) {
        const Element& element = *plan.element;
        if (element.count == 0) return;
        std::vector<VertexField> fields;
        std::vector<PropertyPlace> places;
        for (size_t i = 0; i < element.properties.size(); ++i) {
            const Property& property = element.properties[i];
            if (property.count_type) continue;
            fields.push_back({property, &plan.columns[i]});
            places.push_back({size_t(&element - header_.elements.data()), i});
        }
        splats_ = SplatColumns(source_, fields, element.count);
        vertices_ = VertexArrays(fields, element.count);
        if (!vertices_.position()) fail(source_, "element 'vertex' has no properties x, y, z");
        std::ranges::transform(*vertices_.position(), position_.begin(),
                               [&](size_t field) { return places[field]; });
    }

    /// Plans the first list property with one of the names.
    template <class T>
    void plan_list(ElementPlan& plan, const Names& names, List<T>& list) {
        for (size_t i = 0; i < plan.columns.size(); ++i) {
            const Property& property = plan.element->properties[i];
            if (!property.count_type || std::find(names.begin(), names.end(), property.name) == names.end())
                continue;
            if constexpr (std::is_same_v<T, int32_t>) {
                if (!is_integer(property.type))
                    fail(source_, fmt::format("property '{}' must be a list of integers", property.name));
                plan.columns[i].indices = &list;
            } else {
                plan.columns[i].values = &list;
            }
            return;
        }
    }

    void plan_faces(ElementPlan& plan) {
        plan_list(plan, {"vertex_indices", "vertex_index"}, faces_);
        plan_list(plan, {"texcoord"}, corner_uv_);
        const auto number = find_scalars(*plan.element, Names{"texnumber"});
        if (!number.empty() && header_.textures.size() > 1) {
            texture_number_.resize(plan.element->count);
            plan.columns[number[0]].integers = texture_number_.data();
        }
        face_values_ = FaceArrays(plan);
    }

    void plan_edges(ElementPlan& plan) {
        const auto ends = find_scalars(*plan.element, Names{"vertex1", "vertex2"});
        if (ends.empty() || plan.element->count == 0) return;
        E_.resize(Eigen::Index(plan.element->count), 2);
        for (size_t i = 0; i < 2; ++i) {
            plan.columns[ends[i]].integers = E_.data() + i;
            plan.columns[ends[i]].stride = 2;
        }
    }

    /// Where a scanner stood, as VCGLib writes it with range maps.
    void plan_camera(ElementPlan& plan) {
        const auto place = find_scalars(*plan.element, Names{"view_px", "view_py", "view_pz"});
        for (size_t i = 0; i < place.size(); ++i) plan.columns[place[i]].floats = &camera_[Eigen::Index(i)];
    }

    bool is_cloud() const { return faces_.rows == 0 && strips_.rows == 0 && E_.size() == 0; }

    void check() {
        const size_t count = size_t(vertices_.count());
        if (!is_cloud()) vertices_.check(source_);
        check_indices(source_, {faces_.values.data(), faces_.value_count()}, count, "a face");
        check_indices(source_, {E_.data(), size_t(E_.size())}, count, "an edge");
        strip_triangles_ = triangles_of_strips(strips_);
        check_indices(source_, strip_triangles_, count, "a triangle strip");
    }

    void take_splats() {
        mesh_.splats = splats_.finish(source_);
        mesh_.N = {};  // The reference implementation writes zeros.
        mesh_.up = header_.up.value_or(splat_up);
    }

    /// Where faces carry texture coordinates, makes one vertex of each different (vertex, uv).
    void split_vertices() {
        const bool cloud = is_cloud();
        vertices_.move_into(mesh_, source_);
        if (!splats_.empty()) take_splats();
        if (cloud) drop_points_without_position(source_, mesh_);
        if (corner_uv_.value_count() == 0) return;
        std::vector<uint64_t> keys(faces_.value_count(), no_key);
        parallel_for(faces_.rows, 1 << 13, [&](size_t face) {
            const size_t size = faces_.size_of(face);
            if (corner_uv_.size_of(face) != 2 * size) return;
            const float* uv = corner_uv_.values.data() + corner_uv_.begin_of(face);
            for (size_t k = 0; k < size; ++k)
                keys[faces_.begin_of(face) + k] =
                    std::bit_cast<uint64_t>(std::array{uv[2 * k], uv[2 * k + 1]});
        });
        const auto split =
            split_corners({faces_.values.data(), faces_.value_count()}, keys, size_t(mesh_.V.rows()));
        Array2f::Dense UV = Array2f::Dense::Zero(Eigen::Index(split.key.size()), 2);
        parallel_for(split.key.size(), 1 << 14, [&](size_t i) {
            if (split.key[i] == no_key) return;
            const auto uv = std::bit_cast<std::array<float, 2>>(split.key[i]);
            UV.row(Eigen::Index(i)) << uv[0], uv[1];
        });
        tidy_uv(UV);
        gather_vertices(split, mesh_);
        mesh_.UV = std::move(UV);
        follow_split(split, {E_.data(), size_t(E_.size())});
        follow_split(split, strip_triangles_);
    }

    /// Where faces have colours, makes one vertex of each different (vertex, colour).
    void split_by_color_of_faces() {
        const ArrayXf::Dense C = face_values_.take_colors();
        if (C.rows() == 0 || faces_.value_count() == 0) return;
        if (!mesh_.C.empty() || strip_triangles_.size()) {
            warn_of_left_out_values(
                source_, "the colours",
                mesh_.C.empty() ? beside_strips : "the vertices have colours of their own");
            return;
        }
        const CornerSplit split = color_vertices_by_faces(C, faces_, mesh_);
        follow_split(split, {E_.data(), size_t(E_.size())});
    }

    void make_mesh() {
        if (E_.size()) mesh_.E = std::move(E_);
        triangulate(std::move(faces_), mesh_);
        if (strip_triangles_.empty()) return;
        Array3i::Dense F(mesh_.F.rows() + Eigen::Index(strip_triangles_.size() / 3), 3);
        F << mesh_.F, Eigen::Map<const Array3i::Dense>(strip_triangles_.data(),
                                                       Eigen::Index(strip_triangles_.size() / 3), 3);
        mesh_.F = std::move(F);
        mesh_.source_face = {};
    }

    /// Files that are no range maps may have a camera too, which stands anywhere, or within the content.
    void set_front() {
        if (!camera_.allFinite()) return;
        Box3d box;
        for (Eigen::Index i = 0; i < mesh_.V.rows(); ++i) box.extend(Vec3(mesh_.V.row(i)).cast<double>());
        const Vec3d way = camera_.cast<double>() - mesh_.offset - box.center();
        if (way.norm() > box.diagonal().norm() / 2) mesh_.front = way.normalized();
    }

    /// VCGLib writes "<this>" for the file's own name without its extension.
    std::string without_placeholder(std::string name) const {
        const std::string_view placeholder = "<this>";
        if (name.starts_with(placeholder)) name.replace(0, placeholder.size(), source_.path.stem().string());
        return name;
    }

    void add_materials() {
        TextureLoader loader(source_.path);
        for (const std::string& written : header_.textures) {
            const std::string name = without_placeholder(written);
            Material material;
            material.name = fs::path(name).stem().string();
            material.base_color_texture = loader.load(name);
            if (material.base_color_texture) material.base_color = Vec3::Ones();
            mesh_.materials.push_back(std::move(material));
        }
        if (texture_number_.empty()) return;
        if (strip_triangles_.size())
            return warn_of_left_out_values(source_, "the texture numbers", beside_strips);
        const int32_t last = int32_t(mesh_.materials.size()) - 1;
        for (int32_t& number : texture_number_) number = std::clamp(number, 0, last);
        assign_materials(texture_number_, mesh_);
    }

    /// Why values of faces are left out: triangles of strips have none.
    static constexpr const char* beside_strips = "there are triangle strips beside them";

    const Source& source_;
    const PlyHeader header_;
    std::vector<ElementPlan> plans_;

    VertexArrays vertices_;
    SplatColumns splats_;
    std::array<PropertyPlace, 3> position_{};  ///< of x, y, z
    Vec3 camera_ = Vec3::Constant(std::numeric_limits<float>::quiet_NaN());
    Array2i::Dense E_;
    Polygons faces_, strips_;
    FaceArrays face_values_;
    List<float> corner_uv_;
    std::vector<int32_t> texture_number_, strip_triangles_;
    MeshData mesh_;
};

}  // namespace

MeshData read_ply(const Source& given) {
    if (given.bytes.empty()) fail(given, "the file is empty");
    const Source source = given.without_mark();
    PlyHeader header = parse_ply_header(source);
    if (has_compressed_splats(header)) return read_compressed_splats(source, header);
    return PlyReader(source, std::move(header)).read();
}

}  // namespace easypbr::io
