#include "easypbr/scene/element_colors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <tuple>

#include "easypbr/core/error.h"
#include "easypbr/scene/label_colors.h"
#include "refusal.h"

namespace easypbr::element_colors_test {

namespace {

constexpr float no_value = std::numeric_limits<float>::quiet_NaN();
const Eigen::Affine3d here = Eigen::Affine3d::Identity();
const Vec3d up(0, 1, 0);

/// Two triangles 0 1 2 and 0 2 3, vertices at heights 0, 1, 2, 3.
MeshData strip() {
    MeshData data;
    data.name = "strip";
    data.V = Array3f(Array3f::Dense{{0, 0, 0}, {1, 1, 0}, {0, 2, 0}, {-1, 3, 0}});
    data.F = Array3i(Array3i::Dense{{0, 1, 2}, {0, 2, 3}});
    return data;
}

Array1i labels(std::initializer_list<int32_t> list) {
    return Array1i(
        Array1i::Dense(Eigen::Map<const Eigen::VectorXi>(list.begin(), Eigen::Index(list.size()))));
}

Array1f values(std::initializer_list<float> list) {
    return Array1f(
        Array1f::Dense(Eigen::Map<const Eigen::VectorXf>(list.begin(), Eigen::Index(list.size()))));
}

ColorPlan plan(const MeshData& mesh, const Style& overrides = {}, DrawMode mode = DrawMode::mesh) {
    return plan_colors(mesh, overrides, mode, here, up);
}

ElementColors colors(const MeshData& mesh, const Style& overrides = {}, DrawMode mode = DrawMode::mesh) {
    return element_colors(mesh, plan(mesh, overrides, mode));
}

Style by(ColorBy choice) {
    Style style;
    style.color_by = choice;
    return style;
}

void add_texture(MeshData& mesh) {
    mesh.UV = Array2f(Array2f::Dense::Zero(4, 2));
    mesh.materials.emplace_back();
    mesh.materials[0].base_color_texture.image = std::make_shared<const Image>(1, 1, 3, PixelType::u8);
}

}  // namespace

TEST(ElementColors, FollowTheDataInTheirOrder) {
    MeshData mesh = strip();
    EXPECT_EQ(plan(mesh).by, ColorBy::solid);
    mesh.I = values({0, 1, 2, 3});
    EXPECT_EQ(plan(mesh).by, ColorBy::solid) << "a mesh with intensities is a mesh";
    EXPECT_EQ(plan(mesh, {}, DrawMode::points).by, ColorBy::intensity);
    mesh.scalars.push_back({"confidence", values({0, 1, 2, 3}), true});
    EXPECT_EQ(plan(mesh).by, ColorBy::solid) << "what a file has beside its geometry is shown when asked for";
    mesh.scalars.push_back({"curvature", values({0, 1, 2, 3})});
    EXPECT_EQ(plan(mesh).by, ColorBy::scalar);
    EXPECT_EQ(plan(mesh).scalar, "curvature");
    mesh.C = ArrayXf(ArrayXf::Dense::Ones(4, 3));
    EXPECT_EQ(plan(mesh).by, ColorBy::vertex);
    add_texture(mesh);
    EXPECT_EQ(plan(mesh).by, ColorBy::texture);
    EXPECT_TRUE(plan(mesh).textured && plan(mesh).vertex_colors) << "nobody chose: both count";
    EXPECT_EQ(plan(mesh).source, ColorSource::material);
    EXPECT_EQ(plan(mesh).key, "");
    mesh.L = labels({0, 1, 2, 3});
    EXPECT_EQ(plan(mesh).by, ColorBy::label);
}

TEST(ElementColors, AreTheMaterialsAsChosen) {
    MeshData mesh = strip();
    mesh.C = ArrayXf(ArrayXf::Dense::Ones(4, 3));
    add_texture(mesh);
    mesh.L = labels({0, 1, 2, 3});
    const auto counts = [&](ColorBy choice) {
        const ColorPlan p = plan(mesh, by(choice));
        EXPECT_EQ(p.source, ColorSource::material);
        EXPECT_FALSE(p.exact);
        return std::pair(p.textured, p.vertex_colors);
    };
    EXPECT_EQ(counts(ColorBy::solid), std::pair(false, false));
    EXPECT_EQ(counts(ColorBy::vertex), std::pair(false, true));
    EXPECT_EQ(counts(ColorBy::texture), std::pair(true, false));
}

TEST(ElementColors, OverridesStandForObjectsThatHaveTheData) {
    MeshData mesh = strip();
    mesh.C = ArrayXf(ArrayXf::Dense::Ones(4, 3));
    EXPECT_EQ(plan(mesh, by(ColorBy::label)).by, ColorBy::vertex) << "no labels: as without the override";
    mesh.style.color_by = ColorBy::height;
    EXPECT_EQ(plan(mesh).by, ColorBy::height);
    EXPECT_EQ(plan(mesh, by(ColorBy::label)).by, ColorBy::height);
    EXPECT_EQ(plan(mesh, by(ColorBy::solid)).by, ColorBy::solid);
}

TEST(ElementColors, NamedScalarsAreChosen) {
    MeshData mesh = strip();
    mesh.L = labels({0, 1, 2, 3});
    mesh.scalars = {{"a", values({0, 1, 2, 3})}, {"b", values({0, 1}), true}};
    Style style;
    style.scalar = std::string("b");
    EXPECT_EQ(plan(mesh, style).by, ColorBy::scalar);
    EXPECT_EQ(plan(mesh, style).scalar, "b");
    EXPECT_EQ(plan(mesh, style).element, PerElement::face);
    EXPECT_EQ(plan(mesh, by(ColorBy::scalar)).scalar, "a");
    mesh.style.scalar = std::string("b");
    EXPECT_EQ(plan(mesh).scalar, "b");
    EXPECT_EQ(plan(mesh, by(ColorBy::label)).by, ColorBy::label);
}

TEST(ElementColors, SayWhatTheObjectLacks) {
    MeshData mesh = strip();
    const auto own = [&](ColorBy choice) {
        mesh.style.color_by = choice;
        return refusal<Error>([&] { plan(mesh); });
    };
    EXPECT_EQ(own(ColorBy::label), "mesh 'strip': its style's color_by is label, but it has no labels (L)");
    EXPECT_EQ(own(ColorBy::uv),
              "mesh 'strip': its style's color_by is uv, but it has no texture coordinates (UV)");
    EXPECT_EQ(own(ColorBy::scalar), "mesh 'strip': its style's color_by is scalar, but it has no scalars");
    EXPECT_EQ(own(ColorBy::normal), "taken");
    mesh.scalars = {{"curvature", values({0, 1, 2, 3})}, {"none", {}}};
    mesh.style.scalar = std::string("curvatur");
    EXPECT_EQ(own(ColorBy::scalar),
              "mesh 'strip' has no scalars 'curvatur' (did you mean 'curvature'?); it has curvature, none");
    mesh.style.scalar = std::string("none");
    EXPECT_EQ(own(ColorBy::scalar), "mesh 'strip': its scalars 'none' hold no values");
    mesh.style = {};
    mesh.style.color_min = 2.0f;
    mesh.style.color_max = 1.0f;
    mesh.style.color_by = ColorBy::height;
    EXPECT_EQ(refusal<Error>([&] { colors(mesh); }),
              "style: expected color_min not above color_max, got 2 and 1");
}

TEST(ElementColors, SayWhatNoObjectHas) {
    SceneSnapshot scene;
    MeshData plain = strip(), rich = strip();
    rich.scalars = {{"curvature", values({0, 1, 2, 3})}};
    for (const MeshData& mesh : {plain, rich})
        scene.objects.push_back({mesh.name, std::make_shared<const MeshData>(mesh), here});
    EXPECT_EQ(refusal<Error>([&] { require_colors(scene, by(ColorBy::scalar)); }), "taken");
    EXPECT_EQ(refusal<Error>([&] { require_colors(scene, by(ColorBy::label)); }),
              "style.color_by is label, but the objects have no labels (L)");
    Style style;
    style.scalar = std::string("curvture");
    EXPECT_EQ(
        refusal<Error>([&] { require_colors(scene, style); }),
        "style.scalar: no object has scalars 'curvture' (did you mean 'curvature'?); there are curvature");
    EXPECT_EQ(refusal<Error>([&] { require_colors({}, style); }), "taken");
}

TEST(ElementColors, LabelsHaveTheColoursOfTheirMap) {
    MeshData mesh = strip();
    mesh.L = labels({7, 9, -1, 7});
    mesh.label_map = std::make_shared<const LabelMap>(
        "two",
        std::vector<LabelClass>{{7, "seven", {1, 2, 3}}, {9, "nine", {4, 5, 6}}, {0, "none", {9, 9, 9}}}, 0);
    const ElementColors points = colors(mesh, {}, DrawMode::points);
    EXPECT_EQ(points.colors,
              (std::vector<Rgba8>{{1, 2, 3, 255}, {4, 5, 6, 255}, {9, 9, 9, 255}, {1, 2, 3, 255}}));
    EXPECT_TRUE(plan(mesh, {}, DrawMode::points).exact);
}

// Corners 7 9 -1 all differ: the first one's; corners 7 -1 7: that of most.
TEST(ElementColors, FacesHaveTheLabelOfMostCorners) {
    MeshData mesh = strip();
    mesh.L = labels({7, 9, -1, 7});
    EXPECT_EQ(plan(mesh).element, PerElement::face);
    const GeneratedColors generated(9);
    EXPECT_EQ(colors(mesh).colors, (std::vector<Rgba8>(2, opaque(generated.color_of(7)))));
    mesh.L = labels({7, 9, 9, 9});
    EXPECT_EQ(colors(mesh).colors, (std::vector<Rgba8>(2, opaque(generated.color_of(9)))));
    mesh.L = labels({3, 5});  // of the faces themselves
    EXPECT_EQ(colors(mesh).colors,
              (std::vector<Rgba8>{opaque(generated.color_of(3)), opaque(generated.color_of(5))}));
    // Vertices 0 and 2 are in both faces: the first counts.
    const auto points = colors(mesh, {}, DrawMode::points).colors;
    EXPECT_EQ(points, (std::vector<Rgba8>{opaque(generated.color_of(3)), opaque(generated.color_of(3)),
                                          opaque(generated.color_of(3)), opaque(generated.color_of(5))}));
}

TEST(ElementColors, ValuesOfMeshesAreMappedAfterInterpolation) {
    MeshData mesh = strip();
    mesh.scalars = {{"t", values({0, 1, no_value, 4})}};
    const ElementColors onmesh = colors(mesh);
    EXPECT_EQ(plan(mesh).source, ColorSource::values);
    EXPECT_TRUE(onmesh.colors.empty());
    EXPECT_EQ(onmesh.values.data(), mesh.scalars[0].values.data()) << "no copy";
    EXPECT_EQ(onmesh.range.max, 4);
    EXPECT_EQ(onmesh.table[255], opaque(color_table(Colormap::viridis)[255]));
    EXPECT_EQ(onmesh.nan_color, (Rgba8{128, 128, 128, 255}));
    const ElementColors points = colors(mesh, {}, DrawMode::points);
    EXPECT_TRUE(points.values.empty());
    const ColorTable& table = color_table(Colormap::viridis);
    EXPECT_EQ(
        points.colors,
        (std::vector<Rgba8>{opaque(table[0]), opaque(table[64]), {128, 128, 128, 255}, opaque(table[255])}));
}

TEST(ElementColors, ValuesOfLinesAreMappedAfterInterpolation) {
    MeshData mesh = strip();
    mesh.scalars = {{"t", values({2, 4})}};
    const ColorPlan of_lines = plan(mesh, {}, DrawMode::lines);
    EXPECT_EQ(of_lines.source, ColorSource::values);
    EXPECT_NE(of_lines.key, plan(mesh, {}, DrawMode::points).key);
    const Array1f at_vertices = element_colors(mesh, of_lines).values;
    EXPECT_EQ(Eigen::VectorXf(at_vertices), Eigen::VectorXf(values({3, 2, 3, 4})));
}

TEST(ElementColors, InfiniteValuesAreTheEndsOfTheRange) {
    constexpr float infinite = std::numeric_limits<float>::infinity();
    MeshData mesh = strip();
    mesh.scalars = {{"t", values({1, infinite, no_value, -infinite})}};
    Style style;
    style.color_min = 0.0f;
    style.color_max = 4.0f;
    const ElementColors onmesh = colors(mesh, style);
    EXPECT_EQ(onmesh.values(0), 1);
    EXPECT_EQ(onmesh.values(1), 4);
    EXPECT_TRUE(std::isnan(onmesh.values(2)));
    EXPECT_EQ(onmesh.values(3), 0);
    // Two faces, as points: the mean of both at the corners that they share.
    mesh.scalars = {{"t", values({infinite, -infinite})}};
    EXPECT_EQ(colors(mesh, style, DrawMode::points).colors[0], opaque(color_table(Colormap::viridis)[128]));
}

TEST(ElementColors, ValuesOfFacesAreTheirMeanAtVertices) {
    MeshData mesh = strip();
    mesh.scalars = {{"t", values({2, 4})}};
    EXPECT_EQ(plan(mesh).source, ColorSource::colors);
    const ColorTable& table = color_table(Colormap::viridis);
    EXPECT_EQ(colors(mesh).colors, (std::vector<Rgba8>{opaque(table[0]), opaque(table[255])}));
    EXPECT_EQ(
        colors(mesh, {}, DrawMode::points).colors,
        (std::vector<Rgba8>{opaque(table[128]), opaque(table[0]), opaque(table[128]), opaque(table[255])}));
    mesh.scalars = {{"t", values({2, no_value})}};
    EXPECT_EQ(colors(mesh, {}, DrawMode::points).colors[3], (Rgba8{128, 128, 128, 255}));
}

TEST(ElementColors, HeightsAreThoseInTheWorld) {
    const MeshData mesh = strip();
    Eigen::Affine3d T = Eigen::Affine3d::Identity();
    T.translate(Vec3d(0, 0, 10)).rotate(Eigen::AngleAxisd(M_PI / 2, Vec3d::UnitX())).scale(2);  // y becomes z
    const ColorPlan z = plan_colors(mesh, by(ColorBy::height), DrawMode::mesh, T, Vec3d::UnitZ());
    const ElementColors heights = element_colors(mesh, z);
    for (int i = 0; i < 4; ++i) EXPECT_NEAR(heights.values(i), 10 + 2 * i, 1e-5);
    EXPECT_NE(z.key, plan_colors(mesh, by(ColorBy::height), DrawMode::mesh, T, -Vec3d::UnitZ()).key);
}

// A scene's origin takes a part of the heights, which part is up to the order of showing: the numbers are
// those of both, and the digits those of what is left.
TEST(ElementColors, HeightsDoNotDependOnTheOrigin) {
    MeshData mesh = strip();
    const auto of = [&](double origin, const Style& style) {
        Eigen::Affine3d T = Eigen::Affine3d::Identity();
        T.translation().y() = 2500 - origin;
        const ColorPlan p = plan_colors(mesh, style, DrawMode::points, T, up, Vec3d(0, origin, 0));
        const ValueRange range = plan_range(plan_values(mesh, p), p);
        return std::tuple(range.true_min(), range.true_max(), element_colors(mesh, p).colors);
    };
    Style style = by(ColorBy::height);
    // Vertices at 2500 to 2503: all numbers below are whole ones of float32.
    for (const double origin : {0.0, 2500.0, 2501.0}) {
        style = by(ColorBy::height);
        EXPECT_EQ(std::get<0>(of(origin, style)), 2500) << origin;
        EXPECT_EQ(std::get<1>(of(origin, style)), 2503) << origin;
        style.color_min = 2499.0f;
        style.color_max = 2505.0f;
        EXPECT_EQ(std::get<0>(of(origin, style)), 2499) << origin;
        EXPECT_EQ(std::get<1>(of(origin, style)), 2505) << origin;
        EXPECT_EQ(std::get<2>(of(origin, style)), std::get<2>(of(0, style))) << origin;
        style.color_scale = ColorScale::log;
        EXPECT_EQ(std::get<0>(of(origin, style)), 2499) << origin;
        EXPECT_EQ(std::get<2>(of(origin, style)), std::get<2>(of(0, style))) << origin;
    }
    // Ends that round to one beside the origin still are two.
    for (const double origin : {0.0, 5.0}) {
        const MeshData low = strip();
        Style narrow = by(ColorBy::height);
        narrow.color_min = -1e-9f;
        narrow.color_max = 1e-9f;
        Eigen::Affine3d T = Eigen::Affine3d::Identity();
        T.translation().y() = -1.5 - origin;
        const ColorPlan p = plan_colors(low, narrow, DrawMode::points, T, up, Vec3d(0, origin, 0));
        const ValueRange range = plan_range(plan_values(low, p), p);
        EXPECT_LT(range.min, range.max) << origin;
        EXPECT_LT(range.max - range.min, 1e-6f) << origin;
    }
    // The 0 of a diverging map is a true one: 2500 to 2503 and -2 to 1 are the vertices' heights.
    style = by(ColorBy::height);
    style.colormap = Colormap::coolwarm;
    EXPECT_EQ(std::get<0>(of(2501, style)), 2500);
    const ColorPlan sunk = plan_colors(mesh, style, DrawMode::points, here, up, Vec3d(0, -2, 0));
    EXPECT_EQ(plan_range(plan_values(mesh, sunk), sunk).true_min(), -2);
    EXPECT_EQ(plan_range(plan_values(mesh, sunk), sunk).true_max(), 2);
    // Of 0.001 at 5,000,000 float32, which tells halves apart there, would leave nothing.
    mesh.V = Array3f(Array3f::Dense{{0, 0, 0}, {1, 0.001f, 0}, {0, 0.002f, 0}, {-1, 0.003f, 0}});
    const ColorPlan far =
        plan_colors(mesh, by(ColorBy::height), DrawMode::points, here, up, Vec3d(0, 5e6, 0));
    EXPECT_EQ(plan_values(mesh, far)(3), 0.003f);
    EXPECT_EQ(plan_range(plan_values(mesh, far), far).true_min(), 5e6);
}

TEST(ElementColors, NormalsAndTextureCoordinatesAreTheirNumbers) {
    MeshData mesh = strip();
    mesh.N = Array3f(Array3f::Dense{{1, 0, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, 0}});
    mesh.UV = Array2f(Array2f::Dense{{0, 1}, {0.2f, 1.2f}, {-0.8f, 0}, {0.6f, 2}});
    const auto normals = colors(mesh, by(ColorBy::normal)).colors;
    EXPECT_EQ(normals,
              (std::vector<Rgba8>{
                  {255, 128, 128, 255}, {128, 0, 128, 255}, {128, 128, 255, 255}, {128, 128, 128, 255}}));
    EXPECT_EQ(plan(mesh, by(ColorBy::uv)).source, ColorSource::coordinates);
    const auto uv = colors(mesh, by(ColorBy::uv), DrawMode::points).colors;
    EXPECT_EQ(uv,
              (std::vector<Rgba8>{{0, 255, 0, 255}, {51, 51, 0, 255}, {51, 0, 0, 255}, {153, 0, 0, 255}}));
    mesh.N = {};
    mesh.style.flat = true;
    const ColorPlan flat = plan(mesh, by(ColorBy::normal));
    EXPECT_EQ(flat.element, PerElement::face);
    EXPECT_EQ(element_colors(mesh, flat).colors, (std::vector<Rgba8>(2, {128, 128, 255, 255})));
}

TEST(ElementColors, IntensitiesAreGrey) {
    MeshData mesh = strip();
    mesh.I = values({0, 0.25f, no_value, 1});
    EXPECT_EQ(
        colors(mesh, {}, DrawMode::points).colors,
        (std::vector<Rgba8>{{0, 0, 0, 255}, {64, 64, 64, 255}, {255, 0, 255, 255}, {255, 255, 255, 255}}));
}

TEST(ElementColors, StylesChooseMapRangeAndNan) {
    MeshData mesh = strip();
    mesh.scalars = {{"t", values({0, 1, no_value, 4})}};
    mesh.style.colormap = Colormap::magma;
    mesh.style.color_max = 2.0f;
    mesh.style.nan_color = Vec3(1, 0, 0);
    Style overrides;
    overrides.color_max = 8.0f;
    const ElementColors result = colors(mesh, overrides);
    EXPECT_EQ(result.table[200], opaque(color_table(Colormap::magma)[200]));
    EXPECT_EQ(result.range.max, 8);
    EXPECT_EQ(result.nan_color, (Rgba8{255, 0, 0, 255}));
}

// The values 0, 1 and 4 of 0 to 4 stand at 0, 1/4 and 1: entries 0, 64 and 255.
TEST(ElementColors, OwnAndReversedMapsColourValues) {
    MeshData mesh = strip();
    mesh.scalars = {{"t", values({0, 1, no_value, 4})}};
    mesh.style.colormap = parse_colormap("#000000,#ff0000");
    EXPECT_EQ(colors(mesh, {}, DrawMode::points).colors,
              (std::vector<Rgba8>{{0, 0, 0, 255}, {64, 0, 0, 255}, {128, 128, 128, 255}, {255, 0, 0, 255}}));
    const std::string key = plan(mesh).key;
    mesh.style.colormap = parse_colormap("#000000,#fe0000");
    EXPECT_NE(plan(mesh).key, key);
    mesh.style.colormap = Colormap::grey.reversed();
    EXPECT_EQ(
        colors(mesh, {}, DrawMode::points).colors,
        (std::vector<Rgba8>{{255, 255, 255, 255}, {191, 191, 191, 255}, {255, 0, 255, 255}, {0, 0, 0, 255}}));
}

// 10 is in the middle of 1 and 100; 0 and -5 have no logarithm.
TEST(ElementColors, LogarithmicScalesTakeValuesBelowZeroAsMissing) {
    MeshData mesh = strip();
    mesh.scalars = {{"t", values({1, 10, 0, 100})}};
    mesh.style.colormap = Colormap::grey;
    mesh.style.nan_color = Vec3(1, 0, 0);
    const std::string key = plan(mesh).key;
    mesh.style.color_scale = ColorScale::log;
    EXPECT_NE(plan(mesh).key, key);
    EXPECT_EQ(
        colors(mesh, {}, DrawMode::points).colors,
        (std::vector<Rgba8>{{0, 0, 0, 255}, {128, 128, 128, 255}, {255, 0, 0, 255}, {255, 255, 255, 255}}));
    EXPECT_TRUE(std::isnan(colors(mesh).values(2)));
    mesh.style.color_min = -5.0f;
    EXPECT_THROW(colors(mesh), ArgumentError);
}

// Two bands of 0 to 4: below 2 the first colour, from 2 on the last.
TEST(ElementColors, StepsAreBandsOfOneColour) {
    MeshData mesh = strip();
    mesh.scalars = {{"t", values({0, 1.99f, 2, 4})}};
    mesh.style.colormap = Colormap::grey;
    mesh.style.color_steps = 2;
    EXPECT_EQ(
        colors(mesh, {}, DrawMode::points).colors,
        (std::vector<Rgba8>{{0, 0, 0, 255}, {0, 0, 0, 255}, {255, 255, 255, 255}, {255, 255, 255, 255}}));
}

TEST(ElementColors, KeysChangeWithWhatCounts) {
    MeshData mesh = strip();
    mesh.L = labels({0, 1, 2, 3});
    const std::string before = plan(mesh).key;
    MeshData moved = mesh;
    moved.V = Array3f(Array3f::Dense(2 * mesh.V));
    EXPECT_EQ(plan(moved).key, before) << "labels do not depend on positions";
    mesh.L = labels({0, 1, 2, 3});
    EXPECT_NE(plan(mesh).key, before) << "a new array is another one, whatever it holds";
    EXPECT_NE(plan(mesh, {}, DrawMode::points).key, plan(mesh).key);
    mesh.scalars = {{"t", values({0, 1, 2, 3})}};
    Style style = by(ColorBy::scalar);
    const std::string scalar = plan(mesh, style).key;
    style.color_min = 1.0f;
    EXPECT_NE(plan(mesh, style).key, scalar);
}

// Ten million would be the same in more chunks; the result must not depend on how they are cut.
TEST(ElementColors, AreTheSameInAnyChunk) {
    const Eigen::Index n = 200000;
    MeshData mesh;
    mesh.V = Array3f(Array3f::Dense::Zero(n, 3));
    Array1i::Dense L(n);
    for (Eigen::Index i = 0; i < n; ++i) L(i) = int32_t(i % 97);
    mesh.L = Array1i(L);
    const auto all = colors(mesh, {}, DrawMode::points).colors;
    const GeneratedColors generated(96);
    for (Eigen::Index i = 0; i < n; ++i)
        ASSERT_EQ(all[size_t(i)], opaque(generated.color_of(int32_t(i % 97))));
}

}  // namespace easypbr::element_colors_test
