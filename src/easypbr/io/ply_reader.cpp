#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>

#include "easypbr/core/parallel.h"
#include "easypbr/io/attributes.h"
#include "easypbr/io/mesh_readers.h"
#include "easypbr/io/ply_header.h"
#include "easypbr/io/texture_loader.h"

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

/// The first of several spellings of which all properties are there.
std::vector<size_t> find_spelling(const Element& element, const std::vector<Names>& spellings) {
    for (const Names& names : spellings)
        if (auto found = find_scalars(element, names); !found.empty()) return found;
    return {};
}

/// Colours stored as integers span the range of their type; int and uint are used for 0 .. 255.
float color_scale(ScalarType type) {
    switch (type) {
        case ScalarType::int8:
            return 1 / 127.0f;
        case ScalarType::int16:
            return 1 / 32767.0f;
        case ScalarType::uint16:
            return 1 / 65535.0f;
        case ScalarType::float32:
        case ScalarType::float64:
            return 1;
        default:
            return 1 / 255.0f;
    }
}

/// Reads one file.
class PlyReader {
  public:
    explicit PlyReader(const Source& source) : source_(source), header_(parse_ply_header(source)) {}

    MeshData read() {
        check_counts();
        plan_elements();
        if (header_.format == PlyFormat::ascii) {
            read_text_elements(source_, header_.body, 0, plans_);
        } else {
            const bool little = header_.format == PlyFormat::binary_little_endian;
            read_binary_elements(source_, header_.body, little ? std::endian::little : std::endian::big,
                                 plans_);
        }
        check();
        split_vertices();
        make_mesh();
        add_materials();
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
        bool has_vertices = false, has_faces = false, has_strips = false, has_edges = false;
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
        }
        if (V_.rows() == 0) fail(source_, "no vertices: an element 'vertex' with x, y, z expected");
    }

    void plan_vertices(ElementPlan& plan) {
        const Element& element = *plan.element;
        if (element.count == 0) return;
        const auto position = find_scalars(element, Names{"x", "y", "z"});
        if (position.empty()) fail(source_, "element 'vertex' has no properties x, y, z");
        plan_matrix(plan, position, V_);
        plan_matrix(plan, find_scalars(element, Names{"nx", "ny", "nz"}), N_);
        plan_matrix(plan, find_spelling(element, {{"u", "v"}, {"s", "t"}, {"texture_u", "texture_v"}}), UV_);
        plan_colors(plan);
        if (const auto label = find_scalars(element, Names{"label"}); !label.empty()) {
            L_.resize(Eigen::Index(element.count));
            plan.columns[label[0]].integers = L_.data();
        }
        plan_matrix(plan, find_scalars(element, Names{"intensity"}), I_);
    }

    template <class Matrix>
    void plan_matrix(ElementPlan& plan, const std::vector<size_t>& properties, Matrix& matrix) {
        if (properties.empty()) return;
        matrix.resize(Eigen::Index(plan.element->count), Eigen::Index(properties.size()));
        for (size_t i = 0; i < properties.size(); ++i) {
            plan.columns[properties[i]].floats = matrix.data() + i;
            plan.columns[properties[i]].stride = properties.size();
        }
    }

    void plan_colors(ElementPlan& plan) {
        const auto color =
            find_spelling(*plan.element, {{"red", "green", "blue", "alpha"},
                                          {"red", "green", "blue"},
                                          {"diffuse_red", "diffuse_green", "diffuse_blue", "diffuse_alpha"},
                                          {"diffuse_red", "diffuse_green", "diffuse_blue"},
                                          {"r", "g", "b"}});
        plan_matrix(plan, color, C_);
        for (const size_t i : color) plan.columns[i].scale = color_scale(plan.element->properties[i].type);
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
        if (number.empty() || header_.textures.size() < 2) return;
        texture_number_.resize(plan.element->count);
        plan.columns[number[0]].integers = texture_number_.data();
    }

    void plan_edges(ElementPlan& plan) {
        const auto ends = find_scalars(*plan.element, Names{"vertex1", "vertex2"});
        if (ends.empty()) return;
        E_.resize(Eigen::Index(plan.element->count), 2);
        for (size_t i = 0; i < 2; ++i) {
            plan.columns[ends[i]].integers = E_.data() + i;
            plan.columns[ends[i]].stride = 2;
        }
    }

    void check() {
        const size_t count = size_t(V_.rows());
        check_positions(source_, V_);
        check_indices(source_, {faces_.values.data(), faces_.value_count()}, count, "a face");
        check_indices(source_, {E_.data(), size_t(E_.size())}, count, "an edge");
        strip_triangles_ = triangles_of_strips(strips_);
        check_indices(source_, strip_triangles_, count, "a triangle strip");
        tidy_normals(N_);
        tidy_colors(C_);
    }

    /// Where faces carry texture coordinates, makes one vertex of each different (vertex, uv).
    void split_vertices() {
        move_vertices();
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
        UV_.setZero(Eigen::Index(split.key.size()), 2);
        parallel_for(split.key.size(), 1 << 14, [&](size_t i) {
            if (split.key[i] == no_key) return;
            const auto uv = std::bit_cast<std::array<float, 2>>(split.key[i]);
            UV_.row(Eigen::Index(i)) << uv[0], uv[1];
        });
        gather_vertices(split, mesh_);
        follow_split(split, {E_.data(), size_t(E_.size())});
        follow_split(split, strip_triangles_);
    }

    void move_vertices() {
        mesh_.V = std::move(V_);
        if (N_.size()) mesh_.N = std::move(N_);
        if (C_.size()) mesh_.C = std::move(C_);
        if (L_.size()) mesh_.L = std::move(L_);
        if (I_.size()) mesh_.I = std::move(I_);
    }

    void make_mesh() {
        tidy_uv(UV_);
        if (UV_.size()) mesh_.UV = std::move(UV_);
        if (E_.size()) mesh_.E = std::move(E_);
        triangulate(std::move(faces_), mesh_);
        if (strip_triangles_.empty()) return;
        Array3i::Dense F(mesh_.F.rows() + Eigen::Index(strip_triangles_.size() / 3), 3);
        F << mesh_.F, Eigen::Map<const Array3i::Dense>(strip_triangles_.data(),
                                                       Eigen::Index(strip_triangles_.size() / 3), 3);
        mesh_.F = std::move(F);
        mesh_.source_face = {};
    }

    void add_materials() {
        TextureLoader loader(source_.path);
        for (const std::string& name : header_.textures) {
            Material material;
            material.name = fs::path(name).stem().string();
            material.base_color_texture = loader.load(name);
            if (material.base_color_texture) material.base_color = Vec3::Ones();
            mesh_.materials.push_back(std::move(material));
        }
        if (texture_number_.empty() || strip_triangles_.size()) return;
        const int32_t last = int32_t(mesh_.materials.size()) - 1;
        for (int32_t& number : texture_number_) number = std::clamp(number, 0, last);
        assign_materials(texture_number_, mesh_);
    }

    const Source& source_;
    const PlyHeader header_;
    std::vector<ElementPlan> plans_;

    Array3f::Dense V_, N_;
    ArrayXf::Dense C_;
    Array2f::Dense UV_;
    Array1i::Dense L_;
    Array1f::Dense I_;
    Array2i::Dense E_;
    Polygons faces_, strips_;
    List<float> corner_uv_;
    std::vector<int32_t> texture_number_, strip_triangles_;
    MeshData mesh_;
};

}  // namespace

MeshData read_ply(const Source& source) {
    if (source.bytes.empty()) fail(source, "the file is empty");
    return PlyReader(source).read();
}

}  // namespace easypbr::io
