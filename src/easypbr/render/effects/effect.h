// What effects on a lit frame have in common: bloom, depth of field, outlines.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "easypbr/render/frame/frame.h"
#include "easypbr/render/frame/gbuffer.h"

namespace easypbr::render {

struct Glow;

/// What a frame shows once its passes have run.
struct LitPicture {
    const Target* radiance = nullptr;  ///< as GBuffer::radiance
    const Target* overlay = nullptr;   ///< as GBuffer::overlay, where there is one
    const Target* lines = nullptr;     ///< Primitive::nearest_lines(), where there are lines in the overlay
    const Glow* glow = nullptr;        ///< where bloom spreads light
    const Target* caught = nullptr;    ///< light of a shadow catcher, see GroundPass::caught()
    const GBuffer* guides = nullptr;   ///< for denoising, where layers change what the targets hold
    PixelRect covered;                 ///< all surfaces, lines and layers are inside
    bool partly_covered = false;       ///< the radiance may be brighter than what it covers
    bool spreads = false;              ///< light may fall beyond `covered`
};

struct EffectInputs {
    const Frame& frame;
    const GBuffer& targets;  ///< of the opaque surfaces
    const Box3d& bounds;     ///< of all content
    /// The same surfaces in a G-buffer with ids, in the same memory; they are drawn when this is first
    /// called.
    std::function<const GBuffer&()> with_ids;
};

/// One effect. Its settings, their rows in the table and what is inferred for them stand beside it; it is
/// registered in effects.cpp, its settings in scene/effects/effects.h, its native shaders in
/// cmake/native.cmake.
class Effect {
  public:
    virtual ~Effect() = default;
    /// In the list of times of passes.
    virtual const char* name() const = 0;
    /// Whether draw() has something to do in frames of this shot.
    virtual bool is_on(const Shot& shot) const = 0;
    /// Whether it draws into the overlay (see GBuffer::overlay).
    virtual bool draws_overlay() const { return false; }
    /// How far a pixel of the picture sees beyond itself, in pixels; 0 where the effect is off. `whole` is a
    /// frame of the whole picture: tiles are drawn with a guard band of this width.
    virtual int reach(const Frame& whole, const Box3d& bounds) const = 0;
    /// Draws on from what the frame shows so far, by the driver: from and to textures. With the context
    /// current.
    virtual void draw(const EffectInputs& inputs, LitPicture& lit) = 0;
    /// The same natively: from and to host memory. An overlay that it draws into holds the whole frame.
    virtual void shade(const EffectInputs& inputs, LitPicture& lit, Transfers& transfers) = 0;
};

/// All effects on lit frames, in pipeline order. No context is needed to make them.
std::vector<std::unique_ptr<Effect>> make_effects();

}  // namespace easypbr::render
