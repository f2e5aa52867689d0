#include <fmt/format.h>

#include <cstdio>

#include "easypbr/app/output.h"
#include "easypbr/app/session.h"
#include "easypbr/cli/command.h"
#include "easypbr/cli/render_options.h"
#include "easypbr/cli/stage_times.h"
#include "easypbr/core/file.h"
#include "easypbr/geometry/primitives.h"
#include "easypbr/io/image/image_io.h"
#include "easypbr/scene/fields.h"
#include "easypbr/scene/settings.h"

namespace easypbr::cli {
namespace {

struct DemoOptions {
    std::string output = "demo.png", size = "1280x720";
    std::string samples = "8";
};

void declare_demo(CLI::App& command, DemoOptions& options) {
    command.add_option("-o,--output", options.output, "Image file to write")->option_text("FILE");
    command.add_option("--size,--resolution", options.size, "Width and height in pixels")->option_text("WxH");
    command.add_option("--samples", options.samples, "Number of jittered samples averaged per pixel")
        ->option_text("N")
        ->capture_default_str();
}

/// The number of --samples, as the setting takes it.
int samples_of(const DemoOptions& options) {
    Settings settings;
    set_from_text(settings, "image.samples", options.samples);
    return settings.image.samples;
}

void check_demo(const DemoOptions& options) {
    parse_size(options.size);
    samples_of(options);
}

int run_demo(const DemoOptions& options) {
    const Vec2i size = parse_size(options.size);
    const app::Encoding encoding = app::encoding_for(options.output);
    check_writable(options.output);
    StageTimes times;
    app::Session session(make_demo_scene());
    CameraSettings& camera = session.settings().camera;
    camera.position = Vec3d(3.75, 2.35, 6.45);
    camera.target = Vec3d(0.02, 0.36, 0.02);
    camera.fov_y_deg = 26;
    session.settings().background.color = Vec3(0.36f, 0.375f, 0.40f);
    times.lap("make the scene");
    session.context_info();
    times.lap("open an OpenGL context");
    const Image image = session.render({size, samples_of(options), encoding});
    times.lap("draw");
    io::save_image(image, options.output);
    times.lap("write the picture");
    for (const auto& [stage, seconds] : times.stages()) fmt::print("{:<24}{:8.3f} s\n", stage, seconds);
    fmt::print("{:<24}{:8.3f} s\n{}\n", "total", times.total(), fs::absolute(options.output).string());
    return 0;
}

}  // namespace

void add_demo(CLI::App& app, Job& job) {
    set_job<DemoOptions>(*app.add_subcommand("demo", "Render the embedded demo scene"), job, declare_demo,
                         run_demo, check_demo);
}

}  // namespace easypbr::cli
