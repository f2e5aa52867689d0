#include "easypbr/scene/mesh.h"

#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

#include "easypbr/core/error.h"
#include "easypbr/scene/scene.h"

namespace easypbr::mesh_test {

namespace {

using Positions = Array3f::Dense;
using Faces = Array3i::Dense;

MeshData triangle() {
    MeshData data;
    data.V = Positions{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    data.F = Faces{{0, 1, 2}};
    return data;
}

template <class Change>
std::string message_of(Change&& change) {
    MeshData data = triangle();
    change(data);
    try {
        validate(data);
    } catch (const ArgumentError& error) {
        return error.what();
    }
    return "valid";
}

}  // namespace

TEST(Mesh, StaysTheSameObjectWhenAHandleIsMovedFrom) {
    std::vector<Mesh> meshes{Mesh(triangle())};
    Mesh taken = std::move(meshes[0]);
    EXPECT_EQ(meshes[0], taken);
    EXPECT_EQ(meshes[0].V().rows(), 3);
    Mesh assigned;
    assigned = std::move(taken);
    EXPECT_EQ(taken, assigned);
    Scene scene;
    Scene moved = std::move(scene);
    scene.show(taken, "triangle");
    EXPECT_TRUE(moved.contains("triangle"));
    EXPECT_EQ(moved.snapshot().objects.size(), 1u);
}

TEST(Mesh, AnEditWithinItsOwnEditIsRefused) {
    Mesh mesh(triangle()), other;
    EXPECT_THROW(mesh.edit([&](MeshData&) { mesh.set_offset({1, 0, 0}); }), ArgumentError);
    EXPECT_THROW(mesh.edit([&](MeshData&) { other.edit([&](MeshData&) {
                                                mesh.set_offset({1, 0, 0});
                                            }); }),
                 ArgumentError);
    EXPECT_EQ(mesh.offset(), Vec3d(0, 0, 0));
    mesh.edit([&](MeshData& data) {
        data.offset = Vec3d(double(mesh.V().rows()), 0, 0);
        other.set_offset({2, 0, 0});
    });
    EXPECT_EQ(mesh.offset(), Vec3d(3, 0, 0)) << "reading it, and editing others, is fine";
    EXPECT_EQ(other.offset(), Vec3d(2, 0, 0));
}

TEST(Mesh, AcceptsWhatFitsTogether) {
    MeshData data = triangle();
    data.N = Positions{{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
    data.C = ArrayXf(ArrayXf::Dense::Ones(3, 4));
    data.E = Array2i(Array2i::Dense{{0, 2}});
    data.parts = {{"all", 0, 1, 0}};
    EXPECT_NO_THROW(validate(data));
    EXPECT_NO_THROW(validate(MeshData{}));
}

TEST(Mesh, NamesTheArrayThatDoesNotFit) {
    EXPECT_EQ(message_of([](MeshData& d) { d.N = Positions(Positions::Zero(2, 3)); }),
              "mesh array N: expected 3 rows, one per vertex, or none; got 2 x 3");
    EXPECT_EQ(message_of([](MeshData& d) { d.C = ArrayXf(ArrayXf::Dense::Zero(3, 2)); }),
              "mesh array C: expected 3 x 3 or 3 x 4, got 3 x 2");
    EXPECT_EQ(message_of([](MeshData& d) {
                  d.F = Faces{{0, 1, 2}, {0, 3, 1}};
              }),
              "mesh array F: expected vertex indices from 0 to 2, got 3 in row 1 of 2");
    EXPECT_EQ(message_of([](MeshData& d) {
                  d.E = Array2i(Array2i::Dense{{-1, 0}});
              }),
              "mesh array E: expected vertex indices from 0 to 2, got -1 in row 0 of 1");
    EXPECT_EQ(message_of([](MeshData& d) {
                  d.V = Positions{{0, 0, 0}, {1, std::numeric_limits<float>::infinity(), 0}, {0, 0, 0}};
              }),
              "mesh array V: expected finite positions, got (1, inf, 0) in row 1 of 3");
    EXPECT_EQ(message_of([](MeshData& d) {
                  d.parts = {{"wing", 0, 2, 0}};
              }),
              "mesh part 'wing': expected a range of the 1 faces, got 2 from face 0 on");
    EXPECT_NE(message_of([](MeshData& d) {
                  d.parts = {{"wing", 0, 1, 1}};
              }).find("material index"),
              std::string::npos);
}

TEST(Mesh, RefusesWhatCannotBeDrawn) {
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(message_of([](MeshData& d) {
                  d.source_vertex = Array1i::Dense{{0}, {-1}, {0}};
              }),
              "mesh array source_vertex: expected numbers of vertices from 0 on, got -1 in row 1 of 3");
    EXPECT_EQ(message_of([](MeshData& d) { d.voxel_size = -1; }),
              "mesh voxel_size: expected a finite number of at least 0, got -1");
    EXPECT_NE(message_of([](MeshData& d) { d.voxel_size = nan; }), "valid");
    EXPECT_NE(message_of([](MeshData& d) { d.voxel_size = std::numeric_limits<float>::infinity(); }),
              "valid");
    EXPECT_EQ(message_of([](MeshData& d) { d.front = Vec3d(0, double(nan), 0); }),
              "mesh front: expected finite numbers, got (0, nan, 0)");
    EXPECT_NE(message_of([](MeshData& d) { d.up.x() = double(nan); }), "valid");
    EXPECT_EQ(message_of([](MeshData& d) { d.T_parent_mesh.matrix()(3, 3) = 2; }),
              "mesh T_parent_mesh: expected a last row of (0, 0, 0, 1), got (0, 0, 0, 2)");
    Mesh mesh(triangle());
    Eigen::Affine3d T = Eigen::Affine3d::Identity();
    T.translation().x() = double(nan);
    EXPECT_THROW(mesh.set_T_parent_mesh(T), ArgumentError);
    EXPECT_TRUE(mesh.T_parent_mesh().matrix().isIdentity(0)) << "as before";
}

TEST(Mesh, PartsCoverTheFacesWithoutOverlap) {
    const auto message = [](std::vector<MeshPart> parts) {
        return message_of([&](MeshData& d) {
            d.F = Faces(Faces{{0, 1, 2}}.replicate(4, 1));
            d.parts = std::move(parts);
        });
    };
    EXPECT_EQ(message({{"b", 2, 2, 0}, {"none", 1, 0, 0}, {"a", 0, 2, 0}}), "valid") << "in any order";
    EXPECT_EQ(
        message({{"a", 0, 3, 0}, {"b", 2, 2, 0}}),
        "mesh parts: expected each of the 4 faces in one part, got faces 2 to 2 in two, the second 'b'");
    EXPECT_EQ(message({{"a", 0, 1, 0}, {"b", 2, 2, 0}}),
              "mesh parts: expected each of the 4 faces in one part, got faces 1 to 1 in none");
    EXPECT_EQ(message({{"a", 0, 3, 0}}),
              "mesh parts: expected each of the 4 faces in one part, got faces 3 to 3 in none");
    EXPECT_EQ(
        message({{"a", 0, 4, 0}, {"within", 1, 2, 0}}),
        "mesh parts: expected each of the 4 faces in one part, got faces 1 to 2 in two, the second 'within'");
    EXPECT_EQ(message({{"none", 0, 0, 0}}),
              "mesh parts: expected each of the 4 faces in one part, got faces 0 to 3 in none");
}

TEST(Mesh, TexturesHavePixels) {
    MeshData data = triangle();
    data.materials.resize(1);
    data.materials[0].name = "wood";
    data.materials[0].roughness_texture.image = std::make_shared<const Image>();
    try {
        validate(data);
        FAIL() << "taken";
    } catch (const ArgumentError& error) {
        EXPECT_STREQ(error.what(),
                     "material 'wood'.roughness_texture: expected an image with pixels, or none, "
                     "got an empty one");
    }
    data.materials[0].roughness_texture.image = std::make_shared<const Image>(1, 1, 1, PixelType::u8);
    EXPECT_NO_THROW(validate(data));
}

TEST(Mesh, LabelsAndScalarsBelongToVerticesOrFaces) {
    MeshData data = triangle();  // 3 vertices, 1 face
    data.L = Array1i(Array1i::Dense{{4}, {5}, {-1}});
    data.scalars = {{"area", Array1f(Array1f::Dense::Ones(1))}, {"height", Array1f(Array1f::Dense::Ones(3))}};
    EXPECT_NO_THROW(validate(data));
    EXPECT_EQ(element_of(data, data.L.rows()), PerElement::vertex);
    EXPECT_EQ(element_of(data, data.scalars[0].values.rows()), PerElement::face);
    data.L = Array1i(Array1i::Dense{{4}});
    EXPECT_NO_THROW(validate(data));
    EXPECT_EQ(element_of(data, data.L.rows()), PerElement::face);
    data.F = Faces{{0, 1, 2}, {0, 2, 1}, {0, 1, 2}};  // as many faces as vertices
    EXPECT_EQ(element_of(data, 3), PerElement::vertex);
}

// A quad of two triangles and a triangle; 6 vertices, of which one is in no face.
MeshData two_polygons() {
    MeshData data;
    data.V = Positions{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0, 0}, {9, 9, 9}};
    data.F = Faces{{0, 1, 2}, {0, 2, 3}, {1, 4, 2}};
    data.source_face = Array1i(Array1i::Dense{{0}, {0}, {1}});
    return data;
}

TEST(Mesh, ValuesOfPolygonsBecomeThoseOfTheirTriangles) {
    Mesh mesh(two_polygons());
    mesh.set_L(Array1i(Array1i::Dense{{4}, {7}}));
    mesh.add_scalar("area", Array1f(Array1f::Dense{{1}, {0.5f}}));
    EXPECT_EQ(Array1i::Dense(mesh.L()), (Array1i::Dense{{4}, {4}, {7}}));
    EXPECT_EQ(Array1f::Dense(mesh.scalar("area")), (Array1f::Dense{{1}, {1}, {0.5f}}));
    MeshData data = two_polygons();
    data.L = Array1i(Array1i::Dense{{4}, {7}});
    EXPECT_EQ(Array1i::Dense(Mesh(data).L()), (Array1i::Dense{{4}, {4}, {7}}));
    try {
        mesh.set_L(Array1i(Array1i::Dense::Zero(4)));
        ADD_FAILURE() << "expected an error";
    } catch (const ArgumentError& error) {
        EXPECT_STREQ(error.what(),
                     "mesh array L: expected 6 rows, one per vertex, or 3, one per face, or 2, one per "
                     "polygon, or none; got 4 x 1");
    }
}

TEST(Mesh, ValuesOfPolygonsStayThoseOfFacesWhereTheNumbersAreEqual) {
    MeshData data = two_polygons();
    data.V = Positions{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}};
    data.F = Faces{{0, 1, 2}, {0, 2, 1}, {1, 2, 0}};  // as many as vertices
    data.scalars = {{"height", Array1f(Array1f::Dense{{1}, {2}, {3}})}};
    Mesh mesh(data);
    mesh.set_L(Array1i(Array1i::Dense{{4}, {7}}));
    EXPECT_EQ(Array1i::Dense(mesh.L()), (Array1i::Dense{{4}, {4}, {7}}));
    ASSERT_EQ(mesh.V().rows(), 4);
    EXPECT_EQ(mesh.V().row(3), mesh.V().row(2));
    EXPECT_EQ(Array1f::Dense(mesh.scalar("height")), (Array1f::Dense{{1}, {2}, {3}, {3}}));
    EXPECT_EQ(element_of(*mesh.snapshot(), mesh.L().rows()), PerElement::face);
}

TEST(Mesh, RefusesPolygonsBelowZero) {
    EXPECT_EQ(message_of([](MeshData& d) { d.source_face = Array1i(Array1i::Dense{{-1}}); }),
              "mesh array source_face: expected numbers of polygons from 0 on, got -1 in row 0 of 1");
}

TEST(Mesh, NamesLabelsAndScalarsThatDoNotFit) {
    EXPECT_EQ(message_of([](MeshData& d) { d.L = Array1i(Array1i::Dense::Zero(2)); }),
              "mesh array L: expected 3 rows, one per vertex, or 1, one per face, or none; got 2 x 1");
    const Array1f three = Array1f::Dense::Ones(3), two = Array1f::Dense::Ones(2);
    EXPECT_EQ(message_of([&](MeshData& d) {
                  d.scalars = {{"heat", two}};
              }),
              "mesh array scalars['heat']: expected 3 rows, one per vertex, or 1, one per face, or none; got "
              "2 x 1");
    EXPECT_EQ(message_of([&](MeshData& d) {
                  d.scalars = {{"heat", three}, {"", three}};
              }),
              "mesh scalars: expected a name for array 1, got none");
    EXPECT_EQ(message_of([&](MeshData& d) {
                  d.scalars = {{"heat", three}, {"heat", three}};
              }),
              "mesh scalars: expected different names, got 'heat' for arrays 0 and 1");
}

TEST(Mesh, RefusesLabelsThatTheMapDoesNotHave) {
    const std::vector<LabelClass> classes{{0, "none", {}}, {10, "car", {}}};
    const auto with = [&](int32_t label, UnknownLabels unknown) {
        return message_of([&](MeshData& d) {
            d.L = Array1i(Array1i::Dense{{0}, {10}, {label}});
            d.label_map = std::make_shared<const LabelMap>("cars", classes, 0, unknown);
        });
    };
    EXPECT_EQ(with(10, UnknownLabels::refused), "valid");
    EXPECT_EQ(with(no_label, UnknownLabels::refused), "valid");
    EXPECT_EQ(with(11, UnknownLabels::unlabelled), "valid");
    EXPECT_EQ(
        with(11, UnknownLabels::refused),
        "mesh array L: label 11 in row 2 of 3 is not in the label map 'cars', which has 2 labels from 0 "
        "to 10; add it, or let the map show unknown labels as unlabelled");
    EXPECT_EQ(
        with((3 << 16) + 10, UnknownLabels::refused),
        "mesh array L: label 196618 in row 2 of 3 is not in the label map 'cars', which has 2 labels from 0 "
        "to 10; its lower 16 bits are 'car' (10): take labels & 0xFFFF");
    // Either can be assigned last: what does not fit then is refused.
    Mesh mesh(triangle());
    mesh.set_L(Array1i(Array1i::Dense{{0}, {1}, {2}}));
    EXPECT_THROW(mesh.set_label_map(LabelMap("cars", classes)), ArgumentError);
    EXPECT_FALSE(mesh.label_map());
    mesh.set_labels(Array1i(Array1i::Dense{{0}, {0}, {10}}),
                    std::make_shared<const LabelMap>("cars", classes));
    EXPECT_THROW(mesh.set_L(Array1i(Array1i::Dense{{0}, {1}, {2}})), ArgumentError);
    EXPECT_EQ(mesh.L()(2), 10);
}

TEST(Mesh, KeepsScalarsByName) {
    Mesh mesh(triangle());
    mesh.add_scalar("heat", Array1f(Array1f::Dense::Constant(3, 1)));
    mesh.add_scalar("area", Array1f(Array1f::Dense::Constant(1, 2)));
    mesh.add_scalar("heat", Array1f(Array1f::Dense::Constant(3, 5)));
    EXPECT_EQ(mesh.snapshot()->scalars.size(), 2u);
    EXPECT_EQ(mesh.scalar("heat")(0), 5);
    try {
        mesh.scalar("hat");
        FAIL();
    } catch (const NameError& error) {
        EXPECT_STREQ(error.what(), "mesh '' has no scalars 'hat' (did you mean 'heat'?); it has heat, area");
    }
    mesh.remove_scalar("heat");
    EXPECT_THROW(mesh.scalar("heat"), NameError);
    EXPECT_THROW(mesh.remove_scalar("heat"), NameError);
    EXPECT_EQ(mesh.scalar("area")(0), 2);
}

TEST(Mesh, AddsAllScalarsOrNone) {
    Mesh mesh(triangle());
    const Array1f ones(Array1f::Dense::Constant(3, 1)), twos(Array1f::Dense::Constant(3, 2));
    mesh.edit([&](MeshData& data) { data.scalars = {ScalarArray{"heat", ones, true}}; });
    const ScalarArray heat{"heat", twos}, area{"area", twos}, bad{"bad", Array1f(Array1f::Dense::Zero(7, 1))};
    EXPECT_THROW(mesh.add_scalars({heat, area, bad}), ArgumentError);
    ASSERT_EQ(mesh.snapshot()->scalars.size(), 1u);
    EXPECT_EQ(mesh.scalar("heat")(0), 1);
    mesh.add_scalars({heat, area});
    ASSERT_EQ(mesh.snapshot()->scalars.size(), 2u);
    EXPECT_EQ(mesh.scalar("heat")(0), 2);
    EXPECT_TRUE(mesh.snapshot()->scalars[0].from_file) << "only its values are replaced";
    EXPECT_EQ(mesh.scalar("area")(0), 2);
}

TEST(Mesh, FindsTheFirstBadRowOfMany) {
    // The scan runs in parallel chunks; the row reported is the first one all the same.
    Faces F = Faces::Zero(300000, 3);
    F(299999, 0) = F(150000, 2) = F(70001, 1) = 9;
    EXPECT_NE(message_of([&](MeshData& d) { d.F = F; }).find("row 70001 of 300000"), std::string::npos);
}

TEST(Mesh, StaysAsItWasWhenAnEditFails) {
    Mesh mesh(triangle());
    const auto before = mesh.snapshot();
    EXPECT_THROW(mesh.set_F(Faces{{0, 1, 3}}), ArgumentError);
    EXPECT_THROW(mesh.set_V(Positions(Positions::Zero(2, 3))),
                 ArgumentError);  // F now refers to a missing vertex
    EXPECT_EQ(mesh.snapshot(), before);
    mesh.set_V(Positions(Positions::Ones(3, 3)));
    EXPECT_EQ(before->V(1, 1), 0);
    EXPECT_EQ(mesh.V()(1, 1), 1);
    EXPECT_NE(mesh.V().revision(), before->V.revision());
    EXPECT_EQ(mesh.F().revision(), before->F.revision());
}

TEST(Mesh, RefusesStylesOutOfTheirRanges) {
    Mesh mesh(triangle());
    const auto before = mesh.snapshot();
    const auto told = [&](auto&& change) -> std::string {
        try {
            mesh.edit([&](MeshData& data) { change(data.style); });
        } catch (const ArgumentError& error) {
            return error.what();
        }
        return "valid";
    };
    EXPECT_EQ(
        told([](Style& style) { style.color_steps = 257; }),
        "mesh '': style.color_steps: expected a whole number from 0 to 256, or 'auto' or 'follow', got 257");
    EXPECT_NE(told([](Style& style) { style.point_size = -1.0f; }).find("style.point_size"),
              std::string::npos);
    EXPECT_NE(told([](Style& style) { style.nan_color = Vec3(0, 0, 2); }).find("style.nan_color"),
              std::string::npos);
    EXPECT_EQ(mesh.snapshot(), before);
    EXPECT_EQ(told([](Style& style) { style.color_steps = 256; }), "valid");
    Style thin;
    thin.line_width = 0.0f;
    EXPECT_THROW(mesh.set_style(thin), ArgumentError);
    MeshData data = triangle();
    data.style = thin;
    EXPECT_THROW(Mesh{data}, ArgumentError);
}

TEST(Mesh, LosesNoEditOfTwoThreads) {
    Mesh mesh(triangle());
    const auto count_up = [&] {
        for (int i = 0; i < 2000; ++i) mesh.edit([](MeshData& d) { d.name += "x"; });
    };
    std::thread other(count_up);
    count_up();
    other.join();
    EXPECT_EQ(mesh.name().size(), 4000u);
}

TEST(Mesh, MayBeReadWhileItIsEdited) {
    Mesh mesh(triangle());
    mesh.edit([&](MeshData& d) { d.V = Positions(2 * mesh.V()); });
    EXPECT_EQ(mesh.V()(1, 0), 2);
}

TEST(Mesh, HandlesShareAndClonesDoNot) {
    Mesh mesh(triangle()), child(triangle());
    mesh.add_child(child);
    const Mesh handle = mesh, copy = mesh.clone();
    EXPECT_TRUE(handle == mesh);
    EXPECT_FALSE(copy == mesh);
    EXPECT_EQ(copy.V().data(), mesh.V().data());
    child.edit([](MeshData& d) { d.name = "renamed"; });
    EXPECT_EQ(handle.snapshot()->children[0].name(), "renamed");
    EXPECT_EQ(copy.snapshot()->children[0].name(), "");
}

TEST(Mesh, ChildrenAreAVector) {
    const Mesh a(triangle()), b(triangle());
    MeshData data;
    data.children = {a, b};
    const std::vector<Mesh> both = data.children;
    EXPECT_EQ(both, std::vector({a, b}));
    data.children = {b};
    data.children.push_back(a);
    EXPECT_EQ(data.children, std::vector({b, a}));
    data.children = both;
    EXPECT_EQ(data.children, both);
    MeshData moved = std::move(data);
    EXPECT_EQ(moved.children, both);
    moved.children = {};
    EXPECT_TRUE(moved.children.empty());
}

TEST(Mesh, HasMaterials) {
    Mesh mesh(triangle());
    EXPECT_EQ(mesh.material().base_color, Material{}.base_color);
    EXPECT_THROW(mesh.material(1), NameError);
    EXPECT_THROW(mesh.set_material({}, 1), NameError);
    Material red;
    red.base_color = Vec3(1, 0, 0);
    mesh.set_material(red);
    EXPECT_EQ(mesh.material().base_color, Vec3(1, 0, 0));
    EXPECT_THROW(mesh.material(-1), NameError);
}

TEST(Mesh, CannotContainItself) {
    Mesh a(triangle()), b(triangle());
    a.add_child(b);
    EXPECT_THROW(a.add_child(a), ArgumentError);
    EXPECT_THROW(b.add_child(a), ArgumentError);
    EXPECT_THROW(b.edit([&](MeshData& d) { d.children = {a}; }), ArgumentError);
    EXPECT_THROW(b.edit([&](MeshData& d) { d.children = {b}; }), ArgumentError);
    EXPECT_TRUE(b.children().empty());
}

TEST(Mesh, ComposesPosesFromParentToChild) {
    Mesh parent(triangle()), child(triangle());
    parent.set_T_parent_mesh(Eigen::Affine3d(Eigen::Scaling(2.0)));
    child.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(1, 0, 0)));
    parent.add_child(child);
    std::vector<Vec3d> origins;
    for_each_node(parent,
                  [&](const auto&, const Eigen::Affine3d& T) { origins.push_back(T * Vec3d(0, 0, 0)); });
    ASSERT_EQ(origins.size(), 2u);
    EXPECT_EQ(origins[1], Vec3d(2, 0, 0));
}

}  // namespace easypbr::mesh_test
