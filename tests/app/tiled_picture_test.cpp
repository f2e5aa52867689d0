// Pictures drawn in tiles against the same drawn at once: equal within 1/255 at every pixel, with every
// effect.
#include "easypbr/app/tiled_picture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "easypbr/app/session.h"
#include "easypbr/core/error.h"
#include "easypbr/core/image.h"
#include "easypbr/geometry/primitives.h"
#include "easypbr/geometry/surfels.h"
#include "easypbr/io/image/image_io.h"
#include "easypbr/scene/resolve.h"
#include "gpu_rounding.h"

namespace easypbr::app::tiled_picture_test {
namespace {

using render::Guard;
using render::Tile;
using render::tile_grid;
using render::TileLimits;
using render::tiles_of;

/// Tiles with the least inner part that the guard band leaves room for.
TileLimits smallest_limits(int guard) {
    const int side = 2 * guard + 2 * tile_grid;
    return {side, int64_t(side) * side};
}

/// A gradient with a bright patch, so that every direction looks different.
Environment sky() {
    Image image(64, 32, 3, PixelType::f32);
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 64; ++x) {
            const float value[3] = {0.3f + 0.01f * float(x), 0.4f + 0.02f * float(y),
                                    x > 20 && x < 26 && y > 4 && y < 8 ? 30.0f : 0.6f};
            std::copy_n(value, 3, image.at<float>(x, y));
        }
    return Environment(image);
}

Mesh at(Mesh mesh, const Vec3d& position, const Material& material = {}) {
    mesh.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(position)));
    mesh.set_material(material);
    return mesh;
}

Material colored(const Vec3& color, float roughness = 0.4f) {
    Material m;
    m.base_color = color;
    m.roughness = roughness;
    return m;
}

Scene solids() {
    Scene scene;
    scene.show(at(make_sphere(1, 96), Vec3d(-0.3, 0, 0), colored({0.9f, 0.9f, 0.9f}, 0.2f)), "ball");
    scene.show(at(make_box({1.2f, 1.6f, 1}), Vec3d(1.3, -0.2, -0.6), colored({0.8f, 0.2f, 0.1f})), "box");
    scene.show(at(make_box({5, 0.1f, 5}), Vec3d(0, -1.05, 0), colored({0.5f, 0.6f, 0.5f})), "floor");
    return scene;
}

Mesh cloud() {
    std::mt19937 random(7);
    std::normal_distribution<float> normal;
    Array3f::Dense V(20000, 3);
    for (int i = 0; i < V.rows(); ++i) {
        const Vec3 p(normal(random), normal(random), normal(random));
        V.row(i) = (1 + 0.2f * std::sin(8 * p.x())) * p.normalized();
    }
    MeshData data;
    data.V = Array3f(V);
    data.materials.resize(1);
    data.materials[0].base_color.setConstant(
        0.61f);  // not the default, which is drawn darker: as bright as meshes
    return Mesh(data);
}

Mesh see_through(Mesh mesh) {
    Material m = colored({0.9f, 0.6f, 0.3f});
    m.opacity = 0.5f;
    mesh.set_material(m);
    return mesh;
}

Scene showing(const Mesh& mesh) {
    Scene scene;
    scene.show(mesh, "shown");
    return scene;
}

struct Case {
    const char* name;
    Scene (*scene)();
    void (*change)(Settings&);
    int samples = 1;
    /// Of a million pixels how many may differ: see AreSeamless.
    int rounded = 10;
    Vec2i size{720, 420};
};

void PrintTo(const Case& c, std::ostream* out) {
    *out << c.name;
}

class Tiles : public testing::TestWithParam<Case> {};

Session session_of(const Case& c) {
    Session session(c.scene());
    session.scene().set_environment(sky());
    session.settings().image.size = c.size;
    session.settings().image.samples = c.samples;
    session.settings().background.mode = BackgroundMode::environment;
    session.settings().shadows.resolution = 512;
    session.settings().ssao.enabled = false;
    c.change(session.settings());
    return session;
}

struct Pictures {
    Image whole, tiled;
    std::vector<Tile> tiles;
};

/// The picture at once, and in as many tiles as its effects leave room for.
Pictures both(const Case& c, Encoding encoding = Encoding::srgb8) {
    Session whole = session_of(c), parts = session_of(c);
    const Guard guard = render::guard_of(parts.scene().snapshot(), parts.resolve(), c.size);
    const TileLimits limits = smallest_limits(guard.pixels);
    const std::vector<Tile> tiles = tiles_of(c.size, guard.pixels, limits);
    EXPECT_GT(tiles.size(), 1u) << "guard band of " << guard.pixels;
    parts.limit_tiles(limits);
    return {whole.render({std::nullopt, std::nullopt, encoding}),
            parts.render({std::nullopt, std::nullopt, encoding}), tiles};
}

/// Whether a seam runs within two pixels.
bool is_at_seam(const std::vector<Tile>& tiles, int x, int y) {
    const auto near = [](int place, int first, int length) {
        return (first > 0 && std::abs(place - first) <= 2) || std::abs(place - first - length) <= 2;
    };
    return std::ranges::any_of(tiles, [&](const Tile& tile) {
        return near(x, tile.inner.x, tile.inner.width) || near(y, tile.inner.y, tile.inner.height);
    });
}

// What is drawn is rounded in another way where the picture's coordinates begin elsewhere: by 1e-5 pixels. An
// edge that comes that close to a sample covers it or not, which is one edge pixel in some hundred thousand;
// for splats and lines, which have edges everywhere, `rounded` allows for more; a GPU rounds vertices to
// 1/256 of a pixel, which is some hundred times as many. A seam would have its differences where tiles meet,
// which is a fifteenth of these pictures. All else is equal within one code.
TEST_P(Tiles, AreSeamless) {
    const auto [whole, tiled, tiles] = both(GetParam());
    size_t different = 0, at_seams = 0;
    int largest = 0;
    for (int y = 0; y < whole.height(); ++y)
        for (int x = 0; x < whole.width(); ++x) {
            int most = 0;
            for (int c = 0; c < 4; ++c)
                most = std::max(most,
                                std::abs(int(whole.at<uint8_t>(x, y)[c]) - int(tiled.at<uint8_t>(x, y)[c])));
            largest = std::max(largest, most);
            different += most > 1;
            at_seams += most > 1 && is_at_seam(tiles, x, y);
        }
    const double rounded = GetParam().rounded * (has_gpu() ? 30 : 1);
    EXPECT_LE(double(different), rounded * 1e-6 * double(whole.pixel_count())) << "by up to " << largest;
    EXPECT_LE(double(at_seams), 2 + double(different) / 4);
    // What is compared is a picture.
    const auto values = whole.pixels<uint8_t>();
    EXPECT_GT(*std::ranges::max_element(values) - *std::ranges::min_element(values), 60);
    if (HasFailure()) {
        io::save_image(whole, testing::TempDir() + GetParam().name + "_whole.png");
        io::save_image(tiled, testing::TempDir() + GetParam().name + "_tiled.png");
    }
}

Scene with_glass(float roughness, float thickness) {
    Scene scene = solids();
    Material glass = colored({0.9f, 1, 0.95f}, roughness);
    glass.transmission = 1;
    glass.thickness = thickness;
    scene.show(at(make_sphere(0.6f, 64), Vec3d(0.6, -0.3, 1.3), glass), "glass");
    return scene;
}

Scene with_layers() {
    Scene scene = solids();
    for (int i = 0; i < 3; ++i) {
        Material veil = colored({0.2f, 0.3f + 0.2f * float(i), 0.9f});
        veil.alpha_mode = AlphaMode::blend;
        veil.opacity = 0.4f;
        scene.show(at(make_torus(0.9f, 0.3f), Vec3d(0.3 * i - 0.2, 0.1 * i, 1), veil),
                   fmt::format("veil {}", i));
    }
    return scene;
}

void occluded(Settings& s) {
    s.ssao.enabled = true;
    s.ssao.radius = 0.12f;
}

std::string background_file() {
    const std::string path = testing::TempDir() + "easypbr_tiles_background.png";
    Image image(90, 70, 3, PixelType::u8);
    for (int y = 0; y < 70; ++y)
        for (int x = 0; x < 90; ++x) {
            uint8_t* p = image.at<uint8_t>(x, y);
            p[0] = uint8_t(2 * x);
            p[1] = uint8_t(3 * y);
            p[2] = 128;
        }
    io::save_image(image, path);
    return path;
}

const Case cases[] = {
    {"plain", solids, [](Settings&) {}},
    {"smoothed", solids, [](Settings& s) { s.image.antialias = Antialias::fxaa; }},
    {"averaged", solids, [](Settings&) {}, 4},
    {"occlusion", solids, occluded},
    {"occlusion_averaged", solids, occluded, 4},
    {"occlusion_full", solids,
     [](Settings& s) {
         occluded(s);
         s.ssao.resolution = OcclusionResolution::full;
     },
     8},
    {"hemisphere", solids,
     [](Settings& s) {
         occluded(s);
         s.ssao.method = OcclusionMethod::hemisphere;
     }},
    {"soft_shadows", solids,
     [](Settings& s) {
         s.lights.key.enabled = true;
         s.lights.key.radius = 0.3f;
         s.environment.enabled = false;
         s.background.mode = BackgroundMode::color;
     }},
    {"rays", solids,
     [](Settings& s) {
         s.rays.enabled = true;
         s.rays.count = 8;
     },
     2},
    {"bloom", solids,
     [](Settings& s) {
         s.bloom.enabled = true;
         s.bloom.threshold = 0;
         s.bloom.levels = 3;
     }},
    {"bloom_averaged", solids,
     [](Settings& s) {
         s.bloom.enabled = true;
         s.bloom.levels = 2;
     },
     4},
    {"focus", solids,
     [](Settings& s) {
         s.depth_of_field.enabled = true;
         s.depth_of_field.f_number = 1.4f;
     }},
    {"outlined", solids,
     [](Settings& s) {
         s.outline.enabled = true;
         s.outline.width = 7;
     }},
    {"focus_averaged", solids, [](Settings& s) { s.depth_of_field.enabled = true; }, 4},
    {"orthographic", solids,
     [](Settings& s) {
         occluded(s);
         s.camera.projection = Projection::orthographic;
     }},
    {"ground", solids,
     [](Settings& s) {
         s.ground.mode = GroundMode::shadow;
         s.lights.key.enabled = true;
     }},
    // Far pixels of the ground get paths in some of the frames.
    {"ground_by_paths", solids,
     [](Settings& s) {
         s.path.enabled = true;
         s.path.denoise = Denoising::off;
         s.ground.mode = GroundMode::shadow;
         s.lights.key.enabled = true;
     },
     4},
    // Rare paths are spread over the pixels around.
    {"fireflies", solids,
     [](Settings& s) {
         s.path.enabled = true;
         s.path.denoise = Denoising::off;
         s.path.clamp = 0.01f;
         s.lights.key.enabled = true;
     },
     4},
    {"blurred_background", solids, [](Settings& s) { s.background.mode = BackgroundMode::blur; }},
    {"points", [] { return showing(cloud()); }, [](Settings& s) { s.edl.radius = 8.5f; }},
    // Its widest ring is 93 pixels from the middle, much farther than splats of 3 pixels ask a tile to see.
    {"points_shaded_widely", [] { return showing(cloud()); },
     [](Settings& s) {
         s.style.point_size = 3.0f;
         s.edl.radius = 60;
     },
     1, 100},
    // Without normals they are points.
    {"surfels_as_points", [] { return showing(cloud()); },
     [](Settings& s) {
         s.style.mode = DrawMode::surfels;
         s.style.point_size = 200.0f;
         s.edl.enabled = false;
         s.ssao.enabled = false;
     },
     1, 100},
    {"points_blended", [] { return showing(see_through(cloud())); },
     [](Settings& s) { s.transparency.max_layers = 2; }, 1, 300},
    {"points_occluded", [] { return showing(cloud()); }, occluded},
    {"points_filled", [] { return showing(cloud()); },
     [](Settings& s) {
         s.style.point_size = 3.0f;
         s.points.hole_filling = 3;
     },
     1, 300},
    {"surfels", [] { return showing(estimate_surfels(cloud())); }, [](Settings&) {}, 1, 100},
    {"surfels_blended", [] { return showing(see_through(estimate_surfels(cloud()))); },
     [](Settings& s) { s.transparency.max_layers = 2; }, 1, 300},
    {"lines", solids,
     [](Settings& s) {
         s.style.show_wireframe = true;
         s.style.line_width = 2.5f;
         s.style.line_dash = 7.0f;
     },
     1, 100},
    {"layers", with_layers, [](Settings&) {}},
    {"layers_averaged", with_layers, [](Settings&) {}, 4},
    // Glass sees half a thousand pixels far.
    {"thin_glass", [] { return with_glass(0, 0); }, [](Settings&) {}, 1, 10, {2000, 400}},
    {"rough_glass", [] { return with_glass(0.4f, 0); }, [](Settings&) {}, 1, 10, {2000, 400}},
    {"solid_glass", [] { return with_glass(0, 1); }, [](Settings&) {}, 1, 10, {2000, 400}},
    {"background_image", solids,
     [](Settings& s) {
         s.background.mode = BackgroundMode::image;
         s.background.image = background_file();
     }},
};

INSTANTIATE_TEST_SUITE_P(Effects, Tiles, testing::ValuesIn(cases),
                         [](const auto& info) { return std::string(info.param.name); });

// Ids and depths of tiles are those of the whole picture; depths up to their rounding.
TEST(TiledLayers, AreThoseOfTheWholePicture) {
    const Case c{"layers", solids, [](Settings&) {}};
    Session whole = session_of(c), parts = session_of(c);
    const int guard = render::guard_of(parts.scene().snapshot(), parts.resolve(), c.size).pixels;
    parts.limit_tiles(smallest_limits(guard));
    const std::vector<std::string> names = {"object_id", "element_id", "depth", "normal_world"};
    const auto a = whole.render_layers(names), b = parts.render_layers(names);
    for (const char* exact : {"object_id", "element_id"})
        EXPECT_EQ(compare(a.at(exact), b.at(exact)).different, 0u) << exact;
    // 23 bits of the reversed depth; a GPU has moved vertices otherwise.
    EXPECT_LE(compare(a.at("depth"), b.at("depth")).max, 2e-5 + 0.1 * vertex_rounding());
    // 16 bits of each octahedral coordinate.
    EXPECT_LE(compare(a.at("normal_world"), b.at("normal_world")).max, 1e-4 + 0.1 * vertex_rounding());
}

TEST(TiledPicture, HoldsRadianceToo) {
    const auto [whole, tiled, tiles] = both({"hdr", solids, [](Settings&) {}, 2}, Encoding::scene_linear);
    EXPECT_EQ(tiled.type(), PixelType::f32);
    // Halves of the environment's texels are interpolated at directions that are rounded: 1e-4 of what is 30
    // at most.
    EXPECT_LE(compare(whole, tiled).max, 3e-3);
}

// Put together in memory, it is there whatever is drawn later.
TEST(TiledPicture, IsNeverOutdated) {
    Session session = session_of({"plain", solids, [](Settings&) {}});
    session.limit_tiles(smallest_limits(40));
    const Image still = session.render();
    const Drawn tiled = session.draw();
    EXPECT_THROW(tiled.texture(), ArgumentError);
    const Image small = session.render({Vec2i(64, 48), 1, Encoding::srgb8});
    EXPECT_EQ(small.width(), 64);
    EXPECT_EQ(compare(tiled.picture(), still).different, 0u);
}

TEST(TilesOf, CoverThePictureOnce) {
    for (const Vec2i& size : {Vec2i(1000, 700), Vec2i(385, 4000), Vec2i(2049, 129), Vec2i(513, 513)}) {
        constexpr int guard = 70, side = 512;
        std::vector<int> times(size_t(size.x()) * size_t(size.y()));
        for (const auto& [inner, outer] : tiles_of(size, guard, {side, int64_t(side) * side})) {
            EXPECT_LE(std::max(outer.width, outer.height), side);
            EXPECT_EQ(outer.x % tile_grid + outer.y % tile_grid, 0);
            // A guard band wherever the picture goes on.
            EXPECT_LE(outer.x, std::max(0, inner.x - guard));
            EXPECT_LE(outer.y, std::max(0, inner.y - guard));
            EXPECT_GE(outer.x + outer.width, std::min(size.x(), inner.x + inner.width + guard));
            EXPECT_GE(outer.y + outer.height, std::min(size.y(), inner.y + inner.height + guard));
            for (int y = inner.y; y < inner.y + inner.height; ++y)
                for (int x = inner.x; x < inner.x + inner.width; ++x)
                    ++times[size_t(y) * size_t(size.x()) + size_t(x)];
        }
        EXPECT_TRUE(std::ranges::all_of(times, [](int n) { return n == 1; })) << size.transpose();
    }
}

TEST(TilesOf, DrawUsualPicturesAtOnce) {
    EXPECT_EQ(tiles_of({7680, 4320}, 1000, {}).size(), 1u);
    EXPECT_GT(tiles_of({16384, 9216}, 1000, {}).size(), 1u);
    EXPECT_GT(tiles_of({8192, 8192}, 1000, {}).size(), 1u);
}

// Every effect at once, at a size that only tiles can draw, still has room between the guard bands.
TEST(TilesOf, HaveRoomForAllEffectsAtOnce) {
    Session session = session_of({"all", solids, [](Settings& s) {
                                      s.ssao.enabled = true;
                                      s.bloom.enabled = true;
                                      s.depth_of_field.enabled = true;
                                      s.depth_of_field.f_number = 1;
                                      s.material.transmission = 0.5f;
                                      s.points.hole_filling = 8;
                                  }});
    const Vec2i large(16384, 9216);
    const int guard = render::guard_of(session.scene().snapshot(), session.resolve(large), large).pixels;
    EXPECT_GT(tiles_of(large, guard, {}).size(), 1u);
}

TEST(TilesOf, SayWhenGuardBandsLeaveNoRoom) {
    EXPECT_THROW(tiles_of({2000, 2000}, 300, {600, 360000}), ArgumentError);
}

TEST(PictureSizes, HaveALimitThatIsSaid) {
    Session session = session_of({"plain", solids, [](Settings&) {}});
    try {
        session.render({Vec2i(65536, 65536), 1, Encoding::srgb8});
        FAIL();
    } catch (const ArgumentError& error) {
        EXPECT_NE(std::string(error.what()).find("1073741824 pixels"), std::string::npos) << error.what();
    }
    EXPECT_THROW(session.render({Vec2i(65537, 2), 1, Encoding::srgb8}), ArgumentError);
}

}  // namespace
}  // namespace easypbr::app::tiled_picture_test
