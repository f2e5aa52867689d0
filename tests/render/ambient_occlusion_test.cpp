// Ambient occlusion against closed forms and cast rays.
#include "occlusion_test.h"
#include "test_data.h"

#include "easypbr/scene/resolve.h"

namespace easypbr::ambient_occlusion_test {
namespace {

// A plane sees all of its hemisphere, at the borders of the picture too. 0.98 is required; a pixel's place
// beside a slice must not matter, so what is left is the rounding of 16-bit normals and visibilities; on a
// GPU depths are those of places vertex_rounding() beside the pixels, steeper against the normal the flatter
// the view.
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
                    EXPECT_LT(d.max, 0.002 + 8 * vertex_rounding())
                        << angle << " degrees, projection " << int(projection);
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
    const auto ssao = session.resolve().settings.ssao;
    return difference(
        o,
        [&](int x, int y) {
            if (!o.off_silhouettes(x, y, 4)) return std::nan("");
            return ray_cast_visibility(caster, o.world(x, y).cast<float>(), o.normal_at(x, y), ssao.radius,
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
    wide.settings().ssao.radius = 4 * wide.resolve().settings.ssao.radius;
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

}  // namespace
}  // namespace easypbr::ambient_occlusion_test
