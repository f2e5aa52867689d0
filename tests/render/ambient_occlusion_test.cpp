#include <cmath>
#include <functional>

#include "easypbr/core/error.h"
#include "easypbr/scene/fields.h"
#include "ray_caster.h"
#include "render_test.h"
#include "test_data.h"

namespace easypbr {
namespace {

constexpr float far_beyond_the_scene = 1e4f;

/// What a session draws and what it is compared with, per pixel.
struct Occlusion {
    Image visibility, depth, normal;
    Camera camera;
    Mat4d view_from_clip;

    explicit Occlusion(app::Session& session) {
        auto layers = session.render_layers({"ambient_occlusion", "depth", "normal"});
        visibility = std::move(layers["ambient_occlusion"]);
        depth = std::move(layers["depth"]);
        normal = std::move(layers["normal"]);
        camera = session.camera();
        view_from_clip = camera.projection_matrix(double(depth.width()) / depth.height()).inverse();
    }

    bool covered(int x, int y) const { return depth.at<float>(x, y)[0] > 0; }
    float at(int x, int y) const { return visibility.at<float>(x, y)[0]; }
    Vec3 normal_at(int x, int y) const { return Vec3(Eigen::Map<const Vec3>(normal.at<float>(x, y))); }

    Vec3d world(int x, int y) const {
        const double z = depth.at<float>(x, y)[0];
        const Mat4d P = view_from_clip.inverse();
        const double ndc_x = (x + 0.5) / depth.width() * 2 - 1, ndc_y = 1 - (y + 0.5) / depth.height() * 2;
        const bool flat = camera.projection == Projection::orthographic;
        const Vec3d view(flat ? (ndc_x - P(0, 3)) / P(0, 0) : (ndc_x + P(0, 2)) / P(0, 0) * z,
                         flat ? (ndc_y - P(1, 3)) / P(1, 1) : (ndc_y + P(1, 2)) / P(1, 1) * z, -z);
        return camera.T_world_cam * view;
    }

    /// Whether the surfaces of two neighbouring pixels are not joined: one rises from the other by more than
    /// the pixels are apart.
    bool is_step(int x, int y, int other_x, int other_y) const {
        if (!covered(other_x, other_y)) return true;
        const Vec3d to = world(other_x, other_y) - world(x, y);
        const double pixel = 2 * camera.projection_matrix(1).inverse()(1, 1) / depth.height() *
                             (camera.projection == Projection::orthographic ? 1 : depth.at<float>(x, y)[0]);
        return std::abs(normal_at(x, y).cast<double>().dot(to)) > 3 * pixel;
    }

    /// Whether the surface goes on without a step or a border of the picture within some pixels.
    bool off_silhouettes(int x, int y, int margin) const {
        if (x < margin || y < margin || x + margin + 1 >= depth.width() || y + margin + 1 >= depth.height())
            return false;
        for (int j = y - margin; j <= y + margin; ++j)
            for (int i = x - margin; i <= x + margin; ++i)
                if (!covered(i, j) || is_step(i, j, i + 1, j) || is_step(i, j, i, j + 1)) return false;
        return true;
    }
};

/// Visibility of the surroundings of a point, weighted by the cosine; occluders count less over the outer
/// `falloff` of the radius, as those of the setting ssao.falloff do. `count` rays in a spiral.
double ray_cast_visibility(const RayCaster& caster, const Vec3& position, const Vec3& normal, float radius,
                           float falloff, int count = 512) {
    const Vec3 n = normal.normalized(), t = n.unitOrthogonal(), b = n.cross(t);
    // Off the surface by more than the rounding of its position.
    const Vec3 from = position + n * (1e-4f * radius);
    double open = 0;
    for (int i = 0; i < count; ++i) {
        const double r = std::sqrt((i + 0.5) / count), angle = i * pi * (3 - std::sqrt(5.0));
        const Vec3 d =
            t * float(r * std::cos(angle)) + b * float(r * std::sin(angle)) + n * float(std::sqrt(1 - r * r));
        const float distance = caster.distance(from, d);
        open += 1 - std::clamp((1 - distance / radius) / falloff, 0.0f, 1.0f);
    }
    return open / count;
}

struct Difference {
    double max = 0, rmse = 0, mean = 0;
    int count = 0;
};

/// Differences from `expected` (NaN: not compared) where the picture shows a surface.
Difference difference(const Occlusion& o, const std::function<double(int, int)>& expected, int step = 1) {
    Difference result;
    double squares = 0, sum = 0;
    for (int y = 0; y < o.depth.height(); y += step)
        for (int x = 0; x < o.depth.width(); x += step) {
            const double want = o.covered(x, y) ? expected(x, y) : std::nan("");
            if (std::isnan(want)) continue;
            const double d = o.at(x, y) - want;
            result.max = std::max(result.max, std::abs(d));
            squares += d * d;
            sum += d;
            ++result.count;
        }
    result.rmse = std::sqrt(squares / result.count);
    result.mean = sum / result.count;
    return result;
}

app::Session occlusion_session(const Scene& scene, int size = 256) {
    app::Session session = plain_session(scene, size);
    session.settings().ssao.enabled = true;
    return session;
}

/// Quadrilateral from four corners.
Mesh quad(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    Array3f::Dense V(4, 3);
    V << a.transpose(), b.transpose(), c.transpose(), d.transpose();
    Array3i::Dense F(2, 3);
    F << 0, 1, 2, 0, 2, 3;
    return Mesh{Array3f(V), Array3i(F)};
}

Mesh floor_quad(float half) {
    return quad({-half, 0, half}, {half, 0, half}, {half, 0, -half}, {-half, 0, -half});
}

Scene sphere_on_floor() {
    Scene scene;
    scene.show(floor_quad(40), "floor");
    Mesh sphere = make_sphere(1, 128);
    sphere.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(0, 1, 0)));
    scene.show(sphere, "sphere");
    return scene;
}

Scene teapot_on_floor() {
    Scene scene;
    scene.show(make_teapot(1), "teapot");
    scene.show(floor_quad(1.2f), "floor");
    return scene;
}

/// A box and a sphere in the corner of two walls.
Scene corner_with_objects() {
    Scene scene;
    scene.show(floor_quad(1), "floor");
    scene.show(quad({-1, 0, -1}, {1, 0, -1}, {1, 1, -1}, {-1, 1, -1}), "back");
    scene.show(quad({-1, 0, 1}, {-1, 0, -1}, {-1, 1, -1}, {-1, 1, 1}), "side");
    Mesh box = make_box(Vec3(0.5f, 0.4f, 0.3f));
    box.set_T_parent_mesh(Eigen::Translation3d(-0.2, 0.2, -0.4) * Eigen::AngleAxisd(0.5, Vec3d::UnitY()));
    scene.show(box, "box");
    Mesh sphere = make_sphere(0.2f, 128);
    sphere.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(0.4, 0.2, 0.2)));
    scene.show(sphere, "sphere");
    return scene;
}

/// Directions and steps in which what is left is the error of the method, not of sampling it.
void raise_quality(app::Session& session) {
    SsaoSettings& ssao = session.settings().ssao;
    ssao.resolution = OcclusionResolution::full;
    ssao.directions = 16;
    ssao.steps = 16;
}

void place(app::Session& session, const Vec3d& position, const Vec3d& target, float fov_y_deg,
           double ortho_height = 1) {
    CameraSettings& camera = session.settings().camera;
    camera.position = position;
    camera.target = target;
    camera.fov_y_deg = fov_y_deg;
    camera.ortho_height = ortho_height;
}

// A plane sees all of its hemisphere, at the borders of the picture too. 0.98 is required; a pixel's place
// beside a slice must not matter, so what is left is the rounding of 16-bit normals and visibilities.
TEST(AmbientOcclusion, OpenPlaneIsOpenAtAnyAngle) {
    Scene scene;
    scene.show(floor_quad(1), "floor");
    for (const auto method : {OcclusionMethod::horizon, OcclusionMethod::hemisphere})
        for (const auto resolution : {OcclusionResolution::half, OcclusionResolution::full})
            for (const auto projection : {Projection::perspective, Projection::orthographic})
                for (const double angle : {0.0, 30.0, 60.0, 80.0, 88.0}) {
                    app::Session session = occlusion_session(scene, 201);
                    session.settings().ssao.method = method;
                    session.settings().ssao.resolution = resolution;
                    session.settings().camera.projection = projection;
                    const double a = radians(angle);
                    place(session, Vec3d(0, 1.2 * std::cos(a), 1.2 * std::sin(a)), Vec3d(0, 0, 0), 60);
                    const Difference d = difference(Occlusion(session), [](int, int) { return 1.0; });
                    EXPECT_GT(d.count, 300);
                    EXPECT_LT(d.max, 0.002) << angle << " degrees, projection " << int(projection);
                }
}

// Occlusion by an infinitely long wall of height h at the distance d is (1 - d / sqrt(d^2 + h^2)) / 2. What
// is left of the required 0.05 is the height of the wall between the places that are looked at, and the parts
// of the wall beyond the picture.
TEST(AmbientOcclusion, FloorAndWall) {
    Scene scene;
    scene.show(floor_quad(40), "floor");
    scene.show(quad({-40, 0, 0}, {40, 0, 0}, {40, 1, 0}, {-40, 1, 0}), "wall");
    for (const auto projection : {Projection::perspective, Projection::orthographic}) {
        app::Session session = occlusion_session(scene);
        session.settings().camera.projection = projection;
        session.settings().ssao.radius = far_beyond_the_scene;
        place(session, Vec3d(0.5, 5, 7), Vec3d(0, 0.2, 1), 60, 9);
        raise_quality(session);
        const Occlusion o(session);
        const Difference d = difference(o, [&](int x, int y) {
            const Vec3d p = o.world(x, y);
            if (p.y() > 1e-3 || p.z() < 0.2 || p.z() > 2 || std::abs(p.x()) > 1) return std::nan("");
            return 1 - (1 - p.z() / std::sqrt(p.z() * p.z() + 1)) / 2;
        });
        EXPECT_GT(d.count, 1500);
        EXPECT_LT(d.max, 0.05) << "projection " << int(projection);
    }
}

// Occlusion of a floor by a sphere of radius R that rests on it, at s from the contact: (R^2 / (s^2 +
// R^2))^1.5. A depth buffer says nothing of how far the sphere reaches back, so pixels beside its silhouette
// may err.
TEST(AmbientOcclusion, SphereOnAPlane) {
    const Scene scene = sphere_on_floor();
    for (const double elevation_deg : {30.0, 45.0, 70.0, 89.0}) {
        app::Session session = occlusion_session(scene);
        session.settings().ssao.radius = far_beyond_the_scene;
        const double e = radians(elevation_deg);
        place(session, Vec3d(0, 8 * std::sin(e), 8 * std::cos(e)), Vec3d(0, 0.3, 0), 45);
        raise_quality(session);
        const Occlusion o(session);
        const Difference d = difference(o, [&](int x, int y) {
            const Vec3d p = o.world(x, y);
            const double s = std::hypot(p.x(), p.z());
            if (p.y() > 1e-3 || s < 1 || s > 4 || !o.off_silhouettes(x, y, 4)) return std::nan("");
            return 1 - std::pow(s * s + 1, -1.5);
        });
        EXPECT_GT(d.count, 5000);
        EXPECT_LT(d.max, 0.05) << elevation_deg << " degrees";
    }
}

/// Against rays of the same radius and falloff, silhouettes masked.
Difference against_rays(app::Session& session, int step) {
    const Occlusion o(session);
    const RayCaster caster(session.scene().snapshot());
    const SsaoSettings ssao = session.resolve().settings.ssao;
    return difference(
        o,
        [&](int x, int y) {
            if (!o.off_silhouettes(x, y, 4)) return std::nan("");
            return ray_cast_visibility(caster, o.world(x, y).cast<float>(), o.normal_at(x, y), *ssao.radius,
                                       ssao.falloff);
        },
        step);
}

/// Horizons, as single frames have them by default, within 0.1 and better than the hemisphere; both within
/// the settings' defaults and a radius four times as large.
void expect_agreement_with_rays(const Scene& scene, const std::string& name) {
    double rmse[2];
    for (const auto method : {OcclusionMethod::horizon, OcclusionMethod::hemisphere}) {
        app::Session session = occlusion_session(scene, 512);
        session.settings().ssao.method = method;
        const Difference d = against_rays(session, 3);
        EXPECT_GT(d.count, 4500) << name;
        EXPECT_LT(d.rmse, 0.1) << name;
        rmse[int(method)] = d.rmse;
    }
    EXPECT_LT(rmse[0], rmse[1]) << name;
    app::Session wide = occlusion_session(scene, 512);
    wide.settings().ssao.radius = 4 * *wide.resolve().settings.ssao.radius;
    EXPECT_LT(against_rays(wide, 3).rmse, 0.1) << name;
}

TEST(AmbientOcclusion, AgreesWithRays) {
    expect_agreement_with_rays(corner_with_objects(), "corner");
    expect_agreement_with_rays(teapot_on_floor(), "teapot");
}

TEST(AmbientOcclusion, AgreesWithRaysOnRealFiles) {
    REQUIRE_TEST_DATA();
    for (const char* name : {"head.obj", "room_scene.obj"}) {
        Scene scene;
        scene.show(Mesh(test_data(name)), "mesh");
        expect_agreement_with_rays(scene, name);
    }
}

// A sphere far before a wall: neither occludes the other, and the pixels of both sides of the silhouette stay
// on their own side when the half resolution is magnified. The normals of facets lean by up to 1.4 degrees
// from the sphere's, which costs less than 0.03 where it is seen from the side.
TEST(AmbientOcclusion, SilhouettesHaveNoSpecks) {
    Scene scene;
    scene.show(make_sphere(1, 128), "sphere");
    scene.show(quad({-9, -9, -9}, {9, -9, -9}, {9, 9, -9}, {-9, 9, -9}), "wall");
    for (const auto method : {OcclusionMethod::horizon, OcclusionMethod::hemisphere}) {
        app::Session session = occlusion_session(scene, 203);
        session.settings().ssao.method = method;
        session.settings().ssao.radius = 0.5f;
        place(session, Vec3d(0, 0, 5), Vec3d(0, 0, 0), 30);
        const Difference d = difference(Occlusion(session), [](int, int) { return 1.0; });
        EXPECT_EQ(d.count, 203 * 203);
        EXPECT_LT(d.max, 0.03) << int(method);
    }
}

// Sizes down to one pixel, odd ones too, and the same picture at any: the means of a teapot's visibility at
// half and at twice the size differ by what its outline covers.
TEST(AmbientOcclusion, WorksAtAnySize) {
    const Scene scene = teapot_on_floor();
    for (const Vec2i& size : {Vec2i(1, 1), Vec2i(2, 1), Vec2i(1, 3), Vec2i(5, 7), Vec2i(33, 65)}) {
        app::Session session = occlusion_session(scene);
        session.settings().image.size = size;
        const Occlusion o(session);
        for (const float v : o.visibility.pixels<float>()) {
            EXPECT_GE(v, 0);
            EXPECT_LE(v, 1);
        }
    }
    const auto mean = [&](int size) {
        app::Session session = occlusion_session(scene, size);
        return 1 + difference(Occlusion(session), [](int, int) { return 1.0; }).mean;
    };
    const double middle = mean(200);
    EXPECT_LT(middle, 0.99);
    EXPECT_NEAR(mean(101), middle, 0.01);
    EXPECT_NEAR(mean(401), middle, 0.01);
}

// Only the environment's light is occluded: with lights alone the picture is the same, bit for bit.
TEST(AmbientOcclusion, LeavesDirectLightAlone) {
    const Scene scene = teapot_on_floor();
    Light light;
    light.position = Vec3(1, 3, 2);
    light.intensity = 20;
    Scene lit = scene;
    lit.set_light("light", light);
    app::Session session = plain_session(lit, 128);
    const Image without = render_linear(session);
    session.settings().ssao.enabled = true;
    const Image with = render_linear(session);
    EXPECT_TRUE(std::ranges::equal(with.bytes(), without.bytes()));
}

// White furnace on an open plane: nothing is lost, at one frame and at many.
TEST(AmbientOcclusion, FurnaceHoldsOnAnOpenPlane) {
    Material white;
    white.base_color = Vec3::Ones();
    white.roughness = 0.5f;
    Scene scene;
    scene.show(facing_square(1, white), "square");
    scene.set_environment(constant_environment(0.7f));
    for (const int samples : {1, 8}) {
        app::Session session = occlusion_session(scene, 64);
        session.settings().environment.enabled = true;
        place(session, Vec3d(1.5, 1, 2), Vec3d(0, 0, 0), 30);
        const Image image = render_linear(session, samples);
        for (int y = 0; y < 64; ++y)
            for (int x = 0; x < 64; ++x) {
                const float* p = image.at<float>(x, y);
                if (p[3] == 1) {
                    ASSERT_NEAR(p[1] / 0.7f, 1, 0.005);
                }
            }
    }
}

/// Visibility as the mean of many frames shows it, from the light on a white matt scene.
Image averaged_visibility(const Scene& scene, int samples) {
    Image ratio;
    for (const bool enabled : {false, true}) {
        app::Session session = occlusion_session(scene, 192);
        Settings& s = session.settings();
        s.environment.enabled = true;
        s.shading.dielectric_f0 = 0;
        s.material.roughness = 1.0f;
        s.ssao.enabled = enabled;
        s.ssao.multi_bounce = false;
        place(session, Vec3d(1.2, 1.8, 2.4), Vec3d(-0.1, 0.3, 0), 40);
        Image image = render_linear(session, samples);
        if (enabled)
            for (size_t i = 0; i < image.pixels<float>().size(); ++i)
                ratio.pixels<float>()[i] = image.pixels<float>()[i] / ratio.pixels<float>()[i];
        else
            ratio = std::move(image);
    }
    return ratio;
}

// Frames of a still look in different directions, so noise averages out: between 16 and 64 frames it must
// have halved at least (evenly spread points do better than the root of the count), and 64 frames agree with
// rays within 0.04. 0.002 of each are the Fresnel reflection of the matt floor.
TEST(AmbientOcclusion, NoiseAveragesOut) {
    Scene scene = corner_with_objects();
    scene.set_environment(constant_environment(1));
    const Image few = averaged_visibility(scene, 16), many = averaged_visibility(scene, 64),
                most = averaged_visibility(scene, 512);
    app::Session session = occlusion_session(scene, 192);
    place(session, Vec3d(1.2, 1.8, 2.4), Vec3d(-0.1, 0.3, 0), 40);
    const Occlusion o(session);
    const RayCaster caster(scene.snapshot());
    const SsaoSettings ssao = session.resolve().settings.ssao;
    double noise_few = 0, noise_many = 0, error = 0;
    int count = 0;
    for (int y = 0; y < 192; y += 2)
        for (int x = 0; x < 192; x += 2) {
            if (!o.covered(x, y) || !o.off_silhouettes(x, y, 3)) continue;
            const auto at = [&](const Image& image) { return double(image.at<float>(x, y)[1]); };
            noise_few += std::pow(at(few) - at(most), 2);
            noise_many += std::pow(at(many) - at(most), 2);
            error += std::pow(at(many) - ray_cast_visibility(caster, o.world(x, y).cast<float>(),
                                                             o.normal_at(x, y), *ssao.radius, ssao.falloff),
                              2);
            ++count;
        }
    EXPECT_GT(count, 1000);
    EXPECT_LT(std::sqrt(noise_many / count), 0.003);
    EXPECT_LT(noise_many, noise_few / 4);
    EXPECT_LT(std::sqrt(error / count), 0.04);
}

// Interreflection: the brighter the surface, the less its recesses darken; black ones are occluded as they
// are.
TEST(AmbientOcclusion, BrightRecessesAreLighter) {
    const auto darkest = [](float albedo, bool multi_bounce) {
        Scene scene = teapot_on_floor();
        scene.set_environment(constant_environment(1));
        float least = 1;
        Image open;
        for (const bool enabled : {false, true}) {
            app::Session session = occlusion_session(scene, 96);
            session.settings().environment.enabled = true;
            session.settings().ssao.enabled = enabled;
            session.settings().ssao.multi_bounce = multi_bounce;
            session.settings().material.color = Vec3(albedo, albedo, albedo);
            const Image image = render_linear(session);
            for (size_t i = 0; enabled && i < image.pixel_count(); ++i)
                if (image.pixels<float>()[4 * i + 3] > 0)
                    least = std::min(least, image.pixels<float>()[4 * i] / open.pixels<float>()[4 * i]);
            open = image;
        }
        return least;
    };
    EXPECT_LT(darkest(0.9f, false), 0.7f);
    EXPECT_GT(darkest(0.9f, true), darkest(0.9f, false) + 0.05f);
    EXPECT_GT(darkest(0.9f, true), darkest(0.3f, true) + 0.05f);
}

TEST(AmbientOcclusion, PowerDarkens) {
    const Scene scene = teapot_on_floor();
    app::Session session = occlusion_session(scene, 64);
    session.settings().ssao.resolution = OcclusionResolution::full;
    const auto mean = [&](float power) {
        session.settings().ssao.power = power;
        return difference(Occlusion(session), [](int, int) { return 1.0; }).mean;
    };
    EXPECT_LT(mean(2), 1.3 * mean(1));
    EXPECT_EQ(mean(0), 0);
}

// Points without normals are shaded by eye-dome lighting, and occlusion on top of it when it is asked for.
TEST(AmbientOcclusion, DarkensRecessesOfClouds) {
    const int n = 200;
    Array3f::Dense V(2 * n * n, 3);
    for (int i = 0; i < n * n; ++i) {
        const float u = float(i % n) / n * 2 - 1, v = float(i / n) / n;
        V.row(2 * i) << u, 0, v;
        V.row(2 * i + 1) << u, v, 0;
    }
    Mesh cloud;
    cloud.set_V(Array3f(V));
    Scene scene;
    scene.show(cloud, "corner");
    app::Session session = plain_session(scene, 128);
    session.settings().ssao.enabled = automatic;
    place(session, Vec3d(0, 2, 2), Vec3d(0, 0.3, 0.3), 40);
    EXPECT_FALSE(*session.resolve().settings.ssao.enabled);
    const Image plain = session.render();
    session.settings().ssao.enabled = true;
    session.settings().ssao.radius = 0.3f;
    const Image occluded = session.render();
    const Occlusion o(session);
    double in_corner = 0, elsewhere = 0;
    int corner_count = 0, elsewhere_count = 0;
    for (int y = 0; y < 128; ++y)
        for (int x = 0; x < 128; ++x) {
            if (!o.covered(x, y)) continue;
            const Vec3d p = o.world(x, y);
            const int before = plain.at<uint8_t>(x, y)[0], after = occluded.at<uint8_t>(x, y)[0];
            EXPECT_LE(after, before);
            const double distance = std::max(p.y(), p.z());
            if (distance < 0.05) in_corner += o.at(x, y), ++corner_count;
            if (distance > 0.4 && distance < 0.6) elsewhere += o.at(x, y), ++elsewhere_count;
        }
    ASSERT_GT(corner_count, 100);
    ASSERT_GT(elsewhere_count, 100);
    EXPECT_LT(in_corner / corner_count, elsewhere / elsewhere_count - 0.1);
}

// A tilted plane of points is as open as one of faces, though its splats face the viewer like stairs.
TEST(AmbientOcclusion, LeavesTiltedCloudsOpen) {
    const int n = 300;
    Array3f::Dense V(n * n, 3);
    for (int i = 0; i < n * n; ++i) V.row(i) << float(i % n) / n * 2 - 1, 0, float(i / n) / n * 2 - 1;
    Mesh cloud;
    cloud.set_V(Array3f(V));
    Scene scene;
    scene.show(cloud, "plane");
    app::Session session = plain_session(scene, 160);
    session.settings().ssao.enabled = true;
    session.settings().ssao.radius = 0.2f;
    for (const double elevation_deg : {20.0, 45.0, 80.0}) {
        const double a = radians(elevation_deg);
        place(session, 3 * Vec3d(0, std::sin(a), std::cos(a)), Vec3d::Zero(), 40);
        const Occlusion o(session);
        double sum = 0;
        int count = 0;
        for (int y = 0; y < 160; ++y)
            for (int x = 0; x < 160; ++x) {
                if (!o.covered(x, y) || o.world(x, y).cwiseAbs().maxCoeff() > 0.7) continue;
                sum += o.at(x, y);
                ++count;
            }
        ASSERT_GT(count, 300) << elevation_deg;
        EXPECT_GT(sum / count, 0.9) << elevation_deg;
    }
}

TEST(AmbientOcclusion, SaysWhatItExpected) {
    Settings settings;
    for (const char* radius : {"0", "-1", "nan", "inf"})
        EXPECT_THROW(set_from_text(settings, "ssao.radius", radius), ArgumentError) << radius;
    EXPECT_THROW(set_from_text(settings, "ssao.steps", "0"), ArgumentError);
    EXPECT_THROW(set_from_text(settings, "ssao.falloff", "0"), ArgumentError);
    Scene scene;
    scene.show(make_sphere(), "sphere");
    app::Session session = plain_session(scene);
    session.settings().ssao.enabled = false;
    // Switched off, nothing occludes anything.
    const Image layer = session.render_layers({"ambient_occlusion"}).at("ambient_occlusion");
    EXPECT_EQ(*layer.at<float>(32, 32), 1.0f);
    EXPECT_EQ(*layer.at<float>(0, 0), 0.0f);
}

}  // namespace
}  // namespace easypbr
