// What a recording costs beside drawing: seconds of a turntable of MESH drawn alone (each frame finished,
// none read back) and recorded to OUT, in turns. Prints one JSON line. usage: bench_recording MESH FRAMES
// WIDTHxHEIGHT OUT [ROUNDS]
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <string>
#include <vector>

#include "easypbr/app/session.h"
#include "easypbr/easypbr.h"
#include "easypbr/scene/settings.h"

namespace {

using namespace easypbr;

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

int measure(int argc, char** argv) {
    Vec2i size;
    if (argc < 5 || std::sscanf(argv[3], "%dx%d", &size.x(), &size.y()) != 2) return 2;
    Scene scene;
    scene.show(Mesh(argv[1]), "mesh");
    Viewer view(scene);
    app::Session& session = view.session();
    session.settings().image.size = size;
    session.settings().image.samples = 1;
    const int frames = std::stoi(argv[2]), rounds = argc > 5 ? std::stoi(argv[5]) : 3;
    const CameraPath path = app::turntable(session, frames / 30.0);
    const Camera like = session.camera();
    session.draw_frame();
    std::vector<double> drawn, recorded;
    for (int round = 0; round < rounds; ++round) {
        auto start = std::chrono::steady_clock::now();
        for (const double time : path.times(frames)) {
            session.set_camera(path.camera(time, like));
            session.draw_frame();
        }
        drawn.push_back(seconds_since(start));
        start = std::chrono::steady_clock::now();
        view.recorder.record_path(path, argv[4], {}, frames);
        recorded.push_back(seconds_since(start));
    }
    // Other work on the machine only adds to a time.
    const double draw = *std::ranges::min_element(drawn), record = *std::ranges::min_element(recorded);
    fmt::print("{{\"draw_s\": {:.4f}, \"record_s\": {:.4f}, \"cost\": {:.4f}}}\n", draw, record,
               record / draw - 1);
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        return measure(argc, argv);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "bench_recording: %s\n", error.what());
        return 1;
    }
}
