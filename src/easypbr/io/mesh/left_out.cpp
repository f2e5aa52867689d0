#include "easypbr/io/mesh/left_out.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <set>

#include "easypbr/core/color.h"
#include "easypbr/io/mesh/texture_mapping.h"
#include "easypbr/scene/material_table.h"

namespace easypbr::io {
namespace {

using Properties = std::set<std::string>;

const Properties properties_of_obj{"base_color",
                                   "emissive",
                                   "opacity",
                                   "roughness",
                                   "metallic",
                                   "normal_scale",
                                   "unlit",
                                   "base_color_texture",
                                   "emissive_texture",
                                   "roughness_texture",
                                   "metallic_texture",
                                   "opacity_texture",
                                   "normal_texture"};

std::vector<std::string> labels_and_scalars(const MeshData& mesh, bool of_faces_only) {
    std::vector<std::string> names;
    const auto is_left_out = [&](Eigen::Index rows) {
        return rows > 0 && (!of_faces_only || element_of(mesh, rows) == PerElement::face);
    };
    const char* const of = of_faces_only ? " of faces" : "";
    if (is_left_out(mesh.L.rows())) names.push_back(fmt::format("labels{}", of));
    for (const ScalarArray& scalar : mesh.scalars)
        if (is_left_out(scalar.values.rows()))
            names.push_back(fmt::format("scalars '{}'{}", scalar.name, of));
    return names;
}

/// Whether OBJ and formats of coloured vertices say an alpha mode by an opacity alone, OBJ by its map too.
bool says_alpha_mode(const Material& material, bool has_map) {
    if (!material.alpha_mode.value()) return true;
    const AlphaMode mode = *material.alpha_mode;
    if (mode == AlphaMode::opaque) return material.opacity == 1 && !material.opacity_texture;
    if (const Texture map = has_map ? obj_opacity_texture(material) : Texture())
        return mode == obj_alpha_mode(material.opacity, map);
    return mode == AlphaMode::blend ? material.opacity < 1 || material.opacity_texture
                                    : bool(material.opacity_texture);
}

/// The properties of a material that are not those of a new one, but for `double_sided`: closed surfaces look
/// the same with either.
std::vector<std::string> properties_of(const Material& material, bool has_opacity_map) {
    const Material plain;
    std::vector<std::string> names;
    for (const MaterialColor& color : material_colors())
        if (material.*color.value != plain.*color.value) names.emplace_back(color.name);
    for (const MaterialNumber& number : material_numbers())
        if (material.*number.value != plain.*number.value) names.emplace_back(number.name);
    for (const MaterialTexture& texture : material_textures()) {
        const Texture& given = material.*texture.texture;
        if (given || !given.path.empty()) names.push_back(fmt::format("{}_texture", texture.name));
    }
    if (material.unlit) names.emplace_back("unlit");
    if (!says_alpha_mode(material, has_opacity_map)) names.emplace_back("alpha_mode");
    return names;
}

/// Names in the order of the first material that has them, none twice.
void add_materials(const MeshData& mesh, const Properties& kept, std::vector<std::string>& names) {
    Properties seen = kept;
    for (const Material& material : mesh.materials)
        for (const std::string& name : properties_of(material, kept.contains("opacity_texture")))
            if (seen.insert(name).second) names.push_back(fmt::format("material.{}", name));
}

void add_shaders(const MeshData& mesh, std::vector<std::string>& names) {
    if (std::ranges::any_of(mesh.materials, [](const Material& m) { return bool(m.shader); }))
        names.emplace_back("shaders");
}

/// PLY names the file of one texture: the base colour of a mesh with one material. A warning of its own says
/// where the file does not hold the texture any more.
Properties properties_of_ply(const MeshData& mesh) {
    const bool names_texture =
        mesh.materials.size() == 1 && !mesh.materials[0].base_color_texture.path.empty();
    return names_texture ? Properties{"base_color_texture"} : Properties{};
}

std::vector<std::string> arrays_left_out(const MeshData& mesh, const std::string& extension) {
    if (extension == "ply" || extension == "npz" || extension == "glb") return {};
    if (extension != "obj" && extension != "spz") return labels_and_scalars(mesh, true);
    std::vector<std::string> names;
    if (extension == "spz" && !mesh.N.empty()) names.emplace_back("normals");
    if (extension == "spz" && !mesh.C.empty()) names.emplace_back("colours beside those of splats");
    if (extension == "spz" && !mesh.UV.empty()) names.emplace_back("texture coordinates");
    if (extension == "obj" && has_transparent_colors(mesh.C)) names.emplace_back("the alpha of colours");
    if (!mesh.T.empty() || !mesh.B.empty()) names.emplace_back("tangents");
    if (!mesh.I.empty()) names.emplace_back("intensities");
    std::ranges::move(labels_and_scalars(mesh, false), std::back_inserter(names));
    return names;
}

/// What the values mean. No format has the names and colours of labels.
void add_meanings(const MeshData& mesh, const std::string& extension, std::vector<std::string>& names) {
    if (mesh.voxel_size > 0 && !keeps_voxel_size(mesh, extension)) names.emplace_back(left_out_voxel_size);
    if (mesh.label_map && !mesh.L.empty()) names.emplace_back("the label map");
}

/// What the colours of vertices are multiplied by, linear, and the opacity.
Vec4 factor_of(const Material& material, bool beside_colors) {
    const float opacity = material.alpha_mode_for(false) == AlphaMode::opaque ? 1 : material.opacity;
    const Vec3 color = material.color_factor(beside_colors, false);
    return {color.x(), color.y(), color.z(), opacity};
}

/// White, and the default without colours beside it.
bool is_no_color(const Material& material, bool beside_colors) {
    const Vec4 factor = factor_of(material, beside_colors);
    return factor == Vec4(1, 1, 1, 1) || (material.has_default_color() && factor.w() == 1);
}

/// The material of each vertex: the first where no face has it; nothing where faces of several colours do.
std::vector<int> materials_of_vertices(const MeshData& mesh, const std::vector<Vec4>& factors) {
    constexpr int none = -1;
    std::vector<int> of(size_t(mesh.V.rows()), none);
    for (const MeshPart& part : mesh.parts)
        for (int face = part.first_face; face < part.first_face + part.face_count; ++face)
            for (int corner = 0; corner < 3; ++corner) {
                int& material = of[size_t(mesh.F(face, corner))];
                if (material != none && factors[size_t(material)] != factors[size_t(part.material)])
                    return {};
                material = part.material;
            }
    std::ranges::replace(of, none, 0);
    return of;
}

ArrayXf colors_times(const MeshData& mesh, const std::vector<int>& material,
                     const std::vector<Vec4>& factors) {
    const bool has_alpha = mesh.C.cols() == 4 ||
                           std::ranges::any_of(factors, [](const Vec4& factor) { return factor.w() != 1; });
    ArrayXf::Dense C = ArrayXf::Dense::Ones(mesh.V.rows(), has_alpha ? 4 : 3);
    if (!mesh.C.empty()) C.leftCols(mesh.C.cols()) = mesh.C;
    for (Eigen::Index i = 0; i < C.rows(); ++i) {
        const Vec4& factor = factors[size_t(material[size_t(i)])];
        const Vec3 linear = linear_from_srgb(Vec3(C.row(i).head<3>().transpose()));
        const Vec3 color = srgb_from_linear(Vec3(linear.cwiseProduct(factor.head<3>()).cwiseMin(1.0f)));
        C.row(i).head<3>() = color.transpose();
        if (has_alpha) C(i, 3) *= factor.w();
    }
    return C;
}

}  // namespace

bool keeps_voxel_size(const MeshData& mesh, const std::string& extension) {
    return mesh.voxel_size > 0 && (extension == "glb" || (extension == "npz" && mesh.F.empty()));
}

std::vector<std::string> left_out(const MeshData& mesh, const std::string& extension) {
    std::vector<std::string> names = arrays_left_out(mesh, extension);
    add_meanings(mesh, extension, names);
    if (extension == "obj")
        add_materials(mesh, properties_of_obj, names);
    else if (extension != "glb" && mesh.splats.empty())
        add_materials(mesh, extension == "ply" ? properties_of_ply(mesh) : Properties{}, names);
    if (const TextureMapping* mapping = texture_mapping(mesh, extension))
        std::ranges::move(left_out_mappings(*mapping, mesh), std::back_inserter(names));
    add_shaders(mesh, names);
    return names;
}

std::vector<std::string> left_out(const LoadedScene& scene) {
    std::vector<std::string> names;
    const auto add = [&](size_t count, const char* what) {
        if (count > 0) names.push_back(fmt::format("{} ({})", what, count));
    };
    add(scene.lights.size(), "lights");
    add(scene.cameras.size(), "cameras");
    add(scene.animations.names().size(), "animations");
    add(scene.variants.size(), "material variants");
    return names;
}

MeshData with_material_colors(const MeshData& mesh) {
    const bool beside_colors = !mesh.C.empty();
    const bool is_plain = std::ranges::all_of(
        mesh.materials, [&](const Material& material) { return is_no_color(material, beside_colors); });
    const bool is_textured =
        mesh.materials.size() == 1 &&
        (mesh.materials[0].base_color_texture || !mesh.materials[0].base_color_texture.path.empty());
    std::vector<Vec4> factors;
    for (const Material& material : mesh.materials) factors.push_back(factor_of(material, beside_colors));
    const bool are_one = std::ranges::all_of(factors, [&](const Vec4& f) { return f == factors.front(); });
    MeshData result = mesh;
    if (!mesh.splats.empty() || mesh.materials.empty() || is_textured) return result;
    if (!is_plain || !are_one) {
        const std::vector<int> materials = materials_of_vertices(mesh, factors);
        if (materials.empty()) return result;
        result.C = colors_times(mesh, materials, factors);
    }
    for (Material& material : result.materials) {
        material.base_color = Material().base_color;
        material.base_color_given = false;
        material.opacity = 1;
        if (material.alpha_mode.value_or(AlphaMode::opaque) == AlphaMode::blend)
            material.alpha_mode = automatic;
    }
    return result;
}

}  // namespace easypbr::io
