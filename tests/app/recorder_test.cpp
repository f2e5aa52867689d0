#include "easypbr/app/recorder.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <regex>
#include <stdexcept>

#include "easypbr/app/frame_queue.h"
#include "easypbr/app/recording_target.h"
#include "easypbr/app/session.h"
#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "easypbr/core/log.h"
#include "easypbr/geometry/primitives.h"
#include "easypbr/io/image/image_io.h"
#include "easypbr/io/video/video.h"
#include "easypbr/scene/settings.h"
#include "file_limit.h"
#include "io/temporary_folder.h"

namespace easypbr::app::recorder_test {
namespace {

namespace fs = std::filesystem;

/// Notes what it is given; fails at one index.
struct NotingWriter : FrameWriter {
    struct Notes {
        std::vector<int> indices;
        int most_waiting = 0;
        bool finished = false;
    };
    NotingWriter(Notes& notes, int bad_index = -1) : notes_(notes), bad_index_(bad_index) {}
    void write(int index, const Image& picture) override {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        if (index == bad_index_) throw FileError("the disk is full");
        EXPECT_EQ(int(*picture.at<uint8_t>(0, 0)), index % 256);
        notes_.indices.push_back(index);
    }
    void finish() override { notes_.finished = true; }
    Notes& notes_;
    int bad_index_;
};

Image picture_of(int value) {
    Image image(2, 2, 4, PixelType::u8);
    *image.at<uint8_t>(0, 0) = uint8_t(value);
    return image;
}

TEST(FrameQueue, WritesAllInOrder) {
    NotingWriter::Notes notes;
    FrameQueue queue(std::make_unique<NotingWriter>(notes));
    for (int i = 0; i < 300; ++i) queue.push(picture_of(i));
    queue.finish();
    ASSERT_EQ(notes.indices.size(), 300u);
    for (int i = 0; i < 300; ++i) EXPECT_EQ(notes.indices[size_t(i)], i);
    EXPECT_TRUE(notes.finished);
}

TEST(FrameQueue, IsFinishedByItsEnd) {
    NotingWriter::Notes notes;
    {
        FrameQueue queue(std::make_unique<NotingWriter>(notes));
        for (int i = 0; i < 20; ++i) queue.push(picture_of(i));
    }
    EXPECT_EQ(notes.indices.size(), 20u);
    EXPECT_TRUE(notes.finished);
}

TEST(FrameQueue, PassesFailuresOnAndKeepsWhatCameBefore) {
    NotingWriter::Notes notes;
    FrameQueue queue(std::make_unique<NotingWriter>(notes, 5));
    EXPECT_THROW(
        {
            for (int i = 0; i < 1000; ++i) queue.push(picture_of(i));
        },
        FileError);
    EXPECT_THROW(queue.finish(), FileError);
    EXPECT_EQ(notes.indices.size(), 5u);
    EXPECT_TRUE(notes.finished);
}

TEST(RecordingTarget, NumbersPictures) {
    EXPECT_EQ(frame_path("out/frame_%04d.png", 7), fs::path("out/frame_0007.png"));
    EXPECT_EQ(frame_path("out/%d.exr", 12345), fs::path("out/12345.exr"));
    EXPECT_EQ(frame_path("out/", 3), fs::path("out/frame_00003.png"));
    EXPECT_EQ(frame_path("out", 3), fs::path("out/frame_00003.png"));
    EXPECT_THROW(frame_path("out/frame.png", 0), ArgumentError);
    EXPECT_THROW(frame_path("out/%d_%d.png", 0), ArgumentError);
    EXPECT_THROW(frame_path("out/%s.png", 0), ArgumentError);
}

class Recordings : public testing::Test {
  protected:
    Recordings() {
        scene_.show(make_sphere(1, 16), "sphere");
        session_.settings().image.size = Vec2i(48, 32);
        session_.settings().image.samples = 1;
    }

    std::string error_of(const fs::path& path, const RecordingOptions& options = {}) {
        try {
            recorder_.start(path, options);
        } catch (const std::exception& error) {
            return error.what();
        }
        recorder_.stop();
        return "no error";
    }

    TemporaryFolder folder_;
    Scene scene_;
    Session session_{scene_};
    Clock clock_;
    Recorder recorder_{session_, clock_};
};

TEST_F(Recordings, FramesAreTheStills) {
    const Camera start = session_.camera();
    const CameraPath path = CameraPath::orbit(start, Vec3d::Zero());
    EXPECT_EQ(recorder_.record_path(path, folder_ / "f_%02d.png", {}, 5), 5);
    // The camera is what it was.
    EXPECT_TRUE(session_.camera().T_world_cam.isApprox(start.T_world_cam, 1e-15));
    EXPECT_FALSE(recorder_.is_recording());
    for (int i = 0; i < 5; ++i) {
        session_.set_camera(path.camera(path.times(5)[size_t(i)], start));
        const Image still = session_.render();
        const Image frame = io::load_image(frame_path(folder_ / "f_%02d.png", i));
        EXPECT_TRUE(std::ranges::equal(frame.bytes(), still.bytes())) << "frame " << i;
    }
    EXPECT_FALSE(fs::exists(folder_ / "f_05.png"));
}

// Whatever was drawn before: the camera of a closed path comes from the frame that would be before the first,
// on an open one it rests.
TEST_F(Recordings, TheFirstFrameIsBlurredLikeTheOthers) {
    session_.settings().motion_blur.enabled = true;
    session_.settings().image.samples = 8;
    const Camera start = session_.camera();
    Camera elsewhere = start;
    elsewhere.T_world_cam.translation() += Vec3d(0.5, 0, 0);
    const auto first_frame = [&](const CameraPath& path) {
        session_.set_camera(elsewhere);
        session_.render();
        session_.set_camera(start);
        recorder_.record_path(path, folder_ / "b_%d.png", {}, 6);
        return io::load_image(folder_ / "b_0.png");
    };
    const auto still_after = [&](const Camera& before) {
        session_.set_camera(before);
        session_.render();
        session_.set_camera(start);
        return session_.render();
    };
    const auto same = [](const Image& a, const Image& b) { return std::ranges::equal(a.bytes(), b.bytes()); };
    const Mesh box = make_box();  // A ball looks the same from everywhere.
    scene_.show(box, "sphere");
    const CameraPath closed = CameraPath::orbit(start, Vec3d::Zero());
    const CameraPath open = CameraPath::orbit(start, Vec3d::Zero(), Vec3d::UnitY(), 90);
    const Image sharp = still_after(start), blurred = still_after(closed.camera(closed.times(6)[5], start));
    EXPECT_FALSE(same(sharp, blurred));
    EXPECT_TRUE(same(first_frame(closed), blurred));
    EXPECT_TRUE(same(first_frame(open), sharp));
}

// What is drawn for a lens is wider than the picture: that is no motion.
TEST_F(Recordings, ARestingPathThroughALensIsSharp) {
    Camera camera = Camera::look_at(Vec3d(2, 1.5, 3), Vec3d(0, 0, 0));
    camera.intrinsics = Intrinsics{45, 45, 23.5, 15.5, 48, 32};
    camera.distortion = Distortion::from_coefficients(DistortionModel::brown_conrady, {-0.3, 0.1, 0, 0});
    scene_.show(make_box(), "sphere");
    session_.settings().image.samples = 4;
    session_.set_camera(camera);
    const Image sharp = session_.render();
    session_.settings().motion_blur.enabled = true;
    recorder_.record_path(CameraPath({CameraKey::at(camera), CameraKey::at(camera)}), folder_ / "l_%d.png",
                          {}, 2);
    for (int i = 0; i < 2; ++i) {
        const Image frame = io::load_image(frame_path(folder_ / "l_%d.png", i));
        // A step of 8 bits: a pose that is mixed with itself differs in the last bit.
        EXPECT_TRUE(std::ranges::equal(frame.bytes(), sharp.bytes(),
                                       [](std::byte a, std::byte b) {
                                           return std::abs(std::to_integer<int>(a) -
                                                           std::to_integer<int>(b)) <= 1;
                                       }))
            << "frame " << i;
    }
}

TEST_F(Recordings, TheClockMakesStepsOfAFrame) {
    recorder_.start(folder_ / "a", {.fps = 10});
    EXPECT_TRUE(recorder_.is_recording());
    for (int i = 0; i < 3; ++i) {
        EXPECT_EQ(clock_.time(), 0.1 * i);
        recorder_.add_frame();
    }
    EXPECT_EQ(clock_.delta_time(), 0.1);
    EXPECT_EQ(recorder_.frame_count(), 3);
    EXPECT_EQ(recorder_.stop(), 3);
    EXPECT_EQ(recorder_.stop(), 0);
    EXPECT_FALSE(clock_.fixed_step());
    EXPECT_TRUE(fs::exists(folder_ / "a/frame_00002.png"));
    EXPECT_THROW(recorder_.add_frame(), ArgumentError);
}

// After a recording of two frames the next frame is at 0.2 s, whether it is recorded or not.
TEST_F(Recordings, GoOnWithTheClocksOwnStep) {
    clock_.set_fixed_step(0.5);
    clock_.tick();
    recorder_.start(folder_ / "a", {.fps = 10});
    EXPECT_EQ(clock_.time(), 0);
    EXPECT_EQ(clock_.delta_time(), 0);
    recorder_.add_frame();
    recorder_.add_frame();
    EXPECT_EQ(recorder_.stop(), 2);
    EXPECT_EQ(clock_.fixed_step(), 0.5);
    clock_.tick();
    EXPECT_EQ(clock_.time(), 0.2);
    clock_.tick();
    EXPECT_EQ(clock_.time(), 0.7);
    recorder_.start(folder_ / "b", {.fps = 10});
    clock_.set_time(5);
    recorder_.add_frame();
    EXPECT_EQ(clock_.time(), 5.1) << "the frame at 5 s was recorded";
    EXPECT_EQ(recorder_.stop(), 1);
}

TEST_F(Recordings, WithoutFramesLeaveNoFile) {
    fs::create_directory(folder_ / "old");
    write_file(folder_ / "old/notes.txt", std::string_view("kept"));
    for (const char* name : {"a.mp4", "a.mov", "a.mkv", "a.webm", "a.gif", "a_%d.png", "new/", "old/"}) {
        std::vector<std::string> warnings;
        recorder_.start(folder_ / name);
        set_log_sink([&](LogLevel, std::string_view message) { warnings.emplace_back(message); });
        EXPECT_EQ(recorder_.stop(), 0) << name;
        set_log_sink({});
        ASSERT_EQ(warnings.size(), 1u) << name;
        EXPECT_NE(warnings[0].find("no frame was added"), std::string::npos) << warnings[0];
    }
    std::vector<std::string> left;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder_.path()))
        left.push_back(entry.path().filename().string());
    std::ranges::sort(left);
    EXPECT_EQ(left, (std::vector<std::string>{"notes.txt", "old"}));
    EXPECT_FALSE(clock_.fixed_step());
}

TEST_F(Recordings, AreFinishedByTheRecordersEndAndByExceptions) {
    {
        Recorder passing(session_, clock_);
        passing.start(folder_ / "video.mp4");
        for (int i = 0; i < 4; ++i) passing.add_frame();
        EXPECT_THROW(passing.start(folder_ / "other.mp4"), ArgumentError);
        EXPECT_THROW(passing.add_frame(picture_of(1)), ArgumentError) << "another size";
    }
    EXPECT_GT(fs::file_size(folder_ / "video.mp4"), 500u);
    const CameraPath path = CameraPath::orbit(session_.camera(), Vec3d::Zero());
    const auto fail = [](int frame, int, double) {
        if (frame == 3) throw std::runtime_error("no more");
    };
    EXPECT_THROW(recorder_.record_path(path, folder_ / "g_%d.png", {}, 9, fail), std::runtime_error);
    EXPECT_TRUE(fs::exists(folder_ / "g_2.png"));
    EXPECT_FALSE(fs::exists(folder_ / "g_3.png"));
    EXPECT_FALSE(recorder_.is_recording());
    EXPECT_FALSE(clock_.fixed_step());
}

// Linear floats are written as sRGB: 0.2158605 is ((128 / 255 + 0.055) / 1.055)^2.4.
TEST_F(Recordings, TakeFloatsForVideosAsForPictures) {
    Image linear(48, 32, 3, PixelType::f32), bytes(48, 32, 3, PixelType::u8);
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 48; ++x)
            for (int c = 0; c < 3; ++c) {
                linear.at<float>(x, y)[c] = 0.2158605f;
                bytes.at<uint8_t>(x, y)[c] = 128;
            }
    for (const auto& [name, picture] : {std::pair("floats.gif", &linear), std::pair("bytes.gif", &bytes)}) {
        recorder_.start(folder_ / name);
        for (int i = 0; i < 2; ++i) recorder_.add_frame(*picture);
        EXPECT_EQ(recorder_.stop(), 2);
    }
    const FileBytes a(folder_ / "floats.gif"), b(folder_ / "bytes.gif");
    EXPECT_EQ(a.text(), b.text());
}

TEST_F(Recordings, SayWhatCannotBeRecorded) {
    EXPECT_NE(
        error_of(folder_ / "one.png").find("one picture cannot hold many frames; expected a video (gif"),
        std::string::npos);
    EXPECT_NE(error_of(folder_ / "a.avi").find("unknown extension 'avi'"), std::string::npos);
    EXPECT_NE(error_of("/nowhere/at/all/a.mp4").find("/nowhere/at/all"), std::string::npos);
    EXPECT_NE(error_of("/nowhere/at/all/%d.png").find("/nowhere/at/all"), std::string::npos);
    EXPECT_NE(error_of(folder_ / "a.mp4", {.fps = 0}).find("above 0 frames per second, got 0"),
              std::string::npos);
    EXPECT_NE(error_of(folder_ / "a.gif", {.fps = 60}).find("at most 50 frames per second"),
              std::string::npos);
    const std::string codec = error_of(folder_ / "a.mp4", {.codec = "betamax"});
    EXPECT_NE(codec.find("no encoder 'betamax' for it; it has "), std::string::npos) << codec;
    EXPECT_NE(codec.find("libx264"), std::string::npos) << codec;
    EXPECT_NE(error_of(folder_ / "%d.png", {.codec = "libx264"}).find("pictures have no codec"),
              std::string::npos);
    for (const char* name : {"a.mp4", "%d.jpg", "%d.exr"})
        EXPECT_NE(error_of(folder_ / name, {.deep = true}).find("16 bits per channel need"),
                  std::string::npos)
            << name;
    EXPECT_NE(error_of(folder_ / "%d.jpg", {.size = Vec2i(65536, 1)}).find("65536x1 pixels"),
              std::string::npos);
    session_.settings().background.mode = BackgroundMode::transparent;
    EXPECT_NE(error_of(folder_ / "a.mp4").find("no transparency"), std::string::npos);
    EXPECT_NE(error_of(folder_ / "%d.jpg").find("no transparency"), std::string::npos);
    EXPECT_NE(error_of(folder_ / "%d.hdr").find("no transparency"), std::string::npos);
    EXPECT_EQ(error_of(folder_ / "%d.png"), "no error");
    EXPECT_FALSE(fs::exists(folder_ / "a.mp4"));
}

// /dev/full takes a file's name and no byte: what a full disk does.
TEST_F(Recordings, AFullDiskIsAnError) {
    for (const char* name : {"full.mp4", "full.webm", "full.gif"}) {
        fs::create_symlink("/dev/full", folder_ / name);
        EXPECT_THROW(
            {
                recorder_.start(folder_ / name);
                for (int i = 0; i < 100; ++i) recorder_.add_frame();
                recorder_.stop();
            },
            FileError)
            << name;
        EXPECT_FALSE(recorder_.is_recording());
        EXPECT_TRUE(fs::is_symlink(folder_ / name)) << "only what is a file is removed";
    }
}

TEST_F(Recordings, LeaveNoHalfVideo) {
    for (const char* name : {"a.mp4", "a.mov", "a.mkv", "a.webm", "a.gif"}) {
        recorder_.start(folder_ / name);
        recorder_.add_frame();
        const FileLimit full(200);
        EXPECT_THROW(
            {
                for (int i = 0; i < 100; ++i) recorder_.add_frame();
                recorder_.stop();
            },
            FileError)
            << name;
        EXPECT_TRUE(fs::is_empty(folder_.path())) << name;
    }
}

// What was recorded before stays until a new recording is whole.
TEST_F(Recordings, ReplaceAVideoWhenTheyAreWhole) {
    for (const char* name : {"a.mp4", "a.mkv", "a.webm", "a.gif"}) {
        const fs::path file = folder_ / name;
        const fs::path part = folder_ / (std::string("a.part") + fs::path(name).extension().string());
        const auto text = [&] { return std::string(FileBytes(file).text()); };
        write_file(file, std::string_view("the old one"));
        recorder_.start(file);
        recorder_.stop();
        EXPECT_EQ(text(), "the old one") << "no frame: " << name;
        recorder_.start(file);
        recorder_.add_frame();
        EXPECT_TRUE(fs::exists(part)) << name;
        {
            const FileLimit full(200);
            EXPECT_THROW(
                {
                    for (int i = 0; i < 100; ++i) recorder_.add_frame();
                    recorder_.stop();
                },
                FileError)
                << name;
        }
        EXPECT_EQ(text(), "the old one") << "a full disk: " << name;
        EXPECT_FALSE(fs::exists(part)) << name;
        const fs::path link = folder_ / (std::string("link") + file.extension().string());
        fs::create_symlink(file, link);
        recorder_.start(link);
        for (int i = 0; i < 3; ++i) recorder_.add_frame();
        EXPECT_EQ(recorder_.stop(), 3);
        EXPECT_GT(fs::file_size(file), 100u) << name;
        EXPECT_TRUE(fs::is_symlink(link));
        EXPECT_FALSE(fs::exists(part)) << name;
    }
}

TEST_F(Recordings, ReportTheTimeLeft) {
    std::vector<std::string> said;
    set_progress_sink([&](std::string_view what, double part) {
        said.push_back(std::string(what) + (part >= 1 ? "!" : ""));
    });
    const CameraPath path = CameraPath::orbit(session_.camera(), Vec3d::Zero());
    const auto slowly = [](int, int, double) { std::this_thread::sleep_for(std::chrono::milliseconds(110)); };
    recorder_.record_path(path, folder_ / "%d.png", {}, 4, slowly);
    set_progress_sink({});
    ASSERT_GE(said.size(), 2u);
    // How long a frame takes depends on the machine.
    EXPECT_TRUE(std::regex_match(said.front(), std::regex("%d.png: frame [1-3] of 4, 0:[0-9]{2} left")))
        << said.front();
    EXPECT_EQ(said.back(), "%d.png!");
}

}  // namespace
}  // namespace easypbr::app::recorder_test
