#include "easypbr/render/raytrace/firefly_filter.h"

#include <algorithm>
#include <array>

#include "easypbr/core/luminance.h"
#include "easypbr/core/parallel.h"

namespace easypbr::render {
namespace {

/// Binomial, over cells.
constexpr std::array<float, 5> kernel = {0.0625f, 0.25f, 0.375f, 0.25f, 0.0625f};
constexpr int radius = int(kernel.size()) / 2;
// A pixel's light comes by way of cells beside it, and depends on the pixels beside those that they reach.
static_assert(FireflyFilter::reach == 2 * (radius + 1) * FireflyFilter::cell);

/// Rows of cells that are added up together.
constexpr int band = 16;

bool is_any(const Vec3& light) {
    return light.maxCoeff() > 0;
}

}  // namespace

FireflyFilter::Between FireflyFilter::between(int pixel, int cells) {
    constexpr int half = cell / 2;
    const int from = (pixel + half) / cell - 1;
    return {std::max(from, 0), std::min(from + 1, cells - 1),
            (float(pixel + half - (from + 1) * cell) + 0.5f) / cell};
}

void FireflyFilter::begin_frame(const Vec2i& size, float most) {
    most_ = most;
    size_ = size;
    cells_ = (size + Vec2i::Constant(cell - 1)) / cell;
    const auto count = size_t(cells_.x()) * size_t(cells_.y());
    taken_.assign(count, Vec3::Zero());
    columns_.clear();
    for (int x = 0; x < size.x(); ++x) columns_.push_back(between(x, cells_.x()));
    if (cells_found_.size() != count) cells_found_.assign(count, 0);
}

void FireflyFilter::take(const PixelRect& block, PathRadiance& radiance) {
    if (radiance.beyond.empty()) return;
    const auto each = [&](auto&& visit) {
        for (int y = 0; y < block.height; ++y)
            for (int x = 0; x < block.width; ++x) {
                const auto i = size_t(y) * size_t(block.width) + size_t(x);
                if (const float bright = luminance(radiance.beyond[i]); bright > 0)
                    visit(i, cell_at((block.x + x) / cell, (block.y + y) / cell), bright);
            }
    };
    each([&](size_t, size_t of_cell, float bright) { cells_found_[of_cell] += bright; });
    each([&](size_t i, size_t of_cell, float bright) {
        const float part = staying(cells_found_[of_cell], bright);
        radiance.within[i] += part * radiance.beyond[i];
        taken_[of_cell] += std::min(1 - part, most_ / bright) * radiance.beyond[i];
    });
}

float FireflyFilter::staying(float found, float bright) {
    // n / (n + 1), where n is found / (bright * pixels of a cell).
    return found / (found + bright * float(cell * cell));
}

void FireflyFilter::blur(std::vector<Vec3>& values) const {
    const int columns = cells_.x(), rows = cells_.y();
    const float* const middle = kernel.data() + radius;
    std::vector<Vec3> across(values.size());
    // `here` is element `at` of a line of `count`.
    const auto blurred = [&](const Vec3* here, int at, int count, ptrdiff_t step) {
        Vec3 sum = *here * *middle;
        for (int k = std::max(-radius, -at); k <= std::min(radius, count - 1 - at); ++k)
            if (k != 0) sum += middle[k] * here[k * step];
        return sum;
    };
    parallel_for(size_t(rows), 16, [&](size_t row) {
        const size_t first = cell_at(0, int(row));
        for (int x = 0; x < columns; ++x)
            across[first + size_t(x)] = blurred(&values[first + size_t(x)], x, columns, 1);
    });
    parallel_for(size_t(rows), 16, [&](size_t row) {
        const size_t first = cell_at(0, int(row));
        for (int x = 0; x < columns; ++x)
            values[first + size_t(x)] = blurred(&across[first + size_t(x)], int(row), rows, columns);
    });
}

std::vector<Vec3> FireflyFilter::around(const Reflectance& reflectance) const {
    std::vector<Vec3> sums(taken_.size(), Vec3::Zero());
    parallel_for(size_t((cells_.y() + band - 1) / band), 1, [&](size_t number) {
        const int begin = int(number) * band, end = std::min(begin + band, cells_.y());
        std::vector<Vec3> row(size_t(size_.x())), of_cells(size_t(cells_.x()));
        const int first = std::max((begin - 1) * cell, 0), last = std::min((end + 1) * cell, size_.y());
        for (int y = first; y < last; ++y) {
            const Between rows = between(y, cells_.y());
            if (rows.second < begin || rows.first >= end) continue;
            reflectance(y, row);
            std::ranges::fill(of_cells, Vec3::Zero());
            for (size_t x = 0; x < row.size(); ++x) {
                const auto& [left, right, part] = columns_[x];
                of_cells[size_t(left)] += (1 - part) * row[x];
                of_cells[size_t(right)] += part * row[x];
            }
            const auto add = [&](int of_row, float part) {
                if (of_row < begin || of_row >= end) return;
                Vec3* const to = sums.data() + cell_at(0, of_row);
                for (size_t i = 0; i < of_cells.size(); ++i) to[i] += part * of_cells[i];
            };
            add(rows.first, 1 - rows.part);
            add(rows.second, rows.part);
        }
    });
    return sums;
}

void FireflyFilter::spread(const Reflectance& reflectance, const Receive& receive) {
    if (std::ranges::none_of(taken_, is_any)) return;
    std::vector<Vec3> sums = around(reflectance);
    blur(sums);
    for (size_t i = 0; i < taken_.size(); ++i)
        if (is_any(taken_[i])) taken_[i] = taken_[i].cwiseQuotient(sums[i]);
    blur(taken_);
    parallel_for(size_t(size_.y()), 16, [&](size_t of_row) {
        const int y = int(of_row);
        const auto [above, below, part] = between(y, cells_.y());
        const Vec3 *upper = taken_.data() + cell_at(0, above), *lower = taken_.data() + cell_at(0, below);
        std::vector<Vec3> of_cells(size_t(cells_.x()));
        for (size_t i = 0; i < of_cells.size(); ++i) of_cells[i] = (1 - part) * upper[i] + part * lower[i];
        if (std::ranges::none_of(of_cells, is_any)) return;
        std::vector<Vec3> row(size_t(size_.x()));
        reflectance(y, row);
        for (size_t x = 0; x < row.size(); ++x) {
            const auto& [left, right, of_right] = columns_[x];
            const Vec3 light = (1 - of_right) * of_cells[size_t(left)] + of_right * of_cells[size_t(right)];
            row[x] = row[x].cwiseProduct(light);
        }
        receive(y, row);
    });
}

}  // namespace easypbr::render
