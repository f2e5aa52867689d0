// A driver that says that its contexts are lost, as one does after a reset of the GPU. libepoxy calls drivers
// through pointers, one of which is replaced here.
#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <string>
#include <vector>

#include "easypbr/app/live_drawing.h"
#include "easypbr/app/picture_ring.h"
#include "easypbr/app/session.h"
#include "easypbr/core/log.h"
#include "easypbr/geometry/primitives.h"
#include "easypbr/gui/live_view.h"

namespace easypbr::app::lost_context_test {
namespace {

int losses = 0;  ///< that are still to come
int asked = 0;
int spared = 0;  ///< questions answered well before the next loss

GLenum GLAPIENTRY answer() {
    ++asked;
    if (spared > 0) return --spared, GL_NO_ERROR;
    return losses > 0 ? (--losses, GL_GUILTY_CONTEXT_RESET) : GL_NO_ERROR;
}

/// What two images are compared by.
std::string bytes_of(const Image& image) {
    return {reinterpret_cast<const char*>(image.bytes().data()), image.bytes().size()};
}

/// A sphere that OpenGL draws; warnings are kept.
class LostContext : public testing::Test {
  protected:
    LostContext() {
        Scene scene;
        scene.show(make_sphere(1, 16), "sphere");
        session_ = Session(scene);
        session_.settings().image.size = Vec2i(48, 32);
        session_.settings().image.samples = 4;
        set_log_sink([this](LogLevel level, std::string_view text) {
            if (level == LogLevel::warning) warnings_ += std::string(text) + "\n";
        });
        losses = asked = spared = 0;
    }
    ~LostContext() override {
        epoxy_glGetGraphicsResetStatus = driver_;
        set_log_sink({});
    }
    void lose(int times, int after = 0) {
        losses = times;
        spared = after;
        epoxy_glGetGraphicsResetStatus = answer;
    }
    void use_gl() { session_.use_device(DrawDevice::gl); }
    std::string drawn() { return bytes_of(session_.render()); }

    Session session_;
    std::string warnings_;

  private:
    decltype(epoxy_glGetGraphicsResetStatus) driver_ = epoxy_glGetGraphicsResetStatus;
};

TEST_F(LostContext, IsReplacedAndThePictureIsTheSame) {
    use_gl();
    const std::string before = drawn();
    const uint64_t number = session_.device_number();
    lose(1);
    EXPECT_TRUE(drawn() == before);
    EXPECT_EQ(session_.device_number(), number + 1);
    EXPECT_EQ(warnings_,
              "the OpenGL context was lost: the GPU was reset because of what was drawn; everything is drawn "
              "again in another one\n");
    EXPECT_GT(asked, 1);
    EXPECT_TRUE(drawn() == before);
    EXPECT_EQ(session_.device_number(), number + 1) << "it is lost once";
}

// Whichever question finds it out: of a sample, of reading, of layers, of surfaces.
TEST_F(LostContext, IsReplacedAtEveryMoment) {
    use_gl();
    const std::string before = drawn();
    const std::string depth = bytes_of(session_.render_layers({"depth"}).at("depth"));
    const std::optional<Pick> seen = session_.pick({24, 16});
    ASSERT_TRUE(seen);
    const auto draw_all = [&] {
        EXPECT_TRUE(drawn() == before);
        EXPECT_TRUE(bytes_of(session_.render_layers({"depth"}).at("depth")) == depth);
        const std::optional<Pick> again = session_.pick({24, 16});
        ASSERT_TRUE(again);
        EXPECT_EQ(again->object, seen->object);
    };
    lose(0);
    draw_all();
    const int questions = asked;
    ASSERT_GE(questions, 4);
    for (int after = 0; after < questions; ++after) {
        SCOPED_TRACE(after);
        lose(1, after);
        const uint64_t number = session_.device_number();
        draw_all();
        EXPECT_EQ(session_.device_number(), number + 1);
    }
}

TEST_F(LostContext, IsAnErrorWhereOpenGlWasAskedForAndIsLostAgain) {
    use_gl();
    const std::string before = drawn();
    lose(2);
    try {
        drawn();
        FAIL() << "no error";
    } catch (const ContextError& error) {
        EXPECT_STREQ(
            error.what(),
            "the OpenGL context was lost: the GPU was reset because of what was drawn, and so was the one "
            "made in its place");
    }
    EXPECT_TRUE(drawn() == before) << "the next picture is drawn in a new one";
}

TEST_F(LostContext, LeavesItToTheCpuWhenItIsLostAgain) {
    ::setenv("EASYPBR_DEVICE", "gl", 1);
    drawn();
    EXPECT_EQ(session_.context_info().device, DrawDevice::gl);
    lose(2);
    const std::string after = drawn();
    ::unsetenv("EASYPBR_DEVICE");
    EXPECT_EQ(session_.context_info().device, DrawDevice::cpu);
    EXPECT_NE(warnings_.find("from now on the CPU draws"), std::string::npos) << warnings_;
    Session cpu(session_.scene());
    cpu.settings() = session_.settings();
    cpu.use_device(DrawDevice::cpu);
    EXPECT_TRUE(after == bytes_of(cpu.render()));
}

TEST_F(LostContext, TakesPicturesAlongThatWereNotRead) {
    use_gl();
    const std::string wanted = drawn();
    const Drawn before = session_.draw();
    const uint64_t number = session_.device_number();
    lose(1);
    for (int i = 0; i < 2; ++i) EXPECT_THROW(before.picture(), gl::ContextLost);
    EXPECT_TRUE(drawn() == wanted);
    EXPECT_EQ(session_.device_number(), number + 1);
    EXPECT_THROW(before.picture(), gl::ContextLost);
}

TEST_F(LostContext, LeavesARingOfPicturesUsable) {
    use_gl();
    std::vector<std::string> taken;
    PictureRing ring(session_, [&](Image picture, int) { taken.push_back(bytes_of(picture)); });
    for (int i = 0; i < 4; ++i) ring.draw({});
    ring.drain();
    lose(1);
    for (int i = 0; i < 4; ++i) ring.draw({});
    ring.drain();
    ASSERT_EQ(taken.size(), 8u);
    for (const std::string& picture : taken) EXPECT_TRUE(picture == taken.front());
}

TEST_F(LostContext, IsReplacedUnderALivePicture) {
    use_gl();
    LiveDrawing live(session_);
    const auto finish = [&] {
        for (int i = 0; i < 100 && (i == 0 || live.is_busy()); ++i) live.update({}, {48, 32}, 1.0 / 60);
        return bytes_of(live.picture().image());
    };
    const std::string before = finish();
    lose(0);
    live.update({}, {48, 32}, 1.0 / 60);
    const uint64_t number = session_.device_number();
    lose(1);
    EXPECT_TRUE(finish() == before);
    EXPECT_EQ(session_.device_number(), number + 1);
    live.draw_finished();
    EXPECT_TRUE(bytes_of(live.picture().image()) == before);
}

TEST_F(LostContext, IsReplacedUnderPanels) {
    use_gl();
    gui::LiveView view(session_);
    view.show_image("own", Image(4, 4, 3, PixelType::u8));
    // The line on top shows how long frames take.
    constexpr size_t top = 20 * 320 * 4;
    const auto screen = [&] { return bytes_of(view.finished_screen({320, 200})).substr(top); };
    const std::string before = screen();
    EXPECT_TRUE(screen() == before);
    for (int after = 0; after < 3; ++after) {
        const uint64_t number = session_.device_number();
        lose(1, after);
        EXPECT_TRUE(screen() == before) << after;
        EXPECT_EQ(session_.device_number(), number + 1);
    }
}

}  // namespace
}  // namespace easypbr::app::lost_context_test
