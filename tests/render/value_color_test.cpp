// Colours of values and texture coordinates, which are interpolated and then mapped at each pixel.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "easypbr/scene/element_colors.h"
#include "easypbr/scene/settings.h"
#include "render_test.h"

namespace easypbr::render::value_color_test {
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

/// An unlit square that is coloured by x, from -1 to 1.
Mesh square_of_values() {
    Mesh mesh = facing_square(1);
    mesh.edit([](MeshData& d) {
        Array1f::Dense values(4);
        for (int i = 0; i < 4; ++i) values[i] = d.V(i, 0);
        d.scalars = {{"x", Array1f(values)}};
        d.style.lit = false;
        d.style.color_by = ColorBy::scalar;
    });
    return mesh;
}

}  // namespace

// Unlit scalars on a coarse mesh: the value is interpolated, then mapped, so that a pixel shows the colour of
// its own value.
TEST(Colors, OfValuesAreThoseOfTheTable) {
    const Mesh mesh = square_of_values();
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
    Mesh mesh = square_of_values();
    mesh.edit([](MeshData& d) {
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

}  // namespace easypbr::render::value_color_test
