// The status line's text: positions in the file's coordinates, as exact as pixels are.
#include "easypbr/app/status_text.h"

#include <gtest/gtest.h>

#include "easypbr/app/view_point.h"

namespace easypbr::app::status_text_test {
namespace {

// Written with the first decimal whose unit is not above the step.
TEST(StatusText, HasTheDecimalsThatTellPixelsApart) {
    EXPECT_EQ(coordinates_text({12345.678, -0.5, 2}, 0.03), "(12345.68, -0.50, 2.00)");
    EXPECT_EQ(coordinates_text({12345.678, -0.5, 2}, 0.3), "(12345.7, -0.5, 2.0)");
    EXPECT_EQ(coordinates_text({12345.678, -2.25, 1e14}, 70), "(12346, 0, 100000000000000)");
    EXPECT_EQ(coordinates_text({0.0123456, -1e-6, 0}, 3e-5), "(0.01235, 0.00000, 0.00000)");
    EXPECT_EQ(coordinates_text({1.5e-8, -2.25e-9, 0}, 3e-11), "(1.500e-08, -2.250e-09, 0.000e+00)");
    EXPECT_EQ(coordinates_text({2.5e20, 0, 1e17}, 3e17), "(2.500e+20, 0.000e+00, 1.000e+17)");
    EXPECT_EQ(coordinates_text({0, 0, 0}, 3e-11), "(0e+00, 0e+00, 0e+00)");
}

TEST(StatusText, ShowsTheFilesCoordinates) {
    Pick pick;
    pick.object = "scan";
    pick.is_face = false;
    pick.element = 12;
    pick.position = {25.01, -1.654, 3.624};
    EXPECT_EQ(status_text(pick, {691049.82, 5335040.134, 530.066}, 0.02),
              "scan   point 12   (691074.83, 5335038.48, 533.69)");
    pick.part = "wall";
    pick.is_face = true;
    EXPECT_EQ(status_text(pick, {0, 0, 0}, 0.2), "scan / wall   face 12   (25.0, -1.7, 3.6)");
}

// A perspective view of 90 degrees is twice as high as it is deep; an orthographic one is everywhere the
// same.
TEST(StatusText, APixelIsAsLargeAsItsShareOfTheView) {
    Camera camera;
    camera.fov_y_deg = 90;
    const double rounding = 1e-12;
    EXPECT_TRUE(pixel_pitch(camera, {200, 100}, 10).isApprox(Vec2d(0.2, 0.2), rounding));
    camera.projection = Projection::orthographic;
    camera.ortho_height = 5;
    EXPECT_TRUE(pixel_pitch(camera, {200, 100}, 10).isApprox(Vec2d(0.05, 0.05), rounding));
}

}  // namespace
}  // namespace easypbr::app::status_text_test
