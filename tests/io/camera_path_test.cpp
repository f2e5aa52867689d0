#include "easypbr/io/settings/camera_path_io.h"

#include <gtest/gtest.h>

#include <fstream>

#include "easypbr/core/error.h"
#include "io/temporary_folder.h"
#include "refusal.h"

namespace easypbr::io::camera_path_test {
namespace {

CameraKey key_at(double x, double angle, double segment_s) {
    CameraKey key;
    key.T_world_cam.translation() = Vec3d(x, 0.1, -1.0 / 3);
    key.T_world_cam.linear() = Eigen::AngleAxisd(angle, Vec3d(1, 2, 2) / 3).toRotationMatrix();
    key.segment_s = segment_s;
    return key;
}

TEST(CameraPathFile, ComesBackToTheBit) {
    const TemporaryFolder folder;
    std::vector<CameraKey> keys{key_at(0, 0.1, 0.7), key_at(1, 1.1, 1.0 / 3), key_at(2, -2.1, 5)};
    for (CameraKey& key : keys) key.fov_y_deg = 20 + key.T_world_cam.translation().x() / 3;
    const CameraPath path(keys, {PathMode::linear, PathEase::in_out, true});
    save_camera_path(path, folder / "path.json");
    const CameraPath read = load_camera_path(folder / "path.json");
    EXPECT_EQ(read.duration_s(), path.duration_s());
    EXPECT_EQ(read.options().mode, PathMode::linear);
    EXPECT_EQ(read.options().ease, PathEase::in_out);
    EXPECT_TRUE(read.is_closed());
    for (const double t : path.times(7)) {
        // A rotation is brought to unit length once more when it is read.
        EXPECT_LT((read.pose(t).matrix() - path.pose(t).matrix()).cwiseAbs().maxCoeff(), 1e-15);
        EXPECT_EQ(read.fov_y_deg(t), path.fov_y_deg(t));
    }
    EXPECT_EQ(to_json(read), to_json(load_camera_path(folder / "path.json")));
}

TEST(CameraPathFile, HoldsOrbits) {
    const Camera start = Camera::look_at(Vec3d(1, 2, 3), Vec3d(0, 0.5, 0));
    const CameraPath orbit =
        CameraPath::orbit(start, Vec3d(0, 0.5, 0), Vec3d(0, 1, 1), -120, 2.5, PathEase::out);
    const CameraPath read = parse_camera_path(to_json(orbit), "text");
    EXPECT_FALSE(read.is_closed());
    for (const double t : orbit.times(5))
        EXPECT_LT((read.pose(t).matrix() - orbit.pose(t).matrix()).cwiseAbs().maxCoeff(), 1e-15);
}

TEST(CameraPathFile, HoldsTheHeightOfOrthographicOrbits) {
    Camera start = Camera::look_at(Vec3d(1, 2, 3), Vec3d(0, 0.5, 0)), like = start;
    start.projection = like.projection = Projection::orthographic;
    start.ortho_height = 7.5;
    const CameraPath orbit = CameraPath::orbit(start, Vec3d::Zero());
    const std::string text = to_json(orbit);
    EXPECT_EQ(orbit.camera(0.5, like).ortho_height, 7.5);
    EXPECT_EQ(parse_camera_path(text, "text").camera(0.5, like).ortho_height, 7.5);
    std::string flat = text;
    flat.replace(flat.find("7.5"), 3, "0.0");
    EXPECT_EQ(refusal<FormatError>([&] { parse_camera_path(flat, "text"); }),
              "text: orbit: expected an ortho_height above 0");
    like.projection = Projection::perspective;
    EXPECT_EQ(orbit.camera(0.5, like).ortho_height, like.ortho_height);
}

TEST(CameraPathFile, TakesMatricesInBothAxesAndTargets) {
    const CameraPath plain = parse_camera_path(
        "[[[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]], [1,0,0,4, 0,1,0,0, 0,0,1,0, 0,0,0,1]]", "text");
    EXPECT_EQ(plain.pose(1).translation(), Vec3d(4, 0, 0));
    // OpenCV's camera looks along +z with y down; ours along -z with y up.
    const CameraPath opencv = parse_camera_path(
        R"({"axes": "opencv", "segment_s": 2, "keys": [[1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1],
            {"T_world_cam": [1,0,0,4, 0,1,0,0, 0,0,1,0, 0,0,0,1]}]})",
        "text");
    EXPECT_EQ(opencv.duration_s(), 2);
    EXPECT_EQ(Vec3d(-opencv.pose(0).linear().col(2)), Vec3d(0, 0, 1));
    EXPECT_EQ(Vec3d(opencv.pose(0).linear().col(1)), Vec3d(0, -1, 0));
    const CameraPath looking = parse_camera_path(
        R"([{"position": [0,0,5], "target": [0,0,0], "segment_s": 3}, {"position": [5,0,0], "target": [0,0,0]}])",
        "text");
    EXPECT_EQ(looking.duration_s(), 3);
    EXPECT_LT((-looking.pose(3).linear().col(2) - Vec3d(-1, 0, 0)).norm(), 1e-15);
}

std::string error_of(const std::string& text) {
    try {
        parse_camera_path(text, "path.json");
    } catch (const FormatError& error) {
        return error.what();
    }
    return "no error";
}

TEST(CameraPathFile, SaysWhatIsWrong) {
    const std::string pose = "[1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]";
    EXPECT_EQ(error_of("{").find("cannot read path.json, line 1, column 2: "), 0);
    EXPECT_EQ(error_of("[]"), "path.json: camera path: expected at least two keys, got 0");
    EXPECT_EQ(error_of("[" + pose + "]"), "path.json: camera path: expected at least two keys, got 1");
    EXPECT_EQ(error_of("{}"), "path.json: expected a list of keys");
    EXPECT_EQ(error_of("3"), "path.json: expected an object or a list of keys");
    EXPECT_EQ(error_of("[" + pose + ", [1, 2]]"),
              "path.json: key 1: expected the 16 numbers of a 4 x 4 matrix T_world_cam");
    EXPECT_EQ(error_of("[" + pose + ", {\"position\": [0,0,1]}]"),
              "path.json: key 1: expected T_world_cam, or position and target");
    EXPECT_NE(error_of(R"({"key": []})").find("(did you mean 'keys'?)"), std::string::npos);
    EXPECT_EQ(error_of(R"({"mode": "cubic", "keys": []})"),
              "path.json: mode: expected smooth or linear, got 'cubic'");
    EXPECT_EQ(error_of(R"({"segment_s": 0, "keys": [)" + pose + "," + pose + "]}"),
              "path.json: camera path: expected a time above 0 seconds from key 0 to the next, got 0");
    EXPECT_NE(error_of("[" + pose + ", [2,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]]")
                  .find("key 1: camera pose: expected a rotation"),
              std::string::npos);
    EXPECT_EQ(error_of(R"({"easypbr_camera_path": 2, "keys": []})"), "path.json: expected version 1, got 2");
    EXPECT_THROW(load_camera_path("/nowhere/path.json"), FileError);
}

}  // namespace
}  // namespace easypbr::io::camera_path_test
