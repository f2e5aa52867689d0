// The frame: every pass from shadows to overlays, in pipeline order.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "easypbr/gpu/environment_maps.h"
#include "easypbr/render/drawables/draw_list.h"
#include "easypbr/render/effects/ambient_occlusion/ambient_occlusion_pass.h"
#include "easypbr/render/effects/effect.h"
#include "easypbr/render/effects/ground/ground_pass.h"
#include "easypbr/render/frame/pass_timer.h"
#include "easypbr/render/frame/sampled_tiles.h"
#include "easypbr/render/lighting/background_pass.h"
#include "easypbr/render/lighting/lighting_pass.h"
#include "easypbr/render/output/display_pass.h"
#include "easypbr/render/output/output_pass.h"
#include "easypbr/render/pipeline/custom_passes.h"
#include "easypbr/render/primitives/overlays.h"
#include "easypbr/render/primitives/surfaces.h"
#include "easypbr/render/raytrace/path_pass.h"
#include "easypbr/render/raytrace/ray_pass.h"
#include "easypbr/render/raytrace/received_light.h"
#include "easypbr/render/shadow/shadow_maps.h"
#include "easypbr/render/transparency/layer_guides.h"
#include "easypbr/render/transparency/native_layers.h"
#include "easypbr/render/transparency/transparency_pass.h"

namespace easypbr::render {

/// What the frames of a picture are drawn for.
struct FrameContents {
    bool ids = false;          ///< the id targets are filled; surfaces are of the core model
    bool ground = false;       ///< a plane under the content belongs to the picture
    bool traced = false;       ///< rays look for the environment's light, in place of ambient occlusion
    bool paths = false;        ///< surfaces are lit by path tracing
    bool only_layers = false;  ///< paths light nothing but layers, and no effect spreads their light
    /// Those that have ended get no paths; null: all get some.
    const SampledTiles* tiles = nullptr;
    CustomPasses* custom = nullptr;  ///< a program's own passes, where it is a picture
    bool in_host_memory = false;     ///< whatever follows can take the radiance from host memory
};

/// Owns the passes and the targets between them. All members need the context current.
class Pipeline {
  public:
    Pipeline()
        : primitives_(make_primitives(caches_)),
          surfaces_(primitives_, transfers_),
          overlays_(primitives_),
          shadow_maps_(primitives_, transfers_) {}

    /// Makes the targets for a size and forgets the times of passes.
    void begin(Vec2i size);

    /// Makes the maps of the environment that lights the scene.
    void prepare_environment(const ResolvedSettings& resolved);

    /// Draws a frame of `list`, with the shadows of `casters`. What it returns lives until the next call.
    LitPicture draw(const Frame& frame, const DrawList& list, const DrawList& casters,
                    const FrameContents& contents);
    /// Fills the G-buffer alone, in whichever memory that is done.
    void draw_surfaces(const Frame& frame, const DrawList& list, const SurfaceOutputs& outputs);
    /// Finds the ambient occlusion of a frame whose G-buffer was drawn last; nothing where it is not enabled.
    void occlude_surfaces(const Frame& frame, const DrawList& list);
    /// Clears the overlay and draws what is in it beside surfaces: overlays of primitives, effects, and a
    /// program's own passes. `native`: from and to host memory, which holds a frame that was drawn wholly
    /// natively.
    const Target* draw_overlay(const Frame& frame, const DrawList& list, const FrameContents& contents,
                               bool native);

    /// Whether light of a pixel comes to others, in frames of a shot: through a lens, by motion, or by
    /// effects.
    bool spreads_light(const Shot& shot) const;

    GBuffer& targets() { return targets_; }
    const GBuffer& targets() const { return targets_; }
    Surfaces& surfaces() { return surfaces_; }
    DataCaches& caches() { return caches_; }
    const ShadowMaps& shadow_maps() const { return shadow_maps_; }
    /// Between host memory and textures, since begin().
    Transfers& transfers() const { return transfers_; }
    PassTimer& timer() { return timer_; }
    const PassTimer& timer() const { return timer_; }
    const Box3d& bounds_of(const SceneSnapshot& scene);

    void allow_native_geometry(bool allow) {
        surfaces_.allow_native(allow);
        shadow_maps_.allow_native(allow);
    }
    void allow_native_shading(bool allow) { native_shading_ = allow; }
    /// No frame follows that adds to what paths have found so far.
    void end_paths() { paths_.end(); }
    void evict_unused();

  private:
    /// Lights a G-buffer, block by block of lights with their shadow maps; `caught`: with the light of the
    /// shadow catcher.
    void light(const Frame& frame, const GBuffer& targets, const FrameContents& contents, LightInputs inputs,
               bool caught);
    /// Finds the light of all surfaces that are not layers, by the way that the contents ask for.
    void light_surfaces(const Frame& frame, const DrawList& casters, const FrameContents& contents,
                        const LightInputs& inputs, const AmbientOcclusionPass::Surfaces& surfaces);
    void trace_paths(const Frame& frame, const FrameContents& contents, bool native, bool caught);
    void update_ray_scene(const Frame& frame, const DrawList& casters, bool ground);
    /// Tells kinds that are not lit what darkens them.
    void find_place_light(const Frame& frame, const DrawList& list, const DrawList& casters,
                          const FrameContents& contents);
    /// Depth that hides overlays and layers: of what is drawn over everything else too.
    const Target& hiding_depth(const Frame& frame, const DrawList& list, bool native);
    /// Draws the overlays of primitives where there are no layers.
    void draw_overlay_items(const Frame& frame, const DrawList& list, bool native);
    struct LayerKinds {
        bool native = false;   ///< from and to host memory
        bool overlay = false;  ///< something is in the overlay, or may come into it
    };
    /// Draws the layered items over the picture, before and behind each other and the overlays.
    void draw_transparent(const Frame& frame, const DrawList& list, const FrameContents& contents,
                          LayerKinds kinds, LitPicture& lit);
    /// Whether there were any, by the driver.
    bool draw_transparent_by_driver(const Frame& frame, const DrawList& list, const FrameContents& contents,
                                    bool with_overlay);
    /// Whether they can be drawn natively where nothing else needs the driver.
    bool has_native_layers(const DrawList& list) const;
    /// Finds the light of a layer, by the way that the contents ask for.
    void light_layer(const Frame& frame, const GBuffer& layer, const FrameContents& contents,
                     const LightInputs& inputs);
    /// The same natively.
    bool shade_transparent(const Frame& frame, const DrawList& list, const FrameContents& contents,
                           bool with_overlay);
    /// See draw_layers(); whether there were any.
    bool shade_layers(const Frame& frame, const DrawList& layers, const ItemsByKind& overlays,
                      const Target& opaque, const FrameContents& contents, bool with_overlay);
    /// Draws layers, and the overlays between them, before the surfaces of which `opaque` is the depth.
    void draw_layers(const Frame& frame, const DrawList& layers, const ItemsByKind& overlays,
                     const Target& opaque, const FrameContents& contents, bool with_overlay);
    /// The eye-dome lighting of the layers' points; nothing where there are none.
    const gl::Texture* shade_points(const Frame& frame, const DrawList& layers, const gl::Texture& opaque);
    const Target* shade_points(const Frame& frame, const DrawList& layers, const Target& opaque);
    /// Whether a frame is lit natively: its surfaces are in host memory, and nothing of it needs the driver.
    bool is_lit_natively(const DrawList& list, const FrameContents& contents) const;
    AmbientOcclusionPass::Surfaces surfaces_in(const Frame& frame, const DrawList& opaque,
                                               const FrameContents& contents);
    void occlude(const Frame& frame, bool native, const AmbientOcclusionPass::Surfaces& surfaces);
    /// What is around lit surfaces, natively: what the ground shows of itself, and the environment.
    void shade_surroundings(const Frame& frame, const FrameContents& contents, bool environment);
    void add_targets(bool overlay, bool extensions);
    /// Empties the overlay, and draws the surfaces that are shown past light.
    void begin_overlay(const Frame& frame, const DrawList& list, const FrameContents& contents, bool native);
    /// The first pass after the lighting that only the driver can do; empty where there is none.
    std::string first_by_driver(const DrawList& list, const FrameContents& contents) const;
    bool draws_overlay(const Shot& shot, const FrameContents& contents) const;
    struct EffectKinds {
        bool native = false;        ///< from and to host memory
        bool overlay_only = false;  ///< only those that draw into the overlay
    };
    void draw_effects(const Frame& frame, const DrawList& opaque, EffectKinds kinds, LitPicture& lit);

    GBuffer targets_;
    mutable Transfers transfers_;  ///< reading targets counts too
    DataCaches caches_;
    Primitives primitives_;
    gpu::EnvironmentMaps environment_;
    Surfaces surfaces_;
    Overlays overlays_;
    ShadowMaps shadow_maps_;
    AmbientOcclusionPass ambient_occlusion_;
    RayScene ray_scene_;
    ReceivedLight received_light_;
    DrawList darkening_;  ///< the surfaces of its rays
    RayPass rays_;
    PathPass paths_;
    LightingPass lighting_;
    GroundPass ground_;
    DisplayPass display_;
    TransparencyPass transparency_;
    NativeLayers native_layers_;
    LayerGuides layer_guides_;
    BackgroundPass background_;
    std::vector<std::unique_ptr<Effect>> effects_ = make_effects();
    GBuffer with_ids_;  ///< for effects that ask for ids
    PassTimer timer_;
    bool native_shading_ = true;
    Target hiding_depth_;
    gl::Framebuffer hiding_;
    ProgramVariants hiding_programs_{"screen_triangle.vert", "opaque_limit.frag"};
    /// Bounds of the last scene, and what they were computed from.
    std::vector<std::pair<uint64_t, Eigen::Affine3d>> bounded_;
    Box3d bounds_;
};

}  // namespace easypbr::render
