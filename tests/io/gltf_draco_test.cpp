// Primitives compressed with KHR_draco_mesh_compression, by Draco's encoder.
#ifdef EASYPBR_HAS_DRACO
#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "easypbr/io/mesh/gltf/gltf_draco.h"
#include "io/fuzz.h"
#include "io/gltf_decoded.h"

namespace easypbr::gltf_draco_test {

namespace {

using Json = nlohmann::json;
using Corner = std::array<float, 5>;  ///< position, texture coordinates

/// A grid of n x n cells, as the corners of its triangles.
std::vector<Corner> grid_corners(int n) {
    std::vector<Corner> out;
    const auto add = [&](int x, int y) {
        out.push_back({float(x), float(y), float((x * y) % 5), float(x) / float(n), float(y) / float(n)});
    };
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x) {
            add(x, y), add(x + 1, y), add(x, y + 1);
            add(x, y + 1), add(x + 1, y), add(x + 1, y + 1);
        }
    return out;
}

struct Encoded {
    std::string bytes;
    size_t points = 0, faces = 0;
};

Encoded encoded(const std::vector<Corner>& corners, int method) {
    draco::TriangleSoupMeshBuilder builder;
    builder.Start(int(corners.size() / 3));
    const int V = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32),
              UV = builder.AddAttribute(draco::GeometryAttribute::TEX_COORD, 2, draco::DT_FLOAT32);
    for (size_t f = 0; f < corners.size() / 3; ++f) {
        const Corner *a = &corners[3 * f], *b = a + 1, *c = a + 2;
        const draco::FaceIndex face{uint32_t(f)};
        builder.SetAttributeValuesForFace(V, face, a->data(), b->data(), c->data());
        builder.SetAttributeValuesForFace(UV, face, a->data() + 3, b->data() + 3, c->data() + 3);
    }
    const auto mesh = builder.Finalize();
    draco::Encoder encoder;
    encoder.SetEncodingMethod(method);
    encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, 14);
    encoder.SetAttributeQuantization(draco::GeometryAttribute::TEX_COORD, 14);
    draco::EncoderBuffer buffer;
    EXPECT_TRUE(encoder.EncodeMeshToBuffer(*mesh, &buffer).ok());
    return {{buffer.data(), buffer.size()}, mesh->num_points(), mesh->num_faces()};
}

Json& compress(GltfBuilder& builder, const Encoded& data) {
    const auto accessor = [&](int component_type, size_t count, const char* type) {
        builder.json["accessors"].push_back(
            {{"componentType", component_type}, {"count", count}, {"type", type}});
        return builder.json["accessors"].size() - 1;
    };
    const size_t V = accessor(5126, data.points, "VEC3"), UV = accessor(5126, data.points, "VEC2"),
                 F = accessor(5123, 3 * data.faces, "SCALAR");
    const size_t view = builder.view(std::vector<char>(data.bytes.begin(), data.bytes.end()));
    builder.json["meshes"] = {
        {{"primitives",
          {{{"attributes", {{"POSITION", V}, {"TEXCOORD_0", UV}}},
            {"indices", F},
            {"extensions",
             {{"KHR_draco_mesh_compression",
               {{"bufferView", view}, {"attributes", {{"POSITION", 0}, {"TEXCOORD_0", 1}}}}}}}}}}}};
    builder.json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
    return builder.json["meshes"][0]["primitives"][0];
}

using Key = std::array<long, 5>;

Key key_of(float x, float y, float z, float u, float v) {
    const auto rounded = [](float value) { return std::lround(100 * value); };
    return {rounded(x), rounded(y), rounded(z), rounded(u), rounded(v)};
}

/// The triangles, whatever their order and first corner.
std::multiset<std::array<Key, 3>> triangles_of(const std::function<Key(size_t)>& corner, size_t faces) {
    std::multiset<std::array<Key, 3>> out;
    for (size_t f = 0; f < faces; ++f) {
        std::array<Key, 3> triangle = {corner(3 * f), corner(3 * f + 1), corner(3 * f + 2)};
        std::rotate(triangle.begin(), std::ranges::min_element(triangle), triangle.end());
        out.insert(triangle);
    }
    return out;
}

class GltfDraco : public testing::TestWithParam<int> {};

}  // namespace

TEST_P(GltfDraco, ReadsTrianglesWithTheirAttributes) {
    const std::vector<Corner> corners = grid_corners(7);
    GltfBuilder builder;
    compress(builder, encoded(corners, GetParam()));
    const MeshData mesh = node(decode(builder));
    ASSERT_EQ(size_t(mesh.F.rows()), corners.size() / 3);
    ASSERT_EQ(mesh.UV.rows(), mesh.V.rows());
    const auto found = triangles_of(
        [&](size_t i) {
            const Eigen::Index v = mesh.F(Eigen::Index(i / 3), Eigen::Index(i % 3));
            return key_of(mesh.V(v, 0), mesh.V(v, 1), mesh.V(v, 2), mesh.UV(v, 0), 1 - mesh.UV(v, 1));
        },
        corners.size() / 3);
    const auto expected = triangles_of(
        [&](size_t i) {
            const Corner& c = corners[i];
            return key_of(c[0], c[1], c[2], c[3], c[4]);
        },
        corners.size() / 3);
    EXPECT_EQ(found, expected);
}

TEST_P(GltfDraco, SurvivesDamage) {
    const Encoded data = encoded(grid_corners(4), GetParam());
    // The compressed bytes alone, so that every mutant reaches the decoder.
    std::mt19937 random(7);
    for (int i = 0; i < 4 * fuzz_count(); ++i) {
        Encoded mutant = data;
        mutant.bytes = mutated(data.bytes, random);
        GltfBuilder builder;
        compress(builder, mutant);
        EXPECT_NO_THROW(message_of(builder)) << "mutant " << i;
    }
}

INSTANTIATE_TEST_SUITE_P(Methods, GltfDraco,
                         testing::Values(draco::MESH_EDGEBREAKER_ENCODING, draco::MESH_SEQUENTIAL_ENCODING),
                         [](const auto& info) { return info.param ? "Edgebreaker" : "Sequential"; });

TEST(GltfDraco, PrimitivesMayDescribeTheirDataByTheSameAccessors) {
    std::vector<Corner> corners = grid_corners(3);
    GltfBuilder builder;
    Json first = compress(builder, encoded(corners, draco::MESH_EDGEBREAKER_ENCODING));
    for (Corner& corner : corners) corner[0] += 10;
    const Encoded shifted = encoded(corners, draco::MESH_EDGEBREAKER_ENCODING);
    Json second = first;
    second["extensions"]["KHR_draco_mesh_compression"]["bufferView"] =
        builder.view(std::vector<char>(shifted.bytes.begin(), shifted.bytes.end()));
    builder.json["meshes"][0]["primitives"] = {first, second};
    const MeshData mesh = node(decode(builder));
    ASSERT_EQ(mesh.F.rows(), 36);
    EXPECT_NEAR(mesh.V.col(0).maxCoeff(), 13, 1e-3);
    EXPECT_NEAR(mesh.V.col(0).minCoeff(), 0, 1e-3);
}

TEST(GltfDraco, CountsWhatTheDataHold) {
    GltfBuilder builder;
    compress(builder, encoded(grid_corners(3), draco::MESH_EDGEBREAKER_ENCODING));
    for (Json& accessor : builder.json["accessors"]) accessor["count"] = 99;
    const MeshData mesh = node(decode(builder));
    EXPECT_EQ(mesh.F.rows(), 18);
    EXPECT_EQ(mesh.V.rows(), 16);
}

TEST(GltfDraco, PrefersWhatIsThereWithoutCompression) {
    GltfBuilder builder;
    builder.triangle()["extensions"]["KHR_draco_mesh_compression"]["bufferView"] = 77;
    EXPECT_EQ(node(decode(builder)).F.rows(), 1);
}

TEST(GltfDraco, RefusesWhatDoesNotFit) {
    const Encoded data = encoded(grid_corners(3), draco::MESH_EDGEBREAKER_ENCODING);
    const auto broken = [&](auto&& change) {
        GltfBuilder builder;
        Json& primitive = compress(builder, data);
        change(builder.json, primitive, primitive["extensions"]["KHR_draco_mesh_compression"]);
        return message_of(builder);
    };
    const auto with_bytes = [](std::string bytes, size_t points) {
        GltfBuilder builder;
        compress(builder, {std::move(bytes), points, 18});
        return message_of(builder);
    };
    // Behind the header of 11 bytes: the traversal, then the vertices and the faces with 7 bits in a byte.
    std::string greedy = data.bytes;
    greedy.replace(12, 2, "\xff\xff\xff\xff\x0f\xff\xff\xff\xff\x0f");
    const std::vector<std::pair<std::string, std::string>> table = {
        {broken([](Json&, Json&, Json&) {}), "accepted"},
        {broken([](Json&, Json& p, Json&) { p["mode"] = 5; }), "expected a primitive of triangles"},
        {broken([](Json&, Json& p, Json&) { p.erase("indices"); }), "'indices' is missing"},
        {broken([](Json&, Json&, Json& e) { e["bufferView"] = 9; }), "bufferViews[9] does not exist"},
        {broken([](Json&, Json&, Json& e) { e.erase("attributes"); }), "there are no attributes"},
        {broken([](Json&, Json&, Json& e) { e["attributes"]["POSITION"] = 5; }), "it lacks an attribute"},
        {broken([](Json&, Json&, Json& e) { e["attributes"]["NORMAL"] = 1; }), "'NORMAL' is missing"},
        {broken([](Json& j, Json&, Json&) { j["accessors"][1]["type"] = "VEC4"; }), "too few components"},
        {broken([](Json& j, Json&, Json&) { j["accessors"][0]["count"] = 0; }), "count of 0"},
        {broken([](Json& j, Json&, Json&) { j["accessors"][0]["type"] = "MAT4"; }), "cannot be compressed"},
        {broken([](Json& j, Json&, Json&) { j["accessors"][2]["componentType"] = 5126; }),
         "unsigned integer"},
        {with_bytes(data.bytes.substr(0, data.bytes.size() / 2), data.points), "is damaged"},
        {with_bytes(data.bytes.substr(0, 13), data.points), "truncated header"},
        {with_bytes("PNG and not DRACO", data.points), "its header is not Draco's"},
        {with_bytes(greedy, data.points), "compressed triangles would take"},
    };
    for (const auto& [message, expected] : table)
        EXPECT_NE(message.find(expected), std::string::npos)
            << "expected: " << expected << "\ngot: " << message;
}
#endif

}  // namespace easypbr::gltf_draco_test
