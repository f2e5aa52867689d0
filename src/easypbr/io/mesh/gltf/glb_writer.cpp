#include "easypbr/io/mesh/gltf/glb_writer.h"

#include <fmt/format.h>

#include <array>
#include <limits>
#include <map>
#include <tuple>

#include "easypbr/core/color.h"
#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "easypbr/io/mesh/gltf/glb_textures.h"
#include "easypbr/io/mesh/gltf/gltf_mesh.h"
#include "easypbr/io/mesh/gltf/gltf_splats.h"
#include "easypbr/io/mesh/gltf/gltf_values.h"
#include "easypbr/scene/crease.h"
#include "easypbr/scene/merge.h"
#include "easypbr/scene/mesh.h"
#include "easypbr/scene/mesh_arrays.h"

namespace easypbr::io {
namespace {

enum Target { array_buffer = 34962, element_buffer = 34963 };
enum ComponentType { unsigned_int = 5125, floating = 5126 };
enum PrimitiveMode { mode_points = 0, mode_lines = 1, mode_triangles = 4 };

/// What a mesh of the file is made of: equal ones are written once. Names are those of the first.
struct MeshContent {
    std::vector<uint64_t> revisions;  ///< of the arrays
    std::vector<std::string> scalars;
    std::vector<std::array<int, 3>> parts;  ///< first face, count of faces, material
    std::vector<size_t> materials;          ///< numbers in the file
    bool is_flat = false;
    float voxel_size = 0;
    uint64_t rest_shape = 0, rest_shape_faces = 0;  ///< which decide on sharp edges

    auto values() const {
        return std::tie(revisions, scalars, parts, materials, is_flat, voxel_size, rest_shape,
                        rest_shape_faces);
    }
    bool operator<(const MeshContent& other) const { return values() < other.values(); }
};

/// Equal materials that are written once. The key holds enough of them that few others have the same.
class MaterialNumbers {
  public:
    template <class Add>
    size_t number(const Material& material, bool transparent_vertices, Add&& add) {
        const Vec3& color = material.base_color;
        const Key key{
            material.name,
            transparent_vertices,
            {color[0], color[1], color[2], material.opacity, material.metallic, material.roughness}};
        auto& same_key = numbers_[key];
        for (const auto& [known, number] : same_key)
            if (known == material) return number;
        return same_key.emplace_back(material, add()).second;
    }

  private:
    using Key = std::tuple<std::string, bool, std::array<float, 6>>;
    std::map<Key, std::vector<std::pair<Material, size_t>>> numbers_;
};

class GlbBuilder {
  public:
    std::string build(const Mesh& mesh) {
        content_.json["asset"] = {{"version", "2.0"}, {"generator", "EasyPBR"}};
        content_.json["scene"] = 0;
        origin_ = offset_of_tree(mesh);
        content_.json["scenes"] = OrderedJson::array({{{"nodes", placed_nodes(mesh)}}});
        if (!content_.json.contains("meshes"))
            throw ArgumentError("cannot write GLB: the mesh has no vertices");
        return packed();
    }

  private:
    /// The tree's offset is the translation of a node around all others: JSON holds it in double precision.
    OrderedJson placed_nodes(const Mesh& mesh) {
        OrderedJson nodes = root_nodes(mesh);
        if (origin_.isZero(0)) return nodes;
        OrderedJson around{{"name", mesh.name()}, {"translation", {origin_.x(), origin_.y(), origin_.z()}}};
        around["children"] = std::move(nodes);
        return OrderedJson::array({add(std::move(around))});
    }

    /// What a reader put around a file's nodes is left out again.
    OrderedJson root_nodes(const Mesh& mesh) {
        const auto data = mesh.snapshot();
        OrderedJson nodes = OrderedJson::array();
        if (data->V.empty() && data->T_parent_mesh.matrix() == Mat4d::Identity())
            for (const Mesh& child : data->children) nodes.push_back(add_node(child, 1));
        else
            nodes.push_back(add_node(mesh, 1));
        return nodes;
    }

    size_t add_node(const Mesh& mesh, int depth) {
        require_mesh_depth(depth);
        const auto data = mesh.snapshot();
        OrderedJson node;
        node["name"] = data->name;
        const Mat4d pose = data->T_parent_mesh.matrix();
        if (pose != Mat4d::Identity()) node["matrix"] = std::vector<double>(pose.data(), pose.data() + 16);
        OrderedJson children = OrderedJson::array();
        if (!data->V.empty()) {
            const Vec3d shift = data->offset - origin_;
            // The shift is that of the node's own vertices, not of its children.
            if (shift.isZero(0))
                node["mesh"] = add_mesh(*data);
            else
                children.push_back(add({{"name", data->name},
                                        {"translation", {shift.x(), shift.y(), shift.z()}},
                                        {"mesh", add_mesh(*data)}}));
        }
        for (const Mesh& child : data->children) children.push_back(add_node(child, depth + 1));
        if (!children.empty()) node["children"] = std::move(children);
        return add(std::move(node));
    }

    size_t add(OrderedJson node) {
        content_.json["nodes"].push_back(std::move(node));
        return content_.json["nodes"].size() - 1;
    }

    size_t add_mesh(const MeshData& data) {
        const std::vector<size_t> materials = add_materials(data);
        const auto [found, is_new] = meshes_.try_emplace(content_of(data, materials), meshes_.size());
        if (is_new) write_mesh(data, materials);
        return found->second;
    }

    static MeshContent content_of(const MeshData& data, const std::vector<size_t>& materials) {
        MeshContent content;
        content.revisions = array_revisions(data);
        for (const ScalarArray& scalar : data.scalars) content.scalars.push_back(scalar.name);
        for (const MeshPart& part : data.parts)
            content.parts.push_back({part.first_face, part.face_count, part.material});
        content.materials = materials;
        content.is_flat = data.style.flat.value_or(false);
        content.voxel_size = data.voxel_size;
        content.rest_shape = data.rest_shape.V.revision();
        content.rest_shape_faces = data.rest_shape.F_revision;
        return content;
    }

    void write_mesh(MeshData data, const std::vector<size_t>& materials) {
        // A reader shades a file without normals flat.
        if (data.N.empty() && !data.F.empty() && !data.style.flat.value_or(false)) add_drawn_normals(data);
        OrderedJson attributes = add_attributes(data);
        OrderedJson primitives = OrderedJson::array();
        if (!data.F.empty()) add_parts(data, attributes, materials, primitives);
        if (!data.E.empty()) {
            const size_t indices = add_indices(data.E.data(), size_t(data.E.size()));
            primitives.push_back(
                {{"attributes", attributes}, {"indices", indices}, {"mode", int(mode_lines)}});
            if (!data.F.empty())
                primitives.back()["extras"][gltf_edges_of_faces] = true;
            else if (!materials.empty())
                primitives.back()["material"] = materials[0];
        }
        if (primitives.empty()) {
            primitives.push_back(points(data, std::move(attributes)));
            if (!materials.empty()) primitives.back()["material"] = materials[0];
        }
        OrderedJson mesh{{"name", data.name}, {"primitives", std::move(primitives)}};
        if (data.voxel_size > 0) mesh["extras"][gltf_voxel_size] = data.voxel_size;
        content_.json["meshes"].push_back(std::move(mesh));
    }

    OrderedJson points(const MeshData& data, OrderedJson attributes) {
        if (!data.splats.empty()) add_splats(data.splats, attributes);
        OrderedJson primitive{{"attributes", std::move(attributes)}, {"mode", int(mode_points)}};
        if (!data.splats.empty())
            content_.extend(primitive, khr_gaussian_splatting) = {{"kernel", "ellipse"},
                                                                  {"colorSpace", "srgb_rec709_display"}};
        return primitive;
    }

    void add_splats(const SplatArrays& splats, OrderedJson& attributes) {
        const auto rows = size_t(splats.scales.rows());
        Array4f::Dense xyzw(splats.rotations.rows(), 4);
        xyzw << splats.rotations.rightCols(3), splats.rotations.col(0);
        xyzw.rowwise().normalize();
        attributes[splat_rotation_attribute] = add_floats(xyzw.data(), rows, 4);
        attributes[splat_scale_attribute] = add_floats(splats.scales.data(), rows, 3);
        attributes[splat_opacity_attribute] = add_floats(splats.opacities.data(), rows, 1);
        Eigen::Index column = 0;
        for (int degree = 0; degree <= splats.degree(); ++degree)
            for (int k = 0; k <= 2 * degree; ++k, column += 3) {
                const Array3f::Dense harmonic = splats.sh.middleCols(column, 3);
                attributes[splat_harmonic_name(degree, k)] = add_floats(harmonic.data(), rows, 3);
            }
    }

    size_t material_index(const MeshData& data, Material material) {
        const bool with_coordinates = !data.F.empty() && !data.UV.empty();
        material.base_color = material.color_factor(!data.C.empty(), with_coordinates);
        const bool transparent = has_transparent_colors(data.C);
        return material_numbers_.number(material, transparent,
                                        [&] { return materials_.add(material, transparent); });
    }

    /// Numbers of a mesh's materials: all of faces; one of points and lines, none for the default, which
    /// draws lines dark.
    std::vector<size_t> add_materials(const MeshData& data) {
        std::vector<Material> given = data.materials;
        if (!data.F.empty()) {
            if (given.empty()) given.emplace_back();
        } else {
            const bool has_one = data.splats.empty() && !given.empty() && given[0] != Material();
            given.resize(has_one ? 1 : 0);
        }
        std::vector<size_t> numbers;
        for (const Material& material : given) numbers.push_back(material_index(data, material));
        return numbers;
    }

    void add_parts(const MeshData& data, const OrderedJson& attributes, const std::vector<size_t>& materials,
                   OrderedJson& primitives) {
        std::vector<MeshPart> parts = data.parts;
        if (parts.empty()) parts.push_back({"", 0, int(data.F.rows()), 0});
        for (const MeshPart& part : parts) {
            if (part.face_count == 0) continue;
            const size_t indices =
                add_indices(data.F.data() + 3 * Eigen::Index(part.first_face), 3 * size_t(part.face_count));
            primitives.push_back({{"attributes", attributes},
                                  {"indices", indices},
                                  {"material", materials[size_t(part.material)]},
                                  {"mode", int(mode_triangles)}});
        }
    }

    OrderedJson add_attributes(const MeshData& data) {
        OrderedJson attributes;
        attributes["POSITION"] = add_floats(data.V.data(), size_t(data.V.rows()), 3);
        OrderedJson& position = content_.json["accessors"].back();
        const Vec3 least = data.V.colwise().minCoeff(), most = data.V.colwise().maxCoeff();
        position["min"] = {least[0], least[1], least[2]};
        position["max"] = {most[0], most[1], most[2]};
        if (!data.N.empty()) attributes["NORMAL"] = add_floats(data.N.data(), size_t(data.N.rows()), 3);
        if (!data.UV.empty()) {
            Array2f::Dense UV = data.UV;
            UV.col(1).array() = 1 - UV.col(1).array();
            attributes["TEXCOORD_0"] = add_floats(UV.data(), size_t(UV.rows()), 2);
        }
        // The format has no vertices without a tangent beside others.
        if (!data.N.empty() && !data.uv_tangents.empty() &&
            (data.uv_tangents.col(3).cwiseAbs().array() == 1).all())
            attributes["TANGENT"] = add_floats(data.uv_tangents.data(), size_t(data.V.rows()), 4);
        if (!data.C.empty()) {
            ArrayXf::Dense C = data.C;
            for (Eigen::Index i = 0; i < C.rows(); ++i)
                for (int c = 0; c < 3; ++c) C(i, c) = linear_from_srgb(C(i, c));
            attributes["COLOR_0"] = add_floats(C.data(), size_t(C.rows()), int(C.cols()));
        }
        for (const auto& [name, values] : values_for_gltf(data))
            attributes[name] = add_floats(values.data(), size_t(values.rows()), 1);
        return attributes;
    }

    size_t add_floats(const float* data, size_t rows, int columns) {
        const size_t view = content_.add_view(data, rows * size_t(columns) * sizeof(float), array_buffer);
        return add_accessor(view, floating, rows, columns == 1 ? "SCALAR" : fmt::format("VEC{}", columns));
    }

    size_t add_indices(const int32_t* data, size_t count) {
        return add_accessor(content_.add_view(data, count * 4, element_buffer), unsigned_int, count,
                            "SCALAR");
    }

    size_t add_accessor(size_t view, ComponentType type, size_t count, const std::string& shape) {
        content_.json["accessors"].push_back(
            {{"bufferView", view}, {"componentType", int(type)}, {"count", count}, {"type", shape}});
        return content_.json["accessors"].size() - 1;
    }

    std::string packed() {
        content_.binary.resize((content_.binary.size() + 3) / 4 * 4, '\0');
        content_.json["buffers"] = OrderedJson::array({{{"byteLength", content_.binary.size()}}});
        // Names may hold any bytes: what is no UTF-8 is replaced.
        std::string json = content_.json.dump(-1, ' ', false, OrderedJson::error_handler_t::replace);
        json.resize((json.size() + 3) / 4 * 4, ' ');
        const size_t total = 12 + 8 + json.size() + 8 + content_.binary.size();
        if (total > std::numeric_limits<uint32_t>::max())
            throw ArgumentError(
                fmt::format("cannot write GLB: {} bytes, the format holds at most 4 GiB", total));
        std::string out = "glTF";
        const auto append = [&](size_t value) {
            const uint32_t word = uint32_t(value);
            out.append(reinterpret_cast<const char*>(&word), 4);
        };
        append(2);
        append(total);
        append(json.size());
        out += "JSON" + json;
        append(content_.binary.size());
        out += std::string("BIN\0", 4);
        return out + content_.binary;
    }

    Vec3d origin_ = Vec3d::Zero();
    GlbContent content_;
    GlbMaterials materials_{content_};
    MaterialNumbers material_numbers_;
    std::map<MeshContent, size_t> meshes_;  ///< with their numbers in the file
};

}  // namespace

std::string encode_glb(const Mesh& mesh) {
    return GlbBuilder().build(mesh);
}

void save_glb(const Mesh& mesh, const std::filesystem::path& path) {
    write_file(path, encode_glb(mesh));
}

}  // namespace easypbr::io
