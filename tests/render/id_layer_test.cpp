#include <map>

#include "render_test.h"

#include "easypbr/scene/settings.h"

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

}  // namespace
}  // namespace easypbr::id_layer_test
