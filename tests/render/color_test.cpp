// Colours of labels and scalars in the picture, and what is cut away or drawn over everything.
#include <algorithm>
#include <functional>
#include <limits>
#include <random>

#include "easypbr/core/color.h"
#include "easypbr/gpu/packing.h"
#include "easypbr/render/drawables/draw_list.h"
#include "easypbr/scene/element_colors.h"
#include "easypbr/scene/resolve.h"
#include "easypbr/scene/settings.h"
#include "render_test.h"

namespace easypbr::render::color_test {
namespace {

/// Of the plane z = 0, in the picture from above.
const double pixels_per_unit = 64 / (4 * std::tan(radians(15.0)));

/// Of 128 x 128 pixels, along -z.
Image picture_from_above(const Scene& scene, bool native) {
    app::Session session = plain_session(scene, 128);
    session.allow_native_geometry(native);
    look_from(session, Vec3d(0, 0, 4));
    return session.render({std::nullopt, 1, app::Encoding::srgb8});
}

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

// Unlit scalars on a coarse mesh: the value is interpolated, then mapped, so that a pixel shows the colour of
// its own value.
TEST(Colors, OfValuesAreThoseOfTheTable) {
    Mesh mesh = facing_square(1);
    mesh.edit([](MeshData& d) {
        Array1f::Dense values(4);
        for (int i = 0; i < 4; ++i) values[i] = d.V(i, 0);
        d.scalars = {{"x", Array1f(values)}};
        d.style.lit = false;
        d.style.color_by = ColorBy::scalar;
    });
    Scene scene;
    scene.show(mesh, "square");
    app::Session session = plain_session(scene, 128);
    look_from(session, Vec3d(0, 0, 4));
    const Image picture = session.render({std::nullopt, 1, app::Encoding::srgb8});
    const auto data = mesh.snapshot();
    const ColorPlan plan =
        plan_colors(*data, {}, DrawMode::mesh, Eigen::Affine3d::Identity(), Vec3d::UnitY());
    const ElementColors colors = element_colors(*data, plan);
    ASSERT_EQ(plan.source, ColorSource::values);
    // The square is 119.4 pixels wide, so that a pixel spans two of the 256 steps: either neighbour may be
    // hit.
    for (int x = 10; x < 118; ++x) {
        const auto value = float((x + 0.5 - 64) / pixels_per_unit);
        const int step = color_index(value, colors.range);
        int nearest = 255;
        for (int s = std::max(0, step - 1); s <= std::min(255, step + 1); ++s) {
            int most = 0;
            for (size_t c = 0; c < 3; ++c)
                most = std::max(
                    most, std::abs(int(picture.at<uint8_t>(x, 64)[c]) - int(colors.table[size_t(s)][c])));
            nearest = std::min(nearest, most);
        }
        EXPECT_LE(nearest, 1) << x;
    }
}

// Two large triangles before a grid of 502,002 small ones that they hide, in bands of x; a corner of one has
// no value. Large meshes have single large triangles, too.
TEST(Colors, OfValuesAreThoseOfTheTableInLargeMeshes) {
    constexpr int n = 501;
    constexpr float x0 = -0.4f, step = 0.8f / n;
    Mesh mesh = facing_square(1);
    mesh.edit([](MeshData& d) {
        Array3f::Dense V(4 + (n + 1) * (n + 1), 3);
        Array3i::Dense F(2 + 2 * n * n, 3);
        V.topRows(4) = d.V;
        F.topRows(2) = d.F;
        for (int i = 0; i <= n; ++i)
            for (int j = 0; j <= n; ++j)
                V.row(4 + i * (n + 1) + j) << x0 + step * float(j), x0 + step * float(i), -1;
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < n; ++j) {
                const int a = 4 + i * (n + 1) + j, b = a + n + 1;
                F.row(2 + 2 * (i * n + j)) << a, a + 1, b + 1;
                F.row(3 + 2 * (i * n + j)) << a, b + 1, b;
            }
        Array1f::Dense values = V.col(0);
        values[3] = std::numeric_limits<float>::quiet_NaN();
        d.V = Array3f(V);
        d.F = Array3i(F);
        d.UV = {};
        d.scalars = {{"x", Array1f(values)}};
        d.style.lit = false;
        d.style.color_by = ColorBy::scalar;
        d.style.color_steps = 4;
        d.style.nan_color = Vec3(1, 0, 0);
    });
    const ColorTable table = color_table(Colormap::viridis, 4);
    Scene scene;
    scene.show(mesh, "mesh");
    for (const bool native : {true, false}) {
        const Image picture = picture_from_above(scene, native);
        // The square is 119.4 pixels wide.
        for (int row = 6; row < 122; ++row)
            for (int column = 6; column < 122; ++column) {
                const double x = (column + 0.5 - 64) / pixels_per_unit,
                             y = (64 - row - 0.5) / pixels_per_unit;
                const double bands = 2 * (x + 1), from_band = std::abs(bands - std::round(bands)) / 2;
                // Pixels that a border runs through may be on either side of it.
                if (std::min(from_band, std::abs(x - y)) < 1 / pixels_per_unit) continue;
                const Rgb8 expected = x < y ? Rgb8{255, 0, 0} : table[size_t(64 * std::floor(bands))];
                const uint8_t* const seen = picture.at<uint8_t>(column, row);
                ASSERT_EQ((Rgb8{seen[0], seen[1], seen[2]}), expected)
                    << native << ' ' << column << ' ' << row;
            }
    }
}

// A chosen range that ends inside a triangle: what is beyond has the end's colour, what is within its own.
TEST(Colors, OfAChosenRangeStayWhereTheirValuesAre) {
    Mesh mesh = facing_square(1);
    mesh.edit([](MeshData& d) {
        Array1f::Dense values(4);
        for (int i = 0; i < 4; ++i) values[i] = d.V(i, 0);
        d.scalars = {{"x", Array1f(values)}};
        d.style.lit = false;
        d.style.color_by = ColorBy::scalar;
        d.style.colormap = Colormap::grey;
        d.style.color_min = -0.25f;
        d.style.color_max = 0.5f;
    });
    Scene scene;
    scene.show(mesh, "square");
    app::Session session = plain_session(scene, 128);
    look_from(session, Vec3d(0, 0, 4));
    const Image picture = session.render({std::nullopt, 1, app::Encoding::srgb8});
    for (int x = 10; x < 118; ++x) {
        const double value = (x + 0.5 - 64) / pixels_per_unit;
        // Grey: the colour is its place in the table. A rounding error may take the neighbour.
        const double place = std::clamp((value + 0.25) / 0.75, 0.0, 1.0) * 256 - 0.5;
        EXPECT_NEAR(picture.at<uint8_t>(x, 64)[0], std::clamp(place, 0.0, 255.0), 1) << x;
    }
}

// Two colours with the border at 0, of values from -0.1 to 0.9 and of a range as narrow as a threshold.
TEST(Colors, OfANarrowRangeMeetWhereItsValueIs) {
    Mesh mesh = facing_square(1);
    Scene scene;
    for (const float half : {1e-3f, 1e-9f, 1e-16f}) {
        mesh.edit([&](MeshData& d) {
            Array1f::Dense values(4);
            for (int i = 0; i < 4; ++i) values[i] = d.V(i, 0) < 0 ? -0.1f : 0.9f;
            d.scalars = {{"x", Array1f(values)}};
            d.style.lit = false;
            d.style.color_by = ColorBy::scalar;
            d.style.colormap = parse_colormap("#0000ff,#ff0000");
            d.style.color_steps = 2;
            d.style.color_min = -half;
            d.style.color_max = half;
        });
        scene.show(mesh, "square");
        for (const int way : {0, 1, 2}) {
            app::Session session = plain_session(scene, 128);
            session.allow_native_geometry(way != 1);
            session.settings().path.enabled = way == 2;
            look_from(session, Vec3d(0, 0, 4));
            const Image picture = session.render({std::nullopt, 1, app::Encoding::srgb8});
            // Values are 0 at x = -0.8. A rounding error may take the neighbour.
            const double border = 64 - 0.8 * 64 / (4 * std::tan(radians(15.0)));
            for (int x = 6; x < 122; ++x) {
                if (std::abs(x + 0.5 - border) < 1) continue;
                EXPECT_EQ(int(picture.at<uint8_t>(x, 64)[0]), x > border ? 255 : 0)
                    << half << ", way " << way << ", " << x;
            }
        }
    }
}

// Texture coordinates repeat at each pixel, not at the vertices: from 0 to 4 across a square they are four
// ramps. 2 codes: the texture has 256 steps, and its colours are linear values of 16 bits on the way.
TEST(Colors, OfTextureCoordinatesRepeat) {
    Mesh mesh = facing_square(1);
    mesh.edit([](MeshData& d) {
        d.UV = Array2f(Array2f::Dense(4 * d.UV));
        d.style.lit = false;
        d.style.color_by = ColorBy::uv;
    });
    Scene scene;
    scene.show(mesh, "square");
    for (const bool native : {true, false}) {
        const Image picture = picture_from_above(scene, native);
        const auto coordinate = [&](double pixel) {
            const double u = 2 * (1 + (pixel + 0.5 - 64) / pixels_per_unit);
            return 255 * (u - std::floor(u));
        };
        for (int x = 10; x < 118; ++x) {
            const double red = coordinate(x), green = coordinate(127 - 30);
            if (red < 4 || red > 251) continue;  // at a border either side may be hit
            EXPECT_NEAR(picture.at<uint8_t>(x, 30)[0], red, 2) << native << ' ' << x;
            EXPECT_NEAR(picture.at<uint8_t>(x, 30)[1], green, 2) << native << ' ' << x;
        }
    }
}

TEST(Colors, OfANanValueAreThoseOfNothing) {
    Mesh mesh = facing_square(1);
    mesh.edit([](MeshData& d) {
        Array1f::Dense values(4);
        values << 0, 1, 2, std::numeric_limits<float>::quiet_NaN();
        d.scalars = {{"x", Array1f(values)}};
        d.style.lit = false;
        d.style.color_by = ColorBy::scalar;
        d.style.nan_color = Vec3(1, 0, 1);
    });
    Scene scene;
    scene.show(mesh, "square");
    app::Session session = plain_session(scene, 64);
    look_from(session, Vec3d(0, 0, 4));
    const Image picture = session.render({std::nullopt, 1, app::Encoding::srgb8});
    // The upper left triangle has the corner without a value, the lower right has none.
    const uint8_t* p = picture.at<uint8_t>(16, 16);
    EXPECT_EQ(int(p[0]), 255);
    EXPECT_EQ(int(p[1]), 0);
    EXPECT_EQ(int(p[2]), 255);
    EXPECT_FALSE(picture.at<uint8_t>(48, 48)[0] == 255 && picture.at<uint8_t>(48, 48)[2] == 255);
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

// Half of a square is cut away, in every way to draw it.
TEST(Clip, CutsEveryKind) {
    for (const DrawMode mode :
         {DrawMode::mesh, DrawMode::points, DrawMode::surfels, DrawMode::lines, DrawMode::voxels}) {
        MeshData data;
        constexpr int n = 41;
        Array3f::Dense V(n * n, 3), N(n * n, 3);
        for (int i = 0; i < n * n; ++i) {
            V.row(i) << float(i % n) / 20 - 1, float(i / n) / 20 - 1, 0;
            N.row(i) << 0, 0, 1;
        }
        Array3i::Dense F(2 * (n - 1) * (n - 1), 3);
        for (int y = 0, k = 0; y < n - 1; ++y)
            for (int x = 0; x < n - 1; ++x) {
                const int a = y * n + x;
                F.row(k++) << a, a + 1, a + n + 1;
                F.row(k++) << a, a + n + 1, a + n;
            }
        data.V = Array3f(V);
        data.N = Array3f(N);
        data.F = Array3i(F);
        data.style.mode = mode;
        data.style.voxel_size = 0.05f;
        Scene scene;
        scene.show(Mesh(data), "square");
        app::Session session = plain_session(scene, 100);
        look_from(session, Vec3d(0, 0, 5));
        const auto covered = [&] {
            const Image image = render_linear(session, 4);
            double left = 0, right = 0;
            for (int y = 0; y < 100; ++y)
                for (int x = 0; x < 100; ++x)
                    (x < 47 ? left : right) += x < 47 || x > 53 ? image.at<float>(x, y)[3] : 0;
            return std::pair(left, right);
        };
        const auto [left, right] = covered();
        EXPECT_GT(left, 500) << int(mode);
        session.settings().clip.planes = {1, 0, 0, 0};
        const auto [cut_left, cut_right] = covered();
        EXPECT_EQ(cut_left, 0) << int(mode);
        EXPECT_NEAR(cut_right, right, 0.02 * right) << int(mode);
        session.settings().clip.planes.clear();
        session.settings().clip.box = {-2, -2, -2, 0, 2, 2};
        const auto [box_left, box_right] = covered();
        EXPECT_NEAR(box_left, left, 0.02 * left) << int(mode);
        EXPECT_EQ(box_right, 0) << int(mode);
    }
}

TEST(Overlay, IsInFrontOfEverything) {
    for (const bool with_points : {false, true}) {
        Scene scene;
        scene.show(facing_square(1), "front");
        Mesh behind;
        if (with_points) {
            behind.set_V(Array3f(Array3f::Dense(Array3f::Dense::Zero(1, 3))));
        } else {
            behind = facing_square(0.3f);
        }
        behind.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(0, 0, -1)));
        Style style;
        style.overlay = true;
        style.point_size = 12.0f;
        behind.set_style(style);
        scene.show(behind, "behind");
        app::Session session = plain_session(scene, 64);
        look_from(session, Vec3d(0, 0, 5));
        const Image id = session.render_layers({"object_id"}).at("object_id");
        EXPECT_EQ(*id.at<float>(32, 32), 1.0f) << with_points;
        EXPECT_EQ(*id.at<float>(10, 32), 2.0f) << with_points;
    }
}

// Every other column of a sheet of points is missing: filling closes the gaps and leaves the outline.
TEST(HoleFilling, ClosesGapsBetweenPoints) {
    constexpr int n = 60;
    Array3f::Dense V(n * n, 3);
    for (int i = 0; i < n * n; ++i) V.row(i) << float(i % n) / 30 - 1, float(i / n) / 30 - 1, 0;
    std::mt19937 random(5);
    std::vector<int> kept;
    for (int i = 0; i < n * n; ++i)
        if (random() % 4 != 0) kept.push_back(i);
    MeshData data;
    data.V = Array3f(Array3f::Dense(V(kept, Eigen::all)));
    Scene scene;
    scene.show(Mesh(data), "sheet");
    app::Session session = plain_session(scene, 64);
    session.settings().camera.projection = Projection::orthographic;
    session.settings().camera.ortho_height = 64.0 / 30;
    session.settings().style.point_size = 1.0f;
    look_from(session, Vec3d(0, 0, 5));
    const auto holes_and_outside = [&](int times) {
        session.settings().points.hole_filling = times;
        const Image depth = session.render_layers({"depth"}).at("depth");
        int holes = 0, outside = 0;
        for (int y = 0; y < 64; ++y)
            for (int x = 0; x < 64; ++x) {
                const bool inside = x >= 4 && x < 60 && y >= 4 && y < 60;
                holes += inside && *depth.at<float>(x, y) == 0;
                outside += (x < 1 || x > 62 || y < 1 || y > 62) && *depth.at<float>(x, y) > 0;
            }
        return std::pair(holes, outside);
    };
    EXPECT_GT(holes_and_outside(0).first, 500);
    EXPECT_LE(holes_and_outside(6).first, 5);
    EXPECT_EQ(holes_and_outside(6).second, 0);
}

}  // namespace
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
