// Blended surfaces against the closed form C = sum a_i c_i prod (1 - a_j), j in front of i. A ray caster of
// its own finds the surfaces that a pixel's centre sees.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "easypbr/core/color.h"
#include "easypbr/scene/settings.h"
#include "render_test.h"

namespace easypbr::transparency_test {
namespace {

/// Shown as it is, so that the closed form is known exactly.
Material flat_color(const Vec3& color, float opacity) {
    Material m;
    m.base_color = color;
    m.opacity = opacity;
    m.unlit = true;
    return m;
}

struct Ray {
    Vec3d origin, direction;
};

Ray ray_of(const Camera& camera, double x, double y, int width, int height) {
    const Mat4d p = camera.projection_matrix(double(width) / height);
    const double nx = (x + 0.5) / width * 2 - 1, ny = 1 - (y + 0.5) / height * 2;
    const Vec3d view((nx + p(0, 2)) / p(0, 0), (ny + p(1, 2)) / p(1, 1), -1);
    return {camera.position(), camera.T_world_cam.linear() * view};
}

struct Hit {
    double t;
    Vec3 color;
    float opacity;
};

/// All intersections with a mesh (Moller and Trumbore 1997); two on a shared edge count once.
std::vector<Hit> hits_of(const Mesh& mesh, const Ray& ray) {
    const auto data = mesh.snapshot();
    const Material m = mesh.material();
    std::vector<Hit> hits;
    for (Eigen::Index f = 0; f < data->F.rows(); ++f) {
        Vec3d corner[3];
        for (int k = 0; k < 3; ++k)
            corner[k] = data->T_parent_mesh * Vec3d(data->V.row(data->F(f, k)).transpose().cast<double>());
        const Vec3d e1 = corner[1] - corner[0], e2 = corner[2] - corner[0], p = ray.direction.cross(e2);
        const double det = e1.dot(p);
        if (std::abs(det) < 1e-14) continue;
        const Vec3d s = ray.origin - corner[0], q = s.cross(e1);
        const double u = s.dot(p) / det, v = ray.direction.dot(q) / det, t = e2.dot(q) / det;
        if (u < 0 || v < 0 || u + v > 1 || t <= 0) continue;
        float opacity = m.opacity;
        if (data->C.cols() == 4)
            opacity *= float((1 - u - v) * data->C(data->F(f, 0), 3) + u * data->C(data->F(f, 1), 3) +
                             v * data->C(data->F(f, 2), 3));
        const bool known = std::ranges::any_of(hits, [&](const Hit& h) { return std::abs(h.t - t) < 1e-9; });
        if (!known) hits.push_back({t, m.base_color, opacity});
    }
    return hits;
}

Vec4 composed(std::vector<Hit> hits) {
    std::ranges::sort(hits, {}, &Hit::t);
    Vec4 out(0, 0, 0, 0);
    float through = 1;
    for (const Hit& hit : hits) {
        out.head<3>() += through * hit.opacity * hit.color;
        through *= 1 - hit.opacity;
    }
    out[3] = 1 - through;
    return out;
}

struct Comparison {
    size_t compared = 0, most_hits = 0;
    double worst = 0;
};

/// The picture against the closed form, where the neighbours see as many surfaces: not on outlines.
Comparison compare_with_closed_form(const Image& image, const std::vector<Mesh>& meshes,
                                    const Camera& camera) {
    const int w = image.width(), h = image.height();
    std::vector<std::vector<Hit>> hits(image.pixel_count());
    for (int y = 0; y < h; ++y)
        for (int x = 0; x < w; ++x)
            for (const Mesh& mesh : meshes)
                for (const Hit& hit : hits_of(mesh, ray_of(camera, x, y, w, h)))
                    hits[size_t(y * w + x)].push_back(hit);
    Comparison result;
    for (int y = 1; y + 1 < h; ++y)
        for (int x = 1; x + 1 < w; ++x) {
            const auto& own = hits[size_t(y * w + x)];
            bool inside = true;
            for (int dy = -1; dy <= 1; ++dy)
                for (int dx = -1; dx <= 1; ++dx)
                    inside = inside && hits[size_t((y + dy) * w + x + dx)].size() == own.size();
            if (!inside) continue;
            const Vec4 expected = composed(own);
            const float* p = image.at<float>(x, y);
            for (int c = 0; c < 4; ++c)
                result.worst = std::max(result.worst, double(std::abs(p[c] - expected[c])));
            ++result.compared;
            result.most_hits = std::max(result.most_hits, own.size());
        }
    return result;
}

Mesh moved(Mesh mesh, const Eigen::Affine3d& T) {
    mesh.set_T_parent_mesh(T);
    return mesh;
}

std::vector<Mesh> five_quads() {
    const Vec3 colors[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {0.2f, 0.9f, 0.8f}};
    const float opacities[] = {0.5f, 0.25f, 0.9f, 0.4f, 0.7f};
    std::vector<Mesh> quads;
    for (int i = 0; i < 5; ++i)
        quads.push_back(moved(facing_square(1, flat_color(colors[i], opacities[i])),
                              Eigen::Affine3d(Eigen::Translation3d(0.15 * i, 0.1 * i, 0.3 * i))));
    return quads;
}

Image picture_of(const std::vector<Mesh>& meshes, const std::vector<size_t>& order, Camera& camera,
                 int samples = 1, int size = 48) {
    Scene scene;
    for (const size_t i : order) scene.show(meshes[i], "mesh " + std::to_string(i));
    app::Session session = plain_session(scene, size);
    look_from(session, Vec3d(1, 0.7, 6), 28);
    camera = session.camera();
    return render_linear(session, samples);
}

/// Opacity is kept in 16 bits; five layers add up to five halves of a step, far below the 2/255 that are
/// asked for.
constexpr double tolerance = 5.0 / 65535;

TEST(Transparency, FiveQuadsInAnyOrder) {
    const std::vector<Mesh> quads = five_quads();
    std::vector<size_t> order(quads.size());
    std::iota(order.begin(), order.end(), size_t(0));
    int count = 0;
    do {
        if (count++ % 7 != 0) continue;
        Camera camera;
        const Comparison c = compare_with_closed_form(picture_of(quads, order, camera), quads, camera);
        EXPECT_GT(c.compared, 1000u);
        EXPECT_EQ(c.most_hits, 5u);
        ASSERT_LE(c.worst, tolerance) << "order " << count;
    } while (std::ranges::next_permutation(order).found);
    EXPECT_EQ(count, 120);
}

TEST(Transparency, TwoQuadsThroughEachOther) {
    std::vector<Mesh> quads;
    for (const double angle : {-0.8, 0.7})
        quads.push_back(
            moved(facing_square(1, flat_color(angle < 0 ? Vec3(1, 0.2f, 0) : Vec3(0, 0.3f, 1), 0.6f)),
                  Eigen::Affine3d(Eigen::AngleAxisd(angle, Vec3d::UnitY()))));
    for (const auto& order : {std::vector<size_t>{0, 1}, std::vector<size_t>{1, 0}}) {
        Camera camera;
        const Comparison c = compare_with_closed_form(picture_of(quads, order, camera, 1, 96), quads, camera);
        EXPECT_GT(c.compared, 5000u);
        EXPECT_EQ(c.most_hits, 2u);
        EXPECT_LE(c.worst, tolerance);
    }
}

/// A band wound three times around a torus, overlapping itself: up to six surfaces along a ray.
Mesh knot(std::mt19937& random) {
    const int n = 240;
    Array3f::Dense V(2 * n, 3);
    Array3i::Dense F(2 * n, 3);
    for (int i = 0; i < n; ++i) {
        const double a = 2 * pi * i / n;
        for (int side = 0; side < 2; ++side) {
            const double r = 1 + 0.6 * std::cos(3 * a + 2.4 * side), z = 0.6 * std::sin(3 * a + 2.4 * side);
            V.row(2 * i + side) << float(r * std::cos(2 * a)), float(r * std::sin(2 * a)), float(z);
        }
        const int j = (i + 1) % n;
        F.row(2 * i) << 2 * i, 2 * j, 2 * i + 1;
        F.row(2 * i + 1) << 2 * j, 2 * j + 1, 2 * i + 1;
    }
    std::vector<int> faces(size_t(F.rows()));
    std::iota(faces.begin(), faces.end(), 0);
    std::ranges::shuffle(faces, random);
    Array3i::Dense shuffled(F.rows(), 3);
    for (size_t i = 0; i < faces.size(); ++i) shuffled.row(Eigen::Index(i)) = F.row(faces[i]);
    Mesh mesh{Array3f(V), Array3i(shuffled)};
    mesh.set_material(flat_color(Vec3(0.9f, 0.5f, 0.1f), 0.45f));
    return mesh;
}

TEST(Transparency, AMeshThatOverlapsItself) {
    std::mt19937 random(3);
    for (int turn = 0; turn < 3; ++turn) {
        // Seen from the side, where its windings lie behind each other.
        const std::vector<Mesh> meshes = {
            moved(knot(random), Eigen::Affine3d(Eigen::AngleAxisd(1.3, Vec3d::UnitX())))};
        Camera camera;
        const Comparison c = compare_with_closed_form(picture_of(meshes, {0}, camera, 1, 96), meshes, camera);
        EXPECT_GT(c.compared, 4000u);
        EXPECT_GE(c.most_hits, 4u);
        EXPECT_LE(c.worst, tolerance);
    }
}

TEST(Transparency, VerticesHaveAnOpacityOfTheirOwn) {
    Mesh mesh = facing_square(1, flat_color(Vec3(1, 0.5f, 0.25f), 0.8f));
    ArrayXf::Dense C(4, 4);
    C.setOnes();
    C.col(3) << 0.0f, 0.25f, 1.0f, 0.5f;
    mesh.edit([&](MeshData& data) { data.C = ArrayXf(C); });
    Camera camera;
    const std::vector<Mesh> meshes = {mesh};
    const Comparison c = compare_with_closed_form(picture_of(meshes, {0}, camera), meshes, camera);
    EXPECT_GT(c.compared, 200u);
    // Colours of vertices have 8 bits: half a step of 0.25.
    EXPECT_LE(c.worst, 0.5 / 255 * 0.8 + tolerance);
}

TEST(Transparency, OverOpaqueSurfacesAndHiddenByThem) {
    // Red behind, half blue in front of it, green in front of all on the left half of the picture.
    Mesh back = facing_square(4, flat_color(Vec3(1, 0, 0), 1));
    Mesh glass = moved(facing_square(4, flat_color(Vec3(0, 0, 1), 0.25f)),
                       Eigen::Affine3d(Eigen::Translation3d(0, 0, 1)));
    Mesh front = moved(facing_square(4, flat_color(Vec3(0, 1, 0), 1)),
                       Eigen::Affine3d(Eigen::Translation3d(-4, 0, 2)));
    for (const bool glass_first : {true, false}) {
        Scene scene;
        if (glass_first) scene.show(glass, "glass");
        scene.show(back, "back");
        scene.show(front, "front");
        if (!glass_first) scene.show(glass, "other name");
        app::Session session = plain_session(scene, 32);
        look_from(session, Vec3d(0, 0, 6), 28);
        const Image image = render_linear(session);
        EXPECT_EQ(Vec4(image.at<float>(4, 16)), Vec4(0, 1, 0, 1));
        EXPECT_TRUE(Vec4(image.at<float>(28, 16)).isApprox(Vec4(0.75f, 0, 0.25f, 1), 1e-4f));
    }
}

// One sample is as exact as many: no noise.
TEST(Transparency, SamplesAgree) {
    const std::vector<Mesh> quads = five_quads();
    Camera camera;
    const Image one = picture_of(quads, {0, 1, 2, 3, 4}, camera),
                many = picture_of(quads, {4, 2, 0, 1, 3}, camera, 4);
    for (const auto& [x, y] : {std::pair(24, 24), std::pair(20, 30), std::pair(27, 20)})
        for (int c = 0; c < 4; ++c) EXPECT_NEAR(one.at<float>(x, y)[c], many.at<float>(x, y)[c], tolerance);
}

// Of the layers beyond the limit only the nearest is drawn: with two, the two farthest and the nearest of
// five.
TEST(Transparency, LayersBeyondTheLimit) {
    std::vector<Mesh> quads = five_quads();
    Scene scene;
    for (size_t i = 0; i < quads.size(); ++i) {
        quads[i].set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(0, 0, 0.3 * double(i))));
        scene.show(quads[i], std::to_string(i));
    }
    app::Session session = plain_session(scene, 16);
    session.settings().transparency.max_layers = 2;
    look_from(session, Vec3d(0, 0, 6), 10);
    std::vector<Hit> seen;
    for (const size_t i : {0, 1, 4})
        seen.push_back({-double(i), quads[i].material().base_color, quads[i].material().opacity});
    EXPECT_TRUE(Vec4(render_linear(session).at<float>(8, 8)).isApprox(composed(seen), 1e-4f));
}

TEST(Transparency, PointsBlendInAnyOrder) {
    // Three points behind each other, each larger than the picture's centre.
    std::vector<size_t> order = {0, 1, 2};
    const float alphas[] = {0.5f, 0.25f, 0.8f};
    do {
        Array3f::Dense V(3, 3);
        ArrayXf::Dense C(3, 4);
        for (int i = 0; i < 3; ++i) {
            const auto k = Eigen::Index(order[size_t(i)]);
            V.row(i) << 0, 0, float(k);
            C.row(i) << float(k == 0), float(k == 1), float(k == 2), alphas[k];
        }
        MeshData data;
        data.V = Array3f(V);
        data.C = ArrayXf(C);
        Material white;
        white.base_color = Vec3::Ones();
        data.materials = {white};
        data.style.point_size = 20.0f;
        data.style.lit = false;
        Scene scene;
        scene.show(Mesh(data), "points");
        app::Session session = plain_session(scene, 32);
        session.settings().edl.enabled = false;
        look_from(session, Vec3d(0, 0, 6), 28);
        std::vector<Hit> expected;
        for (int k = 0; k < 3; ++k)
            expected.push_back({-double(k), Vec3(float(k == 0), float(k == 1), float(k == 2)), alphas[k]});
        const Vec4 got(render_linear(session).at<float>(16, 16)), want = composed(expected);
        // Opacities of vertices have 8 bits, and display colours are kept in halves.
        EXPECT_LE((got - want).cwiseAbs().maxCoeff(), 1.5 / 255)
            << got.transpose() << " for " << want.transpose();
    } while (std::ranges::next_permutation(order).found);
}

// Light in front of a colour that is shown past the tone curve, and the other way round: both are mixed as
// they are shown.
TEST(Transparency, DisplayColoursAndLightMix) {
    for (const bool light_in_front : {true, false}) {
        Mesh lit = facing_square(4, flat_color(Vec3(0.5f, 0, 0), 0.5f));
        Mesh display = facing_square(4, flat_color(Vec3(0, 0.8f, 0), 0.25f));
        display.set_material([&] {
            Material m = display.material();
            m.unlit = false;
            return m;
        }());
        Style as_it_is;
        as_it_is.lit = false;
        display.set_style(as_it_is);
        (light_in_front ? lit : display).set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(0, 0, 1)));
        Scene scene;
        scene.show(lit, "lit");
        scene.show(display, "display");
        app::Session session = plain_session(scene, 16);
        look_from(session, Vec3d(0, 0, 6), 10);
        session.settings().background.mode = BackgroundMode::color;
        session.settings().background.color = Vec3(0, 0, 1);
        const float e = 2;  // the exposure is for light alone
        session.settings().tonemap.exposure = e;
        const Vec3 red(0.5f * e, 0, 0), green(0, 0.8f, 0), blue(0, 0, 1);
        const Vec3 expected = light_in_front ? Vec3(0.5f * red + 0.5f * (0.25f * green + 0.75f * blue))
                                             : Vec3(0.25f * green + 0.75f * (0.5f * red + 0.5f * blue));
        const Image image = session.render();
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(image.at<uint8_t>(8, 8)[c], std::lround(255 * srgb_from_linear(expected[c])), 1)
                << light_in_front << " " << c;
    }
}

// Transparent pictures hold straight alpha: the colour of the surface, not darkened by its opacity.
TEST(Transparency, FilesHoldStraightAlpha) {
    Scene scene;
    scene.show(facing_square(4, flat_color(Vec3(0.8f, 0.4f, 0.2f), 0.5f)), "glass");
    app::Session session = plain_session(scene, 16);
    session.settings().tonemap.tone_operator = ToneOperator::aces;
    look_from(session, Vec3d(0, 0, 6), 10);
    const Image half = session.render();
    scene.get("glass").set_material(flat_color(Vec3(0.8f, 0.4f, 0.2f), 1));
    const Image whole = session.render();
    EXPECT_NEAR(half.at<uint8_t>(8, 8)[3], 127.5, 0.5);  // in the middle of two codes
    EXPECT_EQ(whole.at<uint8_t>(8, 8)[3], 255);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(half.at<uint8_t>(8, 8)[c], whole.at<uint8_t>(8, 8)[c], 1);
}

// Stochastic transparency has the right mean, for surfaces behind each other too: 64 samples of 1024 pixels
// leave 0.5 / sqrt(65536) = 0.002.
TEST(Transparency, StochasticMeansTheSame) {
    Mesh front = facing_square(100, flat_color(Vec3(1, 0, 0), 0.5f)),
         back = facing_square(100, flat_color(Vec3(0, 1, 0), 0.5f));
    back.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(0, 0, -1)));
    Scene scene;
    scene.show(front, "front");
    scene.show(back, "back");
    app::Session session = plain_session(scene, 32);
    session.settings().transparency.mode = TransparencyMode::stochastic;
    look_from(session, Vec3d(0, 0, 7));
    const Image image = render_linear(session, 64);
    Vec4 sum = Vec4::Zero();
    for (size_t i = 0; i < image.pixel_count(); ++i) sum += Vec4(image.pixels<float>().data() + 4 * i) / 1024;
    EXPECT_NEAR(sum[0], 0.5, 0.01);
    EXPECT_NEAR(sum[1], 0.25, 0.01);
    EXPECT_NEAR(sum[3], 0.75, 0.01);
}

// Depth, ids and albedo are of the nearest surface that is at least half opaque.
TEST(Transparency, LayersOfGroundTruth) {
    for (const float opacity : {0.4f, 0.6f}) {
        Mesh glass = facing_square(4, flat_color(Vec3(0, 0, 1), opacity));
        glass.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(0, 0, 1)));
        Scene scene;
        scene.show(facing_square(4, flat_color(Vec3(1, 0, 0), 1)), "back");
        scene.show(glass, "glass");
        app::Session session = plain_session(scene, 16);
        look_from(session, Vec3d(0, 0, 6), 10);
        const auto layers = session.render_layers({"depth", "albedo", "object_id"});
        const bool seen = opacity > 0.5f;
        EXPECT_NEAR(layers.at("depth").at<float>(8, 8)[0], seen ? 5 : 6, 1e-4);
        EXPECT_EQ(layers.at("albedo").at<float>(8, 8)[2], seen ? 1.0f : 0.0f);
        const float id = layers.at("object_id").at<float>(8, 8)[0];
        EXPECT_EQ(session.object_names().at(size_t(id) - 1), seen ? "glass" : "back");
    }
}

TEST(Transparency, NothingThereIsNoLayer) {
    Scene scene;
    scene.show(facing_square(1, flat_color(Vec3(1, 1, 1), 0)), "invisible");
    app::Session session = plain_session(scene, 16);
    look_from(session, Vec3d(0, 0, 6), 10);
    EXPECT_EQ(Vec4(render_linear(session).at<float>(8, 8)), Vec4(0, 0, 0, 0));
}

}  // namespace
}  // namespace easypbr::transparency_test
