#include "easypbr/io/mesh/gltf/gltf_materials.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <functional>

#include "easypbr/core/folder.h"
#include "easypbr/core/log.h"
#include "easypbr/core/parallel.h"
#include "easypbr/io/image/image_io.h"
#include "easypbr/io/image/texture_loader.h"
#include "easypbr/io/mesh/gltf/gltf_extensions.h"
#include "easypbr/scene/material_table.h"

namespace easypbr::io {
namespace {

Vec3 vec3_of(const std::vector<double>& v) {
    return {float(v[0]), float(v[1]), float(v[2])};
}

Wrap wrap_of(size_t code) {
    return code == 33071 ? Wrap::clamp : code == 33648 ? Wrap::mirror : Wrap::repeat;
}

/// The images of a file, decoded when they are first asked for as a whole.
class Images {
  public:
    explicit Images(GltfDocument& document) : document_(document), used_(document.count("images")) {}

    void use(size_t index) {
        document_.item("images", index);
        used_[index].wanted = true;
    }

    void decode() {
        std::vector<Entry*> wanted;
        for (size_t i = 0; i < used_.size(); ++i)
            if (used_[i].wanted && locate(i)) wanted.push_back(&used_[i]);
        // The largest first: who begins one last works alone.
        std::ranges::stable_sort(wanted, std::greater(), &Entry::encoded_size);
        std::atomic<size_t> next = 0;
        parallel_for(wanted.size(), 1, [&](size_t) { wanted[next++]->decode(); });
    }

    /// The image, where it was read, with its file.
    const Texture& texture(size_t index) const { return used_[index].texture; }

  private:
    struct Entry {
        bool wanted = false;
        std::string path;  ///< of an external file
        std::string name;
        std::vector<std::byte> decoded;
        std::span<const std::byte> bytes;
        Texture texture;

        uintmax_t encoded_size = 0;  ///< in bytes; 0 where that is not known

        void decode() {
            try {
                if (path.empty())
                    texture.image = std::make_shared<const Image>(decode_image(bytes, name));
                else
                    texture = load_texture(path);
            } catch (const Error& error) {
                log_warning(fmt::format("drawn without a texture: {}", error.what()));
            }
            decoded = {};
        }
    };

    /// Whether the image's bytes are known; says so in the log when they are not.
    bool locate(size_t index) {
        Entry& entry = used_[index];
        entry.name = fmt::format("{}, images[{}]", document_.path().string(), index);
        try {
            const Json& json = document_.item("images", index);
            if (const auto view = document_.optional_integer(json, "bufferView")) {
                entry.bytes = document_.buffer_view(*view);
                entry.encoded_size = entry.bytes.size();
                return true;
            }
            const std::string uri = document_.text(json, "uri");
            if (auto decoded = document_.data_of_uri(uri)) {
                entry.decoded = std::move(*decoded);
                entry.bytes = entry.decoded;
                entry.encoded_size = entry.bytes.size();
            } else {
                entry.path = document_.path_of_uri(uri).string();
                std::error_code unknown;
                // Nothing outside of a folder is looked at.
                if (!FolderScope::current())
                    entry.encoded_size = std::filesystem::file_size(entry.path, unknown);
                if (unknown) entry.encoded_size = 0;
            }
            return true;
        } catch (const Error& error) {
            log_warning(fmt::format("drawn without a texture: {}", error.what()));
            return false;
        }
    }

    GltfDocument& document_;
    std::vector<Entry> used_;
};

class MaterialReader {
  public:
    MaterialReader(const GltfDocument& document, Images& images) : document_(document), images_(images) {}

    /// First pass: marks the images that the material needs.
    void mark(const Json& json) {
        for (const Place& place : places)
            if (const Json* info = texture_info(json, place))
                if (const auto source = source_of(*info)) images_.use(*source);
    }

    Material read(const Json& json, int& uv_set) {
        Material out;
        out.name = document_.text(json, "name");
        read_metallic_roughness(
            member(json, "pbrMetallicRoughness") ? json.at("pbrMetallicRoughness") : Json::object(), out);
        read_rest(json, out);
        read_gltf_extensions(document_, json, out);
        uv_set = uv_set_of(json);
        for (const Place& place : places) {
            out.*place.texture = texture(json, place);
            (out.*place.texture).channel = place.channel;
        }
        // It is what this factor multiplies, a factor of 0.6 as well.
        out.base_color_given = out.base_color_texture && out.has_default_color();
        for (const std::string& change : clamp_to_ranges(out))
            log_warning(fmt::format("{}, material '{}': {}", document_.path().string(), out.name, change));
        return out;
    }

    void read_metallic_roughness(const Json& json, Material& out) const {
        const auto color =
            document_.numbers(json, "baseColorFactor", 4).value_or(std::vector<double>{1, 1, 1, 1});
        out.base_color = vec3_of(color);
        out.opacity = float(color[3]);
        out.metallic = float(document_.number(json, "metallicFactor", 1));
        out.roughness = float(document_.number(json, "roughnessFactor", 1));
    }

    struct Place {
        const char* extension;  ///< or null
        const char* parent;     ///< or null
        const char* key;
        Texture Material::*texture;
        int channel;  ///< that is read; 0 for colours and normals
    };
    static constexpr const char* core = "pbrMetallicRoughness";
    static constexpr Place places[] = {
        {nullptr, core, "baseColorTexture", &Material::base_color_texture, 0},
        {nullptr, core, "metallicRoughnessTexture", &Material::metallic_texture, 2},
        {nullptr, core, "metallicRoughnessTexture", &Material::roughness_texture, 1},
        {nullptr, nullptr, "normalTexture", &Material::normal_texture, 0},
        {nullptr, nullptr, "occlusionTexture", &Material::occlusion_texture, 0},
        {nullptr, nullptr, "emissiveTexture", &Material::emissive_texture, 0},
        {khr_clearcoat, nullptr, "clearcoatTexture", &Material::clearcoat_texture, 0},
        {khr_clearcoat, nullptr, "clearcoatRoughnessTexture", &Material::clearcoat_roughness_texture, 1},
        {khr_clearcoat, nullptr, "clearcoatNormalTexture", &Material::clearcoat_normal_texture, 0},
        {khr_sheen, nullptr, "sheenColorTexture", &Material::sheen_color_texture, 0},
        {khr_sheen, nullptr, "sheenRoughnessTexture", &Material::sheen_roughness_texture, 3},
        {khr_specular, nullptr, "specularTexture", &Material::specular_texture, 3},
        {khr_specular, nullptr, "specularColorTexture", &Material::specular_color_texture, 0},
        {khr_transmission, nullptr, "transmissionTexture", &Material::transmission_texture, 0},
        {khr_volume, nullptr, "thicknessTexture", &Material::thickness_texture, 1},
        {khr_iridescence, nullptr, "iridescenceTexture", &Material::iridescence_texture, 0},
        {khr_iridescence, nullptr, "iridescenceThicknessTexture", &Material::iridescence_thickness_texture,
         1},
        {khr_anisotropy, nullptr, "anisotropyTexture", &Material::anisotropy_texture, 0}};

  private:
    void read_rest(const Json& json, Material& out) const {
        out.emissive =
            vec3_of(document_.numbers(json, "emissiveFactor", 3).value_or(std::vector<double>{0, 0, 0}));
        if (const Json* strength = extension(json, khr_emissive_strength))
            out.emissive *= float(document_.number(*strength, "emissiveStrength", 1));
        if (const Json* normal = member(json, "normalTexture"))
            out.normal_scale = float(document_.number(*normal, "scale", 1));
        if (const Json* occlusion = member(json, "occlusionTexture"))
            out.occlusion_strength = float(document_.number(*occlusion, "strength", 1));
        const std::string mode = document_.text(json, "alphaMode", "OPAQUE");
        out.alpha_mode = mode == "MASK"    ? AlphaMode::mask
                         : mode == "BLEND" ? AlphaMode::blend
                                           : AlphaMode::opaque;
        out.alpha_cutoff = float(document_.number(json, "alphaCutoff", 0.5));
        out.double_sided = document_.boolean(json, "doubleSided", false);
        out.unlit = extension(json, khr_unlit) != nullptr;
    }

    static const Json* texture_info(const Json& json, const Place& place) {
        const Json* owner = place.extension ? extension(json, place.extension)
                            : place.parent  ? member(json, place.parent)
                                            : &json;
        return owner ? member(*owner, place.key) : nullptr;
    }

    std::optional<size_t> source_of(const Json& info) const {
        const size_t index = document_.integer(info, "index");
        const Json& texture = document_.item("textures", index);
        const auto source = image_of(texture);
        if (!source)
            log_warning(fmt::format(
                "drawn without a texture: {}, textures[{}] has no PNG, JPEG or WebP image{}",
                document_.path().string(), index,
                extension(texture, "KHR_texture_basisu") ? " (KHR_texture_basisu is not supported)" : ""));
        return source;
    }

    /// The WebP image where there is one: the other is for programs that cannot read it.
    std::optional<size_t> image_of(const Json& texture) const {
        const Json* webp = extension(texture, ext_texture_webp);
        const auto source = webp ? document_.optional_integer(*webp, "source") : std::nullopt;
        return source ? source : document_.optional_integer(texture, "source");
    }

    int uv_set_of_info(const Json& info) const {
        const Json* transform = extension(info, "KHR_texture_transform");
        const auto given = transform ? document_.optional_integer(*transform, "texCoord") : std::nullopt;
        return int(
            std::min<size_t>(given ? *given : document_.optional_integer(info, "texCoord").value_or(0), 99));
    }

    /// A mesh has one set of coordinates: that of the first texture.
    int uv_set_of(const Json& json) const {
        std::optional<int> chosen;
        for (const Place& place : places)
            if (const Json* info = texture_info(json, place)) {
                const int set = uv_set_of_info(*info);
                if (chosen && *chosen != set)
                    log_warning(
                        fmt::format("{}, {}: TEXCOORD_{} is drawn with TEXCOORD_{} (one set per material)",
                                    document_.path().string(), place.key, set, *chosen));
                chosen = chosen.value_or(set);
            }
        return chosen.value_or(0);
    }

    Texture texture(const Json& json, const Place& place) const {
        Texture out;
        const Json* info = texture_info(json, place);
        if (!info) return out;
        const Json& texture = document_.item("textures", document_.integer(*info, "index"));
        const auto source = image_of(texture);
        if (!source || !images_.texture(*source)) return out;
        out = images_.texture(*source);
        if (const auto index = document_.optional_integer(texture, "sampler")) {
            const Json& sampler = document_.item("samplers", *index);
            out.wrap_u = wrap_of(document_.optional_integer(sampler, "wrapS").value_or(0));
            out.wrap_v = wrap_of(document_.optional_integer(sampler, "wrapT").value_or(0));
            const bool nearest = document_.optional_integer(sampler, "magFilter") == size_t(9728);
            out.filter = nearest ? Filter::nearest : Filter::linear;
        }
        if (const Json* transform = extension(*info, "KHR_texture_transform"))
            out.uv_transform = read_texture_transform(document_, *transform).matrix();
        return out;
    }

    const GltfDocument& document_;
    Images& images_;
};

}  // namespace

Mat3 GltfTextureTransform::matrix() const {
    Mat3d transform = Mat3d::Identity(), flip = Mat3d::Identity();
    transform << std::cos(rotation) * scale[0], std::sin(rotation) * scale[1], offset[0],  //
        -std::sin(rotation) * scale[0], std::cos(rotation) * scale[1], offset[1],          //
        0, 0, 1;
    flip.row(1) << 0, -1, 1;
    return (flip * transform * flip).cast<float>();
}

GltfTextureTransform read_texture_transform(const GltfDocument& document, const Json& json) {
    GltfTextureTransform transform;
    if (const auto offset = document.numbers(json, "offset", 2)) transform.offset = Vec2d(offset->data());
    if (const auto scale = document.numbers(json, "scale", 2)) transform.scale = Vec2d(scale->data());
    transform.rotation = document.number(json, "rotation", 0);
    return transform;
}

std::vector<std::pair<std::string, Texture Material::*>> gltf_texture_places() {
    std::vector<std::pair<std::string, Texture Material::*>> places;
    for (const MaterialReader::Place& place : MaterialReader::places) {
        const std::string parent = place.extension ? fmt::format("extensions/{}/", place.extension)
                                   : place.parent  ? fmt::format("{}/", place.parent)
                                                   : "";
        places.emplace_back(parent + place.key, place.texture);
    }
    return places;
}

GltfMaterials::GltfMaterials(GltfDocument& document)
    : document_(document), entries_(document.count("materials")) {
    Images images(document);
    MaterialReader reader(document, images);
    for (size_t i = 0; i < entries_.size(); ++i) reader.mark(document.item("materials", i));
    images.decode();
    for (size_t i = 0; i < entries_.size(); ++i)
        entries_[i].material = reader.read(document.item("materials", i), entries_[i].uv_set);
    reader.read_metallic_roughness(Json::object(), default_.material);
    default_.material.double_sided = false;
    default_.material.alpha_mode = AlphaMode::opaque;
}

const GltfMaterials::Entry& GltfMaterials::entry(std::optional<size_t> index) const {
    if (!index) return default_;
    document_.item("materials", *index);
    return entries_[*index];
}

const Material& GltfMaterials::material(std::optional<size_t> index) const {
    return entry(index).material;
}

int GltfMaterials::uv_set(std::optional<size_t> index) const {
    return entry(index).uv_set;
}

}  // namespace easypbr::io
