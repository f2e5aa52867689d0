#include "easypbr/scene/colormap.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <string_view>

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

}  // namespace

const std::vector<std::string>& colormap_names() {
    static const std::vector<std::string> names = {"viridis", "plasma",  "inferno", "magma",
                                                   "turbo",   "cividis", "grey",    "coolwarm"};
    return names;
}

Colormap colormap_named(const std::string& name) {
    const auto& names = colormap_names();
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end())
        throw NameError(fmt::format("there is no colormap '{}'{}: expected {}", name,
                                    did_you_mean(name, names), fmt::join(names, ", ")));
    return Colormap(found - names.begin());
}

const ColorTable& color_table(Colormap colormap) {
    static const std::array<ColorTable, 8> tables = {parse(viridis_table),
                                                     parse(plasma_table),
                                                     parse(inferno_table),
                                                     parse(magma_table),
                                                     parse(turbo_table),
                                                     parse(cividis_table),
                                                     grey(),
                                                     coolwarm()};
    return tables[size_t(colormap)];
}

}  // namespace easypbr
