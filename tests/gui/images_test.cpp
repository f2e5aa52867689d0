// Images beside the scene: their colours, and their windows driven by events.
#include "easypbr/gui/image_panels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "easypbr/core/error.h"
#include "easypbr/gui/live_view.h"
#include "easypbr/scene/settings.h"

namespace easypbr::gui::images_test {
namespace {

using app::InputEvent;
using Kind = InputEvent::Kind;
using Code = std::array<int, 4>;

Image floats(int width, int height, int channels, std::vector<float> values) {
    Image image(width, height, channels, PixelType::f32);
    std::ranges::copy(values, image.pixels<float>().begin());
    return image;
}

Code pixel(const Image& image, int x, int y = 0) {
    const uint8_t* p = image.at<uint8_t>(x, y);
    return {p[0], p[1], p[2], p[3]};
}

TEST(ShownImage, OneChannelGoesThroughTheColormapOverAllValues) {
    const Image image = floats(4, 1, 1, {-3, 5, NAN, HUGE_VALF});
    const ColorTable& viridis = color_table(Colormap::viridis);
    const Image shown = shown_image(image, {});
    const auto code = [&](size_t i) { return Code{viridis[i][0], viridis[i][1], viridis[i][2], 255}; };
    EXPECT_EQ(pixel(shown, 0), code(0));
    EXPECT_EQ(pixel(shown, 1), code(255));
    EXPECT_EQ(pixel(shown, 2), (Code{255, 0, 255, 255}));
    EXPECT_EQ(pixel(shown, 3), code(255));
    // A grey table of 256 steps over 0 to 10: 5 is the first of the upper half.
    EXPECT_EQ(pixel(shown_image(image, {0.0f, 10.0f, Colormap::grey}), 1), (Code{128, 128, 128, 255}));
}

TEST(ShownImage, ColoursAreShownAsTheyAre) {
    const Image image = floats(2, 1, 3, {0, 0.5f, 2, -1, 1, NAN});
    EXPECT_EQ(pixel(shown_image(image, {}), 0), (Code{0, 128, 255, 255}));
    EXPECT_EQ(pixel(shown_image(image, {}), 1), (Code{255, 0, 255, 255}));
    EXPECT_EQ(pixel(shown_image(image, {-1.0f, 3.0f, {}}), 0), (Code{64, 96, 191, 255}));
    Image bytes(1, 1, 3, PixelType::u8);
    bytes.pixels<uint8_t>()[0] = 200;
    EXPECT_EQ(pixel(shown_image(bytes, {}), 0), (Code{200, 0, 0, 255}));
    Image wide(1, 1, 1, PixelType::u16);
    wide.pixels<uint16_t>()[0] = 65535;
    EXPECT_EQ(pixel(shown_image(wide, {}), 0), (Code{255, 255, 255, 255}));
}

TEST(ShownImage, TransparentPartsShowAChequeredGround) {
    Image image(16, 1, 4, PixelType::u8);
    image.at<uint8_t>(1, 0)[0] = 255;
    image.at<uint8_t>(1, 0)[3] = 255;
    const Image shown = shown_image(image, {});
    EXPECT_EQ(pixel(shown, 1), (Code{255, 0, 0, 255}));
    EXPECT_EQ(pixel(shown, 0), (Code{153, 153, 153, 255}));  // 0.6
    EXPECT_EQ(pixel(shown, 8), (Code{204, 204, 204, 255}));  // 0.8
}

TEST(ImagePanels, RefuseWhatCannotBeShown) {
    ImagePanels panels;
    EXPECT_THROW(panels.show("", Image(1, 1, 1, PixelType::u8)), ArgumentError);
    EXPECT_THROW(panels.show("a", Image()), ArgumentError);
    EXPECT_THROW(panels.show("a", Image(1, 1, 2, PixelType::u8)), ArgumentError);
    EXPECT_THROW(panels.show("a", Image(16385, 1, 1, PixelType::u8)), ArgumentError);
    EXPECT_THROW(panels.show("a", Image(1, 16385, 1, PixelType::u8)), ArgumentError);
    EXPECT_THROW(panels.show("a", Image(1, 1, 1, PixelType::u8), {1.0f, 1.0f, {}}), ArgumentError);
    EXPECT_THROW(panels.show("a", Image(1, 1, 1, PixelType::u8), {NAN, {}, {}}), ArgumentError);
    EXPECT_TRUE(panels.names().empty());
    EXPECT_THROW(panels.remove("a"), NameError);
    EXPECT_THROW(panels.image("a"), NameError);
}

class ImageWindow : public testing::Test {
  protected:
    ImageWindow() { session_.settings().image.samples = 1; }
    void step(const std::vector<InputEvent>& events = {}) { view_.update(events, {1100, 600}, 1, 0.1); }
    void settle() {
        for (int i = 0; i < 5; ++i) step();
    }
    static InputEvent at(Kind kind, Vec2d position, double notches = 0) {
        InputEvent event;
        event.kind = kind;
        event.position = position;
        event.scroll = {0, notches};
        return event;
    }
    Vec2d canvas(double x, double y) {
        const auto box = view_.places().at("loss");
        return box.min() + box.sizes().cwiseProduct(Vec2d(x, y));
    }
    Code screen_at(Vec2d place) { return pixel(view_.screen(), int(place.x()), int(place.y())); }

    app::Session session_;
    LiveView view_{session_};
};

// Four pixels, 2 x 2, whose places on the screen are the canvas's quarters.
TEST_F(ImageWindow, ShowsPixelsTheirValuesAndZooms) {
    Image image(2, 2, 3, PixelType::u8);
    const uint8_t values[] = {250, 0, 0, 0, 240, 0, 0, 0, 230, 10, 20, 30};
    std::ranges::copy(values, image.pixels<uint8_t>().begin());
    view_.show_image("loss", image);
    settle();
    const auto box = view_.places().at("loss");
    const double side = box.sizes().minCoeff();
    const auto place = [&](double x, double y) {
        return Vec2d(box.center() + side * Vec2d(x - 0.5, y - 0.5));
    };
    EXPECT_EQ(screen_at(place(0.25, 0.25)), (Code{250, 0, 0, 255}));
    EXPECT_EQ(screen_at(place(0.75, 0.25)), (Code{0, 240, 0, 255}));
    EXPECT_EQ(screen_at(place(0.25, 0.75)), (Code{0, 0, 230, 255}));
    step({at(Kind::move, place(0.75, 0.75))});
    step();
    EXPECT_EQ(view_.state().image_value, "loss: (1, 1)  10  20  30");
    // Zooming keeps the pixel under the pointer, and the wheel does not move the camera's picture.
    const Vec2d corner = place(0.9, 0.1);
    step({at(Kind::move, corner)});
    for (int i = 0; i < 6; ++i) step({at(Kind::scroll, corner, -1)});
    step();
    EXPECT_EQ(view_.state().image_value, "loss: (1, 0)  0  240  0");
    EXPECT_NE(screen_at(place(0.25, 0.75)), (Code{0, 0, 230, 255}));
    // What is shown next keeps the place, and another size does not.
    image.pixels<uint8_t>()[3] = 99;
    view_.show_image("loss", image);
    settle();
    EXPECT_EQ(view_.state().image_value, "loss: (1, 0)  99  240  0");
    view_.remove_image("loss");
    settle();
    EXPECT_EQ(view_.places().count("loss"), 0u);
}

TEST_F(ImageWindow, KeepsWhatIsShownWithoutDrawingIt) {
    for (int i = 0; i < 100; ++i) view_.show_image("loss", floats(2, 1, 1, {float(i), 0}));
    EXPECT_EQ(view_.images().image("loss").pixels<float>()[0], 99);
    settle();
    view_.state().panels.shown = false;
    view_.touch();
    settle();
    EXPECT_EQ(view_.places().count("loss"), 0u);
}

}  // namespace
}  // namespace easypbr::gui::images_test
