// A square that fills the picture, so that every pixel is known, and files of shaders for it.
#pragma once

#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>

#include "easypbr/core/error.h"
#include "render/render_test.h"

namespace easypbr::app {

inline constexpr int side = 16;

inline Session square_session(const SurfaceShader& shader, Material material = {}) {
    material.shader = shader;
    Scene scene;
    scene.show(facing_square(10, material), "square");
    Session session = plain_session(scene, side);
    look_from(session, Vec3d(0, 0, 5));
    return session;
}

inline Vec4 middle_of(const Image& image) {
    const float* p = image.at<float>(side / 2, side / 2);
    Vec4 v = Vec4::Zero();
    for (int c = 0; c < image.channels(); ++c) v[c] = p[c];
    return v;
}

/// A file that is written anew with another time each.
class ShaderFile {
  public:
    ShaderFile() {
        char name[] = "/tmp/easypbr_shaderXXXXXX";
        folder_ = mkdtemp(name);
    }
    ~ShaderFile() { std::filesystem::remove_all(folder_); }
    void write(const std::string& text) {
        std::ofstream(path()) << text;
        std::filesystem::last_write_time(
            path(), std::filesystem::file_time_type::clock::now() + std::chrono::seconds(++writes_));
    }
    std::filesystem::path path() const { return folder_ / "own.glsl"; }

  private:
    std::filesystem::path folder_;
    int writes_ = 0;
};

inline std::string message_of(Session& session) {
    try {
        session.render();
    } catch (const ShaderError& error) {
        return error.what();
    }
    return "no ShaderError";
}

}  // namespace easypbr::app
