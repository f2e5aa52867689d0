// The G-buffer: what each target holds is defined here, whoever fills it.
#pragma once

#include "easypbr/core/math.h"
#include "easypbr/gl/texture.h"

namespace easypbr::render {

/// The paper's four targets in better packings: 16 bits for linear albedo (8 would band), octahedral normals
/// (0.004 degrees instead of 0.4), and the depth that the depth test used. Pixels without geometry hold depth
/// 0, else garbage.
struct GBuffer {
    gl::Texture albedo;  ///< RGBA16: linear base colour; a: weight of surfels, 1 for others
    gl::Texture normal;  ///< RG16: octahedral world normal, towards the viewer's side of a two-sided surface
    gl::Texture material;  ///< RGBA8: metallic, roughness, ambient occlusion of the material, 1 for unlit
    gl::Texture
        depth;  ///< R32F: reversed depth of the pixel, near / z for perspective, 0 where there is nothing
    gl::Texture depth_test;  ///< D32F: the same, for the depth test
    gl::Texture
        radiance;  ///< RGBA32F: linear radiance, premultiplied by a: coverage. Emission until it is lit

    gl::Texture
        id;  ///< R32UI, when asked for: 1 + place of the object in the snapshot, 0 where there is nothing

    gl::Framebuffer surface;           ///< albedo, normal, material, depth
    gl::Framebuffer surface_emission;  ///< the same and radiance
    gl::Framebuffer surface_ids;       ///< the same and id; empty until add_ids()
    gl::Framebuffer lit;               ///< radiance with the depth test

    GBuffer() = default;
    explicit GBuffer(Vec2i size);
    /// Makes the id target, if it is not there.
    void add_ids();
    Vec2i size() const { return {albedo.width(), albedo.height()}; }
};

}  // namespace easypbr::render
