// The rows of the table for motion blur, and what is inferred.
#include "easypbr/scene/effect_settings.h"
#include "easypbr/scene/field_builder.h"

namespace easypbr::detail {

void add_motion_blur(Table& table) {
    table.push_back(make("motion_blur.enabled", EASYPBR_AT(motion_blur.enabled),
                         "Enables motion blur of accumulated images, from the poses of camera and objects in "
                         "the previous image."));
    table.push_back(make("motion_blur.shutter", EASYPBR_AT(motion_blur.shutter),
                         "Fraction of the time since the previous image that the shutter is open; it closes "
                         "at the time of this image.",
                         "", {0, 1}));
}

void infer(MotionBlurSettings& /*motion_blur*/, const EffectContext& /*context*/) {}

}  // namespace easypbr::detail
