// What rays found, on its way from the pass that sends them to the one that lights.
#pragma once

#include "easypbr/gl/texture.h"

namespace easypbr::render {

/// What rays found for each pixel of a G-buffer; 1, 0 and 0 where none were sent. Not filtered.
struct TracedLight {
    gl::Texture sky_visibility;    ///< RGBA16F: part of the sky's diffuse light that arrives; a: part of all
                                   ///< light left by recesses that the material knows of and rays do not find
    gl::Texture indirect_diffuse;  ///< RGBA16F: diffuse light of other surfaces, divided by pi
    gl::Texture indirect_specular;  ///< RGBA16F: what other surfaces fill of the reflection, premultiplied;
                                    ///< a: how much
};

}  // namespace easypbr::render
