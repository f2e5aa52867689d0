// The surfaces of all kinds of primitives, into the G-buffer.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "easypbr/render/primitives/primitive.h"
#include "easypbr/render/raster/surface_composite.h"

namespace easypbr::render {

class Surfaces {
  public:
    /// Both must outlive this.
    Surfaces(const Primitives& primitives, Transfers& transfers)
        : primitives_(primitives), transfers_(transfers) {}

    /// Fills the targets with the surfaces of the list, each kind by the faster way that can draw it:
    /// natively without a GPU, by the driver otherwise. They are in host memory where all of them could be
    /// drawn natively, else in the textures. What is drawn over everything else comes last. Returns the
    /// rectangle that all surfaces and overlays are inside.
    PixelRect draw(const Frame& frame, const DrawList& list, const GBuffer& targets,
                   const SurfaceOutputs& outputs);
    /// Gives back the memory that draw() works in.
    void release() { visible_.release(); }
    /// Adds surfaces by the driver, to cleared targets.
    void draw_by_driver(const Frame& frame, const DrawList& list, const GBuffer& targets,
                        const SurfaceOutputs& outputs);
    /// The surfaces alone that are drawn over everything else, after draw(); those of layers may come later.
    GBuffer& over(const Frame& frame);

    /// Which pixels of a small frame the list covers: 1 or 0, row by row.
    std::vector<uint8_t> coverage(const Frame& frame, const DrawList& list);

    /// How far beyond its vertices each of so many objects reaches, that are those of the frame's scene.
    std::vector<ScreenReach> reaches(const Frame& frame, const DrawList& list, size_t objects) const;

    // Layers, see Primitive.
    void begin_layers(const Frame& frame, const DrawList& list, const gl::Texture& opaque);
    void draw_layer(const Frame& frame, const DrawList& list, const GBuffer& layer,
                    const SurfaceOutputs& outputs);
    void take_layer(const DrawList& list);
    void draw_backs(const Frame& frame, const DrawList& list, const GBuffer& targets,
                    const SurfaceOutputs& outputs);

    /// Whether all items can be layers natively.
    bool has_native_layers(const DrawList& list) const;
    /// Nothing behind `opaque` (reversed depths of what is covered of the frame, row by row) is drawn.
    void begin_native_layers(const Frame& frame, const DrawList& list, std::span<const float> opaque);
    /// Writes a layer, perhaps nothing but a rectangle of it; false where it would hold nothing.
    bool peel(const Frame& frame, const DrawList& list, const GBuffer& layer, ExtensionSet extensions,
              PeelLimits& limits);
    /// Writes the back faces of volumes that PeelLimits::backs asks for, nothing but a rectangle of them.
    void peel_backs(const Frame& frame, const DrawList& list, const GBuffer& targets,
                    const PeelLimits& limits);

    /// Writes how near the nearest surface of each pixel is (R32F, reversed depth), nothing but a rectangle
    /// of it. All items must be drawn natively.
    void find_nearest(const Frame& frame, const DrawList& list, const Target& depths);

    /// Without a GPU, surfaces are drawn natively; false leaves them to the driver.
    void allow_native(bool allow) { allow_native_ = allow; }
    bool is_native() const;

  private:
    /// Items of a list, with their kind.
    struct Group {
        Primitive* kind;
        DrawItems items;
    };
    std::vector<Group> groups_of(const DrawList& list) const;
    /// Finds what is visible of a layer.
    void rasterise_layer(const Frame& frame, const DrawList& list, ExtensionSet extensions,
                         const PeelLimits& limits);
    /// Takes the groups out of the list that are visible natively; the rest is left to others.
    void rasterise(const Frame& frame, const SurfaceOutputs& outputs, std::vector<Group>& groups);
    void draw_means(const Frame& frame, const std::vector<Group>& groups, const GBuffer& targets,
                    const SurfaceOutputs& outputs);
    PixelRect draw_groups(const Frame& frame, const DrawList& list, const GBuffer& targets,
                          const SurfaceOutputs& outputs);

    const Primitives& primitives_;
    Transfers& transfers_;
    VisibleSurfaces visible_;
    SurfaceComposite composite_;
    GBuffer over_, coverage_;
    bool allow_native_ = true;
};

}  // namespace easypbr::render
