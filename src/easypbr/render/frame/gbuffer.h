// The G-buffer: what each target holds is defined here, whoever fills it.
#pragma once

#include <initializer_list>

#include "easypbr/core/math.h"
#include "easypbr/gl/draw.h"
#include "easypbr/render/frame/target.h"

namespace easypbr::render {

/// What is written of surfaces beside albedo, normal, material and depth.
struct SurfaceContents {
    bool ids = false, emission = false, extensions = false;
};

/// Set in GBuffer::element where a vertex is seen; the same number stands in the shaders.
inline constexpr uint32_t point_element = 1u << 31;

/// The paper's four targets in better packings: 16 bits for linear albedo (8 would band), octahedral normals
/// (0.004 degrees instead of 0.4), and the depth that the depth test used. Pixels without geometry hold depth
/// 0, else garbage.
struct GBuffer {
    Target albedo;    ///< RGBA16: linear base colour; a: opacity of a layer, else 1
    Target normal;    ///< RG16: octahedral world normal, towards the viewer's side of a two-sided surface
    Target material;  ///< RGBA8: metallic, roughness, ambient occlusion of the material, SurfaceKind
    Target depth;  ///< R32F: reversed depth of the pixel, near / z for perspective, 0 where there is nothing
    Target radiance;  ///< RGBA32F: linear radiance, premultiplied by a: coverage. Emission until it is lit
    Target emission;  ///< RGBA32F, in host memory: of surfaces that were written there, until they are lit

    Target id;  ///< R32UI, when asked for: 1 + place of the object in the snapshot, 0 where there is nothing
    Target element;  ///< R32UI, with id: 1 + index of the face or, with point_element, the vertex

    Target extension[2];  ///< RGBA32UI, when asked for: values of glTF's material extensions, as
                          ///< shaders/common_extension.glsl packs them, where the kind is extended

    Target overlay;  ///< RGBA16F, when asked for: linear display light, premultiplied, over the
                     ///< tone-mapped picture

    bool from_behind = false;  ///< a layer of depth peeling: depth_test() is 1 where there is nothing
    Target ambient_occlusion;  ///< R16, there only when it counts: the part of the surroundings that is seen,
                               ///< 1 where there is nothing

    GBuffer() = default;
    /// Takes no memory until something is drawn.
    explicit GBuffer(Vec2i size);
    Vec2i size() const { return albedo.size(); }
    explicit operator bool() const { return bool(albedo); }

    /// Makes the id and element targets, if they are not there.
    void add_ids();
    /// Makes the targets of material extensions, if they are not there.
    void add_extensions();
    /// Makes the overlay, if it is not there.
    void add_overlay();
    void add_ambient_occlusion();
    void remove_ambient_occlusion();

    /// Empties the textures of surfaces and light. Nothing is drawn where nothing is: depth 0, radiance 0.
    void clear(bool with_ids) const;
    /// The same for a layer; when it is peeled from behind, the depth test begins at the near plane.
    void clear_layer() const;
    /// The textures as attachments that are drawn to, with the depth test; what host memory holds of them is
    /// out of date from now on.
    const gl::Framebuffer& surface() const;           ///< albedo, normal, material, depth
    const gl::Framebuffer& surface_emission() const;  ///< the same and radiance
    const gl::Framebuffer& surface_extended() const;  ///< the same and extension
    const gl::Framebuffer& surface_ids() const;       ///< radiance too, id and element
    const gl::Framebuffer& lit() const;               ///< radiance
    const gl::Framebuffer& display() const;           ///< overlay
    const gl::Framebuffer& occluded() const;          ///< ambient occlusion
    /// Depths of the depth test, as `depth` holds them.
    const gl::Texture& depth_test() const;

    /// Begins to write surfaces in host memory: nothing but a rectangle, whose pixels are undefined.
    void write(const PixelRect& area, SurfaceContents contents) const;
    /// Brings surfaces, and what they emit, to host memory, unless they are there already.
    void download(Transfers& transfers) const;
    /// Brings surfaces that were written in host memory to the textures: with their light, where they are
    /// lit, else with what lighting them needs.
    void upload(Transfers& transfers) const;

    /// Gives host memory back: nothing but sizes and textures stay.
    void release() const;

    /// The state of a screen pass that touches the pixels that hold geometry, and no others.
    gl::DrawState covered_state(const gl::Blending& blending = gl::replace) const;

  private:
    using Attachments = std::initializer_list<const Target*>;
    /// Made when it is first asked for.
    const gl::Framebuffer& framebuffer(gl::Framebuffer& made, Attachments attachments) const;
    /// The same, and host memory is out of date.
    const gl::Framebuffer& drawn(gl::Framebuffer& made, Attachments attachments) const;

    mutable gl::Texture depth_test_;
    mutable gl::Framebuffer surface_, surface_emission_, surface_extended_, surface_ids_, lit_, display_,
        occluded_;
};

}  // namespace easypbr::render
