#include "easypbr/io/image/image_io.h"
#include "easypbr/io/mesh/gltf/gltf_reader.h"
#include "easypbr/io/mesh/mesh_io.h"
#include "io/fuzz.h"
#include "io/gltf_builder.h"

namespace easypbr::fuzz_gltf_test {

namespace {

/// A file with a bit of everything: indices, all attributes, a sparse accessor, a texture, nodes, a light, a
/// camera.
GltfBuilder rich_file() {
    GltfBuilder builder;
    nlohmann::json& primitive = builder.triangle();
    primitive["indices"] = builder.accessor(std::vector<uint16_t>{0, 1, 2}, 5123, "SCALAR", 3);
    primitive["attributes"]["NORMAL"] = builder.floats({0, 0, 1, 0, 0, 1, 0, 0, 1}, 3);
    primitive["attributes"]["TEXCOORD_0"] = builder.floats({0, 0, 1, 0, 0, 1}, 2);
    primitive["attributes"]["COLOR_0"] = builder.floats({0, 0, 1, 0, 0, 1, 1, 1, 1}, 3);
    primitive["material"] = 0;
    const size_t sparse_index = builder.view(std::vector<uint8_t>{1});
    const size_t sparse_value = builder.view(std::vector<float>{1, 2, 3});
    builder.json["accessors"][0]["sparse"] = {
        {"count", 1},
        {"indices", {{"bufferView", sparse_index}, {"componentType", 5121}}},
        {"values", {{"bufferView", sparse_value}}}};
    const auto png = io::encode_png(Image(4, 4, 3, PixelType::u8));
    builder.json["images"] = {{{"bufferView", builder.view(png)}}};
    builder.json["textures"] = {{{"source", 0}}};
    builder.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
    builder.json["nodes"] = {
        {{"children", {1, 2}}, {"rotation", {0, 0, 0, 1}}}, {{"mesh", 0}}, {{"camera", 0}}};
    builder.json["nodes"][2]["extensions"]["KHR_lights_punctual"]["light"] = 0;
    builder.json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.1}}}}};
    builder.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"intensity", 3}}};
    return builder;
}

void load(const std::string& bytes) {
    io::decode_gltf(as_span(bytes), "mutant.gltf");
}

}  // namespace

TEST(FuzzGltf, Glb) {
    fuzz(rich_file().glb(), load);
}

TEST(FuzzGltf, JsonWithDataUri) {
    GltfBuilder builder;
    builder.triangle();
    builder.json["buffers"] = {
        {{"byteLength", 36},
         {"uri", "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}}};
    fuzz(builder.json.dump(1), load);
}

// Numbers of the JSON replaced by others: the container stays whole, so that every check behind it is
// reached.
TEST(FuzzGltf, Numbers) {
    const GltfBuilder good = rich_file();
    std::mt19937 random(77);
    const std::vector<nlohmann::json> values = {0,    1,     2,   7,    -1,   255, 65536,  4294967295u,
                                                1e18, 1e300, 0.5, 5120, 5125, "x", nullptr};
    const nlohmann::json flat = good.json.flatten();
    for (int i = 0; i < fuzz_count(); ++i) {
        nlohmann::json changed = flat;
        for (int k = 0; k < 2; ++k)
            std::next(changed.begin(), long(random() % changed.size())).value() =
                values[random() % values.size()];
        GltfBuilder mutant = good;
        mutant.json = changed.unflatten();
        try {
            load(mutant.glb());
        } catch (const Error&) {
        } catch (const std::exception& error) {
            ADD_FAILURE() << "mutant " << i << ": " << error.what();
        }
    }
}

}  // namespace easypbr::fuzz_gltf_test
