#include <gtest/gtest.h>

#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "easypbr/core/log.h"
#include "easypbr/io/image/image_io.h"
#include "easypbr/io/mesh/assimp/assimp_loader.h"
#include "easypbr/io/mesh/mesh_io.h"
#include "easypbr/scene/mesh.h"
#include "io/assimp_files.h"
#include "io/temporary_folder.h"

#ifdef EASYPBR_HAS_ASSIMP
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <assimp/Importer.hpp>
#endif

namespace easypbr::assimp_test {

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

/// The same with a texture of that name.
std::string textured(const std::string& image) {
    std::string text(dae);
    const auto replace = [&](std::string_view from, const std::string& to) {
        text.replace(text.find(from), from.size(), to);
    };
    replace("<library_effects>", "<library_images><image id=\"i\"><init_from>" + image +
                                     "</init_from></image></library_images><library_effects>");
    replace("<technique sid=\"t\">",
            "<newparam sid=\"f\"><surface type=\"2D\"><init_from>i</init_from></surface></newparam>"
            "<newparam sid=\"s\"><sampler2D><source>f</source></sampler2D></newparam><technique sid=\"t\">");
    replace("<color>0.25 0.5 0.75 1</color>", "<texture texture=\"s\" texcoord=\"UV\"/>");
    return text;
}

Image checkerboard() {
    Image image(4, 2, 3, PixelType::u8);
    for (size_t i = 0; i < image.bytes().size(); ++i) image.bytes()[i] = std::byte(37 * i);
    return image;
}

}  // namespace

class AssimpLoader : public testing::Test {
  protected:
    void SetUp() override {
#ifndef EASYPBR_HAS_ASSIMP
        GTEST_SKIP() << "left out: built without the assimp reader";
#endif
        ASSERT_FALSE(io::assimp_extensions().empty()) << "the assimp reader does not answer";
    }
    const TemporaryFolder folder;
};

TEST_F(AssimpLoader, ReadsColladaWithHierarchyAndMaterial) {
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

TEST_F(AssimpLoader, ReadsAc3d) {
    write_file(folder / "a.ac", ac3d_file);
    const auto [data, T] = first_surface(io::load_assimp(folder / "a.ac").mesh);
    ASSERT_TRUE(data);
    EXPECT_EQ(data->V.rows(), 3);
    EXPECT_EQ(data->F.rows(), 1);
    EXPECT_EQ(data->materials.at(0).base_color, Vec3(0, 1, 0));
    const Vec3d corner = T * Vec3d(data->V.row(0).transpose().cast<double>());
    EXPECT_LT((corner - Vec3d(0, 0, 5)).norm(), 1e-6);
}

TEST_F(AssimpLoader, KnowsItsExtensions) {
    const auto extensions = io::assimp_extensions();
    for (const char* wanted : {"fbx", "dae", "3ds"})
        EXPECT_NE(std::find(extensions.begin(), extensions.end(), wanted), extensions.end()) << wanted;
}

TEST_F(AssimpLoader, RefusesBadInput) {
    EXPECT_THROW(io::load_assimp(folder / "missing.dae"), FileError);
    write_file(folder / "empty.dae", std::string_view());
    EXPECT_THROW(io::load_assimp(folder / "empty.dae"), FormatError);
    write_file(folder / "half.dae", dae.substr(0, dae.size() / 2));
    EXPECT_THROW(io::load_assimp(folder / "half.dae"), FormatError);
    write_file(folder / "a.unheard", std::string_view("text"));
    EXPECT_THROW(io::load_assimp(folder / "a.unheard"), FormatError);
}

TEST_F(AssimpLoader, ReadsTexturesBesideTheFile) {
    io::save_image(checkerboard(), folder / "a.png");
    write_file(folder / "a.dae", textured("a.png"));
    const auto [data, T] = first_surface(io::load_assimp(folder / "a.dae").mesh);
    ASSERT_TRUE(data);
    const Texture& texture = data->materials.at(0).base_color_texture;
    ASSERT_TRUE(texture);
    EXPECT_EQ(texture.path, (folder / "a.png").string());
    EXPECT_EQ(compare(*texture.image, checkerboard()).different, 0u);
}

TEST_F(AssimpLoader, LogsATextureThatIsMissing) {
    write_file(folder / "a.dae", textured("gone.png"));
    std::string messages;
    set_log_sink([&](LogLevel level, std::string_view message) {
        if (level == LogLevel::warning) messages += message;
    });
    const auto [data, T] = first_surface(io::load_assimp(folder / "a.dae").mesh);
    set_log_sink({});
    EXPECT_NE(messages.find("gone.png"), std::string::npos) << messages;
    EXPECT_FALSE(data->materials.at(0).base_color_texture);
}

// Our own GLB has its images within; assimp reads it too.
TEST_F(AssimpLoader, ReadsTexturesWithinTheFile) {
    MeshData data;
    data.V = Array3f::Dense{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    data.UV = Array2f::Dense{{0, 0}, {1, 0}, {0, 1}};
    data.F = Array3i::Dense{{0, 1, 2}};
    data.materials.resize(1);
    data.materials[0].base_color_texture.image = std::make_shared<const Image>(checkerboard());
    io::save_mesh(Mesh(std::move(data)), folder / "a.glb");
    const auto [read, T] = first_surface(io::load_assimp(folder / "a.glb").mesh);
    ASSERT_TRUE(read);
    const Texture& texture = read->materials.at(0).base_color_texture;
    ASSERT_TRUE(texture);
    EXPECT_EQ(compare(*texture.image, checkerboard()).different, 0u);
}

TEST_F(AssimpLoader, ReadsFromTheCurrentFolder) {
    write_file(folder / "a.ac", ac3d_file);
    const fs::path before = fs::current_path();
    fs::current_path(folder.path());
    EXPECT_NO_THROW(io::load_assimp("a.ac"));
    fs::current_path(before);
}

#ifdef EASYPBR_HAS_ASSIMP
namespace {

/// What the reader must answer for a node, straight from assimp.
void expect_same(const aiScene& scene, const aiNode& node, const Mesh& mesh) {
    const auto data = mesh.snapshot();
    EXPECT_EQ(data->name, node.mName.C_Str());
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 4; ++column)
            EXPECT_EQ(float(data->T_parent_mesh.matrix()(row, column)),
                      node.mTransformation[unsigned(row)][unsigned(column)]);
    Eigen::Index vertex = 0, face = 0;
    for (unsigned m = 0; m < node.mNumMeshes; ++m) {
        const aiMesh& from = *scene.mMeshes[node.mMeshes[m]];
        ASSERT_LE(vertex + from.mNumVertices, data->V.rows());
        ASSERT_LE(face + from.mNumFaces, data->F.rows());
        EXPECT_EQ(data->parts.at(m).name, from.mName.C_Str());
        EXPECT_EQ(data->materials.at(size_t(data->parts.at(m).material)).name,
                  scene.mMaterials[from.mMaterialIndex]->GetName().C_Str());
        for (unsigned f = 0; f < from.mNumFaces; ++f, ++face)
            for (int k = 0; k < 3; ++k)
                ASSERT_EQ(data->F(face, k), int(vertex) + int(from.mFaces[f].mIndices[k]));
        for (unsigned i = 0; i < from.mNumVertices; ++i, ++vertex)
            for (unsigned k = 0; k < 3; ++k) {
                ASSERT_EQ(data->V(vertex, k), from.mVertices[i][k]);
                if (from.HasNormals()) {
                    ASSERT_EQ(data->N(vertex, k), from.mNormals[i][k]);
                }
                if (from.HasTextureCoords(0) && k < 2) {
                    ASSERT_EQ(data->UV(vertex, k), from.mTextureCoords[0][i][k]);
                }
                if (from.HasVertexColors(0)) {
                    ASSERT_EQ(data->C(vertex, k), from.mColors[0][i][k]);
                }
            }
    }
    EXPECT_EQ(data->V.rows(), vertex);
    EXPECT_EQ(data->F.rows(), face);
    ASSERT_EQ(data->children.size(), node.mNumChildren);
    for (unsigned i = 0; i < node.mNumChildren; ++i)
        expect_same(scene, *node.mChildren[i], data->children[i]);
}

/// A mesh with all arrays, and a child with another material.
Mesh rich_mesh() {
    MeshData child;
    child.name = "child";
    child.V = Array3f::Dense{{0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}};
    child.F = Array3i::Dense{{0, 1, 2}, {2, 1, 3}};
    child.T_parent_mesh.translation() = Vec3d(1, 2, 3);
    child.materials.resize(1);
    child.materials[0].name = "second";
    MeshData data;
    data.name = "root";
    data.V = Array3f::Dense{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    data.N = Array3f::Dense{{0, 0, 1}, {0, 0.6f, 0.8f}, {0.6f, 0, 0.8f}};
    data.UV = Array2f::Dense{{0, 0}, {0.25f, 0}, {0, 0.5f}};
    ArrayXf::Dense colors(3, 4);
    colors << 1, 0, 0, 1, 0, 0.5f, 0, 1, 0, 0, 1, 0.5f;
    data.C = std::move(colors);
    data.F = Array3i::Dense{{0, 1, 2}};
    data.materials.resize(1);
    data.materials[0].name = "first";
    data.children = {Mesh(std::move(child))};
    return Mesh(std::move(data));
}

}  // namespace

// assimp in this process is the oracle; every value has to come through the reader's as it is.
TEST_F(AssimpLoader, AnswersWhatAssimpReads) {
    write_file(folder / "a.dae", dae);
    write_file(folder / "b.ac", ac3d_file);
    io::save_mesh(rich_mesh(), folder / "c.glb");
    for (const char* name : {"a.dae", "b.ac", "c.glb"}) {
        SCOPED_TRACE(name);
        Assimp::Importer importer;
        const aiScene* scene = importer.ReadFile(
            (folder / name).string(),
            aiProcess_Triangulate | aiProcess_JoinIdenticalVertices | aiProcess_FindInvalidData);
        ASSERT_TRUE(scene) << importer.GetErrorString();
        const Mesh root = io::load_assimp(folder / name).mesh;
        ASSERT_EQ(root.snapshot()->children.size(), 1u);
        expect_same(*scene, *scene->mRootNode, root.snapshot()->children[0]);
    }
}
#endif

}  // namespace easypbr::assimp_test
