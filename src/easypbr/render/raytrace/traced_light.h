// What rays found, on its way from the pass that sends them to the one that lights.
#pragma once

#include "easypbr/render/frame/target.h"

namespace easypbr::render {

/// What rays found for each pixel of a G-buffer; 1, 0 and 0 where none were sent. Not filtered.
struct TracedLight {
    Target sky_visibility;     ///< RGBA16F: part of the sky's diffuse light that arrives; a: part of all
                               ///< light left by recesses that the material knows of and rays do not find
    Target indirect_diffuse;   ///< RGBA16F: diffuse light of other surfaces, divided by pi and
                               ///< half_light_scale()
    Target indirect_specular;  ///< RGBA16F: what other surfaces fill of the reflection, premultiplied,
                               ///< divided by half_light_scale(); a: how much

    /// Brings what rays found to the textures.
    void upload(Transfers& transfers) const {
        for (const Target* target : {&sky_visibility, &indirect_diffuse, &indirect_specular})
            target->upload(transfers);
    }
};

}  // namespace easypbr::render
