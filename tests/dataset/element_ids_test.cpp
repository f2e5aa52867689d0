// face_id names an element of the user's own arrays, however the object is drawn; picking names the same.
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "easypbr/dataset/ground_truth.h"
#include "easypbr/scene/element_colors.h"
#include "easypbr/scene/settings.h"
#include "render/render_test.h"

namespace easypbr::dataset::element_ids_test {
namespace {

constexpr int side = 7, picture = 160;
constexpr float spacing = 0.3f, point_pixels = 9;

/// A square of side x side vertices in the plane z = 0 whose faces have labels and lie in two parts.
Mesh grid(const Style& style) {
    Array3f::Dense V(side * side, 3), N(side * side, 3);
    for (int i = 0; i < side * side; ++i) {
        V.row(i) << float(i % side - side / 2) * spacing, float(i / side - side / 2) * spacing, 0;
        N.row(i) << 0, 0, 1;
    }
    const int count = 2 * (side - 1) * (side - 1);
    Array3i::Dense F(count, 3);
    Array1i::Dense L(count);
    for (int i = 0; i < count / 2; ++i) {
        const int a = i / (side - 1) * side + i % (side - 1);
        F.row(2 * i) << a, a + 1, a + side + 1;
        F.row(2 * i + 1) << a, a + side + 1, a + side;
        L[2 * i] = L[2 * i + 1] = 1 + i % 5;
    }
    MeshData data;
    data.V = Array3f(V);
    data.N = Array3f(N);
    data.F = Array3i(F);
    data.L = Array1i(L);
    data.materials.resize(2);
    data.parts = {{"one", 0, count / 2, 0}, {"two", count / 2, count - count / 2, 1}};
    data.style = style;
    return Mesh(data);
}

struct Drawn {
    std::map<std::string, LayerArray> layers;
    Camera camera;
    int points = 0, faces = 0;
    std::set<int> elements;  ///< of the vertices that were named
};

Drawn draw(app::Session& session, bool native) {
    session.allow_native_geometry(native);
    session.settings().camera.projection = Projection::orthographic;
    session.settings().camera.ortho_height = 2.2;
    look_from(session, Vec3d(0.8, -1.1, 4));
    TruthOptions options;
    options.size = Vec2i(picture, picture);
    return {ground_truth(session, {"face_id", "barycentrics", "position", "depth", "semantic_id"}, options)
                .layers,
            session.camera(),
            0,
            0,
            {}};
}

Vec3 at(const Drawn& drawn, const char* name, size_t i) {
    return Vec3(&drawn.layers.at(name).floats()[3 * i]);
}

/// Every pixel's element against the pixel's own position: a face holds it, a vertex is no further away than
/// `reach` from the line of sight.
void check(Drawn& drawn, const MeshData& mesh, double reach, const std::string& what) {
    const Vec3 towards = drawn.camera.T_world_cam.linear().col(2).cast<float>();
    for (size_t i = 0; i < size_t(picture * picture); ++i) {
        const int element = drawn.layers.at("face_id").integers()[i];
        ASSERT_EQ(element >= 0, drawn.layers.at("depth").floats()[i] > 0) << what;
        if (element < 0) continue;
        const Vec3 position = at(drawn, "position", i), weights = at(drawn, "barycentrics", i);
        const int label = drawn.layers.at("semantic_id").integers()[i];
        if (weights.isZero()) {
            ASSERT_LT(element, mesh.V.rows()) << what;
            const Vec3 away = position - Vec3(mesh.V.row(element));
            ASSERT_LE((away - towards * towards.dot(away)).norm(), reach) << what << " vertex " << element;
            // The label of the first face that has the vertex.
            Eigen::Index face = 0;
            while ((mesh.F.row(face).array() != element).all()) ++face;
            ASSERT_EQ(label, mesh.L(face)) << what << " vertex " << element;
            drawn.elements.insert(element);
            ++drawn.points;
        } else {
            ASSERT_LT(element, mesh.F.rows()) << what;
            Vec3 sum = Vec3::Zero();
            for (int k = 0; k < 3; ++k) sum += weights[k] * Vec3(mesh.V.row(mesh.F(element, k)));
            // A pixel on an edge may belong to the face beside it, 1/256 of its 0.014 away.
            ASSERT_LE((sum - position).norm(), 2e-4) << what << " face " << element;
            ASSERT_EQ(label, mesh.L(element)) << what;
            ++drawn.faces;
        }
    }
}

/// Half a splat, and half a pixel's diagonal.
const double point_reach = (point_pixels / 2 + 0.71) * 2.2 / picture;

Style as_points() {
    Style style;
    style.point_size = point_pixels;
    style.mode = DrawMode::points;
    return style;
}

/// Colours of labels give each face vertices of its own, a cut makes new ones: neither may be named.
TEST(ElementIds, OfVerticesOnTopOfFaces) {
    Style style;
    style.show_points = true;
    style.point_size = point_pixels;
    for (const bool native : {true, false})
        for (const bool labels : {false, true})
            for (const bool cut : {false, true}) {
                Scene scene;
                const Mesh mesh = grid(style);
                scene.show(mesh, "grid");
                app::Session session = plain_session(scene);
                session.settings().style.color_by = labels ? ColorBy::label : ColorBy::solid;
                if (cut) session.settings().clip.planes = {1, 0, 0, 0.5};
                Drawn drawn = draw(session, native);
                const std::string what = fmt::format("native {}, labels {}, cut {}", native, labels, cut);
                // Of a cut edge the end that is nearer is named, up to half an edge (a diagonal) away.
                check(drawn, *mesh.snapshot(), point_reach + (cut ? 0.75 * spacing : 0), what);
                EXPECT_GT(drawn.points, 500) << what;
                EXPECT_GT(drawn.faces, 2000) << what;
                // At x = -0.37 two of seven columns are cut away; the nearer ends of the new edges are among
                // them.
                EXPECT_EQ(drawn.elements.size(), size_t(cut ? 6 * side : side * side)) << what;
            }
}

// Of a mesh with parts too: what is drawn as a point is in none of them.
TEST(ElementIds, OfMeshesDrawnAsPoints) {
    for (const bool native : {true, false})
        for (const bool cut : {false, true}) {
            Scene scene;
            const Mesh mesh = grid(as_points());
            scene.show(mesh, "grid");
            app::Session session = plain_session(scene);
            if (cut) session.settings().clip.planes = {1, 0, 0, 0.5};
            Drawn drawn = draw(session, native);
            check(drawn, *mesh.snapshot(), point_reach, fmt::format("native {}, cut {}", native, cut));
            EXPECT_EQ(drawn.faces, 0);
            EXPECT_EQ(drawn.elements.size(), size_t(cut ? 5 * side : side * side));
        }
}

TEST(ElementIds, OfSurfelsAndVoxels) {
    for (const DrawMode mode : {DrawMode::surfels, DrawMode::voxels})
        for (const bool native : {true, false}) {
            Style style;
            style.mode = mode;
            style.voxel_size = spacing;
            Scene scene;
            const Mesh mesh = grid(style);
            scene.show(mesh, "grid");
            app::Session session = plain_session(scene);
            session.settings().clip.planes = {1, 0, 0, 0.5};
            Drawn drawn = draw(session, native);
            // A surfel's radius is the spacing, and half a pixel's diagonal more, 0.03 of it, may be named; a
            // voxel's corner is half its diagonal away from its vertex.
            const double reach = spacing * (mode == DrawMode::surfels ? 1.05 : std::sqrt(3) / 2 + 0.01);
            check(drawn, *mesh.snapshot(), reach, fmt::format("{} native {}", int(mode), native));
            EXPECT_EQ(drawn.faces, 0);
            EXPECT_EQ(drawn.elements.size(), size_t(5 * side));
        }
}

// The vertices of voxels are their corners: as points on top they name the voxel's vertex.
TEST(ElementIds, OfTheCornersOfVoxels) {
    Style style = as_points();
    style.mode = DrawMode::voxels;
    style.voxel_size = spacing;
    style.show_points = true;
    Scene scene;
    const Mesh mesh = grid(style);
    scene.show(mesh, "grid");
    app::Session session = plain_session(scene);
    Drawn drawn = draw(session, true);
    check(drawn, *mesh.snapshot(), spacing * std::sqrt(3) / 2 + point_reach, "voxels");
    EXPECT_EQ(drawn.elements.size(), size_t(side * side));
}

// Lines are no surfaces: what lies behind them is seen, and nothing where there is nothing.
TEST(ElementIds, LinesHaveNone) {
    Style lines, wireframe;
    lines.mode = DrawMode::lines;
    wireframe.show_wireframe = true;
    for (const Style& style : {lines, wireframe}) {
        Scene scene;
        const Mesh mesh = grid(style);
        scene.show(mesh, "grid");
        app::Session session = plain_session(scene);
        Drawn drawn = draw(session, true);
        check(drawn, *mesh.snapshot(), 0, "lines");
        EXPECT_EQ(drawn.points, 0);
        EXPECT_EQ(drawn.faces > 0, style.mode != DrawMode::lines);
        EXPECT_EQ(bool(session.pick({picture / 2.0, picture / 2.0}, Vec2i(picture, picture))),
                  style.mode != DrawMode::lines);
    }
}

TEST(ElementIds, PickingNamesTheSame) {
    Style on_top = as_points(), surfels, voxels;
    on_top.mode = DrawMode::mesh;
    on_top.show_points = true;
    surfels.mode = DrawMode::surfels;
    voxels.mode = DrawMode::voxels;
    for (const Style& style : {on_top, as_points(), surfels, voxels}) {
        Scene scene;
        scene.show(grid(style), "grid");
        app::Session session = plain_session(scene);
        session.settings().clip.planes = {1, 0, 0, 0.5};
        const Drawn drawn = draw(session, true);
        const app::PickBuffer buffer = session.pick_buffer(Vec2i(picture, picture));
        const int first_of_two = (side - 1) * (side - 1);
        for (int i = 0; i < picture * picture; i += 3) {
            const auto pick = buffer.at(Vec2d(i % picture + 0.5, i / picture + 0.5));
            const int element = drawn.layers.at("face_id").integers()[size_t(i)];
            ASSERT_EQ(bool(pick), element >= 0);
            if (!pick) continue;
            ASSERT_EQ(pick->element, element);
            ASSERT_EQ(pick->is_face, !at(drawn, "barycentrics", size_t(i)).isZero());
            ASSERT_EQ(pick->part, !pick->is_face ? "" : element < first_of_two ? "one" : "two");
        }
    }
}

// Of vertices: most corners of a face decide, else the first one, wherever on the face the pixel is; the
// picture's colours say the same.
TEST(ElementIds, SemanticIdsOfVerticesAreThoseOfThePicture) {
    Scene scene;
    Mesh square = facing_square(1);
    square.edit([](MeshData& data) {
        data.F = Array3i(Array3i::Dense{{1, 2, 0}, {2, 3, 0}});
        data.L = Array1i(Array1i::Dense{{4, 7, 9, 9}});
        data.label_map = std::make_shared<const LabelMap>(
            "three", std::vector<LabelClass>{
                         {4, "four", {40, 0, 0}}, {7, "seven", {0, 70, 0}}, {9, "nine", {0, 0, 90}}});
    });
    scene.show(square, "square");
    const MeshData& mesh = *square.snapshot();
    const std::vector<Rgba8> colors =
        element_colors(mesh, plan_colors(mesh, {}, DrawMode::mesh, mesh.T_parent_mesh, Vec3d::UnitY()))
            .colors;
    app::Session session = plain_session(scene, 40);
    look_from(session, Vec3d(0, 0, 5), 35);
    TruthOptions options;
    options.size = Vec2i(40, 40);
    const GroundTruth truth = ground_truth(session, {"semantic_id", "face_id"}, options);
    std::map<int, int> counts;
    for (size_t i = 0; i < 1600; ++i) {
        const int face = truth.layers.at("face_id").integers()[i];
        if (face < 0) continue;
        ++counts[face];
        const int label = truth.layers.at("semantic_id").integers()[i];
        EXPECT_EQ(label, face == 0 ? 7 : 9);  // corners 7 9 4 and 9 9 4
        EXPECT_EQ(opaque(mesh.label_map->color_of(label)), colors[size_t(face)]);
    }
    EXPECT_EQ(counts.size(), 2u);
}

}  // namespace
}  // namespace easypbr::dataset::element_ids_test
