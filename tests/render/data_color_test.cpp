// Colours of data beside a material for all objects.
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "easypbr/io/image/image_io.h"
#include "render_test.h"

namespace easypbr::render::data_color_test {
namespace {

/// A square with all that may colour it.
Mesh square_with_data() {
    Mesh mesh = facing_square(0.6f);
    mesh.edit([](MeshData& d) {
        Array3f::Dense N(4, 3);
        N.rowwise() = Eigen::RowVector3f(0, 0.6f, 0.8f);
        Array1i::Dense labels(2);
        labels << 1, 5;
        Array1f::Dense of_vertices(4), of_faces(2);
        of_vertices << 0, 1, 3, 4;
        of_faces << 1, 2;
        d.N = Array3f(N);
        d.L = Array1i(labels);
        d.I = Array1f(of_vertices);
        d.scalars = {{"vertices", Array1f(of_vertices)}, {"faces", Array1f(of_faces)}};
        d.style.voxel_size = 0.3f;
        d.style.point_size = 9.0f;
        d.style.lit = false;
        d.style.show_wireframe = true;
        d.style.show_normals = true;
    });
    return mesh;
}

/// One in each kind of primitive, beside each other.
Scene row_of_squares() {
    Scene scene;
    double x = -4;
    for (const DrawMode mode :
         {DrawMode::mesh, DrawMode::points, DrawMode::lines, DrawMode::surfels, DrawMode::voxels}) {
        Mesh mesh = square_with_data();
        mesh.edit([&](MeshData& d) { d.style.mode = mode; });
        mesh.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(x, 0, 0)));
        scene.show(mesh, std::to_string(int(mode)));
        x += 2;
    }
    return scene;
}

std::vector<uint8_t> picture_of(app::Session& session) {
    const Image picture = session.render({std::nullopt, 1, app::Encoding::srgb8});
    return {picture.pixels<uint8_t>().begin(), picture.pixels<uint8_t>().end()};
}

struct Kind {
    const char* name;
    std::function<void(Style&)> choose;
};

const std::vector<Kind> kinds = {
    {"labels", [](Style& s) { s.color_by = ColorBy::label; }},
    {"scalars of vertices", [](Style& s) { s.scalar = std::string("vertices"); }},
    {"scalars of faces", [](Style& s) { s.scalar = std::string("faces"); }},
    {"heights", [](Style& s) { s.color_by = ColorBy::height; }},
    {"intensities", [](Style& s) { s.color_by = ColorBy::intensity; }},
    {"normals", [](Style& s) { s.color_by = ColorBy::normal; }},
    {"coordinates", [](Style& s) { s.color_by = ColorBy::uv; }}};

// They stand for the base colour: a colour and a texture for all materials change no pixel of any kind of
// primitive, with lines on top.
TEST(DataColors, AreKeptUnderAMaterialForAllObjects) {
    const auto file = std::filesystem::temp_directory_path() /
                      ("easypbr-data-color-" + std::to_string(::getpid()) + ".png");
    Image blue(2, 2, 3, PixelType::u8);
    for (size_t i = 2; i < blue.pixels<uint8_t>().size(); i += 3) blue.pixels<uint8_t>()[i] = 255;
    io::save_image(blue, file);
    const Scene scene = row_of_squares();
    for (const Kind& kind : kinds)
        for (const bool native : {true, false}) {
            app::Session session = plain_session(scene, 120);
            session.allow_native_geometry(native);
            session.allow_native_shading(native);
            session.settings().camera.projection = Projection::orthographic;
            session.settings().camera.ortho_height = 10.0;
            look_from(session, Vec3d(0, 0, 8));
            kind.choose(session.settings().style);
            const std::vector<uint8_t> plain = picture_of(session);
            size_t covered = 0;
            for (size_t i = 3; i < plain.size(); i += 4) covered += plain[i] == 255;
            // The faces alone of a square are 1.2 of 10 units wide, 14 of 120 pixels.
            EXPECT_GT(covered, 14u * 14) << kind.name;
            session.settings().material.color = Vec3(1, 0, 0);
            EXPECT_EQ(picture_of(session), plain) << kind.name << native;
            session.settings().material.base_color_texture = file.string();
            EXPECT_EQ(picture_of(session), plain) << kind.name << native;
            session.settings().material.color = automatic;
            EXPECT_EQ(picture_of(session), plain) << kind.name << native;
        }
    std::filesystem::remove(file);
}

// Without data to colour it, the same square has the colour for all.
TEST(DataColors, AreNoMaterialsAndNoColoursOfVertices) {
    Scene scene;
    Mesh mesh = square_with_data();
    mesh.edit([](MeshData& d) {
        d.C = ArrayXf::Dense::Constant(4, 3, 0.5f);
        d.style.show_wireframe = d.style.show_normals = false;
    });
    scene.show(mesh, "square");
    app::Session session = plain_session(scene, 32);
    look_from(session, Vec3d(0, 0, 4));
    session.settings().material.color = Vec3(1, 0, 0);
    for (const ColorBy by : {ColorBy::solid, ColorBy::vertex}) {
        session.settings().style.color_by = by;
        const std::vector<uint8_t> picture = picture_of(session);
        const uint8_t* middle = &picture[4 * (16 * 32 + 16)];
        EXPECT_EQ(std::vector<int>(middle, middle + 3), (std::vector<int>{255, 0, 0})) << int(by);
    }
}

// Values of very many faces have no table. Their wireframe needs none.
TEST(DataColors, OfManyFacesHaveAWireframe) {
    Mesh mesh = make_sphere(1, 720);
    mesh.edit([](MeshData& d) {
        d.style.color_by = ColorBy::height;
        d.style.show_wireframe = true;
        d.source_face = Array1i::Dense::Zero(d.F.rows());  // one polygon: few lines are quick to draw
    });
    ASSERT_GT(mesh.snapshot()->F.rows(), 500000);
    Scene scene;
    scene.show(mesh, "sphere");
    for (const bool native : {true, false}) {
        app::Session session = plain_session(scene, 32);
        session.allow_native_shading(native);
        look_from(session, Vec3d(0, 0, 4));
        // The middle of a sphere is covered.
        EXPECT_EQ(int(picture_of(session)[4 * (16 * 32 + 16) + 3]), 255) << native;
    }
}

}  // namespace
}  // namespace easypbr::render::data_color_test
