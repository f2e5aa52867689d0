// The inferred up axis: of content that stands on something level, of formats that define it, else +y.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "easypbr/core/error.h"
#include "easypbr/geometry/primitives.h"
#include "easypbr/scene/fields.h"
#include "easypbr/scene/resolve.h"
#include "point_mesh.h"

namespace easypbr::up_test {

namespace {

const Vec2i size(64, 48);

/// The up axis of one mesh, shown as it is.
std::string up_of(const Mesh& mesh, const Settings& settings = {}) {
    Scene scene;
    scene.show(mesh, "mesh");
    return resolve(scene.snapshot(), settings, size).settings.camera.up;
}

/// Points of rectangles: corner, two edges.
struct Rectangles {
    std::mt19937 random{3};
    std::vector<Vec3d> points;

    void add(const Vec3d& corner, const Vec3d& u, const Vec3d& v) {
        std::uniform_real_distribution<double> part(0, 1);
        const int count = int(1200 * u.cross(v).norm());
        for (int i = 0; i < count; ++i) points.push_back(corner + part(random) * u + part(random) * v);
    }
    /// As a cloud, turned by R.
    Mesh turned(const Mat3d& R) const {
        Array3f::Dense V(Eigen::Index(points.size()), 3);
        for (size_t i = 0; i < points.size(); ++i)
            V.row(Eigen::Index(i)) = (R * points[i]).cast<float>().transpose();
        return cloud(V);
    }
};

/// A room of 6 by 4 by 2.5 metres with a table, z up, whose walls face no axis.
Rectangles room() {
    Rectangles room;
    const Mat3d R = Eigen::AngleAxisd(0.5, Vec3d::UnitZ()).toRotationMatrix();
    const Vec3d u = R * Vec3d(6, 0, 0), v = R * Vec3d(0, 4, 0), h(0, 0, 2.5);
    room.add(Vec3d::Zero(), u, v);
    room.add(Vec3d::Zero(), u, h);
    room.add(Vec3d::Zero(), v, h);
    room.add(R * Vec3d(2, 1, 0.8), R * Vec3d(2, 0, 0), R * Vec3d(0, 1, 0));
    return room;
}

/// Turns +z into an axis.
Mat3d from_z(const std::string& axis) {
    return Eigen::Quaterniond::FromTwoVectors(Vec3d::UnitZ(), parse_up(axis)).toRotationMatrix();
}

Mesh terrain(const Mat3d& R) {
    Rectangles hills;
    hills.add(Vec3d(-3, -3, 0), Vec3d(6, 0, 0), Vec3d(0, 6, 0));
    for (Vec3d& point : hills.points) point.z() = 0.25 * std::sin(point.x()) * std::cos(point.y());
    return hills.turned(R);
}

/// A cone that stands on its base, z up.
Mesh standing(const std::string& axis) {
    Mesh mesh = make_cone(1, 3, 64);
    mesh.set_V(Array3f::Dense(mesh.V() * Eigen::Quaterniond::FromTwoVectors(Vec3d::UnitY(), parse_up(axis))
                                             .toRotationMatrix()
                                             .cast<float>()
                                             .transpose()));
    mesh.set_N({});
    return mesh;
}

Mesh with_up(Mesh mesh, const Vec3d& up) {
    mesh.edit([&](MeshData& data) { data.up = up; });
    return mesh;
}

}  // namespace

TEST(Up, OfARoomIsTheNormalOfItsFloor) {
    const Rectangles walls = room();
    for (const char* up : {"+z", "-z", "+y", "-y", "+x"}) EXPECT_EQ(up_of(walls.turned(from_z(up))), up);
}

TEST(Up, OfTerrainIsTheAxisThatItIsThinAlong) {
    EXPECT_EQ(up_of(terrain(Mat3d::Identity())), "+z");
    EXPECT_EQ(up_of(terrain(from_z("+y"))), "+y");
    EXPECT_EQ(up_of(terrain(from_z("+x"))), "+y") << "as a wall";
}

namespace {

/// z = f(x, y) over [-1, 1]^2 as a mesh of quads, but those of which a corner is not a number.
template <class Height>
Mesh height_field(Height&& f, int n = 80) {
    Array3f::Dense V(n * n, 3);
    std::vector<std::array<int, 3>> faces;
    for (int i = 0; i < n * n; ++i) {
        const float x = float(i % n) * 2 / float(n - 1) - 1, y = float(i / n) * 2 / float(n - 1) - 1;
        V.row(i) << x, y, f(x, y);
    }
    for (int i = 0; i < n * (n - 1); ++i)
        if (i % n + 1 < n && std::isfinite(V(i, 2) + V(i + 1, 2) + V(i + n, 2) + V(i + n + 1, 2))) {
            faces.push_back({i, i + 1, i + n + 1});
            faces.push_back({i, i + n + 1, i + n});
        }
    V = V.array().isNaN().select(0.0f, V);
    Array3i::Dense F(Eigen::Index(faces.size()), 3);
    for (size_t i = 0; i < faces.size(); ++i) F.row(Eigen::Index(i)) << faces[i][0], faces[i][1], faces[i][2];
    return Mesh(Array3f(V), Array3i(F));
}

Mesh y_up(const Mesh& mesh) {
    Array3f::Dense V = mesh.V();
    V.col(1).swap(V.col(2));
    return Mesh(Array3f(V), mesh.F());
}

}  // namespace

TEST(Up, OfAHeightFieldIsZ) {
    const auto waves = [](float x, float y) { return 0.3f * std::sin(3 * x) * std::cos(2 * y); };
    const auto gentle = [](float x, float y) { return 0.05f * std::sin(3 * x) * std::cos(2 * y); };
    const auto peak = [](float x, float y) { return std::exp(-4 * (x * x + y * y)); };
    for (const Mesh& mesh : {height_field(waves), height_field(gentle), height_field(peak)}) {
        EXPECT_EQ(up_of(mesh), "+z");
        EXPECT_EQ(up_of(cloud(mesh.V())), "+z");
        EXPECT_EQ(up_of(y_up(mesh)), "+y");
        EXPECT_EQ(up_of(cloud(y_up(mesh).V())), "+y");
    }
}

namespace {

/// The corners of the faces as a cloud.
Mesh corners_of(const Mesh& mesh) {
    std::vector<bool> used(size_t(mesh.V().rows()));
    for (Eigen::Index i = 0; i < mesh.F().size(); ++i) used[size_t(mesh.F()(i / 3, i % 3))] = true;
    Array3f::Dense V(Eigen::Index(std::ranges::count(used, true)), 3);
    Eigen::Index row = 0;
    for (size_t i = 0; i < used.size(); ++i)
        if (used[i]) V.row(row++) = mesh.V().row(Eigen::Index(i));
    return cloud(V);
}

/// Each vertex at what `place` makes of it.
template <class Place>
Mesh placed(const Mesh& mesh, Place&& place) {
    Array3f::Dense V = mesh.V();
    for (auto row : V.rowwise()) row = place(Vec3(row.transpose())).transpose().eval();
    return Mesh(Array3f(V), mesh.F());
}

Mesh scaled(const Mesh& mesh, const Vec3& factors) {
    return placed(mesh, [&](const Vec3& p) { return Vec3(p.cwiseProduct(factors)); });
}

/// As MATLAB has it, over [-3, 3]^2 there.
float peaks(float u, float v) {
    const float x = 3 * u, y = 3 * v;
    return 3 * (1 - x) * (1 - x) * std::exp(-x * x - (y + 1) * (y + 1)) -
           10 * (x / 5 - x * x * x - std::pow(y, 5.0f)) * std::exp(-x * x - y * y) -
           std::exp(-(x + 1) * (x + 1) - y * y) / 3;
}

float sinc(float x, float y) {
    const float r = 4 * float(pi) * std::hypot(x, y);
    return r > 0 ? std::sin(r) / r : 1;
}

float waves_along_x(float x, float) {
    return 0.3f * std::sin(4 * x);
}

float slope(float x, float) {
    return std::exp(x);
}

}  // namespace

TEST(Up, OfAHeightFieldIsZAtAnyScale) {
    for (const int n : {10, 100})
        for (auto* f : {peaks, sinc, waves_along_x, slope})
            for (const Vec3& factors :
                 {Vec3(1, 1, 1), Vec3(3, 3, 1), Vec3(1, 1, 2000), Vec3(5000, 9000, 20)}) {
                const Mesh mesh = scaled(height_field(f, n), factors);
                EXPECT_EQ(up_of(mesh), "+z") << n << ", " << factors.transpose();
                EXPECT_EQ(up_of(cloud(mesh.V())), "+z") << n << ", " << factors.transpose();
                EXPECT_EQ(up_of(y_up(mesh)), "+y") << n << ", " << factors.transpose();
                EXPECT_EQ(up_of(cloud(y_up(mesh).V())), "+y") << n << ", " << factors.transpose();
            }
}

TEST(Up, OfAHeightFieldIsZWithHoles) {
    for (const int n : {10, 100}) {
        std::mt19937 random(1);
        const Mesh mesh = height_field(
            [&](float x, float y) { return random() % 20 == 0 ? std::nanf("") : peaks(x, y); }, n);
        EXPECT_EQ(up_of(mesh), "+z") << n;
        EXPECT_EQ(up_of(corners_of(mesh)), "+z") << n;
    }
}

TEST(Up, OfAHeightFieldIsZFarFromZero) {
    Mesh mesh = scaled(height_field(peaks), {5000, 5000, 20});
    mesh.edit([](MeshData& data) { data.offset = {691'000, 5'335'000, 520}; });
    EXPECT_EQ(up_of(mesh), "+z");
}

// 90,000 points and 178,802 faces: more than are judged.
TEST(Up, OfALargeHeightFieldIsZ) {
    const Mesh mesh = height_field(peaks, 300);
    EXPECT_EQ(up_of(mesh), "+z");
    EXPECT_EQ(up_of(cloud(mesh.V())), "+z");
    std::mt19937 random(1);
    const Mesh noise = height_field([&](float, float) { return float(random() % 1024) / 1024; }, 300);
    EXPECT_EQ(up_of(cloud(noise.V())), "+z");
}

TEST(Up, OfAHeightFieldIsZWithoutAGrid) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> part(-0.2f, 0.2f);  // of 2 / 79 from one to the next: no face turns
    const auto moved = [&](float at) { return std::abs(at) < 0.999f ? at + part(random) * 2 / 79 : at; };
    const Mesh mesh = placed(height_field(peaks), [&](const Vec3& p) {
        const float x = moved(p.x()), y = moved(p.y());
        return Vec3(x, y, peaks(x, y));
    });
    EXPECT_EQ(up_of(mesh), "+z");
    EXPECT_EQ(up_of(y_up(mesh)), "+y");
}

TEST(Up, OfAHeightFieldIsZWhateverTheWindings) {
    const Mesh mesh = height_field(peaks);
    Array3i::Dense F = mesh.F();
    for (Eigen::Index i = 0; i < F.rows(); i += 2) std::swap(F(i, 1), F(i, 2));
    EXPECT_EQ(up_of(Mesh(mesh.V(), Array3i(F))), "+z");
}

TEST(Up, OfWhatOnlyResemblesAHeightFieldIsY) {
    const float none = std::nanf("");
    const Mesh mask = height_field([&](float x, float y) { return x * x + y * y < 1 ? peaks(x, y) : none; });
    EXPECT_EQ(up_of(mask), "+y") << "round, as a scan of a face";
    EXPECT_EQ(up_of(corners_of(mask)), "+y");
    const Mesh chin =
        height_field([&](float x, float y) { return x * x + y * y < 1 && y > -0.6f ? peaks(x, y) : none; });
    EXPECT_EQ(up_of(chin), "+y") << "round on three sides";
    const Mesh screen = placed(height_field(peaks), [](const Vec3& p) {
        const float angle = float(pi) / 2 * p.x();
        return Vec3(std::sin(angle), p.y(), std::cos(angle));
    });
    EXPECT_EQ(up_of(screen), "+y") << "curved along x alone, on no grid of x and y";
    // The upper and lower border, 0.4 d from the middle, with d from 2.8 to 3.2, are not straight.
    const Mesh seen = placed(height_field(peaks), [](const Vec3& p) {
        const float ball = std::hypot(p.x(), p.y()) < 0.4f ? 1.0f : 0.0f;
        const float depth = 3 + 0.2f * std::sin(3.5f * p.x()) - ball;
        return Vec3(0.5f * p.x() * depth, 0.4f * p.y() * depth, -depth);
    });
    EXPECT_EQ(up_of(seen), "+y") << "a depth image";
    Mesh told = height_field(peaks);
    told.edit([](MeshData& data) { data.front = Vec3d::UnitZ(); });
    EXPECT_EQ(up_of(told), "+y") << "a depth image, as its file says";
    const Mesh above = height_field([](float x, float y) { return 0.3f * peaks(x, y); });
    const Mesh below = height_field([](float x, float y) { return 0.3f * peaks(x, y) - 1 - x * x; });
    Array3f::Dense both(2 * above.V().rows(), 3);
    both << above.V(), below.V();
    EXPECT_EQ(up_of(cloud(both)), "+y") << "two heights at each place";
}

TEST(Up, OfReliefsAndSheetsIsY) {
    const float none = std::nanf("");
    EXPECT_EQ(up_of(height_field([](float, float) { return 0.0f; })), "+y") << "a picture";
    EXPECT_EQ(
        up_of(height_field([&](float x, float y) { return x * x + y * y < 1 ? 1 - x * x - y * y : none; })),
        "+y")
        << "a mask, which is round";
    EXPECT_EQ(up_of(height_field([&](float x, float) {
                  return std::abs(x) < 0.03f ? none : x < 0 ? 0.0f : 1.0f;
              })),
              "+y")
        << "cards at two depths";
    EXPECT_EQ(up_of(height_field([](float x, float) { return x; })), "+y") << "a ramp";
}

TEST(Up, OfAMeshIsZWhereItStandsOnIt) {
    EXPECT_EQ(up_of(standing("+z")), "+z");
    EXPECT_EQ(up_of(standing("+y")), "+y");
    EXPECT_EQ(up_of(standing("+x")), "+y");
    EXPECT_EQ(up_of(standing("-z")), "+y") << "a flat top is no ground";
}

TEST(Up, IsYWhereNothingSaysOther) {
    std::mt19937 random(5);
    std::normal_distribution<float> normal;
    Array3f::Dense V(20'000, 3);
    for (auto row : V.rowwise()) row << normal(random), normal(random), normal(random);
    EXPECT_EQ(up_of(cloud(V)), "+y");
    V.col(2).setZero();
    EXPECT_EQ(up_of(cloud(V)), "+y") << "a drawing";
    EXPECT_EQ(up_of(points({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}})), "+y");
    EXPECT_EQ(up_of(make_box({1, 1, 1})), "+y");
    EXPECT_EQ(up_of(make_sphere(1, 32)), "+y");
    EXPECT_EQ(up_of(make_box({1, 0.1, 2})), "+y");
    Mesh relief = make_cone(1, 0.5f, 64);
    relief.set_T_parent_mesh(Eigen::Affine3d(Eigen::AngleAxisd(pi / 2, Vec3d::UnitX())));
    EXPECT_EQ(up_of(relief), "+y");
    Mesh tilted = make_box({1, 1, 1});
    tilted.set_T_parent_mesh(Eigen::Affine3d(Eigen::AngleAxisd(0.3, Vec3d::UnitZ())));
    EXPECT_EQ(up_of(tilted), "+y");
    Array3i::Dense F(3, 3);
    F << 0, 1, 2, 0, 2, 3, 4, 5, 6;
    const Mesh corners =
        points({{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}});
    EXPECT_EQ(up_of(Mesh(corners.V(), Array3i(F))), "+y") << "sheets one behind the other";
}

TEST(Up, IsTheSameAtAnyScale) {
    Mesh mesh = room().turned(Mat3d::Identity());
    mesh.set_V(Array3f::Dense(mesh.V() * 1024.0f));
    EXPECT_EQ(up_of(mesh), "+z");
}

TEST(Up, OfAFormatWinsOverTheGround) {
    const Mesh mesh = room().turned(Mat3d::Identity());
    EXPECT_EQ(up_of(with_up(mesh, Vec3d::UnitY())), "+y");
    EXPECT_EQ(up_of(with_up(make_sphere(1, 32), -Vec3d::UnitY())), "-y");
}

TEST(Up, IsInferredInTheOrderThatTheFieldTells) {
    const std::string& doc = field("camera.up").doc;
    size_t last = doc.find("utomatic: ");
    for (const char* source : {"the file's format", "+z of a height field", "the ground", "+y"}) {
        const size_t place = doc.find(source, last);
        ASSERT_NE(place, std::string::npos) << source;
        last = place;
    }
}

TEST(Up, OfAFormatTurnsWithTheMesh) {
    Mesh mesh = with_up(make_sphere(1, 32), Vec3d::UnitZ());
    EXPECT_EQ(up_of(mesh), "+z");
    mesh.set_T_parent_mesh(Eigen::Affine3d(Eigen::AngleAxisd(-pi / 2, Vec3d::UnitX())));
    EXPECT_EQ(up_of(mesh), "+y");
    mesh.set_T_parent_mesh(Eigen::Affine3d(Eigen::AngleAxisd(0.5, Vec3d::UnitX())));
    EXPECT_EQ(up_of(mesh), "+y") << "no axis";
}

TEST(Up, OfFormatsThatDisagreeIsY) {
    Scene scene;
    scene.show(with_up(make_sphere(1, 32), Vec3d::UnitZ()), "scan");
    EXPECT_EQ(resolve(scene.snapshot(), {}, size).settings.camera.up, "+z");
    scene.show(with_up(make_sphere(1, 32), Vec3d::UnitY()), "model");
    EXPECT_EQ(resolve(scene.snapshot(), {}, size).settings.camera.up, "+y");
}

TEST(Up, IsPinnedLatchedAndReleased) {
    const Mesh mesh = room().turned(Mat3d::Identity());
    Settings settings;
    settings.camera.up = "-X";
    EXPECT_EQ(up_direction(settings.camera), Vec3d(-1, 0, 0));
    EXPECT_EQ(parse_up(up_of(mesh, settings)), Vec3d(-1, 0, 0));
    settings.camera.up = automatic;
    EXPECT_EQ(up_direction(settings.camera), Vec3d(0, 1, 0));
    Scene scene;
    scene.show(mesh, "room");
    latch(settings, resolve(scene.snapshot(), settings, size).settings);
    EXPECT_EQ(settings.camera.up.value(), "+z");
    EXPECT_FALSE(settings.camera.up.is_pinned());
    scene.show(make_sphere(1, 32), "room");
    EXPECT_EQ(resolve(scene.snapshot(), settings, size).settings.camera.up, "+z");
    release(settings);
    EXPECT_EQ(resolve(scene.snapshot(), settings, size).settings.camera.up, "+y");
}

namespace {

Mesh with_front(const Vec3d& front, const Vec3d& up = Vec3d::Zero()) {
    MeshData data = *make_sphere(1, 32).snapshot();
    data.front = front;
    data.up = up;
    return Mesh(data);
}

Camera camera_of(const Scene& scene, const Settings& settings = {}) {
    return resolve(scene.snapshot(), settings, size).camera;
}

}  // namespace

// A depth image is seen from where its camera stood, upright.
TEST(Front, IsWhereTheAutomaticCameraStands) {
    for (const Vec3d& up : {Vec3d(0, -1, 0), Vec3d(0, 0, 1), Vec3d(1, 0, 0)})
        for (const Vec3d& front : {Vec3d(0, 0, -1), Vec3d(0.3, 0.5, -2), Vec3d(-1, 0.2, 0.1)}) {
            Scene scene;
            scene.show(with_front(front, up), "image");
            const Camera camera = camera_of(scene);
            EXPECT_LT((camera.T_world_cam.linear().col(2) - front.normalized()).norm(), 1e-6)
                << up.transpose() << " from " << front.transpose();
            EXPECT_GT(camera.T_world_cam.linear().col(1).dot(up), 0) << "upright";
            EXPECT_GT((camera.position() / front.norm()).dot(front), 1) << "beyond the sphere";
        }
}

TEST(Front, TurnsWithTheMesh) {
    Mesh mesh = with_front(Vec3d::UnitZ());
    mesh.set_T_parent_mesh(Eigen::Affine3d(Eigen::AngleAxisd(0.7, Vec3d::UnitY())));
    Scene scene;
    scene.show(mesh, "image");
    EXPECT_LT((camera_of(scene).T_world_cam.linear().col(2) - Vec3d(std::sin(0.7), 0, std::cos(0.7))).norm(),
              1e-6);
}

TEST(Front, OfImagesThatDisagreeIsTheUsualView) {
    Scene usual, images;
    usual.show(make_sphere(1, 32), "model");
    const Mat3d expected = camera_of(usual).T_world_cam.linear();
    images.show(with_front(Vec3d(0, 0, 1)), "first");
    EXPECT_FALSE(camera_of(images).T_world_cam.linear().isApprox(expected));
    images.show(with_front(Vec3d(0.1, 0, 1)), "second");
    EXPECT_LT((camera_of(images).T_world_cam.linear().col(2) - Vec3d(0, 0, 1)).norm(), 1e-6);
    images.show(with_front(Vec3d(1, 0, 1)), "third");
    EXPECT_TRUE(camera_of(images).T_world_cam.linear().isApprox(expected));
    images.remove("second");
    images.remove("third");
    images.show(make_sphere(1, 32), "model");
    EXPECT_TRUE(camera_of(images).T_world_cam.linear().isApprox(expected)) << "a model beside an image";
}

TEST(Front, YieldsToGivenAngles) {
    Scene scene;
    scene.show(with_front(Vec3d(1, 0, 0)), "image");
    Settings settings;
    settings.camera.azimuth_deg = 0;
    settings.camera.elevation_deg = 0;
    EXPECT_LT((camera_of(scene, settings).T_world_cam.linear().col(2) - Vec3d(0, 0, 1)).norm(), 1e-6);
    settings.camera.azimuth_deg = automatic;
    const ResolvedSettings resolved = resolve(scene.snapshot(), settings, size);
    EXPECT_NEAR(resolved.settings.camera.azimuth_deg, 90, 1e-3);
    EXPECT_EQ(resolved.settings.camera.elevation_deg, 0);
}

}  // namespace easypbr::up_test
