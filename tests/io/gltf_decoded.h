// Small glTF files of tests, read.
#pragma once

#include <string>

#include "easypbr/core/error.h"
#include "easypbr/core/log.h"
#include "easypbr/io/mesh/gltf/gltf_reader.h"
#include "easypbr/io/mesh/mesh_io.h"
#include "io/gltf_builder.h"

inline easypbr::io::LoadedScene decode(const GltfBuilder& builder, const std::string& variant = {}) {
    return easypbr::io::decode_gltf(as_span(builder.glb()), "test.glb", variant);
}

/// Data of a node of the scene.
inline easypbr::MeshData node(const easypbr::io::LoadedScene& scene, size_t index = 0) {
    return *scene.mesh.snapshot()->children.at(index).snapshot();
}

/// What is wrong with a file, or "accepted".
inline std::string message_of(const GltfBuilder& builder) {
    try {
        decode(builder);
    } catch (const easypbr::FormatError& error) {
        return error.what();
    }
    return "accepted";
}

/// Warnings, while it lives.
struct LogCapture {
    LogCapture() {
        easypbr::set_log_sink(
            [this](easypbr::LogLevel, std::string_view message) { text += std::string(message) + "\n"; });
    }
    ~LogCapture() { easypbr::set_log_sink({}); }
    std::string text;
};
