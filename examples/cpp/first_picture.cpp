// Two objects, a light of our own and a camera: writes first_picture.png. Needs no file.
// Build against the installed library: cmake -S . -B build -DCMAKE_PREFIX_PATH=PREFIX && cmake --build build
#include <easypbr/easypbr.h>

#include <cstdio>

int main() {
    using namespace easypbr;
    try {
        Mesh teapot = make_teapot();
        Material red;
        red.base_color = linear_from_srgb(parse_color("#b03a2e"));
        red.roughness = 0.2f;
        teapot.set_material(red);
        show(teapot, "teapot");
        show(make_plane(3), "floor");

        Light lamp;
        lamp.position = Vec3d(1.5, 2, 1);
        lamp.intensity = 4;

        Viewer view(Vec2i(800, 600));
        view.add_light("lamp", lamp);
        view.set_camera(Camera::look_at(Vec3d(1.5, 1.6, 3.5), Vec3d(0, 0.4, 0)));
        view.recorder.record("first_picture.png");
    } catch (const Error& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
