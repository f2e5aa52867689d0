// Small glTF files for tests, made piece by piece.
#pragma once

#include <nlohmann/json.hpp>

#include <cstring>
#include <string>
#include <vector>

#include "io/bytes.h"

class GltfBuilder {
  public:
    GltfBuilder() {
        json["asset"]["version"] = "2.0";
        json["scenes"] = {{{"nodes", {0}}}};
        json["nodes"] = {{{"mesh", 0}}};
    }

    template <class T>
    size_t view(const std::vector<T>& values, size_t stride = 0) {
        binary.resize((binary.size() + 3) / 4 * 4, '\0');
        nlohmann::json entry = {
            {"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", values.size() * sizeof(T)}};
        if (stride) entry["byteStride"] = stride;
        binary.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
        json["bufferViews"].push_back(entry);
        return json["bufferViews"].size() - 1;
    }

    /// An accessor over a view of its own.
    template <class T>
    size_t accessor(const std::vector<T>& values, int component_type, const std::string& type, size_t count) {
        json["accessors"].push_back({{"bufferView", view(values)},
                                     {"componentType", component_type},
                                     {"count", count},
                                     {"type", type}});
        return json["accessors"].size() - 1;
    }

    size_t floats(const std::vector<float>& values, int columns) {
        const std::string type = columns == 1 ? "SCALAR" : "VEC" + std::to_string(columns);
        return accessor(values, 5126, type, values.size() / size_t(columns));
    }

    /// A mesh with one triangle (0,0,0) (1,0,0) (0,1,0), without indices.
    nlohmann::json& triangle() {
        const size_t position = floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, 3);
        json["meshes"].push_back({{"primitives", {{{"attributes", {{"POSITION", position}}}}}}});
        return json["meshes"].back()["primitives"][0];
    }

    std::string glb() const {
        nlohmann::json whole = json;
        if (!whole.contains("buffers")) whole["buffers"] = {{{"byteLength", binary.size()}}};
        std::string text = whole.dump();
        text.resize((text.size() + 3) / 4 * 4, ' ');
        const std::string padded = binary + std::string((4 - binary.size() % 4) % 4, '\0');
        return "glTF" + word(2) + word(28 + text.size() + padded.size()) + word(text.size()) + "JSON" + text +
               word(padded.size()) + std::string("BIN\0", 4) + padded;
    }

    nlohmann::json json;
    std::string binary;

  private:
    static std::string word(size_t value) {
        const uint32_t w = uint32_t(value);
        return std::string(reinterpret_cast<const char*>(&w), 4);
    }
};
