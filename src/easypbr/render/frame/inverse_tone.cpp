#include "easypbr/render/frame/inverse_tone.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "easypbr/core/color.h"
#include "easypbr/core/luminance.h"

namespace easypbr::render {
namespace {

constexpr float brightest = 4;

Vec3 inverse_aces(const Vec3& display) {
    static const Mat3 from_input =
        (Mat3() << 0.59719f, 0.35458f, 0.04823f, 0.07600f, 0.90834f, 0.01566f, 0.02840f, 0.13383f, 0.83777f)
            .finished()
            .inverse();
    static const Mat3 from_output = (Mat3() << 1.60475f, -0.53108f, -0.07367f, -0.10208f, 1.10813f, -0.00605f,
                                     -0.00327f, -0.07276f, 1.07602f)
                                        .finished()
                                        .inverse();
    // y = (v^2 + a v - b) / (c v^2 + d v + e), solved for v.
    constexpr float a = 0.0245786f, b = 0.000090537f, c = 0.983729f, d = 0.4329510f, e = 0.238081f;
    const Vec3 fitted = from_output * display;
    Vec3 v;
    for (int i = 0; i < 3; ++i) {
        const float y = std::clamp(fitted[i], 0.0f, 0.999f), linear = a - y * d, square = 1 - y * c;
        v[i] = (std::sqrt(linear * linear + 4 * square * (b + y * e)) - linear) / (2 * square);
    }
    return from_input * v;
}

Vec3 inverse_reinhard(const Vec3& display) {
    return display / std::max(1 - luminance(display), 1e-3f);
}

/// Where the sigmoid of AgX has a value, by bisection: it rises.
float agx_argument(float value) {
    const auto sigmoid = [](float x) {
        const float x2 = x * x, x4 = x2 * x2;
        return 15.5f * x4 * x2 - 40.14f * x4 * x + 31.96f * x4 - 6.868f * x2 * x + 0.4298f * x2 +
               0.1191f * x - 0.00232f;
    };
    float low = 0, high = 1;
    for (int i = 0; i < 20; ++i) {
        const float middle = (low + high) / 2;
        (sigmoid(middle) < value ? low : high) = middle;
    }
    return (low + high) / 2;
}

Vec3 inverse_agx(const Vec3& display) {
    static const Mat3 from_inset =
        (Mat3() << 0.842479062253094f, 0.0784335999999992f, 0.0792237451477643f, 0.0423282422610123f,
         0.878468636469772f, 0.0791661274605434f, 0.0423756549057051f, 0.0784336f, 0.879142973793104f)
            .finished()
            .inverse();
    static const Mat3 from_outset = (Mat3() << 1.19687900512017f, -0.0980208811401368f, -0.0990297440797205f,
                                     -0.0528968517574562f, 1.15190312990417f, -0.0989611768448433f,
                                     -0.0529716355144438f, -0.0980434501171241f, 1.15107367264116f)
                                        .finished()
                                        .inverse();
    constexpr float min_ev = -12.47393f, max_ev = 4.026069f;
    const Vec3 fitted = from_outset * display.array().pow(1 / 2.2f).matrix();
    Vec3 exposed;
    for (int i = 0; i < 3; ++i)
        exposed[i] = std::exp2(agx_argument(std::clamp(fitted[i], 0.0f, 1.0f)) * (max_ev - min_ev) + min_ev);
    return from_inset * exposed;
}

Vec3 inverse_neutral(const Vec3& display) {
    constexpr float start = 0.8f - 0.04f, desaturation = 0.15f, d = 1 - start;
    Vec3 c = display;
    if (const float shown = std::min(display.maxCoeff(), 0.999f); shown >= start) {
        const float peak = d * d / (1 - shown) - d + start;
        const float kept = 1 / (desaturation * (peak - shown) + 1);
        const Vec3 compressed = Vec3::Constant(shown) + (display - Vec3::Constant(shown)) / kept;
        c = (compressed * (peak / shown)).cwiseMax(0.0f);
    }
    const float low = c.minCoeff();
    // What was subtracted leaves 6.25 times the square of a small component.
    const float before = low < 0.04f ? std::sqrt(std::max(low, 0.0f) / 6.25f) : low + 0.04f;
    return c + Vec3::Constant(before - low);
}

Vec3 inverse_curve(const Vec3& display, ToneOperator tone_operator) {
    switch (tone_operator) {
        case ToneOperator::aces:
            return inverse_aces(display);
        case ToneOperator::reinhard:
            return inverse_reinhard(display);
        case ToneOperator::agx:
            return inverse_agx(display);
        case ToneOperator::neutral:
            return inverse_neutral(display);
        default:
            return display;
    }
}

}  // namespace

DisplayTone display_tone(const ResolvedSettings& resolved) {
    return {resolved.settings.tonemap.tone_operator, resolved.exposure};
}

std::string_view tone_feature(ToneOperator tone_operator) {
    switch (tone_operator) {
        case ToneOperator::reinhard:
            return "TONE_REINHARD";
        case ToneOperator::agx:
            return "TONE_AGX";
        case ToneOperator::neutral:
            return "TONE_NEUTRAL";
        case ToneOperator::none:
            return "TONE_NONE";
        default:
            return "TONE_ACES";
    }
}

Vec3 inverse_tone_map(const Vec3& display, const DisplayTone& tone) {
    const Vec3 radiance =
        inverse_curve(display.cwiseMax(0.0f).cwiseMin(1.0f), tone.tone_operator).cwiseMax(0.0f);
    // Dimmed as a whole, so that hues stay.
    const float most = radiance.maxCoeff();
    return radiance * (std::min(1.0f, brightest / std::max(most, 1e-6f)) / tone.exposure);
}

std::optional<Vec3> background_radiance(const ResolvedSettings& resolved) {
    const BackgroundSettings& background = resolved.settings.background;
    if (background.mode != BackgroundMode::color) return std::nullopt;
    return inverse_tone_map(linear_from_srgb(background.color), display_tone(resolved));
}

}  // namespace easypbr::render
