#include <fmt/format.h>
#include <gtest/gtest.h>

#include "easypbr/core/color.h"
#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "easypbr/io/image/image_io.h"
#include "easypbr/io/mesh/gltf/gltf_reader.h"
#include "easypbr/io/mesh/mesh_io.h"
#include "io/gltf_decoded.h"
#include "io/temporary_folder.h"
#include "test_data.h"

namespace easypbr::gltf_test {
using io::LoadedScene;

namespace {

std::string png_bytes(int width, uint8_t value) {
    Image image(width, 2, 3, PixelType::u8);
    for (uint8_t& v : image.pixels<uint8_t>()) v = value;
    const auto bytes = io::encode_png(image);
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

TEST(Gltf, ReadsTheDuck) {
    REQUIRE_TEST_DATA();
    const LoadedScene scene = io::load_gltf(test_data("Duck/Duck.gltf"));
    EXPECT_EQ(scene.mesh.name(), "Duck");
    ASSERT_EQ(scene.cameras.size(), 1u);
    // yfov 0.6605925559997559 rad in the file.
    EXPECT_NEAR(scene.cameras.begin()->second.fov_y_deg, 37.849, 0.001);
    // The camera's node is scaled by the root's 0.01: its position is 0.01 times its translation.
    EXPECT_NEAR(scene.cameras.begin()->second.position().x(), 4.00113, 1e-5);
    const MeshData root = node(scene);
    ASSERT_EQ(root.children.size(), 1u);
    EXPECT_DOUBLE_EQ(root.T_parent_mesh.linear()(0, 0), 0.009999999776482582);
    const auto mesh = root.children[0].snapshot();
    EXPECT_EQ(mesh->V.rows(), 2399);
    EXPECT_EQ(mesh->F.rows(), 12636 / 3);
    EXPECT_EQ(mesh->N.rows(), 2399);
    // Bounds as the accessor's min and max state them.
    EXPECT_FLOAT_EQ(mesh->V.col(1).maxCoeff(), 163.97000122070312f);
    EXPECT_FLOAT_EQ(mesh->V.col(0).minCoeff(), -69.29850006103516f);
    ASSERT_EQ(mesh->materials.size(), 1u);
    EXPECT_EQ(mesh->materials[0].metallic, 0);
    EXPECT_EQ(mesh->materials[0].base_color_texture.image->width(), 512);
}

TEST(Gltf, ReadsTheHelmetWithItsFiveMaps) {
    REQUIRE_TEST_DATA();
    const LoadedScene scene = io::load_gltf(test_data("DamagedHelmet/DamagedHelmet.gltf"));
    const MeshData mesh = node(scene);
    EXPECT_EQ(mesh.V.rows(), 14556);
    EXPECT_EQ(mesh.F.rows(), 46356 / 3);
    const Material& material = mesh.materials.at(0);
    EXPECT_TRUE(material.base_color_texture && material.normal_texture && material.occlusion_texture &&
                material.emissive_texture);
    EXPECT_EQ(material.metallic_texture.image, material.roughness_texture.image);
    EXPECT_EQ(material.metallic_texture.channel, 2);
    EXPECT_EQ(material.roughness_texture.channel, 1);
    EXPECT_EQ(material.occlusion_texture.channel, 0);
    EXPECT_EQ(material.emissive, Vec3(1, 1, 1));
    // The file's v run from 1.0005 to 1.9987, downwards.
    EXPECT_NEAR(mesh.UV.col(1).maxCoeff(), 1 - 1.0005531, 1e-6);
    EXPECT_NEAR(mesh.UV.col(1).minCoeff(), 1 - 1.9986657, 1e-6);
}

TEST(Gltf, StripsAndFansKeepTheirWinding) {
    for (const int mode : {5, 6}) {
        GltfBuilder builder;
        // A strip's zigzag, and a fan around the first vertex, of a square seen from +z.
        const std::vector<float> strip = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
        const std::vector<float> fan = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
        const size_t position = builder.floats(mode == 5 ? strip : fan, 3);
        builder.json["meshes"] = {
            {{"primitives", {{{"attributes", {{"POSITION", position}}}, {"mode", mode}}}}}};
        const MeshData mesh = node(decode(builder));
        ASSERT_EQ(mesh.F.rows(), 2);
        for (int f = 0; f < 2; ++f) {
            const Vec3 a = mesh.V.row(mesh.F(f, 0)), b = mesh.V.row(mesh.F(f, 1)),
                       c = mesh.V.row(mesh.F(f, 2));
            // Counter-clockwise from +z: twice the area of half a square, along +z.
            EXPECT_EQ((b - a).cross(c - a), Vec3(0, 0, 1)) << mode << " " << f;
        }
    }
}

TEST(Gltf, LinesAndPointsAreKept) {
    const std::vector<float> points = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
    const int edges[] = {0, 2, 4, 3};
    for (int mode = 0; mode < 4; ++mode) {
        GltfBuilder builder;
        const size_t position = builder.floats(points, 3);
        builder.json["meshes"] = {
            {{"primitives", {{{"attributes", {{"POSITION", position}}}, {"mode", mode}}}}}};
        const MeshData mesh = node(decode(builder));
        EXPECT_EQ(mesh.V.rows(), 4);
        EXPECT_EQ(mesh.F.rows(), 0);
        EXPECT_EQ(mesh.E.rows(), edges[mode]) << mode;
    }
}

TEST(Gltf, PointsWithIndicesAreThoseOfTheIndices) {
    GltfBuilder builder;
    const size_t position = builder.floats({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}, 3);
    const size_t heat = builder.floats({5, 6, 7, 8}, 1);
    const size_t indices = builder.accessor(std::vector<uint16_t>{3, 1, 3}, 5123, "SCALAR", 3);
    const nlohmann::json some = {
        {"attributes", {{"POSITION", position}, {"_heat", heat}}}, {"indices", indices}, {"mode", 0}};
    nlohmann::json all = some;
    all.erase("indices");
    builder.json["meshes"] = {{{"primitives", {some}}}};
    const MeshData mesh = node(decode(builder));
    EXPECT_EQ(mesh.V, (Array3f::Dense{{1, 0, 0}, {1, 1, 0}})) << "each once, in the order of the vertices";
    EXPECT_EQ(mesh.scalars.at(0).values, (Array1f::Dense{{6}, {8}}));
    for (const auto& primitives : {nlohmann::json{all, some}, nlohmann::json{some, all}}) {
        builder.json["meshes"] = {{{"primitives", primitives}}};
        EXPECT_EQ(node(decode(builder)).V.rows(), 4) << "all and some are all";
    }
}

TEST(Gltf, ReadsInterleavedQuantisedAndSparseData) {
    GltfBuilder builder;
    // Rows of 12 bytes: three shorts of position, padding, a normalised byte normal, padding.
    std::vector<uint8_t> bytes(36);
    const int16_t positions[3][3] = {{0, 0, 0}, {100, 0, 0}, {0, -200, 0}};
    const int8_t normal[3] = {0, 0, 127};
    for (int i = 0; i < 3; ++i) {
        std::memcpy(&bytes[size_t(12 * i)], positions[i], 6);
        std::memcpy(&bytes[size_t(12 * i + 8)], normal, 3);
    }
    const size_t view = builder.view(bytes, 12);
    const size_t sparse_index = builder.view(std::vector<uint8_t>{1});
    const size_t sparse_value = builder.view(std::vector<int16_t>{300, 7, 8});
    builder.json["accessors"] = {{{"bufferView", view},
                                  {"componentType", 5122},
                                  {"count", 3},
                                  {"type", "VEC3"},
                                  {"sparse",
                                   {{"count", 1},
                                    {"indices", {{"bufferView", sparse_index}, {"componentType", 5121}}},
                                    {"values", {{"bufferView", sparse_value}}}}}},
                                 {{"bufferView", view},
                                  {"byteOffset", 8},
                                  {"componentType", 5120},
                                  {"normalized", true},
                                  {"count", 3},
                                  {"type", "VEC3"}}};
    builder.json["meshes"] = {{{"primitives", {{{"attributes", {{"POSITION", 0}, {"NORMAL", 1}}}}}}}};
    const MeshData mesh = node(decode(builder));
    EXPECT_EQ(Vec3(mesh.V.row(1)), Vec3(300, 7, 8));
    EXPECT_EQ(Vec3(mesh.V.row(2)), Vec3(0, -200, 0));
    EXPECT_EQ(Vec3(mesh.N.row(2)), Vec3(0, 0, 1));
}

TEST(Gltf, ReadsTangentsOfVerticesWithNormals) {
    for (const bool with_normals : {true, false}) {
        GltfBuilder builder;
        nlohmann::json& primitive = builder.triangle();
        if (with_normals) primitive["attributes"]["NORMAL"] = builder.floats({0, 0, 1, 0, 0, 1, 0, 0, 1}, 3);
        // Quantised, half as long, and none.
        primitive["attributes"]["TANGENT"] = builder.accessor(
            std::vector<int16_t>{0, 32767, 0, -32767, 16384, 0, 0, 32767, 0, 0, 0, 32767}, 5122, "VEC4", 3);
        builder.json["accessors"].back()["normalized"] = true;
        const MeshData mesh = node(decode(builder));
        // Section 3.7.2.1 of the specification: without normals tangents are ignored.
        ASSERT_EQ(mesh.uv_tangents.rows(), with_normals ? 3 : 0);
        if (!with_normals) continue;
        EXPECT_EQ(Eigen::RowVector4f(mesh.uv_tangents.row(0)), Eigen::RowVector4f(0, 1, 0, -1));
        EXPECT_EQ(Eigen::RowVector4f(mesh.uv_tangents.row(1)), Eigen::RowVector4f(1, 0, 0, 1));
        EXPECT_EQ(Eigen::RowVector4f(mesh.uv_tangents.row(2)), Eigen::RowVector4f(0, 0, 0, 0));
    }
}

TEST(Gltf, AttributesOfOtherProgramsBecomeScalars) {
    GltfBuilder builder;
    nlohmann::json& primitive = builder.triangle();
    const size_t ids = builder.accessor(std::vector<uint16_t>{3, 4, 5, 0}, 5123, "SCALAR", 3);
    const size_t wind = builder.floats({1, 2, 3, 4, 5, 6}, 2);
    const size_t label = builder.floats({0.5f, 1, 2}, 1);
    const size_t matrix = builder.accessor(std::vector<float>(27, 1.0f), 5126, "MAT3", 3);
    primitive["attributes"]["_BATCHID"] = ids;
    primitive["attributes"]["_wind"] = wind;
    primitive["attributes"]["_LABEL"] = label;
    primitive["attributes"]["_matrix"] = matrix;
    primitive["attributes"]["_short"] = builder.floats({1, 2}, 1);
    const LogCapture log;
    primitive["attributes"]["TANGENT"] = builder.floats(std::vector<float>(12, 1.0f), 4);
    // A second primitive without them.
    nlohmann::json second = primitive;
    second["attributes"] = {{"POSITION", primitive["attributes"]["POSITION"]}};
    builder.json["meshes"][0]["primitives"].push_back(second);
    const MeshData mesh = *decode(builder).mesh.snapshot()->children.at(0).snapshot();
    ASSERT_EQ(mesh.V.rows(), 6);
    ASSERT_EQ(mesh.scalars.size(), 4u);
    EXPECT_EQ(scalar_named(mesh, "BATCHID").values[2], 5);
    EXPECT_TRUE(std::isnan(scalar_named(mesh, "BATCHID").values[3]));
    EXPECT_EQ(scalar_named(mesh, "wind_1").values[1], 4);
    EXPECT_EQ(scalar_named(mesh, "LABEL").values[0], 0.5f) << "no whole numbers are no labels";
    EXPECT_TRUE(mesh.L.empty());
    for (const ScalarArray& scalar : mesh.scalars) EXPECT_TRUE(scalar.from_file) << scalar.name;
    EXPECT_NE(log.text.find("attribute _short is left out"), std::string::npos) << log.text;
}

TEST(Gltf, VertexColoursBecomeSrgb) {
    GltfBuilder builder;
    nlohmann::json& primitive = builder.triangle();
    primitive["attributes"]["COLOR_0"] = builder.accessor(
        std::vector<uint16_t>{0, 65535, 32768, 65535, 0, 0, 0, 0, 0, 0, 0, 0}, 5123, "VEC4", 3);
    builder.json["accessors"].back()["normalized"] = true;
    const MeshData mesh = node(decode(builder));
    ASSERT_EQ(mesh.C.cols(), 4);
    EXPECT_EQ(mesh.C(0, 0), 0);
    EXPECT_NEAR(mesh.C(0, 1), 1, 1e-6);
    // sRGB of 0.5 is 0.73536 (32768/65535 = 0.5000076).
    EXPECT_NEAR(mesh.C(0, 2), 0.73536, 2e-5);
    EXPECT_EQ(mesh.C(0, 3), 1);
}

TEST(Gltf, PrimitivesBecomePartsOfOneMesh) {
    GltfBuilder builder;
    nlohmann::json first = builder.triangle();
    nlohmann::json& primitives = builder.json["meshes"][0]["primitives"];
    const size_t other = builder.floats({0, 0, 1, 1, 0, 1, 0, 1, 1}, 3),
                 normal = builder.floats({0, 0, -1, 0, 0, -1, 0, 0, -1}, 3);
    builder.json["materials"] = {
        {{"name", "red"}, {"pbrMetallicRoughness", {{"baseColorFactor", {1, 0, 0, 0.5}}}}}};
    primitives.push_back({{"attributes", {{"POSITION", other}, {"NORMAL", normal}}}, {"material", 0}});
    primitives.push_back(first);
    const MeshData mesh = node(decode(builder));
    // The third primitive shares the first one's vertices. Without normals each face has its own.
    EXPECT_EQ(mesh.V.rows(), 9);
    EXPECT_EQ(mesh.F, (Array3i::Dense{{0, 1, 2}, {6, 7, 8}, {3, 4, 5}}));
    EXPECT_EQ(mesh.source_vertex, (Array1i::Dense{{0}, {1}, {2}, {0}, {1}, {2}, {3}, {4}, {5}}));
    ASSERT_EQ(mesh.parts.size(), 3u);
    EXPECT_EQ(mesh.parts[1].first_face, 1);
    EXPECT_EQ(mesh.parts[1].name, "red");
    EXPECT_EQ(mesh.parts[0].material, mesh.parts[2].material);
    EXPECT_EQ(mesh.materials[size_t(mesh.parts[1].material)].base_color, Vec3(1, 0, 0));
    EXPECT_EQ(mesh.materials[size_t(mesh.parts[1].material)].opacity, 0.5f);
    // glTF's default material is white metal; normals missing in the first primitive are computed.
    EXPECT_EQ(mesh.materials[size_t(mesh.parts[0].material)].metallic, 1);
    EXPECT_EQ(Vec3(mesh.N.row(0)), Vec3(0, 0, 1));
    EXPECT_EQ(Vec3(mesh.N.row(6)), Vec3(0, 0, -1));
}

TEST(Gltf, ReadsMaterialExtensions) {
    GltfBuilder builder;
    builder.triangle()["material"] = 0;
    builder.json["extensionsUsed"] = {"KHR_materials_unlit", "VENDOR_unheard_of"};
    builder.json["extensionsRequired"] = {"KHR_materials_unlit"};
    builder.json["materials"] = {{{"emissiveFactor", {1, 0.5, 0}},
                                  {"alphaMode", "MASK"},
                                  {"alphaCutoff", 0.25},
                                  {"doubleSided", true},
                                  {"extensions",
                                   {{"KHR_materials_emissive_strength", {{"emissiveStrength", 4}}},
                                    {"KHR_materials_unlit", nlohmann::json::object()}}}}};
    LogCapture log;
    const Material material = node(decode(builder)).materials.at(0);
    EXPECT_EQ(material.emissive, Vec3(4, 2, 0));
    EXPECT_EQ(*material.alpha_mode, AlphaMode::mask);
    EXPECT_EQ(material.alpha_cutoff, 0.25f);
    EXPECT_TRUE(material.double_sided && material.unlit);
    EXPECT_NE(log.text.find("VENDOR_unheard_of"), std::string::npos);
    EXPECT_EQ(log.text.find("KHR_materials_unlit"), std::string::npos);
}

TEST(Gltf, TextureTransformTurnsCounterClockwise) {
    GltfBuilder builder;
    builder.triangle()["material"] = 0;
    const std::string png = png_bytes(2, 9);
    builder.json["images"] = {
        {{"bufferView", builder.view(std::vector<char>(png.begin(), png.end()))}, {"mimeType", "image/png"}}};
    builder.json["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}}};
    builder.json["textures"] = {{{"source", 0}, {"sampler", 0}}};
    const double quarter = 1.5707963267948966;
    builder.json["materials"] = {
        {{"pbrMetallicRoughness",
          {{"baseColorTexture",
            {{"index", 0},
             {"extensions",
              {{"KHR_texture_transform",
                {{"offset", {0.25, 0.5}}, {"scale", {2, 3}}, {"rotation", quarter}}}}}}}}}}};
    const Texture texture = node(decode(builder)).materials.at(0).base_color_texture;
    ASSERT_TRUE(texture);
    EXPECT_EQ(texture.wrap_u, Wrap::clamp);
    EXPECT_EQ(texture.wrap_v, Wrap::mirror);
    EXPECT_EQ(texture.filter, Filter::nearest);
    // In glTF's frame (v down) scaling takes (0.1, 0.2) to (0.2, 0.6), a quarter turn counter-clockwise as
    // seen on the screen takes (u, v) to (v, -u) = (0.6, -0.2), shifting gives (0.85, 0.3). In ours: (0.1,
    // 0.8) to (0.85, 0.7).
    const Vec3 moved = texture.uv_transform * Vec3(0.1f, 0.8f, 1);
    EXPECT_NEAR(moved[0], 0.85, 1e-6);
    EXPECT_NEAR(moved[1], 0.7, 1e-6);
}

TEST(Gltf, FindsImagesByPercentCodedPathAndDataUri) {
    const TemporaryFolder folder;
    write_file(folder / "a b.png", png_bytes(3, 1));
    GltfBuilder builder;
    builder.triangle()["material"] = 0;
    const std::string pixel =
        "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg==";
    builder.json["images"] = {
        {{"uri", "a%20b.png"}}, {{"uri", "data:image/png;base64," + pixel}}, {{"uri", "missing.png"}}};
    builder.json["textures"] = {{{"source", 0}}, {{"source", 1}}, {{"source", 2}}};
    builder.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}},
                                  {"normalTexture", {{"index", 1}}},
                                  {"emissiveTexture", {{"index", 2}}}}};
    write_file(folder / "a.glb", builder.glb());
    LogCapture log;
    const Material material = node(io::load_gltf(folder / "a.glb")).materials.at(0);
    ASSERT_TRUE(material.base_color_texture && material.normal_texture);
    EXPECT_EQ(material.base_color_texture.image->width(), 3);
    EXPECT_EQ(material.normal_texture.image->width(), 1);
    EXPECT_FALSE(material.emissive_texture);
    EXPECT_NE(log.text.find("missing.png"), std::string::npos);
}

TEST(Gltf, PlacesNodesCamerasAndLightsInTheWorld) {
    GltfBuilder builder;
    builder.triangle();
    const double half = 0.7071067811865476;
    // A quarter turn about y takes -z to -x. The mirrored child keeps its negative determinant.
    builder.json["nodes"] = {{{"children", {1, 2}},
                              {"translation", {1, 2, 3}},
                              {"rotation", {0, half, 0, half}},
                              {"scale", {2, 2, 2}}},
                             {{"mesh", 0}, {"scale", {-1, 1, 1}}, {"name", "mirrored"}},
                             {{"camera", 0},
                              {"translation", {0, 0, 1}},
                              {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}}};
    builder.json["cameras"] = {{{"type", "orthographic"},
                                {"orthographic", {{"xmag", 1}, {"ymag", 3}, {"znear", 0.5}, {"zfar", 9}}}}};
    builder.json["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"name", "lamp"},
         {"type", "spot"},
         {"color", {1, 0, 0.5}},
         {"intensity", 7},
         {"range", 5},
         {"spot", {{"outerConeAngle", 0.5235987755982988}}}}};
    const LoadedScene scene = decode(builder);
    const MeshData root = node(scene);
    ASSERT_EQ(root.children.size(), 1u);
    EXPECT_EQ(root.children[0].name(), "mirrored");
    EXPECT_LT(root.children[0].T_parent_mesh().linear().determinant(), 0);
    const Camera camera = scene.cameras.begin()->second;
    EXPECT_EQ(camera.projection, Projection::orthographic);
    EXPECT_EQ(camera.ortho_height, 6);
    // (0, 0, 1) scaled by 2 and turned is (2, 0, 0), then shifted.
    EXPECT_LT((camera.position() - Vec3d(3, 2, 3)).norm(), 1e-12);
    EXPECT_NEAR(camera.T_world_cam.linear().determinant(), 1, 1e-12);
    const Light lamp = scene.lights.at("lamp");
    EXPECT_EQ(lamp.type, LightType::spot);
    EXPECT_LT((lamp.direction - Vec3(-1, 0, 0)).norm(), 1e-6);
    EXPECT_LT((lamp.position - Vec3d(3, 2, 3)).norm(), 1e-6);
    EXPECT_EQ(lamp.intensity, 7);
    EXPECT_EQ(lamp.range, 5);
    EXPECT_NEAR(lamp.outer_cone_deg, 30, 1e-4);
}

TEST(Gltf, RefusesBadInput) {
    const auto broken = [](auto&& change) {
        GltfBuilder builder;
        builder.triangle();
        change(builder);
        return message_of(builder);
    };
    using B = GltfBuilder&;
    const std::vector<std::pair<std::string, std::string>> table = {
        {broken([](B) {}), "accepted"},
        {broken([](B b) { b.json["asset"]["version"] = "1.0"; }), "expected glTF 2.x"},
        {broken([](B b) { b.json["accessors"][0]["count"] = 4; }), "accessors[0] ends behind"},
        {broken([](B b) { b.json["accessors"][0]["count"] = 1e18; }), "whole number"},
        {broken([](B b) { b.json["accessors"][0]["count"] = 0; }), "count of 0"},
        {broken([](B b) { b.json["accessors"][0]["byteOffset"] = 1099511627776; }), "ends behind"},
        {broken([](B b) { b.json["accessors"][0]["type"] = "VEC9"; }), "must be SCALAR"},
        {broken([](B b) { b.json["accessors"][0]["type"] = "VEC2"; }), "2 components"},
        {broken([](B b) { b.json["accessors"][0]["componentType"] = 7; }), "componentType"},
        {broken([](B b) { b.json["bufferViews"][0]["byteLength"] = 9999; }), "bufferViews[0] ends"},
        {broken([](B b) { b.json["bufferViews"][0]["byteStride"] = 2; }), "stride"},
        {broken([](B b) { b.json["bufferViews"][0]["buffer"] = 1; }), "buffers[1] does not exist"},
        {broken([](B b) {
             b.json["buffers"] = {{{"byteLength", 9999}}};
         }),
         "buffers[0] must have"},
        {broken([](B b) {
             b.json["buffers"] = {{{"byteLength", 36}, {"uri", "http://x/y"}}};
         }),
         "URI"},
        {broken([](B b) {
             b.json["buffers"] = {{{"byteLength", 36}, {"uri", "data:;base64,*"}}};
         }),
         "base 64"},
        {broken([](B b) { b.json["nodes"][0]["mesh"] = 5; }), "meshes[5] does not exist"},
        {broken([](B b) { b.json["nodes"][0]["mesh"] = -1; }), "whole number"},
        {broken([](B b) { b.json["nodes"][0]["children"] = {0}; }), "circle"},
        {broken([](B b) {
             b.json["nodes"][0]["matrix"] = {1, 2};
         }),
         "16 numbers"},
        {broken([](B b) { b.json["meshes"][0]["primitives"][0]["mode"] = 8; }), "unknown mode"},
        {broken([](B b) { b.json["meshes"][0]["primitives"][0]["material"] = 0; }),
         "materials[0] does not exist"},
        {broken([](B b) { b.json["meshes"] = 3; }), "must be an array"},
        {broken([](B b) {
             b.json["nodes"] = {{{"name", "x"}}};
         }),
         "no mesh"},
        {broken([](B b) {
             const float nan = std::nanf("");
             std::memcpy(b.binary.data() + 4, &nan, 4);
         }),
         "not finite"},
        {broken([](B b) {
             b.json["meshes"][0]["primitives"][0]["indices"] =
                 b.accessor(std::vector<uint8_t>{0, 1, 3}, 5121, "SCALAR", 3);
         }),
         "index 3 of 3 vertices"},
        {broken([](B b) {
             b.json["extensionsRequired"] = {"KHR_texture_basisu", "KHR_materials_ior"};
         }),
         "requires the extension KHR_texture_basisu, which is not supported"},
        {broken([](B b) { b.json["extensionsRequired"] = {"KHR_materials_ior"}; }), "accepted"},
        {broken([](B b) { b.json["extensionsRequired"] = {3}; }), "requires the extension"},
        {broken([](B b) {
             b.json["buffers"] = {{{"uri", "/etc/passwd"}, {"byteLength", 36}}};
         }),
         "URI '/etc/passwd' leads out of the file's folder"},
        {broken([](B b) {
             b.json["buffers"] = {{{"uri", "a/../../b.bin"}, {"byteLength", 36}}};
         }),
         "URI 'a/../../b.bin' leads out of"},
        {broken([](B b) {
             b.json["buffers"] = {{{"uri", "%2e%2E/b.bin"}, {"byteLength", 36}}};
         }),
         "leads out of"},
        {broken([](B b) {
             b.json["buffers"] = {{{"uri", "b.bin%00"}, {"byteLength", 36}}};
         }),
         "leads out of"},
    };
    for (const auto& [message, expected] : table) {
        EXPECT_NE(message.find(expected), std::string::npos)
            << "expected: " << expected << "\ngot: " << message;
        const bool names_file = message.find("test.glb") != std::string::npos;
        EXPECT_EQ(names_file, expected != "accepted") << message;
    }
}

TEST(Gltf, RefusesDamagedContainers) {
    GltfBuilder builder;
    builder.triangle();
    const std::string whole = builder.glb();
    for (size_t size = 0; size < whole.size(); size += 7)
        EXPECT_THROW(io::decode_gltf(as_span(whole.substr(0, size)), "x.glb"), FormatError) << size;
    for (const std::string text : {"{", "[]", "null", "{\"asset\":{\"version\":2}}", "{\"asset\":3}"})
        EXPECT_THROW(io::decode_gltf(as_span(text), "x.gltf"), FormatError) << text;
    EXPECT_THROW(io::load_gltf("missing.gltf"), FileError);
}

TEST(Gltf, RefusesAChainOfNodesThatIsTooDeep) {
    GltfBuilder builder;
    builder.triangle();
    builder.json["nodes"] = nlohmann::json::array();
    for (size_t i = 0; i < 100000; ++i) builder.json["nodes"].push_back({{"children", {i + 1}}});
    builder.json["nodes"].push_back({{"mesh", 0}});
    EXPECT_NE(message_of(builder).find("levels deep"), std::string::npos);
}

TEST(Gltf, SurvivesDeeplyNestedJson) {
    const std::string text = "{\"asset\":{\"version\":\"2.0\"},\"extras\":" + std::string(200000, '[');
    EXPECT_THROW(io::decode_gltf(as_span(text), "x.gltf"), FormatError);
}

TEST(Gltf, AFactorOf06BesideColorsIsNoDefault) {
    const auto material_of = [](bool with_colors) {
        GltfBuilder builder;
        builder.triangle();
        nlohmann::json& primitive = builder.json["meshes"][0]["primitives"][0];
        if (with_colors) primitive["attributes"]["COLOR_0"] = builder.floats({1, 0, 0, 1, 0, 0, 1, 0, 0}, 3);
        primitive["material"] = 0;
        builder.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorFactor", {0.6, 0.6, 0.6, 1}}}}}};
        return node(decode(builder)).materials.at(0);
    };
    EXPECT_EQ(material_of(true).base_color, Vec3(0.6f, 0.6f, 0.6f));
    EXPECT_FALSE(material_of(true).has_default_color());
    EXPECT_TRUE(material_of(false).has_default_color());
}

}  // namespace easypbr::gltf_test
