// The rows of the table for bloom, and what is inferred.
#include <algorithm>
#include <cmath>

#include "easypbr/scene/effect_settings.h"
#include "easypbr/scene/field_builder.h"

namespace easypbr::detail {

namespace {

/// The widest texel of the pyramid has an eighth of the picture's smaller side.
int automatic_levels(Vec2i size) {
    return std::clamp(int(std::lround(std::log2(size.minCoeff() / 16.0))), 1, 6);
}

}  // namespace

void add_bloom(Table& table) {
    table.push_back(make("bloom.enabled", EASYPBR_AT(bloom.enabled),
                         "Enables bloom, applied in linear HDR before tone mapping."));
    table.push_back(make("bloom.intensity", EASYPBR_AT(bloom.intensity),
                         "Fraction of the light above the threshold that is scattered; energy is conserved.",
                         "", {0, 1}));
    table.push_back(
        make("bloom.threshold", EASYPBR_AT(bloom.threshold),
             "Bloom threshold on the largest of red, green and blue after exposure; 0 scatters all light.",
             "", {0, 1e6}));
    table.push_back(make("bloom.knee", EASYPBR_AT(bloom.knee),
                         "Width of the soft knee as a fraction of the threshold.", "", {0, 1}));
    table.push_back(not_kept(
        make("bloom.levels", EASYPBR_AT(bloom.levels),
             "Number of mip levels of the bloom pyramid, which starts at a quarter of the resolution; "
             "automatic: up to 6, the widest texel an eighth of the smaller image side.",
             "", {1, 8})));
    table.push_back(
        not_kept(make("bloom.suppress_fireflies", EASYPBR_AT(bloom.suppress_fireflies),
                      "Weights bright pixels down in the first bloom level to suppress fireflies, which "
                      "does not conserve energy; automatic: on if the threshold is above 0.")));
}

void infer(BloomSettings& bloom, const EffectContext& context) {
    fill(bloom.levels, automatic_levels(context.size));
    fill(bloom.suppress_fireflies, bloom.threshold > 0);
}

}  // namespace easypbr::detail
