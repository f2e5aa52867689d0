#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdio>

#include "easypbr/app/session.h"
#include "easypbr/cli/command.h"
#include "easypbr/cli/console.h"
#include "easypbr/core/cache.h"
#include "easypbr/core/error.h"
#include "easypbr/core/parallel.h"
#include "easypbr/io/mesh/assimp/assimp_loader.h"
#include "easypbr/io/mesh/gltf/gltf_draco.h"
#include "easypbr/io/mesh/mesh_io.h"
#include "easypbr/io/video/video.h"
#include "easypbr/native/shaders.h"
#include "easypbr/render/denoise/open_image_denoise.h"

namespace easypbr::cli {
namespace {

struct DoctorOptions {};

void declare_doctor(CLI::App&, DoctorOptions&) {}

void print(const std::string& name, const std::string& value) {
    fmt::print("{:<12}{}\n", name, value);
}

void print_cache() {
    const std::string folder = cache_folder().string(), problem = cache_problem();
    print("cache", fmt::format("{} ({})", folder.empty() ? "none" : folder,
                               problem.empty() ? "writable" : problem + ": nothing is kept between runs"));
}

void print_formats() {
    const std::vector<std::string> extensions = io::assimp_extensions();
    print("formats", fmt::format("{}", fmt::join(io::readable_extensions(), " ")));
    print("assimp",
          extensions.empty()
              ? "reader not found: FBX, DAE, 3DS and others cannot be read; install libassimp5 and keep "
                "easypbr_read_assimp beside libeasypbr.so"
              : fmt::format("reader found, {} formats", extensions.size()));
    print("Draco",
          io::draco_problem().empty()
              ? "module found: KHR_draco_mesh_compression of glTF"
              : fmt::format("module not found ({}): compressed glTF files cannot be read; install libdraco7 "
                            "and keep libeasypbr_draco.so beside libeasypbr.so",
                            io::draco_problem()));
    print("videos", io::video_support());
}

void print_context(const gl::ContextInfo& info) {
    print("device",
          info.device == DrawDevice::cpu ? "cpu: draws natively, by OpenGL what is not native yet" : "gl");
    for (const gl::Attempt& attempt : info.attempts)
        print("tried", fmt::format("{}: {}", attempt.what, attempt.error.empty() ? "works" : attempt.error));
    print("vendor", info.vendor);
    print("renderer", info.renderer + (info.software ? " (software: draws on the CPU)" : ""));
    print("OpenGL", info.version);
    print("limits", fmt::format("textures up to {0}x{0}, pictures in one piece up to {1}x{1}",
                                info.max_texture_size, std::min(info.max_texture_size, info.max_viewport)));
}

int run_doctor(const DoctorOptions&) {
    print("easypbr", EASYPBR_VERSION);
    print("threads", fmt::format("{}", thread_count()));
    print_cache();
    print_formats();
    std::fflush(stdout);
    print("CPU", fmt::format("shades with {} where there is no GPU (there are {})", native::instruction_set(),
                             fmt::join(native::instruction_sets(), ", ")));
    const std::string oidn = render::OpenImageDenoise::version();
    print("denoiser", oidn.empty() ? "built-in filter (Open Image Denoise is not there: `pip install pyoidn`)"
                                   : "Open Image Denoise " + oidn);
    app::Session session;
    gl::Context& context = session.context();
    try {
        const gl::ContextScope scope(context);
        gl::Context::with_driver();
        print_context(context.info());
    } catch (const ContextError& error) {
        if (context.info().device == DrawDevice::gl) throw;
        print("device", "cpu: draws natively");
        print("OpenGL", std::string("not there: ") + error.what());
    }
    return 0;
}

}  // namespace

void add_doctor(CLI::App& app, Job& job) {
    set_job<DoctorOptions>(*app.add_subcommand("doctor", "Report the rendering capabilities of this machine"),
                           job, declare_doctor, run_doctor);
}

}  // namespace easypbr::cli
