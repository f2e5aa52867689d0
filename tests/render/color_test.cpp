// Colours of labels, vertices and materials in the picture.
#include <algorithm>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <random>
#include <vector>

#include "easypbr/core/color.h"
#include "easypbr/gpu/packing.h"
#include "easypbr/render/drawables/draw_list.h"
#include "easypbr/scene/element_colors.h"
#include "easypbr/scene/resolve.h"
#include "easypbr/scene/settings.h"
#include "render_test.h"

namespace easypbr::render::color_test {
namespace {

MeshData labelled_cloud(int n) {
    std::mt19937 random(3);
    std::normal_distribution<float> normal;
    Array3f::Dense V(n, 3);
    Array1i::Dense L(n);
    for (int i = 0; i < n; ++i) {
        const Vec3 p = Vec3(normal(random), normal(random), normal(random)).normalized();
        V.row(i) << p.x(), p.y(), p.z();
        L[i] = int(random() % 20);
    }
    MeshData data;
    data.V = Array3f(V);
    data.L = Array1i(L);
    return data;
}

std::vector<Rgba8> table_of(const MeshData& data) {
    const ColorPlan plan =
        plan_colors(data, {}, DrawMode::points, Eigen::Affine3d::Identity(), Vec3d::UnitY());
    return element_colors(data, plan).colors;
}

}  // namespace

// At every pixel that has a point, the picture is its label's colour, whatever the samples, tone curve, light
// and anti-aliasing are.
TEST(Colors, OfLabelsAreExact) {
    const MeshData data = labelled_cloud(5000);
    const std::vector<Rgba8> colors = table_of(data);
    Scene scene;
    scene.show(Mesh(data), "cloud");
    for (const bool native : {true, false})
        for (const int samples : {1, 8}) {
            app::Session session(scene);
            session.allow_native_geometry(native);
            session.settings().image.size = Vec2i(160, 120);
            session.settings().tonemap.exposure_compensation = 1.5f;
            session.settings().style.point_size = 6;  // covers most of the sphere
            const Image picture = session.render({std::nullopt, samples, app::Encoding::srgb8});
            const Image element = session.render_layers({"element_id"}).at("element_id");
            int covered = 0;
            for (int y = 0; y < 120; ++y)
                for (int x = 0; x < 160; ++x) {
                    const auto i = size_t(*element.at<float>(x, y));
                    if (i == 0) continue;
                    ++covered;
                    for (size_t c = 0; c < 3; ++c)
                        ASSERT_EQ(int(picture.at<uint8_t>(x, y)[c]), int(colors[i - 1][c]))
                            << native << ' ' << samples << ' ' << x << ' ' << y;
                }
            EXPECT_GT(covered, 4000);
        }
}

// Pixels beside an exact surface hold no trace of it: its edges are not smoothed.
TEST(Colors, OfLabelsLeaveTheBackgroundAlone) {
    MeshData data = labelled_cloud(3000);
    Scene scene;
    scene.show(Mesh(data), "cloud");
    app::Session session(scene);
    session.settings().image.size = Vec2i(160, 120);
    session.settings().background.color = Vec3(0, 0, 0);
    const Image element = session.render_layers({"element_id"}).at("element_id");
    for (const int samples : {1, 8}) {
        const Image picture = session.render({std::nullopt, samples, app::Encoding::srgb8});
        for (int y = 0; y < 120; ++y)
            for (int x = 0; x < 160; ++x) {
                if (*element.at<float>(x, y) > 0) continue;
                for (int c = 0; c < 3; ++c) ASSERT_EQ(int(picture.at<uint8_t>(x, y)[c]), 0);
            }
    }
}

// What a picture before held where now there is nothing is not drawn again.
TEST(Colors, OfLabelsLeaveNoTraceWhereTheyWere) {
    Mesh mesh = facing_square(0.5f);
    mesh.edit([](MeshData& d) {
        d.L = Array1i(Array1i::Dense::Constant(d.F.rows(), 1));
        d.style.lit = false;
    });
    Scene scene;
    scene.show(mesh, "square");
    for (const bool native : {true, false}) {
        app::Session session = plain_session(scene, 64);
        session.allow_native_geometry(native);
        session.allow_native_shading(native);
        const auto alpha_at = [&](double x, int column) {
            session.settings().camera.position = Vec3d(x, 0, 8);
            session.settings().camera.target = Vec3d(x, 0, 0);
            const Image picture = session.render({std::nullopt, 1, app::Encoding::srgb8});
            return int(picture.at<uint8_t>(column, 32)[3]);
        };
        EXPECT_EQ(alpha_at(1, 17), 255);
        EXPECT_EQ(alpha_at(-1, 17), 0) << native;
        EXPECT_EQ(alpha_at(-1, 46), 255);
    }
}

// What colours faces need not fit vertices: dots on a mesh have the colours that a cloud of its vertices has.
TEST(Colors, OfVerticesOnTopOfFacesAreThoseOfACloud) {
    const auto make = [](const std::function<void(MeshData&)>& add) {
        Mesh mesh = facing_square(1);
        mesh.edit([&](MeshData& d) {
            add(d);
            d.style.show_points = true;
            d.style.lit = false;
        });
        return mesh;
    };
    Array1f::Dense values(4);
    values << 0, 1, 2, std::numeric_limits<float>::quiet_NaN();
    Array1i::Dense labels(2);
    labels << 1, 5;
    const Mesh by_scalars = make([&](MeshData& d) { d.scalars = {{"x", Array1f(values)}}; });
    const Mesh by_labels = make([&](MeshData& d) { d.L = Array1i(labels); });
    for (const Mesh& mesh : {by_scalars, by_labels})
        for (const bool cut : {false, true}) {
            Scene scene;
            scene.show(mesh, "square");
            app::Session session = plain_session(scene, 64);
            // Nothing is cut away, but what is drawn went through the cut.
            if (cut) session.settings().clip.planes = {1, 0, 0, 2};
            const ResolvedSettings resolved = session.resolve();
            SpacingCache spacings;
            DrawableCache drawables(spacings);
            const DrawableScene drawable = drawables.apply(scene.snapshot(), resolved.settings);
            const DrawList list = draw_list(drawable, resolved.settings, Material());
            ASSERT_EQ(list.of(DrawMode::points).size(), 1u);
            const DrawItem& points = list.of(DrawMode::points)[0];
            EXPECT_TRUE(points.with_colors);
            EXPECT_EQ(points.kind, SurfaceKind::exact);
            const std::vector<Rgba8> expected = table_of(*mesh.snapshot());
            ASSERT_EQ(points.mesh().C.rows(), 4);
            for (int i = 0; i < 4; ++i) {
                const uint32_t vertex = drawable.sources[0].own(point_element | uint32_t(i + 1)) - 1;
                EXPECT_EQ(gpu::rgba8(points.mesh().C, i), expected[vertex]) << i;
            }
        }
}

TEST(Colors, OfVoxelsNameTheirOwnElements) {
    Array3f::Dense V(2, 3);
    V << -1, 0, 0, 1, 0, 0;
    MeshData data;
    data.V = Array3f(V);
    data.voxel_size = 1.5f;
    Scene scene;
    scene.show(Mesh(data), "voxels");
    app::Session session = plain_session(scene, 64);
    look_from(session, Vec3d(0, 0, 10));
    const Image element = session.render_layers({"element_id"}).at("element_id");
    EXPECT_EQ(*element.at<float>(20, 32), 1.0f);
    EXPECT_EQ(*element.at<float>(44, 32), 2.0f);
}

// A triangle of one colour under a default material is drawn as under a white one, under a given 0.6 darker.
TEST(Colors, OfVerticesAreTimesAGivenFactor) {
    const auto factor = [](bool is_given) {
        MeshData data;
        data.V = Array3f::Dense{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
        data.F = Array3i::Dense{{0, 1, 2}};
        data.C = ArrayXf::Dense::Constant(3, 3, 1.0f);
        data.materials.resize(1);
        data.materials[0].base_color_given = is_given;
        Scene scene;
        scene.show(Mesh(data), "triangle");
        app::Session session(scene);
        session.settings().image.size = Vec2i(32, 32);
        return Vec3(Eigen::Map<const Vec3>(session.render_layers({"albedo"}).at("albedo").at<float>(16, 16)));
    };
    // Half precision, if layers have it: 2^-11 of the value.
    EXPECT_NEAR(factor(false).x(), 1, 1e-3);
    EXPECT_NEAR(factor(true).x(), 0.6, 1e-3);
}

// A texture of 200 is drawn as it is under a default material, under a given 0.6 darker, by rays as well;
// what does not show the texture keeps the default.
TEST(Colors, OfTexturesAreTimesAGivenFactor) {
    const auto mean_of = [](const Material& material, std::optional<ColorBy> by, bool with_uv, bool path) {
        Mesh mesh = facing_square(4, material);
        mesh.edit([&](MeshData& d) {
            if (by) d.style.color_by = *by;
            if (!with_uv) d.UV = {};
        });
        Scene scene;
        scene.show(mesh, "square");
        app::Session session = plain_session(scene, 32);
        session.settings().path.enabled = path;
        return double(*session.render_layers({"albedo"}).at("albedo").at<float>(16, 16));
    };
    Material plain;
    auto image = std::make_shared<Image>(2, 2, 3, PixelType::u8);
    std::ranges::fill(image->pixels<uint8_t>(), uint8_t(200));
    plain.base_color_texture.image = image;
    Material given = plain;
    given.base_color_given = true;
    const double texel = double(linear_from_srgb(Vec3(Vec3::Constant(200 / 255.0f))).x());
    // Half precision, if layers have it: 2^-11 of the value.
    for (const bool path : {false, true}) {
        EXPECT_NEAR(mean_of(plain, {}, true, path), texel, 1e-3) << path;
        EXPECT_NEAR(mean_of(plain, ColorBy::texture, true, path), texel, 1e-3) << path;
        EXPECT_NEAR(mean_of(given, {}, true, path), 0.6 * texel, 1e-3) << path;
        EXPECT_NEAR(mean_of(plain, ColorBy::solid, true, path), 0.6, 1e-3) << path;
        EXPECT_NEAR(mean_of(plain, {}, false, path), 0.6, 1e-3) << path;
    }
}

}  // namespace easypbr::render::color_test
