// The rows of the table for motion blur, and what is inferred.
#include "easypbr/scene/effect_settings.h"
#include "easypbr/scene/field_builder.h"

namespace easypbr::detail {

void add_fields(Table& table, MotionBlurSettings Settings::*effect) {
    const auto of = [&](auto member) { return at(effect, member); };
    table.push_back(make("motion_blur.enabled", of(&MotionBlurSettings::enabled),
                         "Enables motion blur of accumulated images, from the poses of camera and objects in "
                         "the previous image."));
    table.push_back(make("motion_blur.shutter", of(&MotionBlurSettings::shutter),
                         "Fraction of the time since the previous image that the shutter is open; it closes "
                         "at the time of this image.",
                         "", {0, 1}));
}

void infer(MotionBlurSettings& /*motion_blur*/, const EffectContext& /*context*/) {}

}  // namespace easypbr::detail
