// Characters that the font of the panels lacks.
#include <gtest/gtest.h>

#include "easypbr/geometry/primitives.h"
#include "easypbr/gui/live_view.h"
#include "easypbr/scene/settings.h"

namespace easypbr::gui::characters_test {
namespace {

/// The pixels of an object's name in the panel of the scene.
std::vector<uint8_t> shown_name(const std::string& name) {
    const Vec2i size(560, 400);
    Scene scene;
    scene.show(make_sphere(1, 8), name);
    app::Session session(scene);
    session.settings().image.samples = 1;
    LiveView view(session);
    view.state().panels.open.fill(false);
    view.state().panels.open[size_t(Panel::scene)] = true;
    for (int i = 0; i < 100 && (view.is_busy() || i < 3); ++i) view.update({}, size, 1, 0.05);
    const auto box = view.places().at("Scene/visible " + name);
    const Image screen = view.screen();
    std::vector<uint8_t> pixels;
    for (int y = int(box.min().y()); y < int(box.max().y()); ++y)
        for (int x = 0; x < int(box.min().x()); ++x)
            for (int c = 0; c < 3; ++c) pixels.push_back(screen.at<uint8_t>(x, y)[c]);
    return pixels;
}

// Two of Japanese, and one beyond the first 65536: as many white squares (U+25A1).
TEST(Characters, AreSquaresWhereTheFontLacksThem) {
    const std::vector<uint8_t> squares = shown_name("a\u25a1\u25a1\u25a1");
    EXPECT_EQ(shown_name("a\u65e5\u672c\U0001f600"), squares);
    EXPECT_NE(shown_name("a???"), squares);
}

}  // namespace
}  // namespace easypbr::gui::characters_test
