#include "easypbr/scene/label_colors.h"

#include <algorithm>
#include <limits>
#include <mutex>

namespace easypbr {
namespace {

/// The grid of colours to choose from, 29 values per channel: 3 to 255.
constexpr int grid_first = 3, grid_step = 9;
/// Lightness of what stands out from dark and light backgrounds alike, and chroma that does not glare.
constexpr double darkest = 0.4, lightest = 0.92, most_chroma = 0.2;

struct Candidate {
    Rgb8 color;
    Vec3d lab;
    double distance = std::numeric_limits<double>::infinity();  ///< squared, to the nearest chosen one
};

/// The greedy choice, extended when more colours are asked for.
class Sequence {
  public:
    Sequence() {
        for (int r = grid_first; r < 256; r += grid_step)
            for (int g = grid_first; g < 256; g += grid_step)
                for (int b = grid_first; b < 256; b += grid_step) add({uint8_t(r), uint8_t(g), uint8_t(b)});
        for (const int grey : {0, 64, 128, 255})
            keep_away(oklab_from_rgb8({uint8_t(grey), uint8_t(grey), uint8_t(grey)}));
    }

    std::vector<Rgb8> first(size_t count) {
        while (chosen_.size() < count) {
            // The first of the farthest, so that the result is the same everywhere.
            const auto next = std::max_element(
                candidates_.begin(), candidates_.end(),
                [](const Candidate& a, const Candidate& b) { return a.distance < b.distance; });
            chosen_.push_back(next->color);
            keep_away(Vec3d(next->lab));
        }
        return {chosen_.begin(), chosen_.begin() + std::ptrdiff_t(count)};
    }

  private:
    void add(const Rgb8& color) {
        const Vec3d lab = oklab_from_rgb8(color);
        if (lab[0] >= darkest && lab[0] <= lightest && lab.tail<2>().norm() <= most_chroma)
            candidates_.push_back({color, lab});
    }

    void keep_away(const Vec3d& lab) {
        for (Candidate& c : candidates_) c.distance = std::min(c.distance, (c.lab - lab).squaredNorm());
    }

    std::vector<Candidate> candidates_;
    std::vector<Rgb8> chosen_;
};

}  // namespace

Vec3d oklab_from_rgb8(const Rgb8& color) {
    const float* const linear = srgb8_table();
    const Vec3d rgb(linear[color[0]], linear[color[1]], linear[color[2]]);
    const Mat3d lms_from_rgb = (Mat3d() << 0.4122214708, 0.5363325363, 0.0514459929, 0.2119034982,
                                0.6806995451, 0.1073969566, 0.0883024619, 0.2817188376, 0.6299787005)
                                   .finished();
    const Mat3d lab_from_lms = (Mat3d() << 0.2104542553, 0.7936177850, -0.0040720468, 1.9779984951,
                                -2.4285922050, 0.4505937099, 0.0259040371, 0.7827717662, -0.8086757660)
                                   .finished();
    return lab_from_lms * (lms_from_rgb * rgb).unaryExpr([](double v) { return std::cbrt(v); });
}

GeneratedColors::GeneratedColors(int32_t highest) {
    static std::mutex mutex;
    static Sequence sequence;
    const std::lock_guard lock(mutex);
    colors_ = sequence.first(size_t(std::clamp(highest, 0, generated_color_count - 1)) + 1);
}

}  // namespace easypbr
