#include "easypbr/gl/context.h"

#include <epoxy/gl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "easypbr/core/error.h"
#include "easypbr/core/log.h"
#include "easypbr/gl/buffer.h"
#include "easypbr/gl/texture.h"

namespace easypbr::gl::context_test {
namespace {

TEST(Context, SaysWhatItIs) {
    const auto context = Context::create();
    EXPECT_FALSE(context->info().renderer.empty());
    EXPECT_EQ(context->info().version.substr(0, 2), "4.");
    EXPECT_GE(context->info().max_texture_size, 16384);
    ASSERT_FALSE(context->info().attempts.empty());
    EXPECT_EQ(context->info().attempts.back().error, "");
}

/// Sets a variable of the environment for as long as it lives.
class EnvironmentVariable {
  public:
    EnvironmentVariable(const char* name, const char* value) : name_(name) { ::setenv(name, value, 1); }
    EnvironmentVariable(const EnvironmentVariable&) = delete;
    EnvironmentVariable& operator=(const EnvironmentVariable&) = delete;
    ~EnvironmentVariable() { ::unsetenv(name_); }

  private:
    const char* name_;
};

// The one of several GPUs that is asked for; llvmpipe is an EGL device too.
TEST(Context, IsOnTheEglDeviceThatIsAskedFor) {
    {
        const EnvironmentVariable number("EASYPBR_EGL_DEVICE", "0");
        const auto context = Context::create();
        EXPECT_EQ(context->info().device, DrawDevice::gl);
        ASSERT_EQ(context->info().attempts.size(), 1u);
        EXPECT_EQ(context->info().platform.substr(0, 12), "EGL device 0");
    }
    const auto error_of = [](const char* value) -> std::string {
        const EnvironmentVariable number("EASYPBR_EGL_DEVICE", value);
        try {
            Context::create();
        } catch (const ContextError& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_NE(error_of("31").find("there is no EGL device 31: there are "), std::string::npos);
    for (const char* wrong : {"first", "-1", "0x", "1 "})
        EXPECT_NE(error_of(wrong).find("expected the number of an EGL device, from 0 on, got '"),
                  std::string::npos)
            << wrong;
    const EnvironmentVariable number("EASYPBR_EGL_DEVICE", "31");
    EXPECT_EQ(Context::create(DrawDevice::cpu)->info().device, DrawDevice::cpu);
}

TEST(Context, OfTheCpuLoadsTheDriverWhenItIsNeeded) {
    const auto context = Context::create(DrawDevice::cpu), other = Context::create();
    EXPECT_EQ(context->info().device, DrawDevice::cpu);
    EXPECT_TRUE(context->info().software);
    EXPECT_TRUE(context->info().version.empty());
    {
        const ContextScope scope(*context);
        EXPECT_FALSE(Context::has_driver());
        {
            const ContextScope within(*other);
            EXPECT_TRUE(Context::has_driver());
            const ContextScope again(*context);
            EXPECT_FALSE(Context::has_driver());
        }
        EXPECT_FALSE(Context::has_driver());
        const Texture texture(Format::rgba8, 4, 4);
        EXPECT_TRUE(Context::has_driver());
        EXPECT_NE(glGetString(GL_VERSION), nullptr);
    }
    EXPECT_EQ(context->info().version.substr(0, 2), "4.");
    EXPECT_TRUE(context->info().software) << "native passes stay native";
    EXPECT_FALSE(Context::has_driver());
    const ContextScope scope(*context);
    EXPECT_TRUE(Context::has_driver());
    EXPECT_NE(glGetString(GL_VERSION), nullptr) << "current again";
}

TEST(Context, LogsWhatTheDriverSays) {
    std::vector<std::pair<LogLevel, std::string>> messages;
    set_log_sink([&](LogLevel level, std::string_view text) { messages.emplace_back(level, text); });
    const auto context = Context::create();
    {
        const ContextScope scope(*context);
        glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
        glEnable(GL_TEXTURE_CUBE_MAP_POSITIVE_X);  // nothing that can be enabled
        EXPECT_EQ(glGetError(), GLenum(GL_INVALID_ENUM));
        constexpr std::string_view slow = "a slow path", aside = "an aside";
        glDebugMessageInsert(GL_DEBUG_SOURCE_APPLICATION, GL_DEBUG_TYPE_PERFORMANCE, 1,
                             GL_DEBUG_SEVERITY_MEDIUM, GLsizei(slow.size()), slow.data());
        glDebugMessageInsert(GL_DEBUG_SOURCE_APPLICATION, GL_DEBUG_TYPE_OTHER, 1, GL_DEBUG_SEVERITY_MEDIUM,
                             GLsizei(aside.size()), aside.data());
    }
    set_log_sink({});
    ASSERT_EQ(messages.size(), 2u);
    EXPECT_EQ(messages[0].first, LogLevel::warning);
    EXPECT_EQ(messages[0].second.substr(0, 8), "OpenGL: ");
    EXPECT_EQ(messages[1].first, LogLevel::debug);
    EXPECT_EQ(messages[1].second, "OpenGL performance: a slow path");
}

TEST(Context, ScopesNestAndGiveBack) {
    const auto a = Context::create(), b = Context::create();
    EXPECT_EQ(Context::current_or_null(), nullptr);
    {
        const ContextScope outer(*a);
        EXPECT_EQ(Context::current_or_null(), a.get());
        {
            const ContextScope inner(*b);
            EXPECT_EQ(Context::current_or_null(), b.get());
            const ContextScope again(*b);
        }
        EXPECT_EQ(Context::current_or_null(), a.get());
        EXPECT_NE(glGetString(GL_VERSION), nullptr);
    }
    EXPECT_EQ(Context::current_or_null(), nullptr);
    EXPECT_THROW(Context::current(), ContextError);
}

TEST(Context, ServesSeveralThreadsInTurn) {
    const auto context = Context::create();
    const auto work = [&] {
        for (int i = 0; i < 20; ++i) {
            const ContextScope scope(*context);
            const Buffer buffer(size_t(64));
            EXPECT_TRUE(buffer);
        }
    };
    std::thread first(work), second(work);
    first.join();
    second.join();
}

TEST(Context, DeletesObjectsThatDieElsewhere) {
    const auto context = Context::create();
    Buffer buffer;
    GLuint id = 0;
    {
        const ContextScope scope(*context);
        buffer = Buffer(size_t(64));
        id = buffer.id();
    }
    std::thread([dying = std::move(buffer)]() mutable { dying = Buffer(); }).join();
    const ContextScope scope(*context);
    EXPECT_FALSE(glIsBuffer(id));
}

TEST(Context, ObjectsMayOutliveIt) {
    auto context = Context::create();
    Texture texture;
    {
        const ContextScope scope(*context);
        texture = Texture(Format::rgba8, 4, 4);
    }
    context.reset();
    texture = Texture();
}

TEST(Context, RefusesToWorkAfterFork) {
    const auto context = Context::create();
    const pid_t child = fork();
    if (child == 0) {
        try {
            const ContextScope scope(*context);
        } catch (const ContextError& error) {
            _exit(std::string(error.what()).find("spawn") != std::string::npos ? 0 : 2);
        }
        _exit(1);
    }
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_EQ(WEXITSTATUS(status), 0);
}

TEST(Texture, RefusesSizesBeyondTheDriver) {
    const auto context = Context::create();
    const ContextScope scope(*context);
    EXPECT_THROW(Texture(Format::rgba8, context->info().max_texture_size + 1, 1), ContextError);
    EXPECT_THROW(Texture(Format::rgba8, 0, 1), ContextError);
    Texture texture(Format::rgba8, 2, 2);
    EXPECT_THROW(texture.upload(std::vector<std::byte>(3)), ArgumentError);
}

TEST(Texture, RoundTrips) {
    const auto context = Context::create();
    const ContextScope scope(*context);
    Texture texture(Format::rg16, 3, 2);
    std::vector<uint16_t> values(12), back(12);
    for (size_t i = 0; i < values.size(); ++i) values[i] = uint16_t(i * 5000);
    texture.upload(std::as_bytes(std::span(values)));
    Framebuffer({&texture}).read(0, Format::rg16, 0, 0, 3, 2, std::as_writable_bytes(std::span(back)));
    EXPECT_EQ(values, back);
}

}  // namespace
}  // namespace easypbr::gl::context_test
