// 3D Gaussian splats among lights: the shadows that they cast and receive, and rays that meet them.
#include <algorithm>
#include <cmath>
#include <functional>

#include "easypbr/core/color.h"
#include "shadow_test.h"
#include "splat_sheets.h"

namespace easypbr::gaussian_splat_light_test {
namespace {

/// Many small splats side by side in a plane across z, which together stop `opacity` of the light on average
/// in the logarithm: their absorption is a sum of Gaussians, which is even where they are dense.
Mesh wall(float half, float z, float opacity, int side = 48, float grey = 0) {
    const float step = 2 * half / float(side), scale = step;
    MeshData mesh;
    Array3f::Dense V(side * side, 3);
    for (int i = 0; i < side * side; ++i)
        V.row(i) << (float(i % side) + 0.5f) * step - half, (float(i / side) + 0.5f) * step - half, z;
    mesh.V = std::move(V);
    const Eigen::Index n = side * side;
    mesh.splats.scales = Array3f::Dense(Eigen::RowVector3f(scale, scale, 0).replicate(n, 1));
    mesh.splats.rotations = Array4f::Dense(Eigen::RowVector4f(1, 0, 0, 0).replicate(n, 1));
    // What opacities from 1/255 on absorb together: the integral of -ln(1 - o exp(-r^2 / 2)) over the plane,
    // 2 pi s^2 (Li2(o) - Li2(1/255)). One splat lies in each square of s^2.
    const double wanted = -std::log1p(-double(opacity)) / (2 * pi);
    const auto dilogarithm = [](double o) {
        double sum = 0, power = 1;
        for (int k = 1; k < 60; ++k) sum += (power *= o) / (double(k) * k);
        return sum;
    };
    double low = 0, high = 1;
    for (int i = 0; i < 60; ++i)
        (dilogarithm((low + high) / 2) - dilogarithm(1.0 / 255) < wanted ? low : high) = (low + high) / 2;
    mesh.splats.opacities = Array1f::Dense::Constant(n, float(low));
    mesh.splats.sh = ArrayXf::Dense::Constant(n, 3, (grey - 0.5f) / float(constant_harmonic));
    return Mesh(mesh);
}

/// A floor, lit from straight above through `caster`, and seen from below it; with and without shadows.
struct Floor {
    double mean = 0, least = 1, most = 0;
};

Floor lit_floor(app::Session& session, int samples) {
    const LitParts parts = lit_parts(session, samples);
    Floor floor;
    int count = 0;
    for (int y = 0; y < parts.parts.height(); ++y)
        for (int x = 0; x < parts.parts.width(); ++x) {
            const Vec3d p = parts.position(x, y);
            if (!(parts.at(x, y) >= 0) || std::abs(p.z()) > 1e-3 || std::abs(p.y()) > 0.3 ||
                std::abs(p.x()) > 0.3)
                continue;
            floor.mean += double(parts.at(x, y));
            floor.least = std::min(floor.least, double(parts.at(x, y)));
            floor.most = std::max(floor.most, double(parts.at(x, y)));
            ++count;
        }
    EXPECT_GT(count, 30);
    floor.mean /= count;
    return floor;
}

app::Session under(Scene& scene, const std::vector<Mesh>& casters, ShadowMode mode, const Light& light) {
    scene.show(rectangle(-1, -1, 1, 1, 0), "floor");
    for (size_t i = 0; i < casters.size(); ++i) scene.show(casters[i], "caster" + std::to_string(i));
    scene.set_light("lamp", light);
    app::Session session = shadow_session(scene, mode, 96);
    look_from(session, Vec3d(0, -4, 0.3), 25);
    return session;
}

const Light sun = directional(Vec3(0, 0, -1));

// 0.01: texels of the map sample each splat by some points, the low-pass widens it a little, and sums of
// neighbours ripple.
TEST(SplatShadows, OfAHalfOpaqueWallAreHalfDark) {
    for (const bool native : {true, false})
        for (const ShadowMode mode : {ShadowMode::hard, ShadowMode::pcf, ShadowMode::soft})
            for (const Light& light : {sun, point(Vec3(0, 0, 5))}) {
                Scene scene;
                app::Session session = under(scene, {wall(2, 1, 0.5f)}, mode, light);
                session.allow_native_geometry(native);
                const Floor floor = lit_floor(session, 1);
                EXPECT_NEAR(floor.mean, 0.5, 0.01) << int(mode) << " " << int(light.type) << " " << native;
                EXPECT_LT(floor.most - floor.least, 0.02);
            }
}

// Walls behind each other: the product of what each leaves.
TEST(SplatShadows, AreProducts) {
    for (const int count : {1, 2, 3}) {
        std::vector<Mesh> walls;
        for (int i = 0; i < count; ++i) walls.push_back(wall(2, 0.7f + 0.1f * float(i), 0.3f));
        Scene scene;
        app::Session session = under(scene, walls, ShadowMode::hard, sun);
        EXPECT_NEAR(lit_floor(session, 1).mean, std::pow(0.7, count), 0.01) << count;
    }
}

TEST(SplatShadows, MayBeSwitchedOff) {
    Scene scene;
    app::Session session = under(scene, {wall(2, 1, 0.5f)}, ShadowMode::hard, sun);
    session.settings().splats.cast = false;
    EXPECT_EQ(lit_floor(session, 1).least, 1);
}

// What lies between two walls is in the shadow of the one before it alone.
TEST(SplatShadows, LeaveSurfacesBeforeThemAlone) {
    Scene scene;
    app::Session session = under(scene, {wall(2, -0.5f, 0.5f), wall(2, 0.8f, 0.5f)}, ShadowMode::hard, sun);
    EXPECT_NEAR(lit_floor(session, 1).mean, 0.5, 0.01);
}

// The lamp of a path shines through by the product as well: no noise but that of pixels' places.
TEST(SplatRays, WeakenLampsByTheirOpacity) {
    Scene scene;
    app::Session session = under(scene, {wall(2, 1, 0.5f)}, ShadowMode::soft, sun);
    session.settings().path.enabled = true;
    const Floor floor = lit_floor(session, 16);
    EXPECT_NEAR(floor.mean, 0.5, 0.01);
    EXPECT_LT(floor.most - floor.least, 0.04);
}

/// The mean colour of the mirror's middle.
Vec3 mirrored(bool paths, float opacity, const Vec3& color, float behind, int samples) {
    app::Session session = before_mirror(paths, opacity, color, behind);
    const Image image = render_linear(session, samples);
    Vec3 sum = Vec3::Zero();
    int count = 0;
    for (int y = 8; y < 24; ++y)
        for (int x = 8; x < 24; ++x, ++count) sum += Eigen::Map<const Vec3>(image.at<float>(x, y));
    return sum / float(count);
}

// A mirror shows the opacity's part of the sheet's colour and the rest of the sky behind it: 1. 0.02: 16 384
// rays choose one of two values that are at most 1 apart (0.004), and the mirror reflects all but 1 %.
TEST(SplatRays, AreSeenInMirrors) {
    const Vec3 color(0.9f, 0.4f, 0.2f), light = linear_from_srgb(color);
    for (const bool paths : {true, false}) {
        const Vec3 seen = mirrored(paths, 0.6f, color, 6, 64);
        const Vec3 expected = 0.6f * light + 0.4f * Vec3::Ones();
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(seen[c], expected[c], 0.02) << c << " paths " << paths;
    }
}

// The curve is passed once, in a mirror as in the image: a sheet all but opaque has its colour there. 0.02:
// the mirror reflects all but 1 %, the sheet hides all but 1 % of the sky behind it, which is much brighter
// for some curves.
TEST(SplatRays, HaveTheirColoursInMirrorsUnderAllCurves) {
    const Vec3 color(0.75f, 0.45f, 0.2f);
    for (const auto tone : {ToneOperator::aces, ToneOperator::reinhard, ToneOperator::agx,
                            ToneOperator::neutral, ToneOperator::none})
        for (const bool paths : {true, false}) {
            app::Session session = before_mirror(paths, 0.99f, color, 6);
            session.settings().tonemap.tone_operator = tone;
            session.settings().tonemap.exposure = 2;
            session.settings().environment.intensity = 0.25f;
            const Image image = session.render({std::nullopt, 64, Encoding::srgb8});
            for (int c = 0; c < 3; ++c) {
                double sum = 0;
                for (int y = 8; y < 24; ++y)
                    for (int x = 8; x < 24; ++x) sum += image.at<uint8_t>(x, y)[c] / 255.0;
                EXPECT_NEAR(sum / 256, color[c], 0.02)
                    << "curve " << int(tone) << " paths " << paths << " " << c;
            }
        }
}

// Seen through clear glass that bends no ray: nearly all of the sheet's colour.
TEST(SplatRays, AreSeenThroughGlass) {
    const Vec3 color(0.9f, 0.4f, 0.2f), light = linear_from_srgb(color);
    Material glass;
    glass.transmission = 1;
    glass.base_color = Vec3::Ones();
    glass.ior = 1.0001f;
    glass.roughness = 0;
    Scene scene;
    scene.show(facing_square(0.5f, glass), "glass");
    scene.show(sheets({-1}, 0.95f, color), "sheet");
    app::Session session = plain_session(scene, 32);
    session.settings().path.enabled = true;
    look_from(session, Vec3d(0, 0, 3), 10);
    const Image image = render_linear(session, 64);
    Vec3 middle = Vec3::Zero();
    for (int y = 12; y < 20; ++y)
        for (int x = 12; x < 20; ++x) middle += Eigen::Map<const Vec3>(image.at<float>(x, y)) / 64;
    // 0.01: three standard errors of 64 rays in 64 pixels, of which one in twenty goes through the sheet
    // (0.0034 of the colour).
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(middle[c], 0.95f * light[c], 0.01f) << c;
}

/// A carpet of small splats in the plane z = 0, of one colour, under casters, seen from above; the colours of
/// the pixels, linear, with shadows over without, -1 where there is no carpet.
Image darkening(const std::vector<Mesh>& casters, const std::function<void(Scene&, Settings&)>& light,
                int samples = 1) {
    Mesh carpet = wall(1, 0, 0.999f, 96, 0.5f);
    Scene scene;
    scene.show(carpet, "carpet");
    for (size_t i = 0; i < casters.size(); ++i) scene.show(casters[i], "caster" + std::to_string(i));
    app::Session session = shadow_session(scene, ShadowMode::hard, 96);
    Settings& s = session.settings();
    light(scene, s);
    s.camera.projection = Projection::orthographic;
    s.camera.ortho_height = 2;
    s.camera.target = Vec3d(0, 0, 0);
    s.camera.position = Vec3d(0, 0, 0.2);  // below the casters
    s.camera.near = 0.01;
    s.camera.azimuth_deg = 0;
    s.splats.receive = false;
    const Image without = render_linear(session, samples);
    s.splats.receive = true;
    const Image with = render_linear(session, samples);
    Image parts(96, 96, 1, PixelType::f32);
    for (size_t i = 0; i < parts.pixel_count(); ++i) {
        const float all = without.pixels<float>()[4 * i];
        parts.pixels<float>()[i] = all > 0 ? with.pixels<float>()[4 * i] / all : -1;
    }
    return parts;
}

// A square of half width 0.5 above the carpet under a sun from straight above: dark below it and as it was
// beside it, but for a rim of splats that lie on both sides: 4 standard deviations, of 2 / 96 each.
TEST(SplatsReceive, ShadowsOfLamps) {
    const Image parts = darkening({rectangle(-0.5f, -0.5f, 0.5f, 0.5f, 0.5f)}, [](Scene& scene, Settings& s) {
        scene.set_light("lamp", sun);
        s.shadows.enabled = true;
    });
    int below = 0, beside = 0;
    for (int y = 0; y < 96; ++y)
        for (int x = 0; x < 96; ++x) {
            const double u = std::abs(x + 0.5 - 48) / 48, v = std::abs(y + 0.5 - 48) / 48;
            const float part = parts.at<float>(x, y)[0];
            if (std::max(u, v) < 0.5 - 8.0 / 96) {
                ++below;
                ASSERT_NEAR(part, 0, 0.01) << x << " " << y;
            }
            if (std::max(u, v) > 0.5 + 8.0 / 96 && std::max(u, v) < 0.8) {
                ++beside;
                ASSERT_EQ(part, 1) << x << " " << y;
            }
        }
    EXPECT_GT(below, 1000);
    EXPECT_GT(beside, 1000);
}

// What lets a part of the light through darkens by the rest of it. Parts are kept in steps of 1/254, and
// colours pass sRGB's curve: 0.004.
TEST(SplatsReceive, ShadowsOfWhatLetsLightThrough) {
    Material half = matt();
    half.opacity = 0.4f;
    const Image parts = darkening({rectangle(-2, -2, 2, 2, 0.5f, half)}, [](Scene& scene, Settings& s) {
        scene.set_light("lamp", sun);
        s.shadows.enabled = true;
    });
    EXPECT_NEAR(parts.at<float>(75, 40)[0], 0.6f, 0.004f);  // off the edge between the square's triangles
}

// The part of an even sky that a parallel square of half width h at height h hides from the place below its
// middle: 4 / (2 pi) 2 atan(1 / sqrt 2) / sqrt 2 (Howell, "A Catalog of Radiation Heat Transfer Configuration
// Factors", B-3). 0.03: 8 directions for each splat, of which some overlap in a pixel, and the mean of 64
// pixels.
TEST(SplatsReceive, OcclusionOfTheSky) {
    const double hidden = 4 / pi * std::atan(std::sqrt(0.5)) * std::sqrt(0.5);
    const Mesh square = rectangle(-0.6f, -0.6f, 0.6f, 0.6f, 0.6f);
    const Image parts = darkening({square}, [](Scene& scene, Settings& s) {
        scene.set_environment(constant_environment(1));
        s.environment.enabled = true;
        s.ssao.enabled = true;
    });
    double sum = 0;
    for (int y = 44; y < 52; ++y)
        for (int x = 44; x < 52; ++x) sum += double(parts.at<float>(x, y)[0]) / 64;
    EXPECT_NEAR(sum, 1 - hidden, 0.03);
}

/// Two flat splats that cross each other at right angles in the plane of the picture's middle column.
Mesh crossed(bool other_first) {
    MeshData mesh;
    const auto row = [&](int i) { return other_first ? 1 - i : i; };
    Array3f::Dense V = Array3f::Dense::Zero(2, 3), scales(2, 3);
    Array4f::Dense rotations(2, 4);
    ArrayXf::Dense sh(2, 3);
    for (int i = 0; i < 2; ++i) {
        // The left one's mean is nearer by less than the slopes bring.
        V(row(i), 2) = i == 0 ? 0.01f : 0.0f;
        scales.row(row(i)) << 0.5f, 0.5f, 0.0f;
        const float half = float(pi) / 8 * (i == 0 ? 1.0f : -1.0f);
        rotations.row(row(i)) << std::cos(half), 0, std::sin(half), 0;
        const Vec3 color = i == 0 ? Vec3(1, 0, 0) : Vec3(0, 0, 1);
        for (int c = 0; c < 3; ++c) sh(row(i), c) = (color[c] - 0.5f) / float(constant_harmonic);
    }
    mesh.V = std::move(V);
    mesh.splats = {std::move(scales), std::move(rotations), Array1f::Dense::Constant(2, 0.95f),
                   std::move(sh)};
    return Mesh(mesh);
}

Image picture_of_crossed(bool resort, bool other_first = false) {
    Scene scene;
    scene.show(crossed(other_first), "crossed");
    app::Session session = plain_session(scene, 64);
    Settings& s = session.settings();
    s.splats.resort = resort;
    s.camera.projection = Projection::orthographic;
    s.camera.ortho_height = 1;
    look_from(session, Vec3d(0, 0, 4));
    return render_linear(session);
}

// A splat that is turned about the y axis comes nearer on one side: there it hides the other. In one order
// for the picture the first one hides the other on both sides.
TEST(SplatsResorted, AreInTheOrderOfEachPixel) {
    const auto redness = [](const Image& image, int x) {
        const float* p = image.at<float>(x, 32);
        return p[0] - p[2];
    };
    const Image once = picture_of_crossed(false), each = picture_of_crossed(true);
    EXPECT_GT(redness(once, 20), 0.3f);
    EXPECT_GT(redness(once, 44), 0.3f);
    // About y a positive turn moves the right side away from +z, so that red is nearer on the left.
    EXPECT_GT(redness(each, 20), 0.3f);
    EXPECT_LT(redness(each, 44), -0.3f);
    const Image swapped = picture_of_crossed(true, true);
    EXPECT_TRUE(std::ranges::equal(each.bytes(), swapped.bytes()));
}

// Where all splats lie in planes across the view nothing changes but roundings.
TEST(SplatsResorted, AreTheSameWhereTheOrderIsTheSame) {
    const auto picture = [](bool resort) {
        Scene scene;
        for (int i = 0; i < 3; ++i)
            scene.show(wall(0.5f, 0.2f * float(i), 0.5f, 12, 0.5f), "wall" + std::to_string(i));
        app::Session session = plain_session(scene, 64);
        session.settings().splats.resort = resort;
        look_from(session, Vec3d(0, 0, 4));
        return render_linear(session);
    };
    const Image once = picture(false), each = picture(true);
    double most = 0;
    for (size_t i = 0; i < once.pixels<float>().size(); ++i)
        most = std::max(most, double(std::abs(once.pixels<float>()[i] - each.pixels<float>()[i])));
    EXPECT_LT(most, 2.0 / 255);  // splats at the border of what is seen may round to either side
}

}  // namespace
}  // namespace easypbr::gaussian_splat_light_test
