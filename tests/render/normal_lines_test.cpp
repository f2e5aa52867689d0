// Lines along the normals of vertices, in any pose.
#include <cmath>
#include <optional>
#include <vector>

#include "easypbr/gpu/line_segments.h"
#include "easypbr/scene/merge.h"
#include "easypbr/scene/settings.h"
#include "render_test.h"

namespace easypbr::render::normal_lines_test {

// In the world they are as long as they are said to be, and perpendicular to what the pose makes of the
// surface. 1e-5: places of 1 have 24 bits, a pose makes up to 4 of them, and lines are 0.25 long.
TEST(NormalLines, HaveTheirLengthAndDirectionInTheWorld) {
    const auto data = make_sphere(1, 16).snapshot();
    const Mat3d turn = Eigen::AngleAxisd(0.7, Vec3d(1, 2, 3).normalized()).toRotationMatrix();
    Mat3d shear = Mat3d::Identity();
    shear(0, 1) = 1.5;
    for (const Mat3d& pose :
         {Mat3d(Mat3d::Identity()), Mat3d(3 * turn), Mat3d(turn * Vec3d(1, 4, 0.5).asDiagonal()), shear,
          Mat3d(Vec3d(1, 1, -2).asDiagonal())}) {
        const auto segments = gpu::normal_segments(*data, gpu::normal_lines(0.25f, pose));
        ASSERT_EQ(Eigen::Index(segments.size()), data->V.rows());
        for (size_t i = 0; i < segments.size(); ++i) {
            const Vec3d n = data->N.row(Eigen::Index(i)).transpose().cast<double>();
            const Vec3d line = pose * (Vec3(segments[i].b) - Vec3(segments[i].a)).cast<double>();
            EXPECT_NEAR(line.norm(), 0.25, 1e-5);
            const Vec3d along = n.unitOrthogonal();
            for (const Vec3d& tangent : {along, Vec3d(n.cross(along))})
                EXPECT_NEAR(line.dot((pose * tangent).normalized()) / 0.25, 0, 1e-5);
            // Outward: where a step along the normal leads.
            EXPECT_GT(line.dot(pose * n), 0);
        }
    }
    const Vec3 box = data->V.colwise().maxCoeff() - data->V.colwise().minCoeff();
    const auto by_size = gpu::normal_segments(*data, gpu::normal_lines({}, 3 * turn));
    EXPECT_NEAR(3 * (Vec3(by_size[0].b) - Vec3(by_size[0].a)).norm(), 3 * 0.02f * box.norm(), 1e-5);
    // What turns is not made again.
    EXPECT_EQ(gpu::normal_lines({}, 2 * turn).metric, gpu::normal_lines({}, 2 * Mat3d::Identity()).metric);
}

// A mesh in a pose has the lines of the same mesh with the pose in its vertices. Ends differ by rounding
// errors of their places, 1e-6 of 32 pixels, and so does what a line covers.
TEST(NormalLines, InAPoseAreThoseOfTheTransformedMesh) {
    Mesh square = facing_square(0.5f);
    square.edit([](MeshData& d) {
        Array3f::Dense N(4, 3);
        N.rowwise() = Eigen::RowVector3f(0.6f, 0.48f, 0.64f);
        d.N = Array3f(N);
        d.style.mode = DrawMode::lines;
        d.style.show_normals = true;
        d.style.line_width = 3.0f;
    });
    Eigen::Affine3d pose(Eigen::AngleAxisd(0.4, Vec3d::UnitX()));
    pose.linear() *= Vec3d(1.5, 0.6, 2).asDiagonal();
    const Mesh transformed_square(transformed(*square.snapshot(), pose));
    Mesh posed = square;
    posed.set_T_parent_mesh(pose);
    for (const bool native : {true, false}) {
        const auto picture = [&](const Mesh& mesh) {
            Scene scene;
            scene.show(mesh, "square");
            app::Session session = plain_session(scene, 64);
            session.settings().camera.projection = Projection::orthographic;
            session.settings().camera.ortho_height = 2.0;
            look_from(session, Vec3d(0, 0, 4));
            session.allow_native_shading(native);
            session.settings().style.normal_length = 0.4f;
            const Image image = render_linear(session);
            return std::vector<float>(image.pixels<float>().begin(), image.pixels<float>().end());
        };
        const std::vector<float> expected = picture(transformed_square), drawn = picture(posed);
        ASSERT_EQ(drawn.size(), expected.size());
        for (size_t i = 0; i < drawn.size(); ++i) ASSERT_NEAR(drawn[i], expected[i], 1e-3) << native;
    }
}

TEST(NormalLines, AreAsLongAsTwoPercentOfTheDiagonal) {
    Scene scene;
    scene.show(facing_square(1), "square");
    const auto picture = [&](std::optional<float> length) {
        app::Session session = plain_session(scene, 100);
        session.settings().style.show_normals = true;
        if (length) session.settings().style.normal_length = *length;
        look_from(session, Vec3d(0, -4, 1));
        const Image image = render_linear(session);
        return std::vector<float>(image.pixels<float>().begin(), image.pixels<float>().end());
    };
    const float length = 0.02f * std::sqrt(8.0f);
    EXPECT_EQ(picture({}), picture(length));
    EXPECT_NE(picture({}), picture(1.5f * length));
}

}  // namespace easypbr::render::normal_lines_test
