#include <gtest/gtest.h>

#include "easypbr/core/error.h"
#include "easypbr/core/image.h"
#include "easypbr/io/mesh/gltf/glb_writer.h"
#include "easypbr/io/mesh/gltf/gltf_reader.h"
#include "easypbr/io/mesh/mesh_io.h"
#include "easypbr/scene/mesh.h"
#include "easypbr/scene/normals.h"
#include "io/gltf_decoded.h"
#include "io/temporary_folder.h"
#include "scene/cube_mesh.h"
#include "test_data.h"

namespace easypbr::glb_test {

namespace {

std::shared_ptr<const Image> flat_image(int size, std::initializer_list<uint8_t> color) {
    auto image = std::make_shared<Image>(size, size, int(color.size()), PixelType::u8);
    size_t i = 0;
    for (uint8_t& v : image->pixels<uint8_t>()) v = color.begin()[i++ % color.size()];
    return image;
}

MeshData square() {
    MeshData data;
    data.name = "square";
    Array3f::Dense V(4, 3), N(4, 3);
    V << 0, 0, 0, 1, 0, 0, 1, 1, 0.1f, 0, 1, 0;
    N << 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1;
    Array2f::Dense UV(4, 2);
    UV << 0, 0, 1, 0, 1, 1, 0, 0.25f;
    ArrayXf::Dense C(4, 4);
    C << 0, 0.5f, 1, 1, 0.2f, 0.01f, 1, 0.5f, 1, 1, 1, 1, 0, 0, 0, 0;
    Array3i::Dense F(2, 3);
    F << 0, 1, 2, 0, 2, 3;
    data.V = V, data.N = N, data.UV = UV, data.C = C, data.F = F;
    return data;
}

io::LoadedScene round_trip(const Mesh& mesh) {
    const TemporaryFolder folder;
    io::save_glb(mesh, folder / "a.glb");
    return io::load_gltf(folder / "a.glb");
}

MeshData first_child(const Mesh& mesh) {
    return *mesh.snapshot()->children.at(0).snapshot();
}

}  // namespace

TEST(Glb, RoundTripsValuesOfVertices) {
    MeshData data = square();
    Array1i::Dense L(4);
    L << -1, 0, 70000, 1 << 24;
    Array1f::Dense I(4), heat(4);
    I << 0.5f, 1, 0, 1e6f;
    heat << -1.5f, 0.1f, 3e-20f, 7;
    data.L = L, data.I = I;
    data.scalars = {{"heat of \"it\"", heat}};
    const LogCapture log;
    const MeshData read = first_child(round_trip(Mesh(data)).mesh);
    EXPECT_EQ(read.L, data.L);
    EXPECT_EQ(read.I, data.I);
    ASSERT_EQ(read.scalars.size(), 1u);
    EXPECT_EQ(read.scalars[0].name, "heat of \"it\"");
    EXPECT_EQ(read.scalars[0].values, data.scalars[0].values);
    EXPECT_EQ(log.text, "");
    // Points and lines have them too.
    data.F = {};
    const MeshData points = first_child(round_trip(Mesh(data)).mesh);
    EXPECT_EQ(points.L, data.L);
    EXPECT_EQ(points.scalars.at(0).values, data.scalars[0].values);
}

// The attributes of the mesh's own labels and intensities have these names behind their "_".
TEST(Glb, ScalarsCalledAsLabelsAndIntensitiesStayScalars) {
    const std::vector<std::string> names{"LABEL", "INTENSITY", "_LABEL", "__INTENSITY", "label", "_x"};
    for (const bool has_own : {false, true}) {
        MeshData mesh;
        mesh.V = Array3f::Dense::Zero(2, 3);
        for (size_t i = 0; i < names.size(); ++i)
            mesh.scalars.push_back({names[i], Array1f::Dense::Constant(2, 10 + float(i))});
        if (has_own) {
            mesh.L = Array1i::Dense::Constant(2, 7);
            mesh.I = Array1f::Dense::Constant(2, 0.5f);
        }
        const MeshData back = first_child(round_trip(Mesh(mesh)).mesh);
        EXPECT_EQ(back.L, mesh.L);
        EXPECT_EQ(back.I, mesh.I);
        EXPECT_EQ(back.scalars.size(), names.size());
        for (size_t i = 0; i < names.size(); ++i)
            EXPECT_EQ(scalar_named(back, names[i]).values[1], 10 + float(i)) << names[i];
    }
}

TEST(Glb, AMeshKeepsVerticesThatNoEdgeOrFaceIndexes) {
    MeshData mesh;
    mesh.V = Array3f::Dense{{0, 0, 0}, {9, 9, 9}, {1, 0, 0}, {0, 1, 0}};
    mesh.E = Array2i::Dense{{0, 2}};
    MeshData back = first_child(round_trip(Mesh(mesh)).mesh);
    EXPECT_EQ(back.V, mesh.V);
    EXPECT_EQ(back.E, mesh.E);
    mesh.F = Array3i::Dense{{0, 2, 3}};
    back = first_child(round_trip(Mesh(mesh)).mesh);
    EXPECT_EQ(back.V.rows(), 4);
    EXPECT_EQ(back.E, mesh.E);
}

TEST(Glb, SaysWhatItLeavesOut) {
    MeshData data = square();
    data.L = Array1i::Dense::Constant(2, 5);
    data.scalars = {{"area", Array1f::Dense::Constant(2, 5)}, {"heat", Array1f::Dense::Constant(4, NAN)}};
    data.T = Array3f::Dense::Constant(4, 3, 1);
    const TemporaryFolder folder;
    const LogCapture log;
    Mesh(data).save(folder / "a.glb");
    for (const char* name : {"tangents", "labels of faces", "scalars 'area' of faces",
                             "scalars 'heat' with missing values", "of 'square'", "a.glb"})
        EXPECT_NE(log.text.find(name), std::string::npos) << name << " in " << log.text;
    const MeshData read = first_child(io::load_gltf(folder / "a.glb").mesh);
    EXPECT_TRUE(read.L.empty());
    EXPECT_TRUE(read.scalars.empty());
}

TEST(Glb, RoundTripsGeometry) {
    MeshData data = square();
    data.T_parent_mesh.translate(Vec3d(1, 2, 3))
        .rotate(Eigen::AngleAxisd(0.3, Vec3d(1, 2, 2) / 3))
        .scale(Vec3d(-1, 2, 1));
    Array2i::Dense E(1, 2);
    E << 1, 3;
    data.E = E;
    data.uv_tangents = Array4f::Dense{{0, 1, 0, 1}, {0, 1, 0, -1}, {1, 0, 0, 1}, {-1, 0, 0, -1}};
    const MeshData read = first_child(round_trip(Mesh(data)).mesh);
    EXPECT_EQ(read.name, "square");
    EXPECT_EQ(read.V, data.V);
    EXPECT_EQ(read.N, data.N);
    EXPECT_EQ(read.uv_tangents, data.uv_tangents);
    EXPECT_EQ(read.F, data.F);
    EXPECT_EQ(read.E, data.E);
    EXPECT_EQ(read.T_parent_mesh.matrix(), data.T_parent_mesh.matrix());
    // v is turned over twice (exact for these), colours pass through the transfer function twice in float.
    EXPECT_EQ(read.UV, data.UV);
    EXPECT_LT((read.C - data.C).cwiseAbs().maxCoeff(), 1e-6f);
}

TEST(Glb, SharpEdgesOfAMeshWithoutNormalsStay) {
    MeshData data = cube();
    data.I = Array1f(Array1f::Dense::LinSpaced(8, 0, 7));
    data.E = Array2i::Dense{{0, 7}};
    const MeshData read = first_child(round_trip(Mesh(data)).mesh);
    ASSERT_EQ(read.V.rows(), 6 * 4) << "four for each side";
    const Array3f sides = face_normals(data.V, data.F);
    for (Eigen::Index f = 0; f < 12; ++f)
        for (int k = 0; k < 3; ++k) {
            const int32_t v = read.F(f, k), source = data.F(f, k);
            EXPECT_EQ(Vec3(read.V.row(v)), Vec3(data.V.row(source)));
            // Multiples of one unit vector along an axis, normalised: exact.
            EXPECT_EQ(Vec3(read.N.row(v)), Vec3(sides.row(f)));
            EXPECT_EQ(read.I[v], float(source));
        }
    EXPECT_EQ(read.E, data.E);
    // What is drawn flat has none in the file, and is so again.
    data.style.flat = true;
    const MeshData flat = first_child(round_trip(Mesh(data)).mesh);
    EXPECT_EQ(flat.V.rows(), 8);
    EXPECT_TRUE(flat.style.flat.value_or(false));
}

TEST(Glb, RoundTripsPartsAndMaterials) {
    MeshData data = square();
    Material red, glowing;
    red.name = "red";
    red.base_color = {1, 0, 0};
    red.opacity = 0.25f;
    red.alpha_mode = AlphaMode::blend;
    red.base_color_texture.image = flat_image(4, {1, 2, 3});
    red.base_color_texture.wrap_u = Wrap::mirror;
    red.base_color_texture.filter = Filter::nearest;
    Eigen::Affine2f turn =
        Eigen::Translation2f(0.1f, 0.2f) * Eigen::Rotation2Df(0.4f) * Eigen::Scaling(2.0f, 3.0f);
    red.base_color_texture.uv_transform = turn.matrix();
    red.normal_texture.image = red.base_color_texture.image;
    red.normal_scale = 0.5f;
    glowing.emissive = {8, 4, 2};
    glowing.unlit = true;
    glowing.double_sided = false;
    glowing.metallic = 0.25f;
    data.materials = {red, glowing};
    data.parts = {{"a", 0, 1, 1}, {"b", 1, 1, 0}};
    const MeshData read = first_child(round_trip(Mesh(data)).mesh);
    ASSERT_EQ(read.parts.size(), 2u);
    EXPECT_EQ(read.parts[1].first_face, 1);
    const Material& a = read.materials.at(size_t(read.parts[0].material));
    const Material& b = read.materials.at(size_t(read.parts[1].material));
    EXPECT_EQ(a.emissive, Vec3(8, 4, 2));
    EXPECT_TRUE(a.unlit);
    EXPECT_FALSE(a.double_sided);
    EXPECT_EQ(a.metallic, 0.25f);
    EXPECT_EQ(b.name, "red");
    EXPECT_EQ(b.opacity, 0.25f);
    EXPECT_EQ(*b.alpha_mode, AlphaMode::blend);
    EXPECT_EQ(b.normal_scale, 0.5f);
    EXPECT_EQ(b.base_color_texture.wrap_u, Wrap::mirror);
    EXPECT_EQ(b.base_color_texture.filter, Filter::nearest);
    // A few roundings of single precision through angle and scale.
    EXPECT_LT((b.base_color_texture.uv_transform - turn.matrix()).cwiseAbs().maxCoeff(), 1e-6f);
    EXPECT_EQ(b.base_color_texture.image, b.normal_texture.image);
    EXPECT_EQ(compare(*b.base_color_texture.image, *red.base_color_texture.image).max, 0);
}

TEST(Glb, MergesMetallicRoughnessAndOpacity) {
    MeshData data = square();
    Material material;
    material.metallic_texture.image = flat_image(4, {50});
    material.roughness_texture.image = flat_image(2, {60, 70, 80});
    material.base_color_texture.image = flat_image(2, {10, 20, 30});
    material.opacity_texture.image = flat_image(2, {90});
    data.materials = {material};
    const Material read = first_child(round_trip(Mesh(data)).mesh).materials.at(0);
    const Image& merged = *read.metallic_texture.image;
    EXPECT_EQ(merged.width(), 4);
    EXPECT_EQ(merged.at<uint8_t>(3, 3)[read.metallic_texture.channel], 50);
    EXPECT_EQ(merged.at<uint8_t>(3, 3)[read.roughness_texture.channel], 60);
    const uint8_t* color = read.base_color_texture.image->at<uint8_t>(1, 1);
    EXPECT_EQ(color[0], 10);
    EXPECT_EQ(color[3], 90);
}

/// An image of floats of one colour.
std::shared_ptr<const Image> flat_floats(std::initializer_list<float> color) {
    auto image = std::make_shared<Image>(2, 2, int(color.size()), PixelType::f32);
    size_t i = 0;
    for (float& v : image->pixels<float>()) v = color.begin()[i++ % color.size()];
    return image;
}

// Half is code 128 of data and code 188 of light (255 * 0.73536 = 187.52), of the same image, too.
TEST(Glb, FloatsAreCodedByWhatTheyAreUsedAs) {
    MeshData data = square();
    Material apart, packed;
    const auto half = flat_floats({0.5f, 0.5f, 1.0f});
    apart.base_color_texture.image = apart.emissive_texture.image = apart.normal_texture.image = half;
    apart.metallic_texture.image = flat_floats({0.25f});
    apart.roughness_texture.image = apart.opacity_texture.image = apart.occlusion_texture.image = half;
    packed.roughness_texture.image = packed.metallic_texture.image = packed.occlusion_texture.image = half;
    packed.roughness_texture.channel = 1;
    packed.metallic_texture.channel = 2;
    data.materials = {apart, packed};
    data.parts = {{"a", 0, 1, 0}, {"b", 1, 1, 1}};
    const auto read = first_child(round_trip(Mesh(data)).mesh).materials;
    const auto code = [](const Texture& texture, int channel) {
        return int(texture.image->at<uint8_t>(1, 1)[channel]);
    };
    const auto number = [&](const Texture& texture) { return code(texture, texture.channel); };
    const Material& a = read.at(0);
    EXPECT_EQ(code(a.base_color_texture, 0), 188);
    EXPECT_EQ(code(a.base_color_texture, 3), 128);  // the opacity
    EXPECT_EQ(code(a.emissive_texture, 1), 188);
    EXPECT_EQ(code(a.normal_texture, 0), 128);
    EXPECT_EQ(code(a.normal_texture, 2), 255);
    EXPECT_EQ(number(a.metallic_texture), 64);
    EXPECT_EQ(number(a.roughness_texture), 128);
    EXPECT_EQ(number(a.occlusion_texture), 128);
    const Material& b = read.at(1);
    EXPECT_EQ(number(b.roughness_texture), 128);
    EXPECT_EQ(number(b.metallic_texture), 255);
    EXPECT_EQ(number(b.occlusion_texture), 128);
    EXPECT_EQ(b.roughness_texture.image, b.occlusion_texture.image);
}

// Once of each image, as when it is drawn; of colours alone, not of alpha and numbers.
TEST(Glb, ColorsAboveOneAreAWarning) {
    MeshData data = square();
    Material first, second;
    first.base_color_texture.image = flat_floats({0.5f, 7.5f, 0.5f});
    first.opacity_texture.image = first.roughness_texture.image = flat_floats({3});
    first.emissive_texture.image = flat_floats({2, 9});
    first.emissive_texture.path = "sun.exr";
    first.normal_texture.image = flat_floats({0.5f, 0.5f, 4});
    first.sheen_color = Vec3::Ones();
    first.sheen_color_texture.image = flat_floats({5, 0, 0});
    first.specular_color_texture.image = flat_floats({6, 0, 0});
    second.base_color_texture = first.base_color_texture;
    second.emissive_texture.image = flat_floats({1, 9});
    data.materials = {first, second};
    data.parts = {{"a", 0, 1, 0}, {"b", 1, 1, 1}};
    const TemporaryFolder folder;
    const LogCapture log;
    Mesh(data).save(folder / "a.glb");
    const std::string end = ": colours above 1 were clamped to 1, the largest value is ";
    for (const char* const warning : {"base_color_texture@7.5", "emissive_texture 'sun.exr'@2",
                                      "sheen_color_texture@5", "specular_color_texture@6"}) {
        std::string text = warning;
        text.replace(text.find('@'), 1, end);
        EXPECT_NE(log.text.find(text), std::string::npos) << text << " in:\n" << log.text;
    }
    size_t count = 0;
    for (size_t at = log.text.find(end); at != std::string::npos; at = log.text.find(end, at + 1)) ++count;
    EXPECT_EQ(count, 4u) << log.text;
}

/// An image of 8 bits with one channel, row by row.
std::shared_ptr<const Image> grey_image(int width, std::initializer_list<uint8_t> texels) {
    auto image = std::make_shared<Image>(width, int(texels.size()) / width, 1, PixelType::u8);
    std::ranges::copy(texels, image->pixels<uint8_t>().begin());
    return image;
}

std::vector<int> texels_of(const Texture& texture, int channel) {
    std::vector<int> values;
    for (int y = 0; y < texture.image->height(); ++y)
        for (int x = 0; x < texture.image->width(); ++x)
            values.push_back(texture.image->at<uint8_t>(x, y)[channel]);
    return values;
}

/// The material that is read back, and no warning or one with `warning`.
Material saved_material(const Material& material, const std::string& warning = "") {
    MeshData data = square();
    data.materials = {material};
    const TemporaryFolder folder;
    const LogCapture log;
    Mesh(data).save(folder / "a.glb");
    if (warning.empty()) {
        EXPECT_EQ(log.text, "");
    } else {
        EXPECT_NE(log.text.find(warning), std::string::npos) << log.text;
    }
    return first_child(io::load_gltf(folder / "a.glb").mesh).materials.at(0);
}

// The tile of the one texture is that of the larger scale; the other repeats in it.
TEST(Glb, MergesTexturesWhoseTransformsFitInOneTile) {
    Material material;
    material.base_color_texture.image = grey_image(2, {10, 20});
    material.opacity_texture.image = grey_image(2, {30, 40});
    material.opacity_texture.uv_transform(0, 0) = 2;
    material.alpha_mode = AlphaMode::blend;
    const Texture finer = saved_material(material).base_color_texture;
    EXPECT_EQ(texels_of(finer, 0), (std::vector<int>{10, 10, 20, 20}));
    EXPECT_EQ(texels_of(finer, 3), (std::vector<int>{30, 40, 30, 40}));
    EXPECT_EQ(finer.uv_transform, Mat3::Identity());
    std::swap(material.base_color_texture.uv_transform, material.opacity_texture.uv_transform);
    const Texture coarser = saved_material(material).base_color_texture;
    EXPECT_EQ(texels_of(coarser, 0), (std::vector<int>{10, 20, 10, 20}));
    EXPECT_EQ(texels_of(coarser, 3), (std::vector<int>{30, 30, 40, 40}));
    EXPECT_EQ(coarser.uv_transform, Mat3::Identity());
}

// v goes up: at v = 0.75 of the upper row, an offset of 0.5 gives 1.25, which is the lower row.
TEST(Glb, MergesTexturesWhoseOffsetsDiffer) {
    Material material;
    material.metallic_texture.image = grey_image(1, {50, 60});
    material.roughness_texture.image = grey_image(1, {70, 80});
    material.roughness_texture.uv_transform(1, 2) = 0.5f;
    const Material read = saved_material(material);
    EXPECT_EQ(texels_of(read.metallic_texture, 2), (std::vector<int>{50, 60}));
    EXPECT_EQ(texels_of(read.roughness_texture, 1), (std::vector<int>{80, 70}));
    // One image for both is no texture for both.
    material.metallic_texture.image = material.roughness_texture.image = flat_image(2, {1, 2, 3});
    material.metallic_texture.channel = 2, material.roughness_texture.channel = 1;
    material.roughness_texture.uv_transform(0, 0) = 0.3f;
    saved_material(material, "roughness_texture");
}

TEST(Glb, NamesMappingsThatOneTextureCannotHave) {
    Material material;
    material.name = "wall";
    material.base_color_texture.image = grey_image(2, {10, 20});
    material.opacity_texture.image = grey_image(2, {30, 40});
    material.alpha_mode = AlphaMode::blend;
    const std::string warning =
        "transform and wraps of opacity_texture of material 'wall' beside those of base_color_texture";
    material.opacity_texture.uv_transform(0, 0) = 1.5f;
    EXPECT_EQ(texels_of(saved_material(material, warning).base_color_texture, 3), (std::vector<int>{30, 40}));
    material.opacity_texture.uv_transform(0, 0) = 2;
    material.opacity_texture.wrap_u = Wrap::clamp;
    saved_material(material, warning);
    material.opacity_texture.uv_transform = Mat3::Identity();
    saved_material(material, warning);
    material.base_color_texture.wrap_u = Wrap::clamp;
    saved_material(material);
    // 2 texels, 8000 times, are more than are made.
    material.base_color_texture.wrap_u = material.opacity_texture.wrap_u = Wrap::repeat;
    material.opacity_texture.uv_transform(0, 0) = 8000;
    saved_material(material, warning);
}

TEST(Glb, RoundTripsAHierarchyAndClouds) {
    MeshData root;
    root.name = "root";
    MeshData cloud = square();
    cloud.F = {};
    cloud.name = "cloud";
    MeshData middle = square();
    middle.name = "middle";
    middle.children = {Mesh(cloud)};
    root.children = {Mesh(middle), Mesh(cloud)};
    const auto read = round_trip(Mesh(root)).mesh.snapshot();
    ASSERT_EQ(read->children.size(), 2u);
    EXPECT_EQ(read->children[0].name(), "middle");
    ASSERT_EQ(read->children[0].snapshot()->children.size(), 1u);
    EXPECT_EQ(read->children[1].V().rows(), 4);
    EXPECT_EQ(read->children[1].F().rows(), 0);
}

TEST(Glb, RealFileSurvives) {
    REQUIRE_TEST_DATA();
    const Mesh helmet = io::load_gltf(test_data("DamagedHelmet/DamagedHelmet.gltf")).mesh;
    const MeshData before = first_child(helmet), after = first_child(round_trip(helmet).mesh);
    EXPECT_EQ(after.V, before.V);
    EXPECT_EQ(after.F, before.F);
    EXPECT_EQ(
        compare(*after.materials[0].roughness_texture.image, *before.materials[0].roughness_texture.image)
            .max,
        0);
}

TEST(Glb, RefusesAnEmptyMeshAndLeavesNothing) {
    const TemporaryFolder folder;
    EXPECT_THROW(io::save_glb(Mesh(), folder / "a.glb"), ArgumentError);
    EXPECT_THROW(io::save_glb(Mesh(square()), folder / "missing" / "a.glb"), FileError);
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(Glb, ColorsOfVerticesAreWrittenBesideWhite) {
    // square() has colours and no material; a colour that was chosen stays.
    EXPECT_EQ(first_child(round_trip(Mesh(square())).mesh).materials.at(0).base_color, Vec3(1, 1, 1));
    MeshData chosen = square();
    chosen.materials.resize(1);
    chosen.materials[0].base_color = Vec3(0.5f, 0.25f, 1);
    EXPECT_EQ(first_child(round_trip(Mesh(chosen)).mesh).materials.at(0).base_color, Vec3(0.5f, 0.25f, 1));
    MeshData plain = square();
    plain.C = {};
    EXPECT_TRUE(first_child(round_trip(Mesh(plain)).mesh).materials.at(0).has_default_color());
}

TEST(Glb, TexturesAreWrittenBesideWhite) {
    MeshData textured = square();
    textured.C = {};
    textured.UV = Array2f(Array2f::Dense::Zero(textured.V.rows(), 2));
    textured.materials.resize(1);
    textured.materials[0].base_color_texture.image = flat_image(2, {10, 20, 30});
    const auto color_of = [&] {
        return first_child(round_trip(Mesh(textured)).mesh).materials.at(0).base_color;
    };
    EXPECT_EQ(color_of(), Vec3(1, 1, 1));
    textured.materials[0].base_color_given = true;
    EXPECT_EQ(color_of(), Vec3(0.6f, 0.6f, 0.6f));
    EXPECT_FALSE(first_child(round_trip(Mesh(textured)).mesh).materials.at(0).has_default_color());
}

// Points and lines have one, but for the default, which draws lines dark.
TEST(Glb, MaterialsOfPointsAndLinesAreKept) {
    for (const bool lines : {false, true}) {
        MeshData data = square();
        data.F = {};
        data.C = {};
        Array2i::Dense E(1, 2);
        E << 0, 2;
        if (lines) data.E = E;
        Material red;
        red.name = "red";
        red.base_color = Vec3(1, 0, 0);
        red.opacity = 0.5f;
        data.materials = {red};
        const std::vector<Material> found = first_child(round_trip(Mesh(data)).mesh).materials;
        ASSERT_EQ(found.size(), 1u);
        EXPECT_EQ(found[0].name, "red");
        EXPECT_EQ(found[0].base_color, Vec3(1, 0, 0));
        EXPECT_EQ(found[0].opacity, 0.5f);
        data.materials = {Material()};
        const Mesh plain = round_trip(Mesh(data)).mesh;
        EXPECT_TRUE(first_child(plain).materials.empty() ||
                    first_child(plain).materials[0].has_default_color());
    }
}

}  // namespace easypbr::glb_test
