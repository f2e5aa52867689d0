#include "easypbr/io/mesh/assimp/message_materials.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <utility>

#include "easypbr/core/error.h"
#include "easypbr/core/log.h"
#include "easypbr/core/luminance.h"
#include "easypbr/io/image/image_io.h"
#include "easypbr/io/image/texture_loader.h"
#include "easypbr/io/mesh/assimp/message.h"

namespace easypbr::io {
namespace {

/// Bytes of an image without content: its kind and its size.
constexpr size_t smallest_image = sizeof(MessageImage) + sizeof(uint64_t);

/// An image inside the file, decoded when a material first uses it.
struct EmbeddedImage {
    std::span<const std::byte> bytes;
    int width = 0, height = 0;  ///< of RGBA pixels; 0: a compressed image
    bool is_decoded = false;
    std::shared_ptr<const Image> image;  ///< null: damaged
};

EmbeddedImage take_image(MessageCursor& message) {
    EmbeddedImage out;
    switch (message.take<MessageImage>()) {
        case MessageImage::compressed:
            out.bytes = message.take_bytes(message.take<uint64_t>());
            return out;
        case MessageImage::pixels: {
            const auto [width, height] = message.take<std::array<uint32_t, 2>>();
            if (width == 0 || height == 0 || width > max_image_side || height > max_image_side)
                message.fail("an image has no such size");
            out.bytes = message.take_bytes(uint64_t(4) * width * height);
            out.width = int(width), out.height = int(height);
            return out;
        }
    }
    message.fail("there is no such kind of image");
}

std::shared_ptr<const Image> decoded(const EmbeddedImage& from, const std::string& name) {
    if (from.width == 0) return std::make_shared<const Image>(decode_image(from.bytes, name));
    auto image = std::make_shared<Image>(from.width, from.height, 4, PixelType::u8);
    std::copy(from.bytes.begin(), from.bytes.end(), image->bytes().begin());
    return image;
}

Wrap take_wrap(MessageCursor& message) {
    const auto wrap = message.take<uint8_t>();
    if (wrap > uint8_t(Wrap::clamp)) message.fail("there is no such wrap mode");
    return Wrap(wrap);
}

Vec3 to_vector(const float (&values)[3]) {
    return {values[0], values[1], values[2]};
}

class MessageMaterialReader {
  public:
    MessageMaterialReader(MessageCursor& message, const std::filesystem::path& file)
        : message_(message), file_(file), loader_(file) {
        const size_t count = message_.take_count(smallest_image, sizeof(EmbeddedImage));
        for (size_t i = 0; i < count; ++i) images_.push_back(take_image(message_));
    }

    Material take_material() {
        Material out;
        out.name = message_.take_text();
        take_factors(out);
        for (Texture* slot :
             {&out.base_color_texture, &out.metallic_texture, &out.roughness_texture, &out.normal_texture,
              &out.occlusion_texture, &out.emissive_texture, &out.opacity_texture})
            *slot = take_slot();
        if (out.opacity < 1) out.alpha_mode = AlphaMode::blend;
        if (out.opacity_texture) out.alpha_mode = AlphaMode::mask;
        // Old formats leave the factor black where a texture stands.
        if (out.base_color_texture && out.base_color.isZero()) out.base_color.setOnes();
        if (out.emissive_texture && is_black(out.emissive)) out.emissive.setOnes();
        return out;
    }

  private:
    void take_factors(Material& out) {
        const auto factors = message_.take<MessageFactors>();
        out.base_color = to_vector(factors.base_color);
        out.opacity = factors.opacity;
        out.metallic = factors.metallic;
        out.roughness = factors.roughness;
        out.emissive = to_vector(factors.emissive);
        out.double_sided = factors.double_sided != 0;
    }

    /// The first texture whose image can be read.
    Texture take_slot() {
        Texture out;
        for (int left = message_.take<uint8_t>(); left > 0; --left) {
            Texture texture = take_texture(bool(out));
            if (!out) out = std::move(texture);
        }
        return out;
    }

    /// `is_spare`: its image is not read.
    Texture take_texture(bool is_spare) {
        const auto source = message_.take<MessageTexture>();
        if (source > MessageTexture::embedded) message_.fail("there is no such kind of texture");
        const Wrap wrap_u = take_wrap(message_), wrap_v = take_wrap(message_);
        Texture texture;
        if (source == MessageTexture::embedded) {
            const auto index = message_.take<uint32_t>();
            const std::string name = message_.take_text();
            if (index >= images_.size()) message_.fail("there is no such image");
            if (!is_spare) texture.image = embedded(images_[index], name);
        } else {
            const std::string name = message_.take_text();
            if (!is_spare) texture = loader_.load(name);
        }
        texture.wrap_u = wrap_u, texture.wrap_v = wrap_v;
        return texture;
    }

    std::shared_ptr<const Image> embedded(EmbeddedImage& from, const std::string& name) {
        if (!std::exchange(from.is_decoded, true)) try {
                from.image = decoded(from, fmt::format("{}, texture {}", file_.string(), name));
            } catch (const Error& error) {
                log_warning(fmt::format("drawn without a texture: {}", error.what()));
            }
        return from.image;
    }

    MessageCursor& message_;
    const std::filesystem::path& file_;
    TextureLoader loader_;
    std::vector<EmbeddedImage> images_;
};

}  // namespace

std::vector<Material> take_materials(MessageCursor& message, const std::filesystem::path& file) {
    MessageMaterialReader reader(message, file);
    const size_t count = message.take_count(sizeof(MessageFactors), sizeof(Material));
    std::vector<Material> out;
    for (size_t i = 0; i < count; ++i) out.push_back(reader.take_material());
    return out;
}

}  // namespace easypbr::io
