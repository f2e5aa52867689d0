// Shader texts as nobody writes them: what is long must neither overflow the stack nor take for ever.
#include "easypbr/gl/program.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "easypbr/core/error.h"
#include "easypbr/gl/context.h"

namespace easypbr::gl::program_text_test {
namespace {

namespace fs = std::filesystem;

constexpr size_t many = 1'000'000;

/// A folder with shader files, gone afterwards.
class LongLines : public testing::Test {
  protected:
    LongLines() {
        char name[] = "/tmp/easypbr_programXXXXXX";
        folder_ = mkdtemp(name);
    }
    ~LongLines() override { fs::remove_all(folder_); }

    std::string write(const std::string& name, const std::string& text) const {
        std::ofstream(folder_ / name) << text;
        return (folder_ / name).string();
    }

    /// Compiles `body` as a fragment shader's main, behind `head`.
    static void compile(const std::string& head, const std::string& body = "o = vec4(1.0);") {
        const std::string text = head + "\nout vec4 o;\nvoid main() { " + body + " }\n";
        const auto context = Context::create();
        const ContextScope scope(*context);
        const Program program("screen_triangle.vert", "own.frag", {}, {{"own.frag", {"own", text}}});
        EXPECT_TRUE(program);
    }

    fs::path folder_;
};

TEST_F(LongLines, OfATextCompile) {
    compile("//" + std::string(many, 'x'));
    compile(std::string(many, ' '));
    compile("//" + std::string(many, ' ') + "\r");
}

TEST_F(LongLines, OfAnIncludedFileCompile) {
    const std::string inner = write("inner.glsl", "//" + std::string(many, 'x') + "\n");
    write("outer.glsl", "#include \"inner.glsl\"\n//" + std::string(many, '"') + "\n");
    compile("#include \"" + (folder_ / "outer.glsl").string() + "\"");
    EXPECT_EQ(shader_files((folder_ / "outer.glsl").string()),
              (std::vector<fs::path>{folder_ / "outer.glsl", inner}));
}

TEST_F(LongLines, OfIncludesAreRead) {
    const std::string blanks(many, ' ');
    write("inner.glsl", "vec4 own() { return vec4(1.0); }\n");
    const std::string quoted = "\"" + (folder_ / "inner.glsl").string() + "\"";
    compile(blanks + "#include" + blanks + quoted + blanks, "o = own();");
}

TEST_F(LongLines, NameNoFile) {
    const std::string name(many, 'x');
    EXPECT_THROW(compile("#include \"" + name + "\""), ArgumentError);
    const std::string outer = write("outer.glsl", "#include \"" + name + "\"\n");
    try {
        shader_files(outer);
        ADD_FAILURE() << "found the file";
    } catch (const ArgumentError& error) {
        EXPECT_LT(std::string(error.what()).size(), 1000u);
    }
}

TEST_F(LongLines, AreReportedByTheirPlace) {
    const std::string blanks(many, ' ');
    try {
        compile("//" + blanks, blanks + "o = nonsense;");
        ADD_FAILURE() << "compiled";
    } catch (const ShaderError& error) {
        EXPECT_NE(std::string(error.what()).find("own:3"), std::string::npos) << error.what();
    }
}

// What is no directive of this form is left to the compiler.
TEST_F(LongLines, DoNotHideWhatIsNoInclude) {
    write("inner.glsl", "#error inner was included\n");
    const std::string path = (folder_ / "inner.glsl").string();
    for (const std::string& line : {"// #include \"" + path + "\"", "//#include\"" + path + "\""})
        compile(line);
    for (const std::string& line :
         {"#include\"" + path + "\"", std::string("#include \"\""), std::string("#include \"a\"b\"")})
        EXPECT_THROW(compile(line), ShaderError) << line;
}

}  // namespace
}  // namespace easypbr::gl::program_text_test
