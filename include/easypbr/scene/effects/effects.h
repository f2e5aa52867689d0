// The effects and their settings. A line here registers an effect's settings: they become a member of
// Settings, and their rows and inferred values, which stand in the effect's own folder (those of rays and
// paths in render/raytrace), part of the table and of resolve().
#pragma once

#include "easypbr/scene/effects/ambient_occlusion.h"
#include "easypbr/scene/effects/bloom.h"
#include "easypbr/scene/effects/depth_of_field.h"
#include "easypbr/scene/effects/ground.h"
#include "easypbr/scene/effects/motion_blur.h"
#include "easypbr/scene/effects/outline.h"
#include "easypbr/scene/effects/ray_tracing.h"

/// EFFECT(member of BasicSettings, its type there), in the order of the table of settings.
#define EASYPBR_EFFECTS(EFFECT)                                  \
    EFFECT(ground, BasicGroundSettings<MaybeAuto>)               \
    EFFECT(ssao, BasicSsaoSettings<MaybeAuto>)                   \
    EFFECT(path, BasicPathSettings<MaybeAuto>)                   \
    EFFECT(rays, BasicRaySettings<MaybeAuto>)                    \
    EFFECT(bloom, BasicBloomSettings<MaybeAuto>)                 \
    EFFECT(depth_of_field, BasicDepthOfFieldSettings<MaybeAuto>) \
    EFFECT(motion_blur, MotionBlurSettings)                      \
    EFFECT(outline, BasicOutlineSettings<MaybeAuto>)
