// A pass of one's own: dark lines where surfaces end or fold, by outline.frag. Writes outline.png.
// usage: outline OUTLINE.frag; needs no other file
#include <easypbr/easypbr.h>

#include <cstdio>

namespace {

using namespace easypbr;

/// Draws outline.frag over each frame, so that its lines are smoothed with everything else.
class OutlinePass : public app::Pass {
  public:
    explicit OutlinePass(const std::string& file) : shader_(std::filesystem::path(file)) {}

    Vec3 color{0.02f, 0.02f, 0.03f};  ///< linear
    float width = 2;                  ///< pixels

    void draw(const app::PassInput& input) override {
        shader_.set("u_color", color);
        shader_.set("u_width", width);
        // Compiled anew when the file has changed; a mistake in it is a ShaderError that names its line.
        // G-buffer and camera are bound where the shader has uniforms for them.
        input.draw(shader_);
    }

    uint64_t revision() const override { return shader_.revision(); }

  private:
    app::FragmentShader shader_;
};

}  // namespace

int main(int count, char** arguments) {
    const std::string file = count > 1 ? arguments[1] : "outline.frag";
    try {
        Scene scene;
        Mesh teapot = make_teapot();
        Material clay;
        clay.base_color = linear_from_srgb(parse_color("#c8b89a"));
        teapot.set_material(clay);
        scene.show(teapot, "teapot");
        Viewer view(scene);
        view.settings().image.size = Vec2i(800, 600);
        view.add_pass("outline", app::Stage::overlay, std::make_shared<OutlinePass>(file));
        view.recorder.record("outline.png");
    } catch (const Error& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
