// The G-buffer: what each target holds is defined here, whoever fills it.
#pragma once

#include "easypbr/core/math.h"
#include "easypbr/gl/draw.h"
#include "easypbr/gl/texture.h"

namespace easypbr::render {

/// Set in GBuffer::element where a point or a surfel is seen; the same number stands in the shaders.
inline constexpr uint32_t point_element = 1u << 31;

/// The paper's four targets in better packings: 16 bits for linear albedo (8 would band), octahedral normals
/// (0.004 degrees instead of 0.4), and the depth that the depth test used. Pixels without geometry hold depth
/// 0, else garbage.
struct GBuffer {
    gl::Texture albedo;  ///< RGBA16: linear base colour; a: weight of surfels, 1 for others
    gl::Texture normal;  ///< RG16: octahedral world normal, towards the viewer's side of a two-sided surface
    gl::Texture material;  ///< RGBA8: metallic, roughness, ambient occlusion of the material, SurfaceKind
    gl::Texture
        depth;  ///< R32F: reversed depth of the pixel, near / z for perspective, 0 where there is nothing
    gl::Texture depth_test;  ///< D32F: the same, for the depth test
    gl::Texture
        radiance;  ///< RGBA32F: linear radiance, premultiplied by a: coverage. Emission until it is lit

    gl::Texture
        id;  ///< R32UI, when asked for: 1 + place of the object in the snapshot, 0 where there is nothing
    gl::Texture element;  ///< R32UI, with id: 1 + index of the face or, with point_element, the vertex

    gl::Texture extension[2];  ///< RGBA32UI, when asked for: values of glTF's material extensions, as
                               ///< shaders/common_extension.glsl packs them, where the kind is extended

    gl::Texture overlay;  ///< RGBA16F, when asked for: linear display light, premultiplied, over the
                          ///< tone-mapped picture

    bool from_behind = false;       ///< a layer: depth_test is 1 where there is nothing
    gl::Texture ambient_occlusion;  ///< R16, there only when it counts: the part of the surroundings that is
                                    ///< seen, 1 where there is nothing

    gl::Framebuffer surface;           ///< albedo, normal, material, depth
    gl::Framebuffer surface_emission;  ///< the same and radiance
    gl::Framebuffer surface_extended;  ///< the same and extension; empty until add_extensions()
    gl::Framebuffer surface_ids;       ///< the same, id and element; empty until add_ids()
    gl::Framebuffer lit;               ///< radiance with the depth test
    gl::Framebuffer display;           ///< overlay with the depth test; empty until add_overlay()
    gl::Framebuffer occluded;          ///< ambient occlusion with the depth test; empty until it is added

    GBuffer() = default;
    explicit GBuffer(Vec2i size);
    /// Makes the id and element targets, if they are not there.
    void add_ids();
    /// Empties all targets but the overlay. Nothing is drawn where nothing is: depth 0, radiance 0.
    void clear(bool with_ids) const;
    /// The same for a layer; when it is peeled from behind, the depth test begins at the near plane.
    void clear_layer() const;
    /// The state of a screen pass that touches the pixels that hold geometry, and no others.
    gl::DrawState covered_state(const gl::Blending& blending = gl::replace) const;
    /// Makes the targets of material extensions, if they are not there.
    void add_extensions();
    /// Makes the overlay, if it is not there.
    void add_overlay();
    void add_ambient_occlusion();
    void remove_ambient_occlusion();
    Vec2i size() const { return {albedo.width(), albedo.height()}; }
};

}  // namespace easypbr::render
