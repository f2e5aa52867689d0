// What surfaces are drawn for.
#pragma once

#include "easypbr/gl/texture.h"
#include "easypbr/render/frame/extensions.h"

namespace easypbr::render {

/// One layer of depth peeling: of what is nearer than the limit the farthest, or else the nearest.
struct Peel {
    const gl::Texture* limit = nullptr;  ///< R32F, reversed depth
    bool first = true;  ///< the limit is the opaque surfaces' depth; else a pixel with 0 takes no more
    bool farthest = true;
    bool backs = false;  ///< instead the nearest back faces that lie behind the limit
};

/// What geometry is drawn for.
struct SurfaceOutputs {
    bool ids = false;             ///< the id and element targets are filled too
    ExtensionSet extensions = 0;  ///< of the surfaces that are drawn; 0: all are of the core model
    bool whole = false;           ///< in host memory targets hold all of the frame, for what is added to them
    bool emission = false;        ///< in host memory emission is written, though nothing may emit
    /// With ids: where the primitives of a pixel are one surface, the nearest alone is seen, not their mean.
    bool nearest_alone = false;
    const Peel* peel = nullptr;  ///< one layer of depth peeling is drawn, into targets cleared before
};

}  // namespace easypbr::render
