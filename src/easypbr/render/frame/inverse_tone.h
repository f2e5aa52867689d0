// The tone curves of shaders/common_tone.glsl, and their inverse.
#pragma once

#include <optional>
#include <string_view>

#include "easypbr/scene/resolve.h"

namespace easypbr::render {

struct DisplayTone {
    ToneOperator tone_operator = ToneOperator::none;
    float exposure = 1;
};
DisplayTone display_tone(const ResolvedSettings& resolved);
/// The feature of shaders/common_tone.glsl that stands for a curve.
std::string_view tone_feature(ToneOperator tone_operator);

/// Linear Rec.709 radiance, of which exposure and curve make `display`, linear display light in [0, 1]. What
/// only much brighter light would show, near white, stands for radiance that is 4 times white after
/// exposure: the curves take it all but to white, and it lights surfaces no more than a lamp would.
Vec3 inverse_tone_map(const Vec3& display, const DisplayTone& tone);

/// The radiance that stands for a background of one colour where light is traced to it; none where the
/// background is something else.
std::optional<Vec3> background_radiance(const ResolvedSettings& resolved);

}  // namespace easypbr::render
