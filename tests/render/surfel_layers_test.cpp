// Blended surfels against the closed form C = sum a_i c_i prod (1 - a_j), j in front of i: what overlaps of
// one surface counts once.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "render_test.h"

#include "easypbr/scene/settings.h"

namespace easypbr::render::surfel_layers_test {
namespace {

struct Sheet {
    double z;
    Vec3 color;
    float opacity;
};

/// Surfels on a square in the plane z = 0, turned at random, each pixel under four or five of them, in any
/// order.
MeshData surfels(int n, float half, std::mt19937& random) {
    const float spacing = 2 * half / float(n - 1);
    std::uniform_real_distribution<float> uniform(-1, 1);
    std::vector<int> order(size_t(n * n));
    std::iota(order.begin(), order.end(), 0);
    std::ranges::shuffle(order, random);
    Array3f::Dense V(n * n, 3), N(n * n, 3), T(n * n, 3);
    Array1f::Dense B(n * n);
    for (int row = 0; row < n * n; ++row) {
        const int i = order[size_t(row)];
        V.row(row) << (float(i % n) + 0.2f * uniform(random)) * spacing - half,
            (float(i / n) + 0.2f * uniform(random)) * spacing - half, 0;
        N.row(row) << 0, 0, 1;
        const float angle = 3 * uniform(random);
        T.row(row) << 1.4f * spacing * std::cos(angle), 1.4f * spacing * std::sin(angle), 0;
        B[row] = 1.1f * spacing;
    }
    MeshData data;
    data.V = Array3f(V);
    data.N = Array3f(N);
    data.T = Array3f(T);
    data.B = Array1f(B);
    data.style.mode = DrawMode::surfels;
    data.style.lit = false;
    return data;
}

Material of(const Sheet& sheet) {
    Material m;
    m.base_color = sheet.color;
    m.opacity = sheet.opacity;
    m.alpha_mode = AlphaMode::blend;
    return m;
}

Mesh sheet_of_surfels(const Sheet& sheet, std::mt19937& random, float half = 1.5f) {
    MeshData data = surfels(40, half, random);
    data.materials = {of(sheet)};
    Mesh mesh(data);
    mesh.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(0, 0, sheet.z)));
    return mesh;
}

Vec4 composed(std::vector<Sheet> sheets) {
    std::ranges::sort(sheets, std::greater{}, &Sheet::z);
    Vec4 out(0, 0, 0, 0);
    float through = 1;
    for (const Sheet& s : sheets) {
        out.head<3>() += through * s.opacity * s.color;
        through *= 1 - s.opacity;
    }
    out[3] = 1 - through;
    return out;
}

/// The largest difference from one colour over the picture, all of which sees the same sheets.
float worst(const Image& image, const Vec4& expected) {
    float largest = 0;
    for (size_t i = 0; i < image.pixel_count(); ++i)
        largest = std::max(largest, (Vec4(&image.pixels<float>()[4 * i]) - expected).cwiseAbs().maxCoeff());
    return largest;
}

/// What the issue asks for. Display colours are kept in halves (2^-11), opacities in 16 bits.
constexpr float tolerance = 2.0f / 255;

const Sheet red{0, Vec3(0.9f, 0.1f, 0), 0.4f}, green{0.5, Vec3(0, 0.8f, 0.2f), 0.6f},
    blue{0.9, Vec3(0.1f, 0.2f, 1), 0.25f};

TEST(SurfelLayers, StackedPlanesInAnyOrder) {
    std::mt19937 random(1);
    std::vector<Sheet> sheets = {red, green, blue};
    for (const double tilt : {0.0, 40.0})
        for (const Projection projection : {Projection::perspective, Projection::orthographic})
            for (int turn = 0; turn < 3; ++turn) {
                std::ranges::rotate(sheets, sheets.begin() + 1);
                Scene scene;
                for (size_t i = 0; i < sheets.size(); ++i)
                    scene.show(sheet_of_surfels(sheets[i], random), std::to_string(i));
                app::Session session = plain_session(scene, 64);
                session.settings().camera.projection = projection;
                session.settings().camera.ortho_height = 0.8;
                const double a = radians(tilt);
                look_from(session, Vec3d(0, 6 * std::sin(a), 6 * std::cos(a)), 8);
                EXPECT_LE(worst(render_linear(session), composed(sheets)), tolerance)
                    << tilt << " " << int(projection) << " " << turn;
            }
}

// The sheets of one object are as many layers as they are apart by more than a surfel's size.
TEST(SurfelLayers, StackedPlanesOfOneObject) {
    std::mt19937 random(2);
    MeshData data = surfels(40, 1.5f, random);
    const Eigen::Index n = data.V.rows();
    const auto twice = [&](auto& array) {
        using ArrayType = std::remove_reference_t<decltype(array)>;
        typename ArrayType::Dense both(2 * n, array.cols());
        both << array.matrix(), array.matrix();
        array = ArrayType(both);
    };
    twice(data.V), twice(data.N), twice(data.T), twice(data.B);
    ArrayXf::Dense C(2 * n, 4);
    Array3f::Dense V = data.V;
    for (Eigen::Index i = 0; i < 2 * n; ++i) {
        V(i, 2) = i < n ? 0 : 0.4f;
        C.row(i) << float(i < n), float(i >= n), 0, (i < n ? 153.0f : 102.0f) / 255;
    }
    data.V = Array3f(V);
    data.C = ArrayXf(C);
    data.materials = {of({0, Vec3::Ones(), 1})};
    Scene scene;
    scene.show(Mesh(data), "both");
    app::Session session = plain_session(scene, 64);
    look_from(session, Vec3d(0, 0, 6), 8);
    EXPECT_LE(worst(render_linear(session), composed({{0, Vec3(1, 0, 0), 0.6f}, {0.4, Vec3(0, 1, 0), 0.4f}})),
              tolerance);
}

// Objects count apart however near they are: here by less than a tenth of a surfel, the nearer one tilted so
// that its own splats differ.
TEST(SurfelLayers, ObjectsAreNotMerged) {
    std::mt19937 random(3);
    Sheet near = green;
    near.z = red.z + 0.01;
    Scene scene;
    scene.show(sheet_of_surfels(red, random), "red");
    scene.show(sheet_of_surfels(near, random), "green");
    app::Session session = plain_session(scene, 64);
    look_from(session, Vec3d(0, 2, 6), 8);
    EXPECT_LE(worst(render_linear(session), composed({red, near})), tolerance);
}

// Meshes between and behind, the last one not transparent at all; in every mode of transparency.
TEST(SurfelLayers, AmongMeshes) {
    std::mt19937 random(4);
    Sheet wall{-1, Vec3(1, 1, 1), 1}, between{0.25, Vec3(0.3f, 0.9f, 0.9f), 0.5f};
    Scene scene;
    scene.show(sheet_of_surfels(green, random), "green");
    for (const Sheet& sheet : {wall, between}) {
        Mesh mesh = facing_square(2, of(sheet));
        Style display;
        display.lit = false;
        mesh.set_style(display);
        mesh.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(0, 0, sheet.z)));
        scene.show(mesh, sheet.opacity == 1 ? "wall" : "between");
    }
    scene.show(sheet_of_surfels(red, random), "red");
    app::Session session = plain_session(scene, 64);
    look_from(session, Vec3d(0, 1, 6), 8);
    EXPECT_LE(worst(render_linear(session), composed({wall, between, green, red})), tolerance);
    // The wall is a layer too: of three the last one holds the nearest surface of what is left.
    session.settings().transparency.max_layers = 2;
    EXPECT_LE(worst(render_linear(session), composed({wall, red, green})), tolerance);
    session.settings().transparency.max_layers = 8;
    // Random is what meshes are alone: the mean of 64 x 64 pixels of 64 samples errs by 0.5 / 512.
    session.settings().transparency.mode = TransparencyMode::stochastic;
    const Image image = render_linear(session, 64);
    Vec4 sum = Vec4::Zero();
    for (size_t i = 0; i < image.pixel_count(); ++i)
        sum += Vec4(&image.pixels<float>()[4 * i]) / float(image.pixel_count());
    EXPECT_LE((sum - composed({wall, between, green, red})).cwiseAbs().maxCoeff(), tolerance);
}

// Lit as an opaque surface of half the weight.
TEST(SurfelLayers, AreLit) {
    std::mt19937 random(5);
    Scene scenes[2];
    for (const float opacity : {1.0f, 0.5f}) {
        Sheet sheet = red;
        sheet.opacity = opacity;
        Mesh mesh = sheet_of_surfels(sheet, random);
        mesh.set_style([] {
            Style style;
            style.mode = DrawMode::surfels;
            return style;
        }());
        Material material = mesh.material();
        material.alpha_mode = opacity < 1 ? AlphaMode::blend : AlphaMode::opaque;
        mesh.set_material(material);
        Scene& scene = scenes[opacity < 1];
        scene.show(mesh, "sheet");
        scene.set_environment(constant_environment(1));
    }
    Vec4 seen[2];
    for (int i = 0; i < 2; ++i) {
        app::Session session = plain_session(scenes[i], 32);
        session.settings().environment.enabled = true;
        look_from(session, Vec3d(0, 1, 6), 8);
        const Image image = render_linear(session);
        seen[i] = Vec4(image.at<float>(16, 16));
        EXPECT_LE(worst(image, seen[i]), 0.005f);
    }
    EXPECT_GT(seen[0][0], 0.3f);
    EXPECT_LE((seen[0] / 2 - seen[1]).cwiseAbs().maxCoeff(), 0.002f);
}

// A mask cuts out surfels below its cutoff, natively too; ground truth has blended ones from one half on.
TEST(SurfelLayers, MasksAndGroundTruth) {
    std::mt19937 random(6);
    for (const AlphaMode mode : {AlphaMode::mask, AlphaMode::blend})
        for (const bool native : {true, false}) {
            MeshData data = surfels(40, 1.5f, random);
            ArrayXf::Dense C(data.V.rows(), 4);
            for (Eigen::Index i = 0; i < C.rows(); ++i) C.row(i) << 1, 1, 1, data.V(i, 0) < 0 ? 0.3f : 0.7f;
            data.C = ArrayXf(C);
            data.materials = {of({0, Vec3::Ones(), 1})};
            data.materials[0].alpha_mode = mode;
            Scene scene;
            scene.show(Mesh(data), "half");
            app::Session session = plain_session(scene, 64);
            session.allow_native_geometry(native);
            look_from(session, Vec3d(0, 0, 6), 8);
            const Image depth = session.render_layers({"depth"}).at("depth");
            EXPECT_EQ(*depth.at<float>(10, 32), 0.0f);
            EXPECT_NEAR(*depth.at<float>(54, 32), 6, 1e-3);
            const Image image = render_linear(session);
            EXPECT_NEAR(image.at<float>(10, 32)[3], mode == AlphaMode::mask ? 0 : 0.3, tolerance);
            EXPECT_NEAR(image.at<float>(54, 32)[3], mode == AlphaMode::mask ? 1 : 0.7, tolerance);
        }
}

}  // namespace
}  // namespace easypbr::render::surfel_layers_test
