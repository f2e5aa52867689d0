#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "easypbr/gl/context.h"
#include "easypbr/render/pipeline/renderer.h"
#include "easypbr/scene/resolve.h"
#include "render_test.h"

namespace easypbr::id_layer_test {
namespace {

// Two squares side by side, one with a child before it: every pixel says whose it is, exactly.
TEST(IdLayer, NamesEveryPixel) {
    const auto placed = [](double x) {
        Mesh mesh = facing_square(0.5f);
        mesh.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(x, 0, 0)));
        return mesh;
    };
    Scene scene;
    scene.show(placed(-1), "left");
    Mesh right = placed(1), child = facing_square(0.2f);
    child.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(0, 0, 0.1)));
    right.add_child(child);
    scene.show(right, "right");
    app::Session session = plain_session(scene, 100);
    session.settings().image.samples = 16;
    session.settings().camera.projection = Projection::orthographic;
    session.settings().camera.ortho_height = 4.0;
    look_from(session, Vec3d(0, 0, 5));
    const Image ids = session.render_layers({"object_id"}).at("object_id");
    const std::vector<std::string> names = session.object_names();
    ASSERT_EQ(names.size(), 3u);
    std::map<std::string, int> pixels;
    for (const float id : ids.pixels<float>()) ++pixels[id == 0 ? "" : names.at(size_t(id) - 1)];
    // 25 pixels to a unit; pixel centres are at halves, edges at multiples of 2.5: 25 x 25, and 10 x 10 of
    // the child.
    EXPECT_EQ(pixels[names[0]], 625);
    EXPECT_EQ(pixels[names[2]], 100);
    EXPECT_EQ(pixels[names[1]], 525);
    EXPECT_EQ(ids.at<float>(25, 50)[0], 1.0f);
}

// Depths and ids need no light.
TEST(Layers, AreDrawnWithoutLight) {
    Scene scene;
    scene.show(make_sphere(1, 32), "ball");
    scene.set_environment(constant_environment(1));
    const SceneSnapshot snapshot = scene.snapshot();
    const Vec2i size(64, 64);
    const ResolvedSettings resolved = resolve(snapshot, Settings{}, size);
    const auto context = gl::Context::create(DrawDevice::cpu);
    const gl::ContextScope scope(*context);
    render::Renderer renderer;
    renderer.measure_passes(true);
    const auto passes = [&](bool layers, bool occlusion) {
        renderer.draw(snapshot, resolved,
                      {.size = size, .samples = 1, .layers = layers, .occlusion = occlusion});
        std::vector<std::string> names;
        for (const auto& [name, milliseconds] : renderer.pass_times()) names.push_back(name);
        return names;
    };
    const auto has = [](const std::vector<std::string>& names, const char* name) {
        return std::ranges::count(names, name) > 0;
    };
    const std::vector<std::string> picture = passes(false, false), layers = passes(true, false),
                                   occluded = passes(true, true);
    for (const char* name : {"lighting", "shadows", "ambient occlusion", "geometry"})
        EXPECT_TRUE(has(picture, name)) << name;
    for (const char* name : {"lighting", "shadows", "ambient occlusion"})
        EXPECT_FALSE(has(layers, name)) << name;
    EXPECT_GT(renderer.read_layer(render::Layer::depth).at<float>(32, 32)[0], 0);
    EXPECT_TRUE(has(occluded, "ambient occlusion"));
    EXPECT_FALSE(has(occluded, "lighting"));
    EXPECT_FALSE(has(occluded, "shadows"));
}

}  // namespace
}  // namespace easypbr::id_layer_test
