#include "easypbr/scene/colormap.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <string_view>
#include <utility>

#include "easypbr/core/ascii.h"
#include "easypbr/core/error.h"
#include "easypbr/core/suggest.h"

namespace easypbr {
namespace {

#include "easypbr/scene/colormap_tables.inc"

ColorTable parse(std::string_view codes) {
    ColorTable table;
    for (size_t i = 0; i < 256; ++i)
        for (size_t k = 0; k < 3; ++k) {
            const char* const at = codes.data() + 6 * i + 2 * k;
            std::from_chars(at, at + 2, table[i][k], 16);
        }
    return table;
}

ColorTable grey() {
    ColorTable table;
    for (size_t i = 0; i < 256; ++i) table[i].fill(uint8_t(i));
    return table;
}

// Moreland 2009: colours in Msh, the polar form of CIELAB with magnitude, saturation and hue.

/// D65, as sRGB has it (IEC 61966-2-1).
const Eigen::Vector3d white(0.9505, 1.0, 1.089);
const Mat3d xyz_from_rgb =
    (Mat3d() << 0.4124, 0.3576, 0.1805, 0.2126, 0.7152, 0.0722, 0.0193, 0.1192, 0.9505).finished();

Vec3d msh_from_rgb8(const Rgb8& color) {
    const Vec3d rgb = linear_from_srgb(Vec3(color[0], color[1], color[2]) / 255.0f).cast<double>();
    const auto f = [](double t) { return t > 0.008856 ? std::cbrt(t) : 7.787 * t + 16.0 / 116; };
    const Vec3d xyz = (xyz_from_rgb * rgb).cwiseQuotient(white).unaryExpr(f);
    const Vec3d lab(116 * xyz.y() - 16, 500 * (xyz.x() - xyz.y()), 200 * (xyz.y() - xyz.z()));
    const double magnitude = lab.norm();
    return {magnitude, std::acos(lab[0] / magnitude), std::atan2(lab[2], lab[1])};
}

Rgb8 rgb8_from_msh(const Vec3d& msh) {
    const double chroma = msh[0] * std::sin(msh[1]);
    const Vec3d lab(msh[0] * std::cos(msh[1]), chroma * std::cos(msh[2]), chroma * std::sin(msh[2]));
    const double y = (lab[0] + 16) / 116;
    const auto f = [](double t) { return t > 0.2068930 ? t * t * t : (t - 16.0 / 116) / 7.787; };
    const Vec3d xyz = Vec3d(y + lab[1] / 500, y, y - lab[2] / 200).unaryExpr(f).cwiseProduct(white);
    const Vec3d rgb = (xyz_from_rgb.inverse() * xyz).cwiseMax(0).cwiseMin(1);
    return to_rgb8(srgb_from_linear(Vec3(rgb.cast<float>())));
}

/// Hue that an unsaturated colour of magnitude `magnitude` takes so that the way to `saturated` is even.
double adjusted_hue(const Vec3d& saturated, double magnitude) {
    const double m = saturated[0], s = saturated[1];
    if (m >= magnitude) return saturated[2];
    const double spin = s * std::sqrt(magnitude * magnitude - m * m) / (m * std::sin(s));
    return saturated[2] + (saturated[2] > -std::numbers::pi / 3 ? spin : -spin);
}

/// Blue to light grey to red, the map that the paper recommends.
ColorTable coolwarm() {
    const Vec3d cool = msh_from_rgb8({59, 76, 192}), warm = msh_from_rgb8({180, 4, 38});
    const double middle = std::max({cool[0], warm[0], 88.0});
    ColorTable table;
    for (int i = 0; i < 256; ++i) {
        const double t = i / 255.0;
        const Vec3d& end = t < 0.5 ? cool : warm;
        const Vec3d grey(middle, 0, adjusted_hue(end, middle));
        table[size_t(i)] = rgb8_from_msh(grey + std::abs(2 * t - 1) * (end - grey));
    }
    return table;
}

/// Colours at so many even places from the first to the last, between them linear in sRGB.
template <class Table>
void sample_colors(const std::vector<Rgb8>& colors, Table& samples) {
    const double last = double(colors.size() - 1);
    for (size_t i = 0; i < samples.size(); ++i) {
        const double at = last * double(i) / double(samples.size() - 1);
        const size_t below = std::min(size_t(at), colors.size() - 2);
        for (size_t k = 0; k < 3; ++k)
            samples[i][k] =
                uint8_t(std::lround(std::lerp(colors[below][k], colors[below + 1][k], at - double(below))));
    }
}

std::shared_ptr<const std::vector<Rgb8>> checked_colors(std::vector<Rgb8> colors) {
    if (colors.size() < 2)
        throw ArgumentError(fmt::format("colormap: expected at least 2 colours, got {}", colors.size()));
    if (colors.size() > std::tuple_size_v<ColorTable>) {
        std::vector<Rgb8> samples(std::tuple_size_v<ColorTable>);
        sample_colors(colors, samples);
        colors = std::move(samples);
    }
    return std::make_shared<const std::vector<Rgb8>>(std::move(colors));
}

std::vector<Rgb8> rgb8_rows(const Array3f& colors) {
    std::vector<Rgb8> codes;
    for (Eigen::Index i = 0; i < colors.rows(); ++i) {
        const Vec3 color = colors.row(i);
        if (!((color.array() >= 0).all() && (color.array() <= 1).all()))
            throw ArgumentError(fmt::format(
                "colormap: expected colours of three numbers from 0 to 1, got ({}, {}, {}) in row "
                "{} of {}",
                color[0], color[1], color[2], i, colors.rows()));
        codes.push_back(to_rgb8(color));
    }
    return codes;
}

std::vector<Rgb8> parse_colors(std::string_view text) {
    std::vector<Rgb8> colors;
    for (size_t begin = 0; begin <= text.size();) {
        const size_t end = std::min(text.find(',', begin), text.size());
        std::string_view color = text.substr(begin, end - begin);
        color.remove_prefix(std::min(color.find_first_not_of(' '), color.size()));
        color.remove_suffix(color.size() - (color.find_last_not_of(' ') + 1));
        try {
            colors.push_back(to_rgb8(parse_color(color)));
        } catch (const ArgumentError& error) {
            throw ArgumentError(fmt::format("colormap: colour {}: {}", colors.size() + 1, error.what()));
        }
        begin = end + 1;
    }
    return colors;
}

constexpr std::array<const char*, 8> built_in_names = {"viridis", "plasma",  "inferno", "magma",
                                                       "turbo",   "cividis", "grey",    "coolwarm"};

}  // namespace

const std::vector<std::string>& colormap_names() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> all(built_in_names.begin(), built_in_names.end());
        for (const char* name : built_in_names) all.push_back(std::string(name) + "_r");
        return all;
    }();
    return names;
}

Colormap::Colormap(const std::vector<Rgb8>& colors) : colors_(checked_colors(colors)) {}

Colormap::Colormap(const Array3f& colors) : colors_(checked_colors(rgb8_rows(colors))) {}

Colormap Colormap::reversed() const {
    if (colors_) return Colormap(std::vector<Rgb8>(colors_->rbegin(), colors_->rend()));
    Colormap other = *this;
    other.is_reversed_ = !is_reversed_;
    return other;
}

bool Colormap::operator==(const Colormap& other) const {
    if (colors_ && other.colors_) return *colors_ == *other.colors_;
    return !colors_ && !other.colors_ && built_in_ == other.built_in_ && is_reversed_ == other.is_reversed_;
}

std::string Colormap::text() const {
    if (!colors_) return colormap_names()[built_in_ + (is_reversed_ ? built_in_names.size() : 0)];
    std::string text;
    for (const Rgb8& color : *colors_)
        text += fmt::format("{}#{:02x}{:02x}{:02x}", text.empty() ? "" : ",", color[0], color[1], color[2]);
    return text;
}

Colormap parse_colormap(std::string_view text) {
    const auto& names = colormap_names();
    const auto found =
        std::ranges::find_if(names, [&](const auto& name) { return ascii::same_letters(name, text); });
    if (found != names.end()) {
        const size_t place = size_t(found - names.begin()), count = built_in_names.size();
        const Colormap map{uint8_t(place % count)};
        return place < count ? map : map.reversed();
    }
    if (text.starts_with('#') || text.find(',') != text.npos) return Colormap(parse_colors(text));
    throw NameError(
        fmt::format("there is no colormap '{}'{}: expected {}, one of these with _r behind it (reversed), "
                    "or colours such as '#000080,#ffffff,#800000'",
                    text, did_you_mean(text, names), fmt::join(built_in_names, ", ")));
}

ColorTable color_table(const Colormap& colormap) {
    static const std::array<ColorTable, built_in_names.size()> tables = {parse(viridis_table),
                                                                         parse(plasma_table),
                                                                         parse(inferno_table),
                                                                         parse(magma_table),
                                                                         parse(turbo_table),
                                                                         parse(cividis_table),
                                                                         grey(),
                                                                         coolwarm()};
    ColorTable table;
    if (colormap.colors_)
        sample_colors(*colormap.colors_, table);
    else
        table = tables[colormap.built_in_];
    if (colormap.is_reversed_) std::ranges::reverse(table);
    return table;
}

ColorTable color_table(const Colormap& colormap, int steps) {
    const ColorTable whole = color_table(colormap);
    const int parts = color_parts(steps);
    if (steps == 0) return whole;
    const auto of_band = [&](int band) {
        return whole[steps == 1 ? 128 : size_t(std::lround(band * 255.0 / (steps - 1)))];
    };
    ColorTable table;
    const int per_band = parts / steps;
    for (int i = 0; i < 256; ++i) table[size_t(i)] = of_band(std::min(i / per_band, steps - 1));
    return table;
}

int color_parts(int steps) {
    if (steps < 0 || steps > 256)
        throw ArgumentError(fmt::format("colormap: expected 0 to 256 bands, got {}", steps));
    return steps > 0 ? steps * (256 / steps) : 256;
}

}  // namespace easypbr
