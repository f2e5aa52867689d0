// A pass of one's own: dark lines where surfaces end or fold, by outline.frag. Writes outline.png.
// usage: outline OUTLINE.frag; needs no other file
#include <easypbr/easypbr.h>

#include <cstdio>

namespace {

using namespace easypbr;

/// Draws outline.frag over each frame, so that its lines are smoothed with everything else.
class OutlinePass : public render::Pass {
  public:
    explicit OutlinePass(const std::string& file) : program_("screen_triangle.vert", file) {}

    Vec3 color{0.02f, 0.02f, 0.03f};  ///< linear
    float width = 2;                  ///< pixels

    void draw(const render::PassInput& input) override {
        // Compiled anew when the file has changed; a mistake in it is a ShaderError that names its line.
        const gl::Program& program = program_.get(input.defines());
        program.set("u_color", color);
        program.set("u_width", width);
        // G-buffer and camera are bound where the shader has uniforms for them.
        input.draw(program);
    }

    uint64_t revision() const override { return program_.revision(); }

  private:
    gl::WatchedProgram program_;
};

}  // namespace

int main(int count, char** arguments) {
    // A path needs a folder in it to be told from the library's own shaders.
    const std::string file = count > 1 ? arguments[1] : "./outline.frag";
    try {
        Scene scene;
        Mesh teapot = make_teapot();
        Material clay;
        clay.base_color = linear_from_srgb(parse_color("#c8b89a"));
        teapot.set_material(clay);
        scene.show(teapot, "teapot");
        Viewer view(scene);
        view.settings().image.size = Vec2i(800, 600);
        view.add_pass("outline", render::Stage::overlay, std::make_shared<OutlinePass>(file));
        view.recorder.record("outline.png");
    } catch (const Error& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
