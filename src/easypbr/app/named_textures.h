// The textures of materials that settings may replace.
#pragma once

#include "easypbr/scene/material.h"
#include "easypbr/scene/settings.h"

namespace easypbr::app {

struct NamedTexture {
    std::string MaterialSettings::*path;
    Texture Material::*texture;
};

inline constexpr NamedTexture named_textures[] = {
    {&MaterialSettings::base_color_texture, &Material::base_color_texture},
    {&MaterialSettings::metallic_texture, &Material::metallic_texture},
    {&MaterialSettings::roughness_texture, &Material::roughness_texture},
    {&MaterialSettings::normal_texture, &Material::normal_texture},
    {&MaterialSettings::occlusion_texture, &Material::occlusion_texture},
    {&MaterialSettings::emissive_texture, &Material::emissive_texture},
    {&MaterialSettings::opacity_texture, &Material::opacity_texture}};

}  // namespace easypbr::app
