#include "easypbr/gl/program.h"

#include <epoxy/gl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>

#include "easypbr/core/error.h"
#include "easypbr/gl/buffer.h"
#include "easypbr/gl/context.h"
#include "easypbr/gl/texture.h"

namespace easypbr::gl::program_test {
namespace {

namespace fs = std::filesystem;

/// A folder of shader files that stands in for the embedded ones.
class ProgramTest : public testing::Test {
  protected:
    ProgramTest() { setenv("EASYPBR_SHADER_DIR", folder_.c_str(), 1); }
    ~ProgramTest() override {
        unsetenv("EASYPBR_SHADER_DIR");
        fs::remove_all(folder_);
    }
    void add_folder(const std::string& name) const { fs::create_directories(path_of(name)); }
    std::string path_of(const std::string& name) const { return (fs::path(folder_) / name).string(); }
    void write(const std::string& name, const std::string& text) const {
        std::ofstream(fs::path(folder_) / name) << text;
    }
    /// What `main` of a fragment shader of this name writes into a pixel.
    static std::array<uint8_t, 4> pixel(const std::string& fragment,
                                        const std::vector<std::string>& defines) {
        const Program program("screen_triangle.vert", fragment, defines);
        const Texture color(Format::rgba8, 1, 1);
        const Framebuffer target({&color});
        target.bind();
        program.use();
        const VertexArray none = VertexArray::make();
        none.bind();
        glDisable(GL_DEPTH_TEST);
        glDrawArrays(GL_TRIANGLES, 0, 3);
        std::array<uint8_t, 4> texel;
        glReadPixels(0, 0, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, texel.data());
        return texel;
    }
    static std::string message(const std::string& fragment, const std::vector<std::string>& defines) {
        try {
            const Program program("screen_triangle.vert", fragment, defines);
        } catch (const Error& error) {
            return error.what();
        }
        return "compiled";
    }

  private:
    static std::string make_folder() {
        char name[] = "/tmp/easypbr_shadersXXXXXX";
        return mkdtemp(name);
    }
    const std::string folder_ = make_folder();
    const std::unique_ptr<Context> context_ = Context::create();
    const ContextScope scope_{*context_};
};

TEST_F(ProgramTest, ReportsFileAndLine) {
    write("broken.frag",
          "#include \"common_encoding.glsl\"\n#feature ROUND is_round\nout vec4 o;\n"
          "void main() { o = nonsense; }\n");
    EXPECT_THROW(Program("screen_triangle.vert", "broken.frag"), ContextError);
    EXPECT_NE(message("broken.frag", {}).find("broken.frag:4"), std::string::npos)
        << message("broken.frag", {});
    EXPECT_THROW(shader_source("missing.frag"), ArgumentError);
}

TEST_F(ProgramTest, FeaturesAreConstants) {
    write("feature.frag",
          "#feature LEFT is_left\n#feature RIGHT is_right  // a comment\nout vec4 o;\n"
          "uniform vec4 u_unused;\n"
          "void main() { o = vec4(is_left, is_right, 0.0, 1.0); if (is_left && is_right) o = u_unused; }\n");
    using Texel = std::array<uint8_t, 4>;
    EXPECT_EQ(pixel("feature.frag", {}), (Texel{0, 0, 0, 255}));
    EXPECT_EQ(pixel("feature.frag", {"LEFT"}), (Texel{255, 0, 0, 255}));
    EXPECT_EQ(pixel("feature.frag", {"RIGHT", "STEPS 3"}), (Texel{0, 255, 0, 255}));
    // The compiler removes what stands in a branch that is never taken.
    EXPECT_FALSE(Program("screen_triangle.vert", "feature.frag", {"LEFT"}).has("u_unused"));
    EXPECT_TRUE(Program("screen_triangle.vert", "feature.frag", {"LEFT", "RIGHT"}).has("u_unused"));
}

TEST_F(ProgramTest, RefusesAFeatureThatNoShaderDeclares) {
    write("feature.frag",
          "#feature FLOATING is_floating\nout vec4 o;\nvoid main() { o = vec4(is_floating); }\n");
    EXPECT_EQ(message("feature.frag", {"FLOATNG"}),
              "no shader has a line '#feature FLOATNG' (did you mean 'FLOATING'?)");
    EXPECT_THROW(Program("screen_triangle.vert", "feature.frag", {"FLOATNG"}), ArgumentError);
    // Passes give all their shaders the same macros.
    EXPECT_EQ(message("feature.frag", {"SHADOW_CUBES"}), "compiled");
    EXPECT_NE(message("feature.frag", {"SHADOW_CUBE"}).find("(did you mean 'SHADOW_CUBES'?)"),
              std::string::npos);
    // Custom programs may define any macro.
    const ShaderTexts own = {
        {"own.frag", {"own", "out vec4 o;\n#ifdef MINE\nvoid main() { o = vec4(1.0); }\n#endif\n"}}};
    EXPECT_NO_THROW(Program("screen_triangle.vert", "own.frag", {"MINE"}, own));
}

TEST_F(ProgramTest, IncludesAFileOnce) {
    write("value.glsl", "float value() { return 1.0; }\n");
    write("outer.glsl", "#include \"value.glsl\"\nfloat twice() { return 2.0 * value(); }\n");
    const std::string rest = "out vec4 o;\nvoid main() { o = vec4(value(), 0.5 * twice(), 0.0, 1.0); }\n";
    write("once.frag", "#include \"value.glsl\"\n#include \"outer.glsl\"\n#include \"value.glsl\"\n" + rest);
    EXPECT_EQ(pixel("once.frag", {}), (std::array<uint8_t, 4>{255, 255, 0, 255}));
    // Where the condition is false a file that was left out the second time would be missing.
    write("twice.frag", "#ifdef ROUND\n#include \"outer.glsl\"\n#endif\n#include \"value.glsl\"\n" + rest);
    EXPECT_EQ(message("twice.frag", {"ROUND"}),
              "shader file 'value.glsl' is included within #if, and again: expected its "
              "include before the #if");
}

// By way of a folder a file has another name each time it includes itself.
TEST_F(ProgramTest, EndsWhereAFileIncludesItself) {
    add_folder("x");
    write("circle.frag", "#include \"x/../circle.frag\"\n");
    try {
        shader_stage(path_of("circle.frag"));
        FAIL() << "accepted";
    } catch (const ArgumentError& error) {
        EXPECT_NE(std::string(error.what()).find("or more than 64 deep"), std::string::npos) << error.what();
    }
}

}  // namespace
}  // namespace easypbr::gl::program_test
