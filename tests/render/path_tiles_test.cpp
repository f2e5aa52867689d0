// Tiles of path traced pictures that end by their own noise.
#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "easypbr/render/frame/sampled_tiles.h"
#include "render_test.h"

namespace easypbr::path_tiles_test {
namespace {

constexpr int size = 160, most = 256;
constexpr float asked = 0.02f;

TEST(SampledTiles, CoverThePicture) {
    render::SampledTiles tiles;
    tiles.begin({40, 17});
    ASSERT_EQ(tiles.count(), 6u);
    EXPECT_EQ(tiles.tile_at(39, 16), 5u);
    const PixelRect last = tiles.area_of(5);
    EXPECT_EQ(last.x, 32);
    EXPECT_EQ(last.y, 16);
    EXPECT_EQ(last.width, 8);
    EXPECT_EQ(last.height, 1);
    tiles.end(5, 12);
    EXPECT_TRUE(tiles.has_ended(5));
    EXPECT_EQ(tiles.frames_of(5, 20), 12);
    EXPECT_EQ(tiles.frames_of(4, 20), 20);
    tiles.begin({40, 17});
    EXPECT_FALSE(tiles.has_ended(5));
}

// The tiles of a rectangle are those of its pixels, and no others.
TEST(TileGrid, KnowsTheTilesOfARectangle) {
    const render::TileGrid grid({100, 50});
    for (const PixelRect& area :
         {PixelRect{0, 0, 100, 50}, {15, 16, 2, 16}, {31, 47, 1, 3}, {96, 48, 4, 2}}) {
        std::vector<size_t> expected;
        for (int y = area.y; y < area.y + area.height; ++y)
            for (int x = area.x; x < area.x + area.width; ++x) expected.push_back(grid.tile_at(x, y));
        std::ranges::sort(expected);
        const auto repeated = std::ranges::unique(expected);
        expected.erase(repeated.begin(), repeated.end());
        EXPECT_EQ(grid.tiles_in(area), expected);
    }
    EXPECT_TRUE(grid.tiles_in({20, 20, 0, 5}).empty());
}

// Values stay where they were written, the others are those of T(), also once others have been forgotten.
TEST(TilePixels, HoldWhatWasWritten) {
    struct Value {
        int x = -1, y = -2;
    };
    render::TilePixels<Value> pixels;
    for (int round = 0; round < 2; ++round) {
        pixels.begin({600, 400});
        for (int y = 0; y < 400; ++y)
            for (int x = (y / 16 % 2) * 16; x < 600; x += x % 16 == 15 ? 17 : 1)
                pixels.make(pixels.grid().tile_at(x, y))[render::TileGrid::place_of(x, y)] = {x, y};
        for (int y = 0; y < 400; ++y)
            for (int x = 0; x < 600; ++x) {
                const bool is_written = (x / 16 + y / 16) % 2 == 0;
                const Value value = pixels.at(x, y);
                ASSERT_EQ(value.x, is_written ? x : -1);
                ASSERT_EQ(value.y, is_written ? y : -2);
            }
        EXPECT_EQ(pixels.of(1), nullptr);
    }
}

/// A wall that fills the picture, lit by a lamp from beside, which a ball hides from a part of it: noise is
/// in the penumbra, and hardly any elsewhere.
struct Wall {
    Wall() {
        scene.show(facing_square(20), "wall");
        Mesh ball = make_sphere(0.2f, 32);
        Eigen::Affine3d pose = Eigen::Affine3d::Identity();
        pose.translation() = Vec3d(1.5, 0, 1.5);
        ball.set_T_world_mesh(pose);
        scene.show(ball, "ball");
        Light light;
        light.position = Vec3d(4, 0, 4);
        light.radius = 0.25f;
        light.intensity = 80;
        scene.set_light("lamp", light);
    }
    /// By default no light is spread from tile to tile.
    app::Session session(float noise, float clamp = 0) const {
        app::Session session = plain_session(scene, size);
        Settings& s = session.settings();
        s.path.enabled = true;
        s.path.denoise = Denoising::off;
        s.path.clamp = clamp;
        s.image.noise = noise;
        // Which never ends: pictures that may end early look at other places of pixels than others.
        s.image.time_budget = 1e6f;
        s.shadows.enabled = true;
        look_from(session, Vec3d(0, 0, 4), 30);
        return session;
    }
    Scene scene;
};

bool is_equal_in(const PixelRect& area, const Image& a, const Image& b) {
    for (int y = area.y; y < area.y + area.height; ++y) {
        const uint8_t* of_a = a.at<uint8_t>(area.x, y);
        if (!std::equal(of_a, of_a + 4 * area.width, b.at<uint8_t>(area.x, y))) return false;
    }
    return true;
}

double root_mean_square(const Image& a, const Image& b) {
    double sum = 0;
    const auto x = a.bytes(), y = b.bytes();
    for (size_t i = 0; i < x.size(); ++i) sum += std::pow(int(x[i]) - int(y[i]), 2);
    return std::sqrt(sum / double(x.size()));
}

double mean_code(const Image& image) {
    double sum = 0;
    for (const std::byte byte : image.bytes()) sum += int(byte);
    return sum / double(image.bytes().size());
}

/// The picture without ends of tiles, after each number of frames that tiles may end at.
std::map<int, Image> pictures_by_frames(app::Session session) {
    std::map<int, Image> pictures;
    for (;;) {
        const auto done = session.refine({std::nullopt, most});
        pictures[done.frames] = done.drawn.picture();
        if (done.frames == done.total) return pictures;
    }
}

// A tile is that of the picture of as many frames as it got, to the last bit. Flat ones get few, and the
// samples that others get make the error less than that of as many everywhere. 0.85: it is 1 without any
// gain, and 0.6 if a third of the tiles needs 100 frames, by (0.2 / asked)^2, and the others 4.
TEST(PathTiles, SamplesGoWhereTheErrorIs) {
    const Wall wall;
    const std::map<int, Image> uniform = pictures_by_frames(wall.session(0));
    const Image& reference = uniform.at(most);
    app::Session session = wall.session(asked);
    const Image picture = session.render({std::nullopt, most});
    render::SampledTiles tiles;
    tiles.begin({size, size});
    double samples = 0;
    std::vector<int> frames;
    for (size_t tile = 0; tile < tiles.count(); ++tile) {
        const auto same = std::ranges::find_if(
            uniform, [&](const auto& of) { return is_equal_in(tiles.area_of(tile), of.second, picture); });
        ASSERT_NE(same, uniform.end()) << "tile " << tile;
        frames.push_back(same->first);
        samples += double(same->first) / double(tiles.count());
    }
    std::ranges::sort(frames);
    EXPECT_LE(frames[frames.size() / 2], 6);
    EXPECT_GE(frames.back(), 24);
    const Image& as_many = uniform.at(int(std::ceil(samples)));
    EXPECT_LT(root_mean_square(picture, reference), 0.85 * root_mean_square(as_many, reference));
    // That tiles end by the noise of their own samples makes them no darker. Of 255: a third of the pixels
    // have an error of up to 5, which makes 0.02 of their mean.
    EXPECT_NEAR(mean_code(picture), mean_code(reference), 0.1);
    EXPECT_TRUE(std::ranges::equal(session.render({std::nullopt, most}).bytes(), picture.bytes()));
}

// Light of rare paths is spread beyond tiles, to those that have not ended: none of it is lost. Of 255, as
// above.
TEST(PathTiles, LoseNoLightThatIsSpread) {
    const Wall wall;
    app::Session all = wall.session(0), ends = wall.session(asked, 0.25f);
    EXPECT_NEAR(mean_code(ends.render({std::nullopt, most})), mean_code(all.render({std::nullopt, most})),
                0.1);
}

// Where bloom spreads light from tile to tile all of them go on until the picture ends.
TEST(PathTiles, GoOnWhereLightSpreads) {
    const Wall wall;
    app::Session ends = wall.session(asked), goes_on = wall.session(0);
    ends.settings().bloom.enabled = goes_on.settings().bloom.enabled = true;
    int frames = 0;
    for (bool is_last = false; !is_last;) {
        const auto done = ends.refine({std::nullopt, most});
        const auto same = goes_on.refine({std::nullopt, most});
        frames = done.frames;
        is_last = done.frames == done.total;
        if (!is_last) continue;
        EXPECT_TRUE(std::ranges::equal(done.drawn.picture().bytes(), same.drawn.picture().bytes()));
    }
    EXPECT_GT(frames, 6);
    EXPECT_LT(frames, most);
}

}  // namespace
}  // namespace easypbr::path_tiles_test
