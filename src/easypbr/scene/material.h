// Material: glTF 2.0's metallic-roughness model.
#pragma once

#include <memory>
#include <string>

#include "easypbr/core/image.h"
#include "easypbr/core/math.h"

namespace easypbr {

enum class Wrap { repeat, mirror, clamp };
enum class Filter { linear, nearest };
enum class AlphaMode { opaque, mask, blend };

/// An image with the way it is laid on a surface. uv (0, 0) is the lower left corner of the image (OBJ, PLY;
/// the glTF loader flips v). Empty when `image` is null.
struct Texture {
    std::shared_ptr<const Image> image;
    std::string path;  ///< where the image came from, for messages and saving; may be empty
    Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
    Filter filter = Filter::linear;
    Mat3 uv_transform = Mat3::Identity();  ///< applied to (u, v, 1)
    int channel = 0;  ///< the channel read by a one-channel use (metallic, roughness, occlusion)

    explicit operator bool() const { return image != nullptr; }
};

/// Factors multiply their textures. Colours are linear Rec.709.
struct Material {
    std::string name;
    Vec3 base_color{0.6f, 0.6f, 0.6f};
    float opacity = 1;
    float metallic = 0;      ///< 0 dielectric .. 1 metal
    float roughness = 0.5f;  ///< perceptual, 0 .. 1; alpha = roughness^2
    Vec3 emissive{0, 0, 0};  ///< radiance added to the picture, strength included
    float normal_scale = 1;
    float occlusion_strength = 1;
    AlphaMode alpha_mode = AlphaMode::opaque;
    float alpha_cutoff = 0.5f;
    bool double_sided = true;
    bool unlit = false;  ///< base colour is shown as it is

    Texture base_color_texture;  ///< sRGB; its alpha multiplies opacity
    Texture metallic_texture;
    Texture roughness_texture;
    Texture normal_texture;  ///< tangent space, +Y up (OpenGL, glTF)
    Texture occlusion_texture;
    Texture emissive_texture;  ///< sRGB
    Texture opacity_texture;   ///< used by alpha mode mask (and blend)

    bool has_textures() const {
        return base_color_texture || metallic_texture || roughness_texture || normal_texture ||
               occlusion_texture || emissive_texture || opacity_texture;
    }
};

}  // namespace easypbr
