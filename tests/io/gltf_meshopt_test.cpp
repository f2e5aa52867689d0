// Buffer views compressed with EXT_meshopt_compression, by meshoptimizer's encoder.
#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <cmath>

#include "io/fuzz.h"
#include "io/gltf_decoded.h"

namespace easypbr::gltf_meshopt_test {

namespace {

using Json = nlohmann::json;
constexpr const char* meshopt = "EXT_meshopt_compression";

struct Packed {
    const char* mode;
    size_t count, stride;
    std::vector<unsigned char> bytes;
    const char* filter = "NONE";
};

template <class T>
Packed attributes(const std::vector<T>& rows, size_t columns, const char* filter = "NONE") {
    const size_t stride = columns * sizeof(T), count = rows.size() / columns;
    std::vector<unsigned char> bytes(meshopt_encodeVertexBufferBound(count, stride));
    bytes.resize(meshopt_encodeVertexBuffer(bytes.data(), bytes.size(), rows.data(), count, stride));
    return {"ATTRIBUTES", count, stride, bytes, filter};
}

Packed triangles(const std::vector<uint32_t>& indices, size_t vertices) {
    std::vector<unsigned char> bytes(meshopt_encodeIndexBufferBound(indices.size(), vertices));
    bytes.resize(meshopt_encodeIndexBuffer(bytes.data(), bytes.size(), indices.data(), indices.size()));
    return {"TRIANGLES", indices.size(), 4, bytes};
}

Packed sequence(const std::vector<uint32_t>& indices, size_t vertices) {
    std::vector<unsigned char> bytes(meshopt_encodeIndexSequenceBound(indices.size(), vertices));
    bytes.resize(meshopt_encodeIndexSequence(bytes.data(), bytes.size(), indices.data(), indices.size()));
    return {"INDICES", indices.size(), 4, bytes};
}

/// An accessor over what is packed, whose own buffer is there for programs without the extension alone.
size_t add(GltfBuilder& builder, const Packed& packed, int component_type, const std::string& type,
           bool normalized = false) {
    const size_t plain = builder.view(packed.bytes);
    Json& view = builder.json["bufferViews"][plain];
    Json extension = view;
    extension["byteStride"] = packed.stride;
    extension["count"] = packed.count;
    extension["mode"] = packed.mode;
    if (packed.filter != std::string("NONE")) extension["filter"] = packed.filter;
    view = {
        {"buffer", 1}, {"byteLength", packed.count * packed.stride}, {"extensions", {{meshopt, extension}}}};
    if (packed.mode == std::string("ATTRIBUTES")) view["byteStride"] = packed.stride;
    builder.json["accessors"].push_back({{"bufferView", plain},
                                         {"componentType", component_type},
                                         {"count", packed.count},
                                         {"type", type},
                                         {"normalized", normalized}});
    return builder.json["accessors"].size() - 1;
}

/// A grid of n x n vertices.
struct Grid {
    explicit Grid(size_t n) {
        for (size_t y = 0; y < n; ++y)
            for (size_t x = 0; x < n; ++x) {
                V.insert(V.end(), {float(x), float(y), std::sin(float(x * y))});
                const uint32_t a = uint32_t(y * n + x), b = a + uint32_t(n);
                if (x + 1 < n && y + 1 < n) F.insert(F.end(), {a, a + 1, b, b, a + 1, b + 1});
            }
    }
    std::vector<float> V;
    std::vector<uint32_t> F;
};

/// The buffers: what is packed, and the fallback without data.
void add_buffers(GltfBuilder& builder) {
    builder.json["buffers"] = {{{"byteLength", builder.binary.size()}},
                               {{"byteLength", 1000000}, {"extensions", {{meshopt, {{"fallback", true}}}}}}};
    builder.json["extensionsRequired"] = {meshopt};
}

GltfBuilder grid_file(const Grid& grid, const Packed& indices) {
    GltfBuilder builder;
    const size_t V = add(builder, attributes(grid.V, 3), 5126, "VEC3"),
                 F = add(builder, indices, 5125, "SCALAR");
    builder.json["meshes"] = {{{"primitives", {{{"attributes", {{"POSITION", V}}}, {"indices", F}}}}}};
    add_buffers(builder);
    return builder;
}

void expect_grid(const GltfBuilder& builder, const Grid& grid) {
    const MeshData mesh = node(decode(builder));
    ASSERT_EQ(size_t(mesh.V.rows()), grid.V.size() / 3);
    ASSERT_EQ(size_t(mesh.F.rows()), grid.F.size() / 3);
    for (size_t i = 0; i < grid.V.size(); ++i)
        ASSERT_EQ(mesh.V(Eigen::Index(i / 3), Eigen::Index(i % 3)), grid.V[i]) << i;
    // The encoder of triangles may turn a triangle, which keeps its winding.
    for (size_t f = 0; f < grid.F.size() / 3; ++f) {
        std::vector<int> found, expected;
        for (size_t k = 0; k < 3; ++k) {
            found.push_back(mesh.F(Eigen::Index(f), Eigen::Index(k)));
            expected.push_back(int(grid.F[3 * f + k]));
        }
        std::rotate(found.begin(), std::ranges::min_element(found), found.end());
        std::rotate(expected.begin(), std::ranges::min_element(expected), expected.end());
        ASSERT_EQ(found, expected) << f;
    }
}

}  // namespace

TEST(GltfMeshopt, ReadsAttributesAndBothKindsOfIndices) {
    const Grid grid(23);
    expect_grid(grid_file(grid, triangles(grid.F, grid.V.size() / 3)), grid);
    expect_grid(grid_file(grid, sequence(grid.F, grid.V.size() / 3)), grid);
}

TEST(GltfMeshopt, ReadsFilteredAttributes) {
    const Grid grid(5);
    const size_t count = grid.V.size() / 3;
    std::vector<float> wanted(4 * count), four(4 * count, 0);
    for (size_t i = 0; i < count; ++i) {
        const Vec3 N = Vec3(std::cos(float(i)), std::sin(float(i)), 0.5f - 0.04f * float(i)).normalized();
        std::copy_n(N.data(), 3, wanted.begin() + long(4 * i));
        std::copy_n(N.data(), 3, four.begin() + long(4 * i));
    }
    std::vector<int16_t> octahedral(4 * count);
    meshopt_encodeFilterOct(octahedral.data(), count, 8, 16, four.data());
    std::vector<uint32_t> exponential(3 * count);
    meshopt_encodeFilterExp(exponential.data(), count, 12, 24, grid.V.data());
    GltfBuilder builder;
    const size_t V = add(builder, attributes(exponential, 3, "EXPONENTIAL"), 5126, "VEC3"),
                 N = add(builder, attributes(octahedral, 4, "OCTAHEDRAL"), 5122, "VEC3", true);
    builder.json["meshes"] = {
        {{"primitives", {{{"attributes", {{"POSITION", V}, {"NORMAL", N}}}, {"mode", 0}}}}}};
    add_buffers(builder);
    const MeshData mesh = node(decode(builder));
    ASSERT_EQ(size_t(mesh.N.rows()), count);
    for (size_t i = 0; i < count; ++i)
        for (size_t k = 0; k < 3; ++k) {
            const auto row = Eigen::Index(i), column = Eigen::Index(k);
            EXPECT_NEAR(mesh.N(row, column), wanted[4 * i + k], 1e-4) << i;
            EXPECT_NEAR(mesh.V(row, column), grid.V[3 * i + k], 1e-5 * (1 + std::abs(grid.V[3 * i + k])));
        }
}

TEST(GltfMeshopt, ReadsFilteredRotations) {
    const std::vector<float> rotation = {0, 0, float(std::sqrt(0.5)), float(std::sqrt(0.5)), 0, 0, 0, 1};
    std::vector<int16_t> filtered(8);
    meshopt_encodeFilterQuat(filtered.data(), 2, 8, 16, rotation.data());
    GltfBuilder builder;
    builder.triangle();
    const size_t times = builder.floats({0, 1}, 1);
    const size_t R = add(builder, attributes(filtered, 4, "QUATERNION"), 5122, "VEC4", true);
    builder.json["animations"] = {
        {{"samplers", {{{"input", times}, {"output", R}}}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "rotation"}}}}}}}};
    add_buffers(builder);
    io::LoadedScene scene = decode(builder);
    scene.animations.apply(0, 0);
    const Vec3d x = scene.mesh.children()[0].T_world_mesh().linear().col(0);
    EXPECT_LT((x - Vec3d(0, 1, 0)).norm(), 1e-3);
}

TEST(GltfMeshopt, RefusesWhatDoesNotFit) {
    const Grid grid(4);
    const auto broken = [&](auto&& change) {
        GltfBuilder builder = grid_file(grid, triangles(grid.F, 16));
        change(builder.json["bufferViews"][0], builder.json["bufferViews"][0]["extensions"][meshopt]);
        return message_of(builder);
    };
    const std::vector<std::pair<std::string, std::string>> table = {
        {broken([](Json&, Json&) {}), "accepted"},
        {broken([](Json&, Json& e) { e["mode"] = "PLANTS"; }), "unknown mode 'PLANTS'"},
        {broken([](Json&, Json& e) { e["filter"] = "COLOR"; }), "unknown filter 'COLOR'"},
        {broken([](Json&, Json& e) { e["filter"] = "QUATERNION"; }), "do not go with"},
        {broken([](Json&, Json& e) { e["mode"] = "TRIANGLES"; }), "do not go with"},
        {broken([](Json&, Json& e) { e["byteStride"] = 260; }), "do not go with"},
        {broken([](Json&, Json& e) { e["byteStride"] = 0; }), "do not go with"},
        {broken([](Json&, Json& e) { e["count"] = 0; }), "do not go with"},
        {broken([](Json&, Json& e) { e["count"] = 17; }), "do not make the view's"},
        {broken([](Json& view, Json& e) {
             e["count"] = 1099511627776;
             view["byteLength"] = 1099511627776;
         }),
         "do not make the view's"},
        {broken([](Json& view, Json& e) {
             e["count"] = 10000000000;
             view["byteLength"] = 120000000000;
         }),
         "bufferViews[0] would take 120.0 GB"},
        {broken([](Json&, Json& e) { e["byteOffset"] = 100000; }), "ends at byte"},
        {broken([](Json&, Json& e) { e["byteLength"] = e["byteLength"].get<int>() - 1; }), "damaged data"},
        {broken([](Json&, Json& e) { e["byteOffset"] = 1; }), "damaged data"},
        {broken([](Json&, Json& e) { e["buffer"] = 1; }), "buffers[1] has no data"},
        {broken([](Json&, Json& e) { e = 1; }), "'buffer' is missing"},
    };
    for (const auto& [message, expected] : table)
        EXPECT_NE(message.find(expected), std::string::npos)
            << "expected: " << expected << "\ngot: " << message;
}

TEST(GltfMeshopt, SurvivesDamage) {
    const Grid grid(6);
    fuzz(grid_file(grid, triangles(grid.F, 36)).glb(),
         [](const std::string& bytes) { io::decode_gltf(as_span(bytes), "mutant.glb"); });
}

}  // namespace easypbr::gltf_meshopt_test
