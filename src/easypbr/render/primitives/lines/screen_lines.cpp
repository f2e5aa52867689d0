#include "easypbr/render/primitives/lines/screen_lines.h"

#include <algorithm>
#include <cmath>

#include "easypbr/core/color.h"
#include "easypbr/core/parallel.h"

namespace easypbr::render {
namespace {

/// The part of a segment that is drawn, from 0 to 1; nothing where `from` is not below `to`.
struct Part {
    float from = 0, to = 1;

    /// Leaves what is above 0 of a value that is `a` at the start and `b` at the end.
    void cut(float a, float b) {
        if (a < 0 && b < 0) to = -1;
        if (a < 0 && b >= 0) from = std::max(from, a / (a - b));
        if (a >= 0 && b < 0) to = std::min(to, a / (a - b));
    }
    bool is_empty() const { return from > to; }
};

/// No segment is cut nearer than this part of the larger |w| of its ends: their clip coordinates are of
/// single precision, an error of 1e-7 of it that is to stay small beside w, which they are divided by.
constexpr float least_part_of_w = 1e-5f;
/// Pixels from the middle of the picture, beyond which segments are cut: there single precision still holds
/// hundredths.
constexpr float farthest_pixel = 1e5f;

Part part_of(const Vec4& start, const Vec4& end, const Vec2& size) {
    const float least_w = least_part_of_w * std::max(std::abs(start.w()), std::abs(end.w()));
    Part part;
    part.cut(start.w() - least_w, end.w() - least_w);
    part.cut(start.w() - start.z(), end.w() - end.z());  // the near plane
    part.cut(start.z(), end.z());                        // the far plane of an orthographic camera
    for (int k = 0; k < 2; ++k) {
        const float side = 2 * farthest_pixel / size[k];
        part.cut(side * start.w() - start[k], side * end.w() - end[k]);
        part.cut(side * start.w() + start[k], side * end.w() + end[k]);
    }
    return part;
}

/// The ends themselves at 0 and 1.
Vec4 point_at(const Vec4& start, const Vec4& end, float place) {
    return start * (1 - place) + end * place;
}

/// See LineView::color for `given`.
void set_color(float* to, const Rgba8& own, const Vec4& given) {
    const Vec4 encoded = Vec4(own[0], own[1], own[2], own[3]) / 255.0f;
    const Vec3 color = given.w() == 0 ? linear_from_srgb(Vec3(encoded.head<3>())) : Vec3(given.head<3>());
    std::copy_n(color.data(), 3, to);
    to[3] = given.w() > 0 ? 1 : encoded.w();
}

Vec2 pixel_of(const Vec4& clip, const Vec2& size) {
    const Vec2 ndc = clip.head<2>() / clip.w();
    return {(0.5f + 0.5f * ndc.x()) * size.x(), (0.5f - 0.5f * ndc.y()) * size.y()};
}

/// False where nothing of it is drawn.
bool project(const gpu::Segment& segment, const LineView& view, native::ScreenLine& line) {
    const Vec4 start = view.clip_from_mesh * Vec4(segment.a[0], segment.a[1], segment.a[2], 1),
               end = view.clip_from_mesh * Vec4(segment.b[0], segment.b[1], segment.b[2], 1);
    const Part part = part_of(start, end, view.size);
    if (part.is_empty()) return false;
    const Vec4 a = point_at(start, end, part.from), b = point_at(start, end, part.to);
    const Vec2 from = pixel_of(a, view.size), to = pixel_of(b, view.size), way = to - from;
    line.length = way.norm();
    if (!std::isfinite(line.length)) return false;
    const Vec2 along = line.length > 1e-6f ? Vec2(way / line.length) : Vec2(1, 0);
    std::copy_n(from.data(), 2, line.start);
    std::copy_n(along.data(), 2, line.along);
    line.depths[0] = a.z() / a.w();
    line.depths[1] = b.z() / b.w();
    line.ws[0] = a.w();
    line.ws[1] = b.w();
    line.parts[0] = part.from;
    line.parts[1] = part.to;
    set_color(line.start_color, segment.color_a, view.color);
    set_color(line.end_color, segment.color_b, view.color);
    std::copy_n(segment.places, 2, line.places);
    line.row = segment.row;
    return true;
}

/// The lines of all segments.
struct Projected {
    std::vector<native::ScreenLine> lines;
    std::vector<uint8_t> drawn;  ///< 0: nothing of it, and the line is undefined

    Projected(std::span<const gpu::Segment> segments, const LineView& view)
        : lines(segments.size()), drawn(segments.size()) {
        parallel_for(segments.size(), 4096,
                     [&](size_t i) { drawn[i] = project(segments[i], view, lines[i]); });
        if (view.dash > 0) set_dashes(view);
    }

  private:
    /// Counts the pixels that are drawn of a chain: what is cut off counts for nothing, so that nothing jumps
    /// where a segment passes the near plane.
    void set_dashes(const LineView& view) {
        double length = 0;
        for (const gpu::ChainStep& step : view.chains) {
            if (step.first) length = 0;
            if (!drawn[step.segment]) continue;
            native::ScreenLine& line = lines[step.segment];
            const double start = step.reversed ? length + double(line.length) : length;
            line.dash[0] = float(std::fmod(start, 2 * double(view.dash)));
            line.dash[1] = step.reversed ? -1.0f : 1.0f;
            length += double(line.length);
        }
    }
};

}  // namespace

std::vector<native::ScreenLine> screen_lines(std::span<const gpu::Segment> segments, const LineView& view) {
    auto [lines, drawn] = Projected(segments, view);
    size_t count = 0;
    for (size_t i = 0; i < lines.size(); ++i)
        if (drawn[i]) lines[count++] = lines[i];
    lines.resize(count);
    return lines;
}

std::vector<std::array<float, 2>> dashes_of(std::span<const gpu::Segment> segments, const LineView& view) {
    const Projected projected(segments, view);
    std::vector<std::array<float, 2>> dashes(segments.size());
    std::ranges::transform(projected.lines, dashes.begin(), [](const native::ScreenLine& line) {
        return std::array{line.dash[0], line.dash[1]};
    });
    return dashes;
}

}  // namespace easypbr::render
