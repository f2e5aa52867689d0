// Milliseconds per frame on an orbit, as peer_vtk.py measures them: 3 degrees a frame, each frame finished by
// reading a pixel back. Prints one JSON line. usage: bench_frames MESH FRAMES ENVIRONMENT WIDTHxHEIGHT
// [--driver] [--lights=N] [--turning-lights] [group.name=value]...
// --lights=N: that many point lights around the mesh.
// --turning-lights: they turn about the mesh, one degree a frame: shadows are drawn anew.
// --driver: OpenGL's driver rasterises all triangles, also where there is no GPU.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "easypbr/app/session.h"
#include "easypbr/core/background.h"
#include "easypbr/core/image.h"
#include "easypbr/easypbr.h"
#include "easypbr/scene/settings.h"

namespace {

using namespace easypbr;

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// The same picture drawn again must be the timed frame: share of pixels that differ by 2/255 at most.
double equal_share(const Image& a, const Image& b) {
    size_t equal = 0;
    for (size_t i = 0; i < a.pixel_count(); ++i) {
        int worst = 0;
        for (size_t c = 0; c < 4; ++c)
            worst = std::max(
                worst, std::abs(int(a.pixels<uint8_t>()[4 * i + c]) - int(b.pixels<uint8_t>()[4 * i + c])));
        equal += worst <= 2;
    }
    return double(equal) / double(a.pixel_count());
}

/// VTK's camera after ResetCamera() and Azimuth(): 30 degrees, the bounding sphere just fits.
Camera vtk_camera(const Box3d& bounds, double azimuth_deg) {
    const double distance = bounds.diagonal().norm() / 2 / std::sin(radians(15)),
                 angle = radians(azimuth_deg);
    return Camera::look_at(bounds.center() + distance * Vec3d(std::sin(angle), 0, std::cos(angle)),
                           bounds.center());
}

/// Lights on a spiral around the content, together as bright as one.
void set_lights(Scene& scene, const Box3d& bounds, int count, double azimuth_deg) {
    const double distance = 1.5 * bounds.diagonal().norm();
    for (int i = 0; i < count; ++i) {
        const double z = 1 - (2 * i + 1.0) / count,
                     angle = i * pi * (3 - std::sqrt(5.0)) + radians(azimuth_deg),
                     across = std::sqrt(1 - z * z);
        const Vec3d way(across * std::cos(angle), z, across * std::sin(angle));
        Light light;
        light.position = bounds.center() + distance * way;
        light.intensity = float(distance * distance / count);
        scene.set_light(fmt::format("light {}", i), light);
    }
}

int measure(int argc, char** argv) {
    if (argc < 5) return 2;
    auto start = std::chrono::steady_clock::now();
    Mesh mesh(argv[1]);
    const double load = seconds_since(start);
    start = std::chrono::steady_clock::now();
    vertex_normals(mesh.V(), mesh.F());
    const double normals = seconds_since(start);
    Scene scene;
    scene.show(mesh, "mesh");
    app::Session session(scene);
    session.load_environment(argv[3]);
    Settings& settings = session.settings();
    Vec2i size;
    if (std::sscanf(argv[4], "%dx%d", &size.x(), &size.y()) != 2) return 2;
    settings.image.size = size;
    settings.image.samples = 1;
    settings.background.mode = BackgroundMode::environment;
    settings.material.roughness = 0.4f;
    settings.material.metallic = 0.0f;
    const Box3d bounds = scene.snapshot().bounds();
    int lights = 0;
    bool turning = false;
    for (int i = 5; i < argc; ++i) {
        const std::string option = argv[i];
        const size_t equals = option.find('=');
        if (option.starts_with("--lights=")) {
            lights = std::stoi(option.substr(9));
            set_lights(scene, bounds, lights, 0);
            continue;
        }
        if (option == "--turning-lights") turning = true;
        if (option == "--driver") session.allow_native_geometry(false);
        if (equals != std::string::npos)
            set_from_text(settings, option.substr(0, equals), option.substr(equals + 1));
    }
    session.set_camera(vtk_camera(bounds, 0));
    start = std::chrono::steady_clock::now();
    session.draw_frame();
    const double first = seconds_since(start);
    // Large data are put in order from the second frame on.
    start = std::chrono::steady_clock::now();
    session.draw_frame();
    const double second = seconds_since(start);
    BackgroundWork::wait_for_all();
    const double ordered = seconds_since(start);

    const int frames = std::stoi(argv[2]);
    std::vector<double> times;
    app::Drawn timed;
    for (int i = 0; i < frames; ++i) {
        session.set_camera(vtk_camera(bounds, 3.0 * (i + 1)));
        if (turning) set_lights(scene, bounds, lights, i + 1);
        start = std::chrono::steady_clock::now();
        timed = session.draw_frame();
        times.push_back(seconds_since(start) * 1e3);
    }
    const Image last = timed.picture();
    const double equal = equal_share(last, session.render());
    session.renderer().measure_passes(true);
    session.draw_frame();
    std::string passes;
    for (const auto& [name, ms] : session.renderer().pass_times())
        passes += fmt::format(R"({}"{}": {:.1f})", passes.empty() ? "" : ", ", name, ms);
    std::sort(times.begin(), times.end());
    fmt::print(
        R"({{"tool": "easypbr", "mesh": "{}", "size": "{}x{}", "load_s": {:.3f}, "normals_s": {:.3f}, "first_frame_s": {:.3f}, "second_frame_s": {:.3f}, "ordered_s": {:.3f}, )"
        R"("frame_ms_median": {:.1f}, "frame_ms_min": {:.1f}, "equal_to_still": {:.5f}, "passes_ms": {{{}}}}})"
        "\n",
        argv[1], size.x(), size.y(), load, normals, first, second, ordered, times[times.size() / 2], times[0],
        equal, passes);
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        return measure(argc, argv);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "bench_frames: %s\n", error.what());
        return 1;
    }
}
