// A camera path that is made key by key.
#include "easypbr/app/path_editor.h"

#include <gtest/gtest.h>

#include "easypbr/core/error.h"

namespace easypbr::app::path_editor_test {
namespace {

Camera camera_at(double x) {
    return Camera::look_at(Vec3d(x, 1, 5), Vec3d(0, 0, 0));
}

double x_of(const PathEditor& editor, size_t key) {
    return editor.keys()[key].T_world_cam.translation().x();
}

TEST(PathEditor, NeedsTwoKeys) {
    PathEditor editor;
    EXPECT_FALSE(editor.path());
    EXPECT_EQ(editor.problem(), "");
    editor.add(camera_at(0));
    EXPECT_FALSE(editor.path());
    EXPECT_NE(editor.problem(), "");
    editor.play();
    EXPECT_FALSE(editor.is_playing());
    editor.add(camera_at(1));
    ASSERT_TRUE(editor.path());
    EXPECT_EQ(editor.problem(), "");
    EXPECT_NEAR(editor.path()->pose(1).translation().x(), 1, 1e-9);
}

TEST(PathEditor, KeysAreInsertedMovedReplacedAndRemoved) {
    PathEditor editor;
    for (const double x : {0.0, 1.0, 3.0}) editor.add(camera_at(x));
    editor.insert(2, camera_at(2));
    editor.move(0, 3);
    const double expected[] = {1, 2, 3, 0};
    for (size_t key = 0; key < 4; ++key) EXPECT_EQ(x_of(editor, key), expected[key]);
    editor.move(3, 0);
    editor.replace(1, camera_at(1.5));
    EXPECT_EQ(x_of(editor, 1), 1.5);
    editor.set_segment(0, 2.5);
    EXPECT_DOUBLE_EQ(editor.path()->duration_s(), 4.5);
    editor.remove(0);
    EXPECT_EQ(editor.keys().size(), 3u);
    EXPECT_DOUBLE_EQ(editor.path()->duration_s(), 2);
    editor.clear();
    EXPECT_FALSE(editor.path());
}

TEST(PathEditor, PlaysToItsEndOrAround) {
    PathEditor editor;
    editor.add(camera_at(0));
    editor.add(camera_at(1));
    editor.play();
    EXPECT_TRUE(editor.advance(0.3));  // shows the start
    EXPECT_EQ(editor.time(), 0);
    EXPECT_TRUE(editor.advance(0.3));
    EXPECT_DOUBLE_EQ(editor.time(), 0.3);
    EXPECT_TRUE(editor.advance(0.9));
    EXPECT_EQ(editor.time(), 1);
    EXPECT_FALSE(editor.is_playing());
    EXPECT_FALSE(editor.advance(0.1));
    editor.seek(0.25);
    EXPECT_TRUE(editor.advance(0.1));
    EXPECT_EQ(editor.time(), 0.25);
    editor.seek(7);
    EXPECT_EQ(editor.time(), 1);
    CameraPathOptions closed;
    closed.closed = true;
    editor.set_options(closed);
    EXPECT_DOUBLE_EQ(editor.path()->duration_s(), 2);
    editor.play();
    editor.advance(0);
    editor.advance(1.5);
    EXPECT_NEAR(editor.time(), 0.5, 1e-12);  // started at 1
    EXPECT_TRUE(editor.is_playing());
}

TEST(PathEditor, TakesPathsAndOrbitsOver) {
    PathEditor editor;
    editor.set(CameraPath::orbit(camera_at(1), Vec3d(0, 0, 0)));
    ASSERT_TRUE(editor.path());
    EXPECT_TRUE(editor.keys().empty());
    editor.add(camera_at(2));
    EXPECT_FALSE(editor.path());
    editor.add(camera_at(3));
    EXPECT_TRUE(editor.path());
    PathEditor other;
    other.set(*editor.path());
    EXPECT_EQ(other.keys().size(), 2u);
}

TEST(PathEditor, SaysWhatIsWrong) {
    PathEditor editor;
    editor.add(camera_at(0));
    Camera flat = camera_at(1);
    flat.projection = Projection::orthographic;
    editor.add(flat);
    EXPECT_FALSE(editor.path());
    EXPECT_NE(editor.problem().find("orthographic"), std::string::npos);
    EXPECT_THROW(editor.remove(2), NameError);
    EXPECT_THROW(editor.move(0, 2), NameError);
    EXPECT_THROW(editor.insert(3, flat), NameError);
    EXPECT_THROW(editor.set_segment(0, 0), ArgumentError);
    EXPECT_THROW(editor.seek(NAN), ArgumentError);
}

}  // namespace
}  // namespace easypbr::app::path_editor_test
