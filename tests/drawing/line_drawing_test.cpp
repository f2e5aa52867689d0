#include "easypbr/drawing/line_drawing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "easypbr/app/session.h"
#include "easypbr/core/error.h"
#include "easypbr/core/log.h"
#include "easypbr/geometry/primitives.h"
#include "easypbr/scene/mesh.h"
#include "easypbr/scene/resolve.h"
#include "easypbr/scene/settings.h"
#include "io/temporary_folder.h"

namespace easypbr::line_drawing_test {
namespace {

using drawing::Polyline;

const Vec2i size{400, 300};
/// Visibility changes are found to 1/64 of a pixel, and polylines are simplified to 0.05.
constexpr double found_px = 1.0 / 64 + 1e-3, drawn_px = 0.05;

/// Looks along -z from z = 10; a world unit is 50 pixels.
Camera front(Projection projection = Projection::orthographic) {
    Camera camera = Camera::look_at({0, 0, 10}, {0, 0, 0});
    camera.projection = projection;
    camera.ortho_height = 6;
    // At a distance of 10.
    camera.fov_y_deg = 2 * std::atan(0.3) * 180 / M_PI;
    return camera;
}

Vec2d at(double x, double y) {
    return {200 + 50 * x, 150 - 50 * y};
}

struct Drawn {
    drawing::LineDrawing drawing;
    std::vector<Polyline> visible, hidden;
};

Drawn draw(app::Session& session, const Camera& camera, const Vec2i& picture = size) {
    session.set_camera(camera);
    Drawn drawn{drawing::line_drawing(session.scene().snapshot(), session.resolve(picture), picture), {}, {}};
    for (const auto& object : drawn.drawing.objects) {
        drawn.visible.insert(drawn.visible.end(), object.visible.begin(), object.visible.end());
        drawn.hidden.insert(drawn.hidden.end(), object.hidden.begin(), object.hidden.end());
    }
    return drawn;
}

Drawn draw(const Mesh& mesh, const Camera& camera) {
    app::Session session;
    session.scene().show(mesh, "mesh");
    return draw(session, camera);
}

double length(const std::vector<Polyline>& lines) {
    double sum = 0;
    for (const Polyline& line : lines)
        for (size_t i = 1; i < line.size(); ++i) sum += (line[i] - line[i - 1]).norm();
    return sum;
}

Mesh segment(const Vec3& from, const Vec3& to) {
    MeshData data;
    Array3f::Dense V(2, 3);
    V.row(0) = from.transpose();
    V.row(1) = to.transpose();
    Array2i::Dense E(1, 2);
    E << 0, 1;
    data.V = std::move(V);
    data.E = std::move(E);
    return Mesh(std::move(data));
}

/// A square of two triangles in the plane z = `z`, from -half to half.
Mesh square(float half, float z) {
    Array3f::Dense V(4, 3);
    V << -half, -half, z, half, -half, z, half, half, z, -half, half, z;
    Array3i::Dense F(2, 3);
    F << 0, 1, 2, 0, 2, 3;
    return {std::move(V), std::move(F)};
}

TEST(LineDrawing, CubeAlongItsDiagonalHasNineVisibleEdgesAndThreeHidden) {
    Camera camera = Camera::look_at({10, 10, 10}, {0, 0, 0});
    camera.projection = Projection::orthographic;
    camera.ortho_height = 6;
    const Drawn drawn = draw(make_box(), camera);
    // Isometric: every edge is foreshortened by sqrt(2/3).
    const double edge = 50 * std::sqrt(2.0 / 3);
    EXPECT_NEAR(length(drawn.visible), 9 * edge, 9 * drawn_px);
    EXPECT_NEAR(length(drawn.hidden), 3 * edge, 3 * drawn_px);
}

TEST(LineDrawing, CubeWithoutCreasesIsItsHexagon) {
    app::Session session;
    session.scene().show(make_box(), "box");
    session.settings().outline.creases = false;
    Camera camera = Camera::look_at({10, 10, 10}, {0, 0, 0});
    camera.projection = Projection::orthographic;
    camera.ortho_height = 6;
    const Drawn drawn = draw(session, camera);
    ASSERT_EQ(drawn.visible.size(), 1u);
    EXPECT_EQ(drawn.visible[0].size(), 7u) << "six corners, and the first again";
    EXPECT_EQ(drawn.visible[0].front(), drawn.visible[0].back());
    EXPECT_NEAR(length(drawn.visible), 6 * 50 * std::sqrt(2.0 / 3), 6 * drawn_px);
    EXPECT_TRUE(drawn.hidden.empty());
}

TEST(LineDrawing, WindingOfSingleFacesDoesNotMatter) {
    Mesh box = make_box();
    box.edit([](MeshData& data) {
        Array3i::Dense F = data.F.matrix();
        for (Eigen::Index i = 0; i < F.rows(); i += 3) std::swap(F(i, 1), F(i, 2));
        data.F = std::move(F);
    });
    const Camera camera = Camera::look_at({5, 3, 8}, {0, 0, 0});
    const Drawn turned = draw(box, camera), right = draw(make_box(), camera);
    EXPECT_NEAR(length(turned.visible), length(right.visible), 12 * found_px);
    EXPECT_NEAR(length(turned.hidden), length(right.hidden), 12 * found_px);
}

TEST(LineDrawing, FaceHidesTheMiddleOfALineBehindIt) {
    for (const Projection projection : {Projection::orthographic, Projection::perspective}) {
        app::Session session;
        session.scene().show(segment({-2, 0.3f, 0}, {2, 0.3f, 0}), "line");
        session.scene().show(square(0.5f, 2), "square");
        const Drawn drawn = draw(session, front(projection));
        // From 10 away, what is 2 nearer is 10/8 as large.
        const double half = projection == Projection::perspective ? 0.5 * 10 / 8 : 0.5;
        const auto& line = drawn.drawing.objects[0];
        ASSERT_EQ(line.name, "line");
        ASSERT_EQ(line.visible.size(), 2u);
        ASSERT_EQ(line.hidden.size(), 1u);
        EXPECT_NEAR((line.visible[0].front() - at(-2, 0.3)).norm(), 0, 1e-4);
        EXPECT_NEAR((line.hidden[0].front() - at(-half, 0.3)).norm(), 0, found_px);
        EXPECT_NEAR((line.hidden[0].back() - at(half, 0.3)).norm(), 0, found_px);
        EXPECT_NEAR((line.visible[1].back() - at(2, 0.3)).norm(), 0, 1e-4);
    }
}

TEST(LineDrawing, LineIsHiddenFromWhereItPiercesAFace) {
    app::Session session;
    // Through z = 0 at x = 0.5; depth is not linear in a perspective picture.
    session.scene().show(segment({-1, 0, 3}, {2, 0, -3}), "line");
    session.scene().show(square(2, 0), "square");
    const Drawn drawn = draw(session, front(Projection::perspective));
    const auto& line = drawn.drawing.objects[0];
    ASSERT_EQ(line.visible.size(), 1u);
    ASSERT_EQ(line.hidden.size(), 1u);
    EXPECT_NEAR((line.visible[0].back() - at(0.5, 0)).norm(), 0, found_px);
    EXPECT_NEAR((line.hidden[0].back() - at(2 * 10.0 / 13, 0)).norm(), 0, 1e-4);
}

TEST(LineDrawing, LineOnAFaceIsSeen) {
    app::Session session;
    session.scene().show(segment({-0.4f, 0, 0}, {0.4f, 0.1f, 0}), "line");
    session.scene().show(square(0.5f, 0), "square");
    EXPECT_TRUE(draw(session, front()).hidden.empty());
}

TEST(LineDrawing, TransparentFaceHidesNothing) {
    app::Session session;
    Mesh glass = square(0.5f, 2);
    Material material;
    material.transmission = 1;
    glass.set_material(material);
    session.scene().show(segment({-2, 0, 0}, {2, 0, 0}), "line");
    session.scene().show(glass, "glass");
    EXPECT_TRUE(draw(session, front()).hidden.empty());
    session.settings().material.transmission = 0;
    EXPECT_EQ(draw(session, front()).hidden.size(), 1u);
}

TEST(LineDrawing, SphereIsACircleWithoutGaps) {
    const Drawn drawn = draw(make_icosphere(1, 6), front());
    // A contour of the polyhedron lies within a face of the sphere's: edges are 2 pixels long, so that it is
    // at most that far within, and on the sphere at its corners.
    std::vector<char> seen(360, 0);
    for (const Polyline& line : drawn.visible)
        for (size_t i = 1; i < line.size(); ++i)
            for (int k = 0; k <= 16; ++k) {
                const Vec2d p = line[i - 1] + k / 16.0 * (line[i] - line[i - 1]) - at(0, 0);
                EXPECT_NEAR(p.norm(), 50, 0.2);
                seen[size_t(std::floor((std::atan2(p.y(), p.x()) + M_PI) * 180 / M_PI)) % 360] = 1;
            }
    EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), 360);
}

TEST(LineDrawing, SheetHasItsBorder) {
    const Drawn drawn = draw(square(1, 0), front());
    ASSERT_EQ(drawn.visible.size(), 1u);
    EXPECT_EQ(drawn.visible[0].size(), 5u) << "the diagonal is no edge of it";
    EXPECT_NEAR(length(drawn.visible), 400, 1e-3);
}

TEST(LineDrawing, ThePictureAndTheNearPlaneCutLines) {
    app::Session session;
    session.scene().show(segment({0, -0.1f, 0}, {0, -0.1f, 20}), "line");
    // The line passes the camera.
    const Drawn beside = draw(session, front(Projection::perspective));
    ASSERT_EQ(beside.visible.size(), 1u);
    EXPECT_NEAR((beside.visible[0].front() - at(0, -0.1)).norm(), 0, 1e-4);
    const float margin = Settings().outline.width;
    EXPECT_NEAR(beside.visible[0].back().y(), size.y() + margin, 1e-3);
    session.settings().camera.near = 1;
    const Drawn cut = draw(session, front(Projection::perspective));
    EXPECT_NEAR((cut.visible[0].back() - at(0, -1)).norm(), 0, 1e-3) << "at depth 1";
    const Drawn wide = draw(segment({-100, 0, 0}, {100, 0, 0}), front());
    ASSERT_EQ(wide.visible.size(), 1u);
    EXPECT_NEAR(wide.visible[0].front().x(), -margin, 1e-3);
    EXPECT_NEAR(wide.visible[0].back().x(), size.x() + margin, 1e-3);
    EXPECT_TRUE(draw(segment({-2, 100, 0}, {2, 100, 0}), front()).drawing.objects.empty());
}

TEST(LineDrawing, LensBendsLines) {
    Mat3d K;
    K << 500, 0, 199.5, 0, 500, 149.5, 0, 0, 1;
    Mat4d T = Mat4d::Identity();
    T(2, 3) = 10;
    T(1, 1) = T(2, 2) = -1;  // OpenCV's axes: y down, z forward
    Camera camera = Camera::from_opencv(K, T, size.x(), size.y());
    camera.distortion = Distortion::from_coefficients(DistortionModel::brown_conrady, {-0.3, 0.1, 0, 0});
    const Drawn drawn = draw(segment({-3, 2, 0}, {3, 2, 0}), camera);
    ASSERT_EQ(drawn.visible.size(), 1u);
    ASSERT_GT(drawn.visible[0].size(), 3u);
    for (const Vec2d& point : drawn.visible[0]) {
        // Back to the straight line: y = 2 at a distance of 10.
        const Vec2d slopes((point.x() - 200) / 500, (point.y() - 150) / 500);
        EXPECT_NEAR(camera.distortion->undistort(slopes).y(), -0.2, 1e-4);
    }
}

TEST(LineDrawing, CloudIsLeftOutWithAWarning) {
    std::vector<std::string> warnings;
    set_log_sink([&](LogLevel, std::string_view message) { warnings.emplace_back(message); });
    MeshData cloud;
    cloud.V = Array3f(Array3f::Dense::Random(10, 3));
    const Drawn drawn = draw(Mesh(std::move(cloud)), front());
    set_log_sink({});
    EXPECT_TRUE(drawn.drawing.objects.empty());
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_NE(warnings[0].find("'mesh' has no edges"), std::string::npos);
}

class SvgFile : public testing::Test {
  protected:
    TemporaryFolder folder;
    app::Session session;

    void SetUp() override { session.scene().show(make_box(), "a <b> & \"c\" \xff"); }
    std::string saved(app::HiddenLines hidden) {
        drawing::save_line_drawing(session, folder / "a.svg", {size, hidden});
        std::ostringstream text;
        text << std::ifstream(folder / "a.svg").rdbuf();
        return text.str();
    }
};

TEST_F(SvgFile, HoldsGroupsNamesAndStyles) {
    session.settings().outline.color = {1, 0, 0};
    session.settings().outline.width = 3;
    const std::string text = saved(app::HiddenLines::dashed);
    EXPECT_NE(text.find("viewBox=\"0 0 400 300\""), std::string::npos);
    EXPECT_NE(text.find("stroke=\"#ff0000\""), std::string::npos);
    EXPECT_NE(text.find("<title>a &lt;b&gt; &amp; &quot;c&quot; \xef\xbf\xbd</title>"), std::string::npos);
    EXPECT_NE(text.find("class=\"visible\" stroke-width=\"3\""), std::string::npos);
    EXPECT_NE(text.find("class=\"hidden\" stroke-width=\"1.5\" stroke-dasharray=\"18 4.5\""),
              std::string::npos);
    EXPECT_EQ(saved(app::HiddenLines::none).find("hidden"), std::string::npos);
    EXPECT_EQ(saved(app::HiddenLines::solid).find("dasharray"), std::string::npos);
    EXPECT_EQ(saved(app::HiddenLines::dashed), text) << "the same bytes again";
}

TEST_F(SvgFile, IsRefusedWhereItCannotBe) {
    EXPECT_THROW(drawing::save_line_drawing(session, folder / "a.png"), ArgumentError);
    EXPECT_THROW(drawing::save_line_drawing(session, folder / "no/such/a.svg"), FileError);
    EXPECT_THROW(drawing::save_line_drawing(session, folder / "a.svg", {Vec2i(0, 5), {}}), ArgumentError);
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
    EXPECT_THROW(drawing::hidden_lines_named("dasht"), NameError);
    EXPECT_EQ(drawing::hidden_lines_named("solid"), app::HiddenLines::solid);
}

}  // namespace
}  // namespace easypbr::line_drawing_test
