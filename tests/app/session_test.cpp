#include "easypbr/app/session.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <thread>

#include "easypbr/app/output.h"
#include "easypbr/core/file.h"
#include "easypbr/core/image.h"
#include "easypbr/core/log.h"
#include "easypbr/geometry/primitives.h"
#include "easypbr/io/image/image_io.h"
#include "easypbr/io/settings/settings_io.h"
#include "easypbr/scene/resolve.h"
#include "easypbr/scene/setting_files.h"

namespace easypbr::app::session_test {
namespace {

namespace fs = std::filesystem;

class SessionFiles : public testing::Test {
  protected:
    void SetUp() override {
        char name[] = "/tmp/easypbr_sessionXXXXXX";
        ASSERT_NE(mkdtemp(name), nullptr);
        folder_ = name;
    }
    void TearDown() override { fs::remove_all(folder_); }

    size_t file_count() const {
        return size_t(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
    }

    static Session small_session() {
        Scene scene;
        scene.show(make_sphere(1, 16), "sphere");
        Session session(scene);
        session.settings().image.size = Vec2i(48, 32);
        session.settings().image.samples = 2;
        return session;
    }

    fs::path folder_;
};

Image constant_image(const Vec3& color) {
    Image image(8, 4, 3, PixelType::f32);
    for (size_t i = 0; i < image.pixel_count(); ++i)
        std::copy_n(color.data(), 3, image.pixels<float>().data() + 3 * i);
    return image;
}

TEST_F(SessionFiles, DrawsAgainWithoutAMeshThatIsTooLarge) {
    Session session = small_session();
    const Image before = small_session().render();
    session.scene().show(make_sphere(1e38f, 4), "huge");
    try {
        session.render();
        ADD_FAILURE() << "drawn";
    } catch (const ArgumentError& error) {
        EXPECT_NE(std::string(error.what()).find("mesh 'huge'"), std::string::npos) << error.what();
    }
    session.scene().remove("huge");
    EXPECT_TRUE(compare(session.render(), before).max == 0);
}

TEST_F(SessionFiles, SavedSettingsReproduceThePicture) {
    Session first = small_session();
    first.settings().camera.azimuth_deg = 77;
    first.settings().tonemap.tone_operator = ToneOperator::agx;
    render_to_file(first, folder_ / "first.png");
    save_settings(first, {}, folder_ / "look.json");

    Session second = small_session();
    load_settings(second, folder_ / "look.json");
    render_to_file(second, folder_ / "second.png");
    EXPECT_EQ(
        compare(io::load_image(folder_ / "first.png"), io::load_image(folder_ / "second.png")).different, 0u);
}

// A scene's file is only compared with its hash; the environment's is loaded again.
TEST_F(SessionFiles, SavedSettingsNameNoFileWhoseNameIsNotUtf8) {
    const fs::path model = folder_ / "caf\xe9.ply", light = folder_ / "caf\xe9.hdr",
                   look = folder_ / "look.json";
    write_file(model, "x");
    write_file(light, "x");
    Session session = small_session();
    std::vector<std::string> warnings;
    set_log_sink([&](LogLevel, std::string_view message) { warnings.emplace_back(message); });
    save_settings(session, {model}, look);
    set_log_sink({});
    const std::string folder = fs::absolute(folder_).string();
    EXPECT_EQ(warnings, std::vector{look.string() + " does not hold the hash of " + folder +
                                    "/caf\xe9.ply, whose name is not UTF-8"});
    EXPECT_TRUE(io::load_settings(look).files.empty());
    session.settings().environment.file = light.string();
    EXPECT_THROW(save_settings(session, {}, look), ArgumentError);
}

// The file can be used from any folder and says when one of the files has changed since.
TEST_F(SessionFiles, SavedSettingsNameEveryFileAbsolutely) {
    io::save_image(constant_image(Vec3(1, 1, 1)), folder_ / "white.hdr");
    write_file(folder_ / "plain.glsl", "void surface(inout Surface s) {}");
    Session session = small_session();
    Settings& settings = session.settings();
    const auto relative = [&](const char* name) { return fs::relative(folder_ / name).string(); };
    settings.environment.file = settings.background.image = relative("white.hdr");
    for (const MaterialTexture& row : replaceable_textures())
        settings.material.*row.setting = relative("white.hdr");
    settings.material.shader = relative("plain.glsl");
    save_settings(session, {}, folder_ / "look.json");
    const io::SettingsFile saved = io::load_settings(folder_ / "look.json");
    int count = 0;
    for_each_file(saved.settings, [&](const std::string& file) {
        ++count;
        EXPECT_TRUE(fs::path(file).is_absolute()) << file;
        EXPECT_TRUE(saved.files.contains(file)) << file;
    });
    EXPECT_EQ(count, 10) << "environment, background, seven textures, shader";
}

// The camera and lights stay where they were put when an object changes; refit() infers them anew.
TEST_F(SessionFiles, LatchesUntilRefit) {
    Session session = small_session();
    session.render();
    const Vec3d position = session.camera().position();
    const std::string name = session.scene().names().at(0);
    session.scene().show(make_sphere(10, 16), name);
    session.render();
    EXPECT_EQ(session.camera().position(), position);
    session.refit();
    session.render();
    EXPECT_GT(session.camera().position().norm(), 5 * position.norm());
}

// A further object is in the picture at once, unless it is within the others or the camera is pinned.
TEST_F(SessionFiles, FitsAgainWhenTheContentGrows) {
    Session session = small_session();
    session.render();
    const Vec3d position = session.camera().position();
    session.scene().show(make_sphere(0.1f, 16), "small");
    EXPECT_EQ(session.camera().position(), position);
    session.scene().show(make_sphere(10, 16), "large");
    EXPECT_GT(session.camera().position().norm(), 5 * position.norm());
    session.render();
    const Camera second = session.camera();
    EXPECT_TRUE(session.settings().lights.key.position.value());
    session.scene().remove("large");
    session.render();
    EXPECT_EQ(session.camera().position(), second.position()) << "less content";
    session.set_camera(second);
    session.scene().show(make_sphere(100, 16), "largest");
    EXPECT_EQ(session.camera().position(), second.position());
}

// A ground that was inferred never cuts through content that sinks, and comes back to where it was.
TEST_F(SessionFiles, TheGroundIsBelowWhatSinks) {
    Scene scene;
    Mesh box = make_box();
    scene.show(box, "box");
    Session session(scene);
    const auto height = [&] {
        session.render({Vec2i(32, 24), 1});
        return session.resolve(Vec2i(32, 24)).settings.ground.height;
    };
    const double first = height();
    EXPECT_NEAR(first, -0.5, 1e-3);
    for (const double lift : {2.0, -3.0, 0.0}) {
        box.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(0, lift, 0)));
        EXPECT_NEAR(height(), std::min(first, first + lift), 1e-6) << lift;
    }
    session.settings().ground.height = 0.25;
    EXPECT_EQ(height(), 0.25);
}

// Lit surfaces before one colour stand on a shadow catcher.
TEST_F(SessionFiles, TheGroundIsInferredFromContentAndBackground) {
    const auto mode = [&](const Mesh& mesh, const std::function<void(Settings&)>& change) {
        Scene scene;
        scene.show(mesh, "mesh");
        Session session(scene);
        change(session.settings());
        return session.resolve(Vec2i(32, 24)).settings.ground.mode;
    };
    const auto nothing = [](Settings&) {};
    const auto points = [](const Mesh& mesh) {
        MeshData data;
        data.V = mesh.V();
        return Mesh(data);
    };
    const Mesh box = make_box();
    EXPECT_EQ(mode(box, nothing), GroundMode::shadow);
    EXPECT_EQ(mode(points(box), nothing), GroundMode::none) << "points";
    for (const auto mode_of_background :
         {BackgroundMode::environment, BackgroundMode::blur, BackgroundMode::transparent})
        EXPECT_EQ(mode(box, [&](Settings& s) { s.background.mode = mode_of_background; }), GroundMode::none);
    EXPECT_EQ(mode(box, [](Settings& s) { s.style.lit = false; }), GroundMode::none);
    EXPECT_EQ(mode(box, [](Settings& s) { s.style.mode = DrawMode::points; }), GroundMode::none);
    EXPECT_EQ(mode(box, [](Settings& s) { s.shadows.enabled = false; }), GroundMode::none);
    EXPECT_EQ(mode(box, [](Settings& s) { s.ground.mode = GroundMode::plane; }), GroundMode::plane);
}

// The key gives most of the light of the default studio, a given environment all of its own.
TEST_F(SessionFiles, TheStudioIsDimmerThanTheKey) {
    Scene scene;
    scene.show(make_box(), "box");
    Session session(scene);
    const ResolvedSettings whole = session.resolve(Vec2i(32, 24));
    EXPECT_EQ(whole.settings.environment.intensity, 0.2f);
    session.settings().environment.enabled = false;
    // The exposure is the reciprocal of the light that is metered.
    EXPECT_GT(whole.exposure / session.resolve(Vec2i(32, 24)).exposure, 0.5f) << "the key's part";
    session.settings().environment.enabled = automatic;
    session.settings().environment.intensity = 3.0f;
    EXPECT_EQ(session.resolve(Vec2i(32, 24)).settings.environment.intensity, 3.0f);
    session.settings().environment.intensity = automatic;
    session.render({Vec2i(32, 24), 1});
    scene.set_environment(Environment(Image(16, 8, 3, PixelType::f32), "black"));
    EXPECT_EQ(session.resolve(Vec2i(32, 24)).settings.environment.intensity, 1.0f) << "not latched";
}

TEST_F(SessionFiles, FollowsWhenAskedTo) {
    Session session = small_session();
    session.settings().camera.position = follow;
    session.settings().camera.target = follow;
    session.render();
    const Vec3d position = session.camera().position();
    session.scene().show(make_sphere(10, 16), "large");
    EXPECT_GT(session.camera().position().norm(), 5 * position.norm());
}

// An environment that is given after the first picture switches the three-point lights off.
TEST_F(SessionFiles, NewEnvironmentIsInferredAnew) {
    Session session = small_session();
    session.render();
    EXPECT_TRUE(session.resolve().settings.lights.key.enabled);
    io::save_image(constant_image(Vec3(4, 4, 4)), folder_ / "env.exr");
    session.load_environment(folder_ / "env.exr");
    const ResolvedSettings resolved = session.resolve();
    EXPECT_FALSE(resolved.settings.lights.key.enabled);
    // A constant environment of 4 gives a white diffuse object a radiance of 4: it is brought to 1.
    EXPECT_NEAR(resolved.exposure, 0.25f, 0.01f);
}

// The light of a constant environment is its value: the automatic exposure is the reciprocal, as above.
TEST_F(SessionFiles, AnEnvironmentThatChangesIsReadAgain) {
    const fs::path file = folder_ / "env.exr";
    auto time = fs::file_time_type::clock::now();
    const auto write = [&](float value) {
        io::save_image(constant_image(Vec3(value, value, value)), file);
        fs::last_write_time(file, time += std::chrono::seconds(1));
    };
    write(4);
    Session session = small_session();
    session.settings().environment.file = file.string();
    EXPECT_NEAR(session.resolve().exposure, 0.25f, 0.01f);
    const uint64_t version = session.picture_version();
    EXPECT_EQ(session.picture_version(), version);
    write(2);
    EXPECT_GT(session.picture_version(), version);
    EXPECT_NEAR(session.resolve().exposure, 0.5f, 0.02f);
    fs::remove(file);
    EXPECT_NEAR(session.resolve().exposure, 0.5f, 0.02f) << "missing while it is replaced";
    write(1);
    EXPECT_NEAR(session.resolve().exposure, 1.0f, 0.04f);
}

TEST_F(SessionFiles, AnEmptySceneLatchesNothing) {
    Session session;
    session.settings().image.size = Vec2i(16, 16);
    session.settings().camera.position = Vec3d(0, 0, 5);
    session.settings().camera.target = Vec3d(0, 0, 0);
    session.render();
    EXPECT_FALSE(session.settings().lights.key.position.value().has_value());
    EXPECT_THROW(Session().render(), ArgumentError);
}

TEST_F(SessionFiles, NothingHalfWritten) {
    Session session = small_session();
    EXPECT_THROW(render_to_file(session, folder_ / "missing" / "a.png"), FileError);
    EXPECT_THROW(render_to_file(session, folder_), ArgumentError);
    EXPECT_THROW(render_to_file(session, folder_ / "a.gif"), ArgumentError);
    EXPECT_THROW(check_picture(folder_ / "a.jpg", session.settings(), Vec2i(65501, 1)), ArgumentError);
    EXPECT_NO_THROW(check_picture(folder_ / "a.jpg", session.settings(), Vec2i(65500, 1)));
    EXPECT_NO_THROW(check_picture(folder_ / "a.png", session.settings(), Vec2i(65536, 1)));
    session.settings().background.mode = BackgroundMode::transparent;
    EXPECT_THROW(render_to_file(session, folder_ / "a.jpg"), ArgumentError);
    EXPECT_THROW(render_to_file(session, folder_ / "a.hdr"), ArgumentError);
    session.settings().background.mode = BackgroundMode::image;
    session.settings().background.image = (folder_ / "none.png").string();
    EXPECT_THROW(render_to_file(session, folder_ / "a.png"), FileError);
    EXPECT_EQ(file_count(), 0u);
}

TEST_F(SessionFiles, ImageBackgroundCoversThePicture) {
    io::save_image(to_u8(constant_image(Vec3(0, 1, 0))), folder_ / "green.png");
    Session session = small_session();
    session.settings().background.mode = BackgroundMode::image;
    session.settings().background.image = (folder_ / "green.png").string();
    const auto corner = [&] {
        const Image image = session.render();
        const uint8_t* p = image.at<uint8_t>(0, 0);
        return std::vector<int>(p, p + 4);
    };
    EXPECT_EQ(corner(), (std::vector<int>{0, 255, 0, 255}));
    // A file that changes is read again.
    io::save_image(to_u8(constant_image(Vec3(1, 0, 0))), folder_ / "green.png");
    fs::last_write_time(folder_ / "green.png", fs::file_time_type::clock::now() + std::chrono::seconds(5));
    EXPECT_EQ(corner(), (std::vector<int>{255, 0, 0, 255}));
}

// An image in memory stays until the settings name another one; a mode that shows none leaves it.
TEST_F(SessionFiles, ImagesInMemoryAreBackgrounds) {
    io::save_image(to_u8(constant_image(Vec3(1, 0, 0))), folder_ / "red.png");
    Session session = small_session();
    BackgroundSettings& background = session.settings().background;
    session.settings().ground.mode = GroundMode::none;
    background.color = Vec3(0, 0, 1);
    background.image = "none.png";
    const auto corner = [&] {
        const Image image = session.render();
        const uint8_t* p = image.at<uint8_t>(0, 0);
        return std::vector<int>(p, p + 4);
    };
    EXPECT_THROW(session.set_background(Image()), ArgumentError);
    EXPECT_EQ(background.image, "none.png");
    session.set_background(to_u8(constant_image(Vec3(0, 1, 0))));
    EXPECT_EQ(background.image, "");
    EXPECT_EQ(corner(), (std::vector<int>{0, 255, 0, 255}));
    background.mode = BackgroundMode::color;
    EXPECT_EQ(corner(), (std::vector<int>{0, 0, 255, 255}));
    background.mode = BackgroundMode::image;
    EXPECT_EQ(corner(), (std::vector<int>{0, 255, 0, 255}));
    background.image = (folder_ / "red.png").string();
    EXPECT_EQ(corner(), (std::vector<int>{255, 0, 0, 255}));
    background.image.clear();
    EXPECT_THROW(session.render(), ArgumentError);
}

TEST_F(SessionFiles, BackgroundsThatAreNotReadLeaveTheOneBefore) {
    io::save_image(to_u8(constant_image(Vec3(1, 0, 0))), folder_ / "red.png");
    Session session = small_session();
    session.settings().ground.mode = GroundMode::none;
    const BackgroundSettings& background = session.settings().background;
    const auto corner = [&] {
        const Image image = session.render();
        const uint8_t* p = image.at<uint8_t>(0, 0);
        return std::vector<int>(p, p + 4);
    };
    session.set_background(to_u8(constant_image(Vec3(0, 1, 0))));
    EXPECT_THROW(session.load_background(folder_ / "none.png"), FileError);
    EXPECT_EQ(background.image, "");
    EXPECT_EQ(corner(), (std::vector<int>{0, 255, 0, 255}));
    session.settings().background.mode = BackgroundMode::color;
    session.load_background(folder_ / "red.png");
    EXPECT_EQ(background.image, (folder_ / "red.png").string());
    EXPECT_EQ(background.mode, BackgroundMode::image);
    EXPECT_EQ(corner(), (std::vector<int>{255, 0, 0, 255}));
}

// A picture of one colour behind everything, as its corner shows it, in all encodings and with several
// samples.
TEST_F(SessionFiles, ImageBackgroundKeepsBitsRadianceAndAlpha) {
    const auto corner = [&](const Image& behind, const char* name, int samples, Encoding encoding) {
        io::save_image(behind, folder_ / name);
        Session session = small_session();
        session.settings().ground.mode = GroundMode::none;
        session.settings().background.mode = BackgroundMode::image;
        session.settings().background.color = Vec3(0, 0, 1);
        session.settings().background.image = (folder_ / name).string();
        const Image picture = session.render({std::nullopt, samples, encoding});
        std::vector<double> values;
        for (int c = 0; c < 4; ++c)
            values.push_back(encoding == Encoding::scene_linear ? double(picture.at<float>(0, 0)[c])
                             : encoding == Encoding::srgb16     ? double(picture.at<uint16_t>(0, 0)[c])
                                                                : double(picture.at<uint8_t>(0, 0)[c]));
        return values;
    };
    const auto expect_near = [](const std::vector<double>& values, const std::vector<double>& expected,
                                double tolerance) {
        for (size_t c = 0; c < 4; ++c) EXPECT_NEAR(values[c], expected[c], tolerance) << "channel " << c;
    };
    Image fine(4, 4, 3, PixelType::u16), half(4, 4, 4, PixelType::u8);
    const uint16_t codes[] = {12345, 23456, 34567};
    const uint8_t red[] = {255, 0, 0, 51};
    for (size_t i = 0; i < 16; ++i) {
        std::ranges::copy(codes, fine.at<uint16_t>(int(i) % 4, int(i) / 4));
        std::ranges::copy(red, half.at<uint8_t>(int(i) % 4, int(i) / 4));
    }
    for (const int samples : {1, 4}) {
        // Powers of the CPU are off by 2e-6, an eighth of a code of 16 bits; a driver's by some times that.
        expect_near(corner(fine, "fine.png", samples, Encoding::srgb16), {12345, 23456, 34567, 65535}, 2);
        const Image bright = constant_image(Vec3(4, 0.5f, 0.25f));
        expect_near(corner(bright, "bright.exr", samples, Encoding::scene_linear), {4, 0.5, 0.25, 1}, 1e-6);
        // sRGB of 0.5 and 0.25: 187.5 and 137.0, rounded.
        expect_near(corner(bright, "bright.exr", samples, Encoding::srgb8), {255, 187.5, 137, 255}, 0.51);
        // A fifth of red over blue.
        expect_near(corner(half, "half.png", samples, Encoding::scene_linear), {0.2, 0, 0.8, 1}, 1e-6);
    }
}

TEST_F(SessionFiles, LayersAreWrittenBesideThePicture) {
    Session session = small_session();
    const auto files = layers_to_files(session, folder_ / "out.png", {"depth", "normal_world"});
    ASSERT_EQ(files.size(), 2u);
    EXPECT_TRUE(fs::exists(folder_ / "out_depth.exr"));
    EXPECT_EQ(io::load_image(folder_ / "out_normal_world.exr").channels(), 3);
}

TEST_F(SessionFiles, SixteenBitPng) {
    Session session = small_session();
    render_to_file(session, folder_ / "deep.png", {}, true);
    EXPECT_EQ(io::load_image(folder_ / "deep.png").type(), PixelType::u16);
}

// Two viewers on two threads, and one viewer used from two threads: the same pictures as alone.
TEST_F(SessionFiles, Threads) {
    Session alone = small_session();
    const Image expected = alone.render();
    std::vector<std::thread> threads;
    std::array<Image, 4> images;
    for (Image& image : images)
        threads.emplace_back([&image] {
            Session own = small_session();
            image = own.render();
        });
    for (std::thread& thread : threads) thread.join();
    for (const Image& image : images) EXPECT_EQ(compare(expected, image).different, 0u);
}

// Two sessions by one device, in turns: the same pictures as alone, at every size.
TEST_F(SessionFiles, BesideAnotherOneByTheSameDevice) {
    Session session = small_session();
    session.settings().background.color = Vec3(1, 0, 0);
    const Image expected = session.render();
    Session other = session.beside();
    EXPECT_EQ(&other.renderer(), &session.renderer());
    EXPECT_EQ(compare(expected, other.render()).different, 0u);
    other.settings().background.color = Vec3(0, 0, 1);
    const Image blue = other.render({Vec2i(40, 40), std::nullopt});
    EXPECT_EQ(blue.width(), 40);
    EXPECT_EQ(compare(expected, session.render()).different, 0u);
    EXPECT_EQ(compare(blue, other.render({Vec2i(40, 40), std::nullopt})).different, 0u);
    // What is shown is shown in both.
    session.scene().show(make_sphere(0.5f, 8), "another");
    EXPECT_EQ(other.object_names().size(), 2u);
}

// What the other one draws between two frames ends the sum: it begins again, and is the same in the end.
TEST_F(SessionFiles, RefinementBeginsAgainAfterAnotherSessionDrew) {
    Session session = small_session();
    session.settings().image.samples = 4;
    const Image expected = session.render();
    Session other = session.beside();
    other.settings().background.color = Vec3(0, 0, 1);
    EXPECT_TRUE(session.refine().began);
    EXPECT_FALSE(session.refine().began);
    other.refine();
    EXPECT_TRUE(session.refine().began);
    other.pick_buffer();
    EXPECT_TRUE(session.refine().began);
    Session::Refinement done;
    do done = session.refine();
    while (done.frames < done.total);
    EXPECT_EQ(compare(expected, done.drawn.picture()).different, 0u);
    EXPECT_FALSE(session.refine().drew);  // It is complete.
    other.pick_buffer();
    EXPECT_FALSE(session.refine().drew);  // Surfaces leave the picture.
    other.render();
    EXPECT_TRUE(session.refine().began);
}

// An edit while a picture is drawn: the picture is that of before or after, never a mixture or a crash.
TEST_F(SessionFiles, EditsWhileDrawing) {
    Session session = small_session();
    Mesh mesh = session.scene().get("sphere");
    std::thread editor([&] {
        for (int i = 0; i < 50; ++i) mesh.set_V(Array3f(Array3f::Dense(mesh.V() * (i % 2 ? 2.0f : 0.5f))));
    });
    for (int i = 0; i < 10; ++i) session.render();
    editor.join();
    EXPECT_NO_THROW(session.render());
}

}  // namespace
}  // namespace easypbr::app::session_test
