#include <gtest/gtest.h>

#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "easypbr/io/mesh/assimp/assimp_loader.h"
#include "easypbr/io/mesh/mesh_io.h"
#include "easypbr/scene/mesh.h"
#include "io/temporary_folder.h"

using namespace easypbr;

namespace {

/// The first descendant with faces, and its pose in the world.
struct Found {
    std::shared_ptr<const MeshData> data;
    Eigen::Affine3d T_world_mesh;
};

Found first_surface(const Mesh& root) {
    Found found{};
    for_each_node(root, [&](const std::shared_ptr<const MeshData>& data, const Eigen::Affine3d& T) {
        if (!found.data && !data->F.empty()) found = {data, T};
    });
    return found;
}

constexpr std::string_view dae = R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
  <asset><up_axis>Y_UP</up_axis></asset>
  <library_effects><effect id="fx"><profile_COMMON><technique sid="t"><lambert>
    <diffuse><color>0.25 0.5 0.75 1</color></diffuse></lambert></technique></profile_COMMON></effect></library_effects>
  <library_materials><material id="blue" name="blue"><instance_effect url="#fx"/></material></library_materials>
  <library_geometries><geometry id="g" name="quad"><mesh>
    <source id="p"><float_array id="pa" count="12">0 0 0 1 0 0 1 1 0 0 1 0</float_array>
      <technique_common><accessor source="#pa" count="4" stride="3">
        <param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/>
      </accessor></technique_common></source>
    <vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
    <polylist count="1" material="m"><input semantic="VERTEX" source="#v" offset="0"/>
      <vcount>4</vcount><p>0 1 2 3</p></polylist>
  </mesh></geometry></library_geometries>
  <library_visual_scenes><visual_scene id="s"><node id="n" name="moved">
    <translate>1 2 3</translate>
    <instance_geometry url="#g"><bind_material><technique_common>
      <instance_material symbol="m" target="#blue"/></technique_common></bind_material></instance_geometry>
  </node></visual_scene></library_visual_scenes>
  <scene><instance_visual_scene url="#s"/></scene>
</COLLADA>)";

constexpr std::string_view ac3d = R"(AC3Db
MATERIAL "green" rgb 0 1 0  amb 0 0 0  emis 0 0 0  spec 0 0 0  shi 10  trans 0
OBJECT world
kids 1
OBJECT poly
name "tri"
loc 0 0 5
numvert 3
0 0 0
1 0 0
0 1 0
numsurf 1
SURF 0x0
mat 0
refs 3
0 0 0
1 1 0
2 0 1
kids 0
)";

}  // namespace

class Assimp : public testing::Test {
  protected:
    void SetUp() override {
        if (io::assimp_extensions().empty()) GTEST_SKIP() << "left out: built without the assimp module";
    }
    const TemporaryFolder folder;
};

TEST_F(Assimp, ReadsColladaWithHierarchyAndMaterial) {
    write_file(folder / "a.dae", dae);
    const io::LoadedScene scene = io::load_assimp(folder / "a.dae");
    EXPECT_EQ(scene.mesh.name(), "a");
    const auto [data, T] = first_surface(scene.mesh);
    ASSERT_TRUE(data);
    // One quad makes two triangles.
    EXPECT_EQ(data->V.rows(), 4);
    EXPECT_EQ(data->F.rows(), 2);
    EXPECT_LT((T.translation() - Vec3d(1, 2, 3)).norm(), 1e-6);
    ASSERT_EQ(data->materials.size(), 1u);
    EXPECT_EQ(data->materials[0].name, "blue");
    EXPECT_EQ(data->materials[0].base_color, Vec3(0.25f, 0.5f, 0.75f));
}

TEST_F(Assimp, ReadsAc3d) {
    write_file(folder / "a.ac", ac3d);
    const auto [data, T] = first_surface(io::load_assimp(folder / "a.ac").mesh);
    ASSERT_TRUE(data);
    EXPECT_EQ(data->V.rows(), 3);
    EXPECT_EQ(data->F.rows(), 1);
    EXPECT_EQ(data->materials.at(0).base_color, Vec3(0, 1, 0));
    const Vec3d corner = T * Vec3d(data->V.row(0).transpose().cast<double>());
    EXPECT_LT((corner - Vec3d(0, 0, 5)).norm(), 1e-6);
}

TEST_F(Assimp, KnowsItsExtensions) {
    const auto extensions = io::assimp_extensions();
    for (const char* wanted : {"fbx", "dae", "3ds"})
        EXPECT_NE(std::find(extensions.begin(), extensions.end(), wanted), extensions.end()) << wanted;
}

TEST_F(Assimp, RefusesBadInput) {
    EXPECT_THROW(io::load_assimp(folder / "missing.dae"), FileError);
    write_file(folder / "empty.dae", std::string_view());
    EXPECT_THROW(io::load_assimp(folder / "empty.dae"), FormatError);
    write_file(folder / "half.dae", dae.substr(0, dae.size() / 2));
    EXPECT_THROW(io::load_assimp(folder / "half.dae"), FormatError);
    write_file(folder / "a.unheard", std::string_view("text"));
    EXPECT_THROW(io::load_assimp(folder / "a.unheard"), FormatError);
}
