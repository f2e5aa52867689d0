#include "easypbr/io/mesh/texture_mapping.h"

#include <algorithm>
#include <optional>

#include "easypbr/core/parallel.h"
#include "easypbr/io/image/texture_loader.h"

namespace easypbr::io {
namespace {

constexpr size_t mapping_grain = 1 << 15;

bool is_used(const Texture& texture) {
    return texture.image || !texture.path.empty();
}

Vec2 mapped(const Mat3& M, const Array2f& UV, Eigen::Index row) {
    const Vec3d uv = M.cast<double>() * Vec3d(double(UV(row, 0)), double(UV(row, 1)), 1);
    return uv.head<2>().cast<float>();
}

std::vector<MeshPart> parts_of(const MeshData& mesh) {
    if (mesh.materials.empty()) return {};
    if (!mesh.parts.empty()) return mesh.parts;
    return {{{}, 0, int(mesh.F.rows()), 0}};
}

/// The transform that the texture coordinates of a material get; the identity where they stay.
Mat3 transform_to_bake(const TextureMapping& mapping, const Material& material) {
    std::optional<Mat3> shared;
    for (Texture Material::*const member : mapping.textures) {
        const Texture& texture = material.*member;
        if (!is_used(texture)) continue;
        if (shared && *shared != texture.uv_transform) return Mat3::Identity();
        shared = texture.uv_transform;
    }
    return shared && !mapping.has_transform(*shared) ? *shared : Mat3::Identity();
}

/// The transform's index of each vertex, -1 without a face; nothing where a vertex would need two.
std::optional<std::vector<int>> transform_of_vertices(const std::vector<Mat3>& transforms,
                                                      const MeshData& mesh) {
    std::vector<int> of(size_t(mesh.V.rows()), -1);
    for (const MeshPart& part : parts_of(mesh))
        for (Eigen::Index i = 0; i < 3 * Eigen::Index(part.face_count); ++i) {
            int& known = of[size_t(mesh.F.data()[3 * Eigen::Index(part.first_face) + i])];
            if (known >= 0 && transforms[size_t(known)] != transforms[size_t(part.material)]) return {};
            known = part.material;
        }
    return of;
}

/// Whether texture coordinates of the part's faces are outside of the image.
bool leaves_image(const Texture& texture, const MeshPart& part, const MeshData& mesh) {
    const int32_t* const first = mesh.F.data() + 3 * Eigen::Index(part.first_face);
    return std::any_of(first, first + 3 * Eigen::Index(part.face_count), [&](int32_t vertex) {
        const Vec2 uv = mapped(texture.uv_transform, mesh.UV, vertex);
        return uv.minCoeff() < 0 || uv.maxCoeff() > 1;
    });
}

/// Whether all texels of the channel are near 0 or 1.
bool is_binary(const Texture& texture) {
    constexpr int tolerance = 32;  // What JPEG makes of black and white.
    const auto has_no_grey = [&](const Image& image) {
        for (int y = 0; y < image.height(); ++y)
            for (int x = 0; x < image.width(); ++x)
                if (const int value = image.at<uint8_t>(x, y)[texture.channel];
                    value > tolerance && value < 255 - tolerance)
                    return false;
        return true;
    };
    const Image& image = *texture.image;
    return image.type() == PixelType::u8 ? has_no_grey(image) : has_no_grey(data_to_u8(image));
}

}  // namespace

const TextureMapping& obj_mapping() {
    static const TextureMapping mapping{
        {&Material::base_color_texture, &Material::emissive_texture, &Material::roughness_texture,
         &Material::metallic_texture, &Material::opacity_texture, &Material::normal_texture},
        [](const Mat3& M) { return M(0, 1) == 0 && M(1, 0) == 0; },
        [](Wrap u, Wrap v) { return u == v && u != Wrap::mirror; }};
    return mapping;
}

const TextureMapping& ply_mapping() {
    static const TextureMapping mapping{{&Material::base_color_texture},
                                        [](const Mat3& M) { return M.isIdentity(0); },
                                        [](Wrap u, Wrap v) { return u == v && u == Wrap::repeat; }};
    return mapping;
}

Texture obj_opacity_texture(const Material& material) {
    const Texture& color = material.base_color_texture;
    const bool shows_alpha = material.alpha_mode.value_or(AlphaMode::opaque) != AlphaMode::opaque && color &&
                             !material.opacity_texture && !is_fully_opaque(*color.image);
    if (!shows_alpha) return material.opacity_texture;
    Texture alpha = color;
    alpha.channel = alpha.image->channels() - 1;
    return alpha;
}

AlphaMode obj_alpha_mode(float opacity, const Texture& texture) {
    return opacity == 1 && is_binary(texture) ? AlphaMode::mask : AlphaMode::blend;
}

void bake_uv_transforms(const TextureMapping& mapping, MeshData& mesh) {
    if (mesh.UV.empty() || mesh.F.empty()) return;
    std::vector<Mat3> transforms;
    for (const Material& material : mesh.materials)
        transforms.push_back(transform_to_bake(mapping, material));
    const auto stays = [](const Mat3& M) { return M.isIdentity(0); };
    if (std::ranges::all_of(transforms, stays)) return;
    const auto of = transform_of_vertices(transforms, mesh);
    if (!of) return;
    Array2f::Dense UV = mesh.UV;
    parallel_for(of->size(), mapping_grain, [&](size_t i) {
        const auto row = Eigen::Index(i);
        if ((*of)[i] >= 0 && !stays(transforms[size_t((*of)[i])]))
            UV.row(row) = mapped(transforms[size_t((*of)[i])], mesh.UV, row).transpose();
    });
    mesh.UV = std::move(UV);
    for (size_t i = 0; i < transforms.size(); ++i)
        for (Texture Material::*const member : mapping.textures)
            if (!stays(transforms[i])) (mesh.materials[i].*member).uv_transform.setIdentity();
}

std::vector<std::string> left_out_mappings(const TextureMapping& mapping, const MeshData& mesh) {
    if (mesh.UV.empty()) return {};
    bool transforms = false, wraps = false, filters = false;
    for (const MeshPart& part : parts_of(mesh))
        for (Texture Material::*const member : mapping.textures) {
            const Texture& texture = mesh.materials[size_t(part.material)].*member;
            if (!is_used(texture)) continue;
            transforms = transforms || !mapping.has_transform(texture.uv_transform);
            wraps = wraps ||
                    (!mapping.has_wraps(texture.wrap_u, texture.wrap_v) && leaves_image(texture, part, mesh));
            filters = filters || texture.filter != Filter::linear;
        }
    std::vector<std::string> names;
    if (transforms) names.emplace_back("texture transforms");
    if (wraps) names.emplace_back("wraps of textures");
    if (filters) names.emplace_back("filters of textures");
    return names;
}

const Texture* ply_texture(const MeshData& mesh) {
    if (mesh.materials.size() != 1) return nullptr;
    const Texture& texture = mesh.materials[0].base_color_texture;
    return is_in_file(texture) ? &texture : nullptr;
}

const TextureMapping* texture_mapping(const MeshData& mesh, const std::string& extension) {
    if (extension == "obj") return &obj_mapping();
    return extension == "ply" && ply_texture(mesh) ? &ply_mapping() : nullptr;
}

}  // namespace easypbr::io
