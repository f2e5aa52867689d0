// Outlines, where the edges and the lines around them are known on paper.
#include "render_test.h"

#include "easypbr/scene/settings.h"

namespace easypbr::outline_test {
namespace {

constexpr int size = 128;

/// Red lines 2 pixels wide on a picture without light, seen from straight above: 16 units wide, 8 pixels
/// each.
app::Session outlined(const Scene& scene) {
    app::Session session = plain_session(scene, size);
    Settings& s = session.settings();
    s.outline.enabled = true;
    s.outline.color = Vec3(1, 0, 0);
    s.outline.depth_step = 0.01f;
    s.camera.projection = Projection::orthographic;
    s.camera.ortho_height = 16;
    look_from(session, Vec3d(0, 0, 20));
    return session;
}

const uint8_t* pixel(const Image& image, int x, int y) {
    return image.at<uint8_t>(x, y);
}

int red_pixels(const Image& image, int first_row = 0) {
    int count = 0;
    for (int y = first_row; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) count += pixel(image, x, y)[0] > 0;
    return count;
}

Mesh shifted_square(double x) {
    Mesh mesh = facing_square(2);
    mesh.translate(Vec3d(x, 0, 0));
    return mesh;
}

// The square's edges lie between pixels 31 and 32, and 95 and 96. Centres are 0.5 from the nearest edge, then
// 1.5: a line that reaches 1 to either side covers 1 and 0 of them, of 1 pixel of transition. The pixel
// outside a corner is sqrt(0.5) away: 1.5 - 0.7071 = 0.7929, or 202.2 of 255.
TEST(Outline, OfASquareIsARing) {
    Scene scene;
    scene.show(facing_square(4), "square");
    app::Session session = outlined(scene);
    const Image image = session.render();
    for (const int x : {31, 32, 95, 96}) {
        EXPECT_EQ(pixel(image, x, 64)[0], 255) << x;
        EXPECT_EQ(pixel(image, 64, x)[0], 255) << x;
        EXPECT_EQ(pixel(image, x, 64)[3], 255) << x;
    }
    for (const int x : {30, 33, 94, 97}) EXPECT_EQ(pixel(image, x, 64)[0], 0) << x;
    EXPECT_EQ(pixel(image, 30, 64)[3], 0);
    EXPECT_EQ(pixel(image, 33, 64)[3], 255);
    EXPECT_NEAR(pixel(image, 31, 31)[3], 202, 1);
    EXPECT_EQ(red_pixels(image), 4 * 66 + 4 * 62);
}

// Four pixels wide: two on either side.
TEST(Outline, HasItsWidth) {
    Scene scene;
    scene.show(facing_square(4), "square");
    app::Session session = outlined(scene);
    session.settings().outline.width = 4;
    const Image image = session.render();
    for (const int x : {30, 31, 32, 33}) EXPECT_EQ(pixel(image, x, 64)[0], 255) << x;
    for (const int x : {29, 34}) EXPECT_EQ(pixel(image, x, 64)[0], 0) << x;
}

// Reversed depth is linear over a plane in the image. At the bottom of the picture a pixel's depth differs
// from its neighbour's by 1 / 30, at the horizon by far more than the least step; only the horizon is an
// edge.
TEST(Outline, OfASteepPlaneIsItsHorizonAlone) {
    Scene scene;
    scene.show(facing_square(50), "floor");
    app::Session session = outlined(scene);
    Settings& s = session.settings();
    s.camera.projection = Projection::perspective;
    s.camera.up = "+z";
    look_from(session, Vec3d(0, -20, 1), 40);
    const Image image = session.render();
    int horizon = 0;
    while (horizon < size && pixel(image, 64, horizon)[0] == 0) ++horizon;
    ASSERT_LT(horizon, 80);
    EXPECT_EQ(red_pixels(image, horizon + 3), 0);
}

// The faces of a box meet at 90 degrees.
TEST(Outline, OfCreasesByTheirAngle) {
    Scene scene;
    scene.show(make_box(Vec3(6, 6, 6)), "box");
    app::Session session = outlined(scene);
    Settings& s = session.settings();
    s.outline.silhouettes = s.outline.objects = false;
    look_from(session, Vec3d(20, 15, 18));
    EXPECT_GT(red_pixels(session.render()), 100);
    s.outline.crease_angle_deg = 100;
    EXPECT_EQ(red_pixels(session.render()), 0);
    s.outline.crease_angle_deg = 40;
    s.outline.creases = false;
    EXPECT_EQ(red_pixels(session.render()), 0);
}

// Two squares side by side in one plane: neither depth nor normals know the border between pixels 63 and 64,
// the ids do.
TEST(Outline, OfObjectsThatTouch) {
    Scene scene;
    scene.show(shifted_square(-2), "left");
    scene.show(shifted_square(2), "right");
    app::Session session = outlined(scene);
    for (const bool objects : {true, false}) {
        session.settings().outline.objects = objects;
        const Image image = session.render();
        for (const int x : {63, 64}) EXPECT_EQ(pixel(image, x, 64)[0], objects ? 255 : 0) << x;
        for (const int x : {62, 65}) EXPECT_EQ(pixel(image, x, 64)[0], 0) << x;
        EXPECT_EQ(pixel(image, 32, 64)[0], 255);
    }
}

// The ground is no part of the content: neither its horizon nor its border with the content's foot is a
// silhouette of its own.
TEST(Outline, LeavesTheGroundOut) {
    Scene scene;
    scene.show(make_box(Vec3(2, 2, 2)), "box");
    app::Session session = outlined(scene);
    Settings& s = session.settings();
    s.camera.up = "+z";
    s.camera.projection = Projection::perspective;
    look_from(session, Vec3d(0, -20, 4), 40);
    const int alone = red_pixels(session.render());
    s.ground.mode = GroundMode::plane;
    EXPECT_EQ(red_pixels(session.render()), alone);
}

TEST(Outline, RefusesWhatCannotBe) {
    Scene scene;
    scene.show(facing_square(4), "square");
    app::Session session = outlined(scene);
    session.settings().outline.width = 17;
    EXPECT_THROW(session.render(), ArgumentError);
}

}  // namespace
}  // namespace easypbr::outline_test
