// Points and surfels cast the shadows that meshes of their shape cast, and receive them.
#include <random>
#include <utility>

#include "shadow_test.h"

#include "easypbr/scene/settings.h"

namespace easypbr::splat_shadow_test {
namespace {

constexpr int size = 128;
constexpr int resolution = 256;
constexpr double texel = 6.0 / resolution;  // of a map over the floor of side 6

/// A floor under a light at 45 degrees that goes towards +x, seen from straight above.
app::Session session_over(Scene& scene, const Mesh& caster, bool native, bool parallel = true) {
    scene.show(rectangle(-3, -3, 3, 3, 0), "floor");
    scene.show(caster, "caster");
    scene.set_light("light", parallel ? directional(Vec3(1, 0, -1)) : point(Vec3(-5, 0, 5)));
    app::Session session = shadow_session(scene, ShadowMode::hard, size);
    Settings& s = session.settings();
    s.shadows.resolution = resolution;
    s.camera.projection = Projection::orthographic;
    s.camera.ortho_height = 6;
    s.camera.target = Vec3d(0, 0, 0);
    s.camera.position = Vec3d(0, 0, 10);
    s.camera.azimuth_deg = 0;
    s.edl.enabled = true;
    session.allow_native_geometry(native);
    return session;
}

Mesh drawn_as(const Mesh& mesh, DrawMode mode) {
    Style style = mesh.style();
    style.mode = mode;
    Mesh result = mesh.clone();
    result.set_style(style);
    result.set_material(matt());
    return result;
}

Mesh surfel(const Vec3& at, const Vec3& normal, const Vec3& tangent, float other) {
    Array3f::Dense V(1, 3), N(1, 3), T(1, 3);
    V << at.x(), at.y(), at.z();
    N << normal.x(), normal.y(), normal.z();
    T << tangent.x(), tangent.y(), tangent.z();
    Array1f::Dense B(1);
    B << other;
    MeshData data;
    data.V = Array3f(V);
    data.N = Array3f(N);
    data.T = Array3f(T);
    data.B = Array1f(B);
    const Mesh mesh(data);
    return drawn_as(mesh, DrawMode::surfels);
}

/// Checks every pixel of the floor that is not under the caster: shadowed where inside() is positive, lit
/// where it is negative, by more than a distance.
template <class Inside>
void expect_shadow(app::Session& session, double within, const char* what, Inside&& inside) {
    const LitParts lit = lit_parts(session);
    int shadowed = 0;
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            const Vec3d p = lit.position(x, y);
            if (lit.at(x, y) < 0 || std::abs(p.z()) > 1e-3) continue;
            const double depth = inside(p.x(), p.y());
            if (depth > within) {
                EXPECT_EQ(lit.at(x, y), 0) << what << " at " << p.x() << ", " << p.y();
            }
            if (depth < -within) {
                EXPECT_EQ(lit.at(x, y), 1) << what << " at " << p.x() << ", " << p.y();
            }
            shadowed += depth > within;
        }
    EXPECT_GT(shadowed, 300) << what;
}

// A disc at height 1.5 that lies flat, its shadow the same disc, 1.5 further; an ellipse likewise.
TEST(SplatShadow, OfASurfel) {
    for (const auto& [other, native] :
         {std::pair(0.8f, true), std::pair(0.5f, true), std::pair(0.5f, false)}) {
        Scene scene;
        app::Session session =
            session_over(scene, surfel(Vec3(-1.5f, 0, 1.5f), Vec3(0, 0, 1), Vec3(0.8f, 0, 0), other), native);
        // A texel, and how far the surfel is pushed back: a quarter of its radius along the light, which
        // moves nothing in parallel light.
        expect_shadow(session, 1.5 * texel, "surfel", [&](double x, double y) {
            const double r = std::hypot(x / 0.8, y / other);
            return (1 - r) * other;
        });
    }
}

// A lamp close to a disc, which parts of a cube's sides see from its edge, before and behind them. It is
// pushed to a height of 0.8 and seen from 1.3.
TEST(SplatShadow, OfASurfelAtALamp) {
    for (const bool native : {true, false}) {
        Scene scene;
        app::Session session =
            session_over(scene, surfel(Vec3(0, 0, 1), Vec3(0, 0, 1), Vec3(0.8f, 0, 0), 0.8f), native);
        scene.set_light("light", point(Vec3(0, 0, 1.3f)));
        // Towards the side a texel is 0.026 wide on the floor.
        expect_shadow(session, 0.08, native ? "native" : "driver",
                      [](double x, double y) { return 0.8 * 1.3 / 0.5 - std::hypot(x, y); });
    }
}

// Surfels that a mask leaves out cast nothing.
TEST(SplatShadow, OfMaskedSurfels) {
    for (const float cutoff : {0.3f, 0.5f}) {
        Mesh disc = surfel(Vec3(-1.5f, 0, 1.5f), Vec3(0, 0, 1), Vec3(0.8f, 0, 0), 0.8f);
        Material masked = matt();
        masked.alpha_mode = AlphaMode::mask;
        masked.opacity = 0.4f;
        masked.alpha_cutoff = cutoff;
        disc.set_material(masked);
        Scene scene;
        app::Session session = session_over(scene, disc, true);
        const LitParts lit = lit_parts(session);
        int shadowed = 0;
        for (int y = 0; y < size; ++y)
            for (int x = 0; x < size; ++x) shadowed += lit.at(x, y) == 0;
        // Pi 0.8^2 of 36 is a part of 0.056, of which the disc hides nothing from above.
        EXPECT_NEAR(shadowed, cutoff < 0.4f ? 0.056 * size * size : 0, 40) << cutoff;
    }
}

// A cloud in a square, at points and without and with normals: its shadow is that of a square with rounded
// corners, larger by the points' radius.
TEST(SplatShadow, OfADenseCloud) {
    constexpr int side = 80;
    const float spacing = 1.6f / (side - 1);
    for (const bool native : {true, false})
        for (const bool parallel : {true, false})
            for (const bool with_normals : {false, true}) {
                Array3f::Dense V(side * side, 3), N(side * side, 3);
                for (int i = 0; i < side * side; ++i) {
                    V.row(i) << -2.3f + spacing * float(i % side), -0.8f + spacing * float(i / side), 1.5f;
                    N.row(i) << 0, 0, 1;
                }
                Mesh cloud;
                cloud.set_V(Array3f(V));
                if (with_normals) cloud.set_N(Array3f(N));
                Scene scene;
                app::Session session =
                    session_over(scene, drawn_as(cloud, DrawMode::points), native, parallel);
                // From the lamp at (-5, 0, 5) the square at height 1.5 looks 10 / 7 as large on the floor.
                const double k = parallel ? 1 : 5 / 3.5, x0 = parallel ? -0.8 : -5 + (-2.3 + 5) * k;
                const double half = 0.8 * k;
                // The discs' radius, 0.75 spacings, stands out; they are pushed by as much again.
                const double within = 1.5 * texel * k + 2 * 0.75 * spacing * k;
                expect_shadow(session, within, native ? "native" : "driver", [&](double x, double y) {
                    return half - std::max(std::abs(x - x0 - half), std::abs(y));
                });
            }
}

/// Mean lit part of a unit ball where it faces the light to `degrees`, of more than 2000 pixels.
double mean_lit(const LitParts& lit, double degrees) {
    double sum = 0;
    int count = 0;
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            if (lit.at(x, y) < 0) continue;
            const Vec3d n = lit.position(x, y).normalized();
            if (n.dot(Vec3d(0.6, 0, 0.8)) < std::cos(radians(degrees))) continue;
            sum += lit.at(x, y);
            ++count;
        }
    EXPECT_GT(count, 2000);
    return sum / count;
}

// A cloud in the round, lit by a light: the half that faces it is lit, the other is not, and it does not
// shadow itself. The same of surfels.
TEST(SplatShadow, DoesNotFallOnItself) {
    const Mesh ball = make_sphere(1, 128);
    for (const DrawMode mode : {DrawMode::points, DrawMode::surfels})
        for (const bool native : {true, false}) {
            Mesh cloud;
            cloud.set_V(ball.V());
            cloud.set_N(ball.N());
            Scene scene;
            scene.show(drawn_as(cloud, mode), "ball");
            scene.set_light("light", directional(Vec3(-0.6f, 0, -0.8f)));
            app::Session session = shadow_session(scene, ShadowMode::soft, size);
            session.allow_native_geometry(native);
            look_from(session, Vec3d(2, -3, 2.5), 36);
            EXPECT_GT(mean_lit(lit_parts(session), 70), 0.99)
                << "mode " << int(mode) << ", native " << native;
        }
}

// Surfels so large that the ball bends by a hundredth of its radius within one: pushed back by a quarter of
// their size they do not shadow their neighbours.
TEST(SplatShadow, OfLargeSurfelsDoesNotFallOnTheirNeighbours) {
    const Mesh ball = make_sphere(1, 24);
    Mesh cloud;
    cloud.set_V(ball.V());
    cloud.set_N(ball.N());
    Scene scene;
    scene.show(drawn_as(cloud, DrawMode::surfels), "ball");
    scene.set_light("light", directional(Vec3(-0.6f, 0, -0.8f)));
    app::Session session = shadow_session(scene, ShadowMode::hard, size);
    look_from(session, Vec3d(2, -3, 2.5), 36);
    EXPECT_GT(mean_lit(lit_parts(session), 60), 0.99);
}

// A card of a mesh over a cloud that is lit: what lies under it is dark.
TEST(SplatShadow, FallsOnPointsAndSurfels) {
    for (const DrawMode mode : {DrawMode::points, DrawMode::surfels}) {
        constexpr int side = 150;
        Array3f::Dense V(side * side, 3), N(side * side, 3);
        for (int i = 0; i < side * side; ++i) {
            V.row(i) << -2 + 4.0f / (side - 1) * float(i % side), -2 + 4.0f / (side - 1) * float(i / side), 0;
            N.row(i) << 0, 0, 1;
        }
        Mesh cloud;
        cloud.set_V(Array3f(V));
        cloud.set_N(Array3f(N));
        Scene scene;
        scene.show(drawn_as(cloud, mode), "cloud");
        scene.show(rectangle(-1.8f, -0.6f, -0.6f, 0.6f, 1), "card");
        scene.set_light("light", directional(Vec3(1, 0, -1)));
        app::Session session = shadow_session(scene, ShadowMode::hard, size);
        look_from(session, Vec3d(0, -1, 6), 40);
        const LitParts lit = lit_parts(session);
        int inside = 0, outside = 0;
        for (int y = 0; y < size; ++y)
            for (int x = 0; x < size; ++x) {
                const Vec3d p = lit.position(x, y);
                if (lit.at(x, y) < 0 || std::abs(p.z()) > 0.03) continue;
                const double depth = 0.6 - std::max(std::abs(p.x() + 0.2), std::abs(p.y()));
                if (depth > 0.1) {
                    EXPECT_LT(lit.at(x, y), 0.01f) << p.x() << ", " << p.y() << " mode " << int(mode);
                    ++inside;
                }
                if (depth < -0.1 && std::max(std::abs(p.x()), std::abs(p.y())) < 1.9) {
                    EXPECT_GT(lit.at(x, y), 0.99f) << p.x() << ", " << p.y() << " mode " << int(mode);
                    ++outside;
                }
            }
        EXPECT_GT(inside, 500);
        EXPECT_GT(outside, 2000);
    }
}

// Maps are kept while only the camera moves; a moved, recoloured or resized cloud draws what it must.
TEST(SplatShadow, MapsAreKept) {
    Scene scene;
    Mesh cloud;
    cloud.set_V(make_sphere(0.5f, 32).V());
    Mesh points = drawn_as(cloud, DrawMode::points);
    app::Session session = session_over(scene, points, true);
    session.settings().shadows.enabled = true;
    render_linear(session);
    const uint64_t first = session.shadow_maps_drawn();
    for (int i = 0; i < 5; ++i) {
        session.settings().camera.position = Vec3d(0.1 * i, 0, 10);
        render_linear(session);
    }
    EXPECT_EQ(session.shadow_maps_drawn(), first);
    points = drawn_as(cloud, DrawMode::points);
    points.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(0.1, 0, 0)));
    scene.show(points, "caster");
    render_linear(session);
    EXPECT_EQ(session.shadow_maps_drawn(), first + 1);
    Style style = points.style();
    style.point_size = 0.3f;
    style.point_size_unit = SizeUnit::world;
    points.set_style(style);
    render_linear(session);
    EXPECT_EQ(session.shadow_maps_drawn(), first + 2);
}

// A cloud without normals keeps its own colours: no map is drawn until something stands by that light falls
// on.
TEST(SplatShadow, NothingIsDrawnForWhatReceivesNone) {
    Scene scene;
    Mesh cloud;
    cloud.set_V(make_sphere(0.5f, 32).V());
    scene.show(cloud, "cloud");
    scene.set_light("sun", directional(Vec3(0, 0, -1)));
    app::Session session(scene);
    session.settings().shadows.enabled = true;
    session.settings().image.size = {64, 64};
    render_linear(session);
    EXPECT_EQ(session.shadow_maps_drawn(), 0u);
    scene.show(make_sphere(0.5f, 32), "lit");
    render_linear(session);
    EXPECT_GT(session.shadow_maps_drawn(), 0u);
}

}  // namespace
}  // namespace easypbr::splat_shadow_test
