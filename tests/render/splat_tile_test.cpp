// Tiles of splats: the blending of all pixels at once against that of one pixel after the other.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "easypbr/native/shaders.h"
#include "easypbr/render/primitives/splats/splat_tile.h"

namespace easypbr::splat_tile_test {
namespace {

using render::ProjectedSplat;
using render::SplatTile;

constexpr float no_limit = std::numeric_limits<float>::infinity();

/// Splats in and around the tile at (16, 32), from the nearest on at every pixel: they bulge by less than
/// 0.01 of depth, 2 ln(255) / (sharpness^2 depth).
std::vector<ProjectedSplat> stack_of_splats(uint32_t seed, float most_opacity) {
    std::mt19937 random(seed);
    const auto between = [&](float low, float high) {
        return std::uniform_real_distribution<float>(low, high)(random);
    };
    std::vector<ProjectedSplat> splats(80);
    float depth = 0.9f;
    for (uint32_t i = 0; i < splats.size(); ++i) {
        ProjectedSplat& s = splats[i];
        const float wide = between(0.4f, 9), high = between(0.4f, 9), turn = between(-0.9f, 0.9f);
        const float part = 1 / (1 - turn * turn);
        s = {.x = between(10, 38),
             .y = between(26, 54),
             .xx = part / (wide * wide),
             .xy = -part * turn / (wide * high),
             .yy = part / (high * high),
             .opacity = between(0.01f, most_opacity),
             .red = between(0, 1.5f),
             .green = between(0, 1),
             .blue = between(0, 1),
             .depth = depth -= 0.01f,
             .depth_x = 0,
             .depth_y = 0,
             .half_width = 0,
             .half_height = 0,
             .sharpness = between(110, 2000),
             .index = i};
        const float farthest = 2 * std::log(s.opacity / render::least_splat_alpha);
        s.half_width = std::sqrt(farthest) * wide;
        s.half_height = std::sqrt(farthest) * high;
    }
    return splats;
}

SplatTile empty_tile(bool is_limited, bool is_soft, bool sums_positions) {
    SplatTile tile;
    tile.left = 16;
    tile.top = 32;
    tile.clear();
    tile.is_limited = is_limited;
    tile.is_soft = is_soft;
    tile.sums_positions = sums_positions;
    tile.axis = {0.001f, 0.1f, -1, 0};
    for (size_t i = 0; i < tile.farthest.size(); ++i) {
        tile.farthest[i] = i % 3 == 0 ? -no_limit : 0.2f + 0.1f * std::sin(float(i));
        tile.nearest[i] = i % 5 == 0 ? no_limit : 0.7f + 0.1f * std::cos(float(i));
    }
    return tile;
}

std::vector<uint32_t> places_of(const std::vector<ProjectedSplat>& splats) {
    std::vector<uint32_t> places(splats.size());
    std::iota(places.begin(), places.end(), 0u);
    return places;
}

/// Calls body(tile, splats) for tiles of all kinds.
template <class Body>
void for_each_case(const Body& body) {
    for (uint32_t seed = 0; seed < 24; ++seed) {
        SCOPED_TRACE("tile " + std::to_string(seed));
        body(empty_tile(seed % 2 == 0, seed % 4 == 0, seed % 3 == 0),
             stack_of_splats(seed, seed % 5 == 0 ? 1 : 0.4f));
    }
}

/// All splats are in their order at every pixel, so both ways to blend give the same: but for roundings of
/// their exponential functions, 3e-7 of a splat, and of the normal distribution's, 1e-7, in up to 80 splats.
TEST(SplatTile, IsWhatEachPixelIs) {
    for_each_case([](const SplatTile& empty, const std::vector<ProjectedSplat>& splats) {
        SplatTile tile = empty, reference = empty;
        tile.blend(splats, places_of(splats));
        reference.blend_resorted(splats, places_of(splats));
        int medians = 0;
        for (size_t i = 0; i < tile.through.size(); ++i) {
            // A splat of the least opacity that is drawn may be drawn by one of them only.
            const float tolerance = 2e-5f + 1.01f * render::least_splat_alpha * reference.through[i];
            ASSERT_NEAR(tile.through[i], reference.through[i], tolerance) << i;
            ASSERT_NEAR(tile.red[i], reference.red[i], 1.5f * tolerance) << i;
            ASSERT_NEAR(tile.green[i], reference.green[i], tolerance) << i;
            ASSERT_NEAR(tile.blue[i], reference.blue[i], tolerance) << i;
            ASSERT_NEAR(tile.positions[i], reference.positions[i], 1e-2f) << i;
            medians += tile.median[i] == reference.median[i];
        }
        EXPECT_GE(medians, 254);
    });
}

TEST(SplatTile, IsTheSameForAllInstructionSets) {
    const std::string before(native::instruction_set());
    for_each_case([](const SplatTile& empty, const std::vector<ProjectedSplat>& splats) {
        SplatTile first = empty;
        native::use_instruction_set(native::instruction_sets().front());
        first.blend(splats, places_of(splats));
        for (const std::string_view name : native::instruction_sets()) {
            SplatTile tile = empty;
            native::use_instruction_set(name);
            tile.blend(splats, places_of(splats));
            for (const auto channel : {&SplatTile::red, &SplatTile::green, &SplatTile::blue,
                                       &SplatTile::through, &SplatTile::positions})
                ASSERT_EQ(std::memcmp(&(tile.*channel), &(first.*channel), sizeof(SplatTile::Pixels)), 0)
                    << name;
            ASSERT_EQ(tile.median, first.median) << name;
        }
    });
    native::use_instruction_set(before);
}

}  // namespace
}  // namespace easypbr::splat_tile_test
