#include "easypbr/render/output/background_image.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

#include "easypbr/core/log.h"
#include "easypbr/core/parallel.h"

namespace easypbr::render {
namespace {

/// The part of an image, in parts of its size, that covers a picture.
Vec2 covering_scale(const Image& image, const Vec2i& picture) {
    const float shape = float(picture.x()) / float(picture.y()),
                own = float(image.width()) / float(image.height());
    return shape > own ? Vec2(1, own / shape) : Vec2(shape / own, 1);
}

/// Rows of a background image's light that are made at once: its numbers take more memory than its codes.
constexpr int rows_at_once = 128;

/// Premultiplied linear light of some rows. Adds the count of values that were no numbers.
Image linear_rows(const Image& image, int first, int count, size_t& replaced) {
    Image rows(image.width(), count, image.channels(), image.type());
    const size_t row_bytes = rows.bytes().size() / size_t(count);
    std::ranges::copy(image.bytes().subspan(size_t(first) * row_bytes, rows.bytes().size()),
                      rows.bytes().begin());
    Image light = with_channels(picture_to_linear_f32(rows), 4);
    replaced += replace_non_finite(light);
    return light;
}

}  // namespace

int BackgroundImage::halvings(const Vec2i& picture, int most_side) const {
    const float shown = covering_scale(*image_, picture).x() * float(image_->width());
    int count = 0;
    // A bilinear sample reads two texels of a line.
    for (float per_pixel = shown / float(picture.x()); per_pixel >= 2; per_pixel /= 2) ++count;
    while (std::max(image_->width(), image_->height()) >> count > most_side) ++count;
    return count;
}

Vec2 BackgroundImage::uv_scale() const {
    return Vec2(float(image_->width()), float(image_->height()))
        .cwiseQuotient((light_.size() * (1 << halvings_)).cast<float>());
}

Vec4 BackgroundImage::uv(const Frame& frame) const {
    const Vec2 whole = frame.picture_size.cast<float>(), by = uv_scale();
    const Vec2 scale = covering_scale(*image_, frame.picture_size);
    const Vec2 part = scale.cwiseProduct(frame.size.cast<float>().cwiseQuotient(whole));
    const Vec2 first =
        (Vec2(1, 1) - scale) / 2 + scale.cwiseProduct(frame.origin.cast<float>().cwiseQuotient(whole));
    return Vec4(part.x(), part.y(), first.x(), first.y()).cwiseProduct(Vec4(by.x(), by.y(), by.x(), by.y()));
}

const Target& BackgroundImage::light(const Vec2i& picture, int most_side) {
    const int wanted = halvings(picture, most_side);
    if (light_ && wanted == halvings_) return light_;
    const Vec2i size(std::max(1, image_->width() >> wanted), std::max(1, image_->height() >> wanted));
    Target light(gl::Format::rgba32f, size);
    light.write(light.whole());
    const std::span<std::byte> to = light.pixels<std::byte>();
    const size_t row_bytes = to.size() / size_t(size.y());
    size_t replaced = 0;
    for (int row = 0; row < size.y(); row += rows_at_once) {
        // Of the last rows, those that no whole row is made of are left out.
        const int rows = std::min(rows_at_once, size.y() - row);
        Image band =
            linear_rows(*image_, row << wanted, std::min(rows << wanted, image_->height()), replaced);
        for (int i = 0; i < wanted; ++i) band = half_size(band);
        std::ranges::copy(band.bytes(), to.begin() + long(size_t(row) * row_bytes));
    }
    if (replaced > 0)
        log_warning(fmt::format(
            "background image '{}': {} values that are NaN or infinite were replaced by 0", name_, replaced));
    light_ = std::move(light);
    halvings_ = wanted;
    return light_;
}

Image BackgroundImage::covering(const Vec2i& picture) {
    const Target& from = light(picture, most_native_side);
    const std::span<const Vec4> texels = from.pixels<const Vec4>();
    Frame frame;
    frame.size = frame.picture_size = picture;
    const Vec4 place = uv(frame);
    Image covered(picture.x(), picture.y(), 4, PixelType::f32);
    parallel_for(size_t(picture.y()), 8, [&](size_t row) {
        // As linear filtering does it, clamped at the edges.
        const auto between = [](float part, int count) {
            const float at = std::clamp(part * float(count) - 0.5f, 0.0f, float(count - 1));
            const int first = int(at);
            return std::tuple(first, std::min(first + 1, count - 1), at - float(first));
        };
        const float v = (float(row) + 0.5f) / float(picture.y()) * place.y() + place.w();
        const auto [top, bottom, below] = between(v, from.height());
        for (int x = 0; x < picture.x(); ++x) {
            const float u = (float(x) + 0.5f) / float(picture.x()) * place.x() + place.z();
            const auto [left, right, beside] = between(u, from.width());
            const auto texel = [&](int i, int j) -> const Vec4& {
                return texels[size_t(j) * size_t(from.width()) + size_t(i)];
            };
            const Vec4 upper = texel(left, top) * (1 - beside) + texel(right, top) * beside,
                       lower = texel(left, bottom) * (1 - beside) + texel(right, bottom) * beside;
            const Vec4 light = upper * (1 - below) + lower * below;
            std::copy_n(light.data(), 4, covered.at<float>(x, int(row)));
        }
    });
    return covered;
}

}  // namespace easypbr::render
