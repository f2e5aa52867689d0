// Every shader by the reference compiler of GLSL and the validator of SPIR-V: drivers accept what the
// standard does not, each in its own way.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "easypbr/gl/program.h"

namespace easypbr::gl::shader_standard_test {
namespace {

namespace fs = std::filesystem;
using Names = std::vector<std::string>;

/// What a command prints, and its exit status.
struct Answer {
    std::string text;
    int status = -1;
};

Answer run(const std::string& command) {
    Answer answer;
    FILE* pipe = popen((command + " 2>&1").c_str(), "r");
    if (!pipe) return answer;
    char part[4096];
    for (size_t count; (count = std::fread(part, 1, sizeof part, pipe)) > 0;) answer.text.append(part, count);
    answer.status = pclose(pipe);
    return answer;
}

bool has_tools() {
    return run("glslangValidator --version").status == 0 && run("spirv-val --version").status == 0;
}

bool exists(const std::string& name) {
    return std::ranges::count(shader_names(), name) > 0;
}

/// The vertex shader that the library links a fragment shader with.
std::string vertex_shader_of(const std::string& fragment) {
    if (fragment == "shadow_shaded.frag") return "geometry_mesh.vert";
    const std::string same = fs::path(fragment).stem().string() + ".vert";
    return exists(same) ? same : "screen_triangle.vert";
}

/// Without those of paths, which the CPU alone runs.
Names fragment_shaders() {
    Names names;
    for (const std::string& name : shader_names())
        if (name.ends_with(".frag") && !name.starts_with("path_")) names.push_back(name);
    return names;
}

/// What is linked with its stages: fragment shaders, and compute shaders alone.
Names last_stages() {
    Names names = fragment_shaders();
    for (const std::string& name : shader_names())
        if (name.ends_with(".comp")) names.push_back(name);
    return names;
}
Names stages_of(const std::string& last) {
    if (last.ends_with(".comp")) return {last};
    return {vertex_shader_of(last), last};
}

/// The macros that lines #if of the text ask for.
void add_conditions(const std::string& text, Names& macros) {
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        if (!line.starts_with("#if")) continue;
        line.resize(std::min(line.find("//"), line.size()));
        std::string word;
        for (const char c : line + ' ') {
            if (std::isupper(static_cast<unsigned char>(c)) || c == '_')
                word += c;
            else if (!word.empty())
                macros.push_back(std::exchange(word, {}));
        }
    }
}

/// Macros of both stages, sorted. NATIVE is of the translation to C++ alone.
Names macros_of(const Names& stages) {
    Names macros;
    for (const std::string& stage : stages) {
        const ShaderStage shader = shader_stage(stage);
        macros.insert(macros.end(), shader.features.begin(), shader.features.end());
        add_conditions(shader.text, macros);
    }
    std::ranges::sort(macros);
    macros.erase(std::unique(macros.begin(), macros.end()), macros.end());
    std::erase(macros, "NATIVE");
    return macros;
}

/// Sets of macros in which each two macros meet in all four ways: both on, both off, and one alone. Two
/// numbers differ in a bit, so the sets of that bit and of its complement have one without the other.
std::vector<Names> variants_of(const Names& macros) {
    std::vector<Names> variants = {{}, macros};
    for (size_t bit = 1; bit < macros.size(); bit *= 2) {
        Names on, off;
        for (size_t i = 0; i < macros.size(); ++i) (i & bit ? on : off).push_back(macros[i]);
        variants.push_back(std::move(on));
        variants.push_back(std::move(off));
    }
    return variants;
}

/// Macros that have a value, as the passes give them.
const Names values = {"LIGHTS_PER_BLOCK 16", "DFG_SIZE 64", "UV_TRANSFORMS 19"};

class ShaderStandard : public testing::TestWithParam<std::string> {
  protected:
    ShaderStandard() {
        std::string pattern = (fs::temp_directory_path() / "easypbr_shaders_XXXXXX").string();
        folder_ = mkdtemp(pattern.data());
    }
    ~ShaderStandard() override { fs::remove_all(folder_); }

    /// Compiles and links both stages to SPIR-V for OpenGL and validates it; what a tool has to object.
    std::string objection(const Names& stages, const Names& defines) const {
        std::string files, outputs;
        for (const std::string& stage : stages) {
            std::ofstream(folder_ / stage) << shader_stage(stage, defines).text;
            files += " " + stage;
            outputs += " && spirv-val --target-env opengl4.5 " + stage.substr(stage.rfind('.') + 1) + ".spv";
        }
        // SPIR-V asks for numbers of uniforms and of what passes between stages; OpenGL finds them by name.
        const Answer answer =
            run(fmt::format("cd '{}' && glslangValidator -G --auto-map-locations --auto-map-bindings -l{}{}",
                            folder_.string(), files, outputs));
        return answer.status == 0 ? "" : answer.text.substr(0, 3000);
    }

  private:
    fs::path folder_;
};

TEST_P(ShaderStandard, EveryVariantCompilesAndIsValid) {
    if (!has_tools()) GTEST_SKIP() << "glslang-tools and spirv-tools are not installed";
    const Names stages = stages_of(GetParam());
    for (Names variant : variants_of(macros_of(stages))) {
        // What is seen behind is of the extended model's transmission.
        if (std::ranges::count(variant, "BEHIND") > 0) variant.emplace_back("EXTENDED");
        const std::string shown = fmt::format("{}", fmt::join(variant, " "));
        variant.insert(variant.end(), values.begin(), values.end());
        ASSERT_EQ(objection(stages, variant), "") << "with " << shown;
    }
}

INSTANTIATE_TEST_SUITE_P(All, ShaderStandard, testing::ValuesIn(last_stages()),
                         [](const auto& info) { return fs::path(info.param).stem().string(); });

TEST(ShaderStandardVariants, EachTwoMacrosMeetInAllWays) {
    for (const size_t count : {1, 2, 3, 5, 8, 17}) {
        Names macros;
        for (size_t i = 0; i < count; ++i) macros.push_back(fmt::format("M{}", i));
        const std::vector<Names> variants = variants_of(macros);
        for (size_t i = 0; i < count; ++i)
            for (size_t j = 0; j < i; ++j) {
                bool seen[4] = {};
                for (const Names& variant : variants)
                    seen[2 * std::ranges::count(variant, macros[i]) +
                         std::ranges::count(variant, macros[j])] = true;
                EXPECT_TRUE(seen[0] && seen[1] && seen[2] && seen[3]) << count << ": " << i << " " << j;
            }
    }
}

TEST(ShaderStandardVariants, EveryVertexShaderIsLinkedWithOne) {
    Names linked;
    for (const std::string& name : fragment_shaders()) linked.push_back(vertex_shader_of(name));
    for (const std::string& name : shader_names())
        if (name.ends_with(".vert")) {
            EXPECT_GT(std::ranges::count(linked, name), 0) << name;
        }
}

}  // namespace
}  // namespace easypbr::gl::shader_standard_test
