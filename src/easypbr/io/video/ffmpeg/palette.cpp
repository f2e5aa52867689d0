#include "easypbr/io/video/ffmpeg/palette.h"

#include <algorithm>
#include <limits>
#include <vector>

#include "easypbr/core/parallel.h"

namespace easypbr::io {
namespace {

constexpr int bits = 5, side = 1 << bits, cells = side * side * side;

int cell_of(int r, int g, int b) {
    return (r >> (8 - bits)) << (2 * bits) | (g >> (8 - bits)) << bits | b >> (8 - bits);
}

/// Pixels of one cell, and the sums of their colours.
struct Cell {
    std::array<uint32_t, 3> place;
    uint64_t count = 0;
    std::array<uint64_t, 3> sum{};
};

struct Box {
    size_t begin, end;  ///< range of cells
    uint64_t count;
    int axis;  ///< its longest
    uint32_t length;
};

Box box_of(const std::vector<Cell>& list, size_t begin, size_t end) {
    Box box{begin, end, 0, 0, 0};
    std::array<uint32_t, 3> low{side, side, side}, high{};
    for (size_t i = begin; i < end; ++i) {
        box.count += list[i].count;
        for (size_t c = 0; c < 3; ++c) {
            low[c] = std::min(low[c], list[i].place[c]);
            high[c] = std::max(high[c], list[i].place[c]);
        }
    }
    for (size_t c = 0; c < 3; ++c)
        if (high[c] - low[c] > box.length) box.length = high[c] - low[c], box.axis = int(c);
    return box;
}

std::vector<Cell> used_cells(const Image& picture) {
    std::vector<Cell> all(cells);
    const auto pixels = picture.pixels<uint8_t>();
    for (size_t i = 0; i < pixels.size(); i += 4) {
        Cell& cell = all[size_t(cell_of(pixels[i], pixels[i + 1], pixels[i + 2]))];
        ++cell.count;
        for (size_t c = 0; c < 3; ++c) cell.sum[c] += pixels[i + c];
    }
    std::vector<Cell> used;
    for (size_t i = 0; i < all.size(); ++i)
        if (all[i].count) {
            all[i].place = {uint32_t(i >> (2 * bits)), uint32_t(i >> bits) % side, uint32_t(i) % side};
            used.push_back(all[i]);
        }
    return used;
}

uint32_t mean_of(const std::vector<Cell>& list, const Box& box) {
    std::array<uint64_t, 3> sum{};
    for (size_t i = box.begin; i < box.end; ++i)
        for (size_t c = 0; c < 3; ++c) sum[c] += list[i].sum[c];
    uint32_t color = 0xff;
    for (size_t c = 0; c < 3; ++c) color = color << 8 | uint32_t((sum[c] + box.count / 2) / box.count);
    return color;
}

int channel(uint32_t color, int index) {
    return int(color >> (16 - 8 * index)) & 0xff;
}

/// Finer cells for finding a pixel's colour: their middles are at most 2 from it.
constexpr int fine_bits = 6, fine_side = 1 << fine_bits, fine_cells = fine_side * fine_side * fine_side;

/// Index of the nearest colour for the middle of a fine cell.
uint8_t nearest_of_cell(const Palette& palette, size_t cell) {
    constexpr int shift = 8 - fine_bits, half = 1 << (shift - 1);
    const int middle[3] = {(int(cell >> (2 * fine_bits)) << shift) + half,
                           (int(cell >> fine_bits) % fine_side << shift) + half,
                           (int(cell) % fine_side << shift) + half};
    int best = std::numeric_limits<int>::max();
    uint8_t nearest = 0;
    for (size_t k = 0; k < palette.size(); ++k) {
        int distance = 0;
        for (int c = 0; c < 3; ++c) {
            const int d = middle[c] - channel(palette[k], c);
            distance += d * d;
        }
        if (distance < best) best = distance, nearest = uint8_t(k);
    }
    return nearest;
}

/// The 8 x 8 matrix of Bayer, 0 .. 63: the bits of x ^ y and y, interleaved and reversed.
int bayer(int x, int y) {
    int value = 0;
    for (int bit = 0; bit < 3; ++bit)
        value |= (((x ^ y) >> bit & 1) << (5 - 2 * bit)) | ((y >> bit & 1) << (4 - 2 * bit));
    return value;
}

}  // namespace

Palette median_cut(const Image& picture) {
    std::vector<Cell> list = used_cells(picture);
    std::vector<Box> boxes{box_of(list, 0, list.size())};
    while (boxes.size() < 256) {
        const auto worst = std::ranges::max_element(
            boxes, {}, [](const Box& box) { return double(box.length) * box.length * double(box.count); });
        if (worst->length == 0) break;
        const Box box = *worst;
        const auto first = list.begin() + std::ptrdiff_t(box.begin),
                   last = list.begin() + std::ptrdiff_t(box.end);
        std::ranges::stable_sort(first, last, {},
                                 [&](const Cell& cell) { return cell.place[size_t(box.axis)]; });
        size_t cut = box.begin;
        uint64_t before = 0;
        while (cut + 1 < box.end && (before += list[cut].count) * 2 < box.count) ++cut;
        // Both sides keep a cell.
        cut = std::clamp(cut + 1, box.begin + 1, box.end - 1);
        *worst = box_of(list, box.begin, cut);
        boxes.push_back(box_of(list, cut, box.end));
    }
    Palette palette;
    palette.fill(0xff000000u);
    for (size_t i = 0; i < boxes.size(); ++i) palette[i] = mean_of(list, boxes[i]);
    return palette;
}

void map_to_palette(const Image& picture, const Palette& palette, uint8_t* rows, int stride) {
    constexpr int amplitude = 10;  // About the distance of neighbours among 256 colours.
    const size_t width = size_t(picture.width());
    std::vector<uint32_t> cell_of_pixel(picture.pixel_count());
    parallel_for(size_t(picture.height()), 16, [&](size_t y) {
        const uint8_t* from = picture.at<uint8_t>(0, int(y));
        for (size_t x = 0; x < width; ++x, from += 4) {
            const int shift = (2 * bayer(int(x) & 7, int(y) & 7) - 63) * amplitude / 128;
            const auto moved = [&](int c) {
                return uint32_t(std::clamp(from[c] + shift, 0, 255)) >> (8 - fine_bits);
            };
            cell_of_pixel[y * width + x] = moved(0) << (2 * fine_bits) | moved(1) << fine_bits | moved(2);
        }
    });
    std::vector<uint8_t> nearest(fine_cells, 0);
    for (const uint32_t cell : cell_of_pixel) nearest[cell] = 1;
    parallel_for(nearest.size(), 4096, [&](size_t cell) {
        if (nearest[cell]) nearest[cell] = nearest_of_cell(palette, cell);
    });
    parallel_for(size_t(picture.height()), 16, [&](size_t y) {
        uint8_t* to = rows + std::ptrdiff_t(y) * stride;
        for (size_t x = 0; x < width; ++x) to[x] = nearest[cell_of_pixel[y * width + x]];
    });
}

}  // namespace easypbr::io
