// A kind of primitive: all that the frame, shadows, layers, rays and tiles need to know of it.
#pragma once

#include <algorithm>
#include <memory>
#include <span>
#include <vector>

#include "easypbr/render/drawables/draw_list.h"
#include "easypbr/render/frame/frame.h"
#include "easypbr/render/frame/gbuffer.h"
#include "easypbr/render/primitives/caches.h"
#include "easypbr/render/primitives/hit_surface.h"
#include "easypbr/render/primitives/place_light.h"
#include "easypbr/render/primitives/ray_geometry.h"
#include "easypbr/render/primitives/shadow_layer.h"
#include "easypbr/render/raster/surface_writer.h"
#include "easypbr/render/raster/visible_surfaces.h"

namespace easypbr::render {

/// Items of one kind, in the order of the scene.
using DrawItems = std::span<const DrawItem>;

/// One step of drawing overlays. `begin` comes first. Then `behind` and `front` for each layer of what light
/// passes, from the farthest on, and once more for what lies before all of them; `over` is the last.
struct OverlayStep {
    enum class Part {
        begin,   ///< finds what is to be drawn
        behind,  ///< adds what lies behind `next` and has not been drawn, and, where a kind lies_around(),
                 ///< behind `others` too
        front,   ///< adds the rest of it, before `others`, when all kinds have done the step before
        over     ///< adds the items that are drawn over everything else (is_over())
    };
    Part part = Part::begin;
    /// Given for native drawing: the targets and the layer are in host memory.
    Transfers* host = nullptr;
    /// With `begin` and `over`: a GPU draws, so that kinds that the CPU draws too had better be its own.
    bool by_gpu = false;
    /// With `begin`: hidden is what lies behind this (R32F, reversed depth), whose normals are those of the
    /// targets; both stay as they are until `over`.
    const Target* opaque = nullptr;
    const GBuffer* next = nullptr;  ///< the layer; none: all that is left
    /// Reversed depths at which kinds that do not lie around others are, 0: nowhere; empty: nowhere at all.
    std::span<const float> others = {};
};

/// How far primitives may reach beyond their vertices in a picture, at most: a length in the world, and
/// pixels beyond that. Lengths count as heights of the picture do, along rows too.
struct ScreenReach {
    double world = 0, pixels = 0;

    void extend(const ScreenReach& other) {
        world = std::max(world, other.world);
        pixels = std::max(pixels, other.pixels);
    }
};

/// One kind of primitive; a folder of its own, and a line in primitives.cpp. Its items are surfaces, or
/// overlays: unlit, hiding no surface, drawn between the layers. The members for what a kind has not are left
/// as they are and draw nothing. Members that draw need the context current.
class Primitive {
  public:
    virtual ~Primitive() = default;

    /// The items that are of this kind: DrawList::of(mode()), and its overlays of that mode.
    virtual DrawMode mode() const = 0;

    // The G-buffer. Surfaces are drawn in one of three ways: by the driver, by finding the nearest primitive
    // of each pixel natively, or, where the primitives of a pixel are one surface together, by computing
    // their mean natively.

    /// Adds items to what the textures hold, by the driver.
    virtual void draw(const Frame&, DrawItems, const GBuffer&, const SurfaceOutputs&) {}
    /// Whether the CPU can draw some items without the driver, where there is no GPU.
    virtual bool is_native(DrawItems) const { return false; }
    /// Adds the nearest primitive of each pixel; false, where anything may have been added, when only the
    /// driver can draw the items in this frame. `extensions`: those that the targets hold.
    virtual bool rasterise(const Frame&, DrawItems, ExtensionSet /*extensions*/, VisibleSurfaces&) {
        return false;
    }
    /// The primitives of a pixel are one surface: then add_mean() takes the place of rasterise().
    virtual bool is_mean() const { return false; }
    /// The driver can draw them; else add_mean() does so on every device.
    virtual bool has_driver() const { return true; }
    /// Adds the surface of each pixel of the whole frame where it is nearer than `hides` (reversed depth, row
    /// by row) says; `writer` holds the same frame.
    virtual void add_mean(const Frame&, DrawItems, std::span<const float>, const SurfaceOutputs&,
                          SurfaceWriter&) {}
    /// Sets to 1 what items cover of the frame, row by row; false when only the G-buffer can tell.
    virtual bool cover(const Frame&, DrawItems, std::span<uint8_t>) { return false; }

    /// Whether these items can be layers natively: rasterise() draws them by the limits of
    /// VisibilityBuffer::begin_layer(), and of volumes the back faces where VisibilityBuffer::takes_backs();
    /// or, where the primitives of a pixel are one surface, add_mean_layer() does.
    virtual bool has_native_layers(DrawItems) const { return false; }
    /// Nothing behind `opaque` (reversed depths of what is covered of the frame, row by row) is drawn.
    virtual void begin_mean_layers(const Frame&, DrawItems, std::span<const float> /*opaque*/) {}
    /// Adds each item's next surface where it is farther than what the layer holds (where the limits ask for
    /// the nearest: nearer), and sets the limits there. `writer` holds the whole frame. False: there was
    /// none.
    virtual bool add_mean_layer(const Frame&, DrawItems, PeelLimits&, SurfaceWriter&) { return false; }

    // Layers of what light passes, by the driver. begin_layers() once, then draw_layer() for each that is
    // peeled, and take_layer() for those that hold something.

    /// Nothing behind `opaque` (R32F, reversed depth) is drawn.
    virtual void begin_layers(const Frame&, DrawItems, const gl::Texture&) {}
    virtual void draw_layer(const Frame& frame, DrawItems items, const GBuffer& layer,
                            const SurfaceOutputs& outputs) {
        draw(frame, items, layer, outputs);
    }
    virtual void take_layer(DrawItems) {}
    /// Draws the back faces of volumes.
    virtual void draw_backs(const Frame&, DrawItems, const GBuffer&, const SurfaceOutputs&) {}

    // Shadows and rays.

    virtual ShadowShape shadow_shape(const DrawItem&) { return {}; }
    /// Rasterises casters that stop light, and takes them out of the list.
    virtual void rasterise_shadows(const ShadowView&, Casters&, ShadowDepths&) {}
    virtual void draw_shadows(const ShadowLayer&, const Casters&) {}
    /// Whether rasterise_tints() draws casters that weaken light.
    virtual bool has_native_tints(DrawItems) const { return false; }
    virtual void rasterise_tints(const ShadowView&, const Casters&, TintLayer&) {}
    virtual void add_to(RayGeometry&, const DrawItem&) {}
    /// What rays find that meet an item that add_to() has added. The item must outlive it.
    virtual std::unique_ptr<HitSurface> hit_surface(const ResolvedSettings& resolved, const DrawItem& item);

    // Overlays, which lie between the layers, each where it is.

    /// A step of Overlays.
    virtual void draw_overlay(const Frame&, DrawItems, const GBuffer& /*targets*/, const OverlayStep&) {}
    /// After the step `begin`: reversed depth of the nearest item in each pixel of the frame, row by row; 0
    /// where there is none. Empty: none anywhere, or the items lie around those of other kinds.
    virtual std::vector<float> overlay_depths() const { return {}; }
    /// After the step `begin`, until the next one: R32F, reversed depth of the nearest line that covers half
    /// of a pixel, 0 where there is none; null for kinds that draw no lines.
    virtual const Target* nearest_lines() const { return nullptr; }
    /// Items lie before and behind those of other kinds in a pixel: they are drawn around them, in two parts.
    virtual bool lies_around() const { return false; }

    /// What reaches places of the scene, for kinds that surfaces darken though they are not lit; null: all
    /// light. It must live as long as the kind draws.
    virtual void set_place_light(const PlaceLight*) {}

    // Bounds.

    /// How far an item reaches beyond its vertices, in world units.
    virtual double reach(const DrawItem&) { return 0; }
    /// How far an item reaches beyond its vertices in the picture of a frame.
    virtual ScreenReach screen_reach(const Frame&, const DrawItem&) { return {}; }
    /// How far primitives of a style reach beyond their own pixel, in pixels: for tiles of large pictures.
    virtual int reach_in_pixels(const DrawStyle&) const { return 0; }

    /// Drops what nothing has asked for since the last call.
    virtual void evict_unused() {}
};

using Primitives = std::vector<std::unique_ptr<Primitive>>;

/// All kinds, in the order in which they are drawn. The caches must outlive them. No context is needed.
Primitives make_primitives(DataCaches& caches);

}  // namespace easypbr::render
