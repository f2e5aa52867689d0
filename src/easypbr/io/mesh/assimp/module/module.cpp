#include "easypbr/io/mesh/assimp/module/module.h"

#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <limits>
#include <map>

#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "easypbr/io/mesh/assimp/module/materials.h"
#include "easypbr/io/mesh/mesh_io.h"
#include "easypbr/scene/mesh.h"

namespace easypbr::io {
namespace {

constexpr unsigned steps =
    aiProcess_Triangulate | aiProcess_JoinIdenticalVertices | aiProcess_FindInvalidData;

class SceneConverter {
  public:
    SceneConverter(const aiScene& scene, const std::filesystem::path& path)
        : scene_(scene), materials_(assimp_materials(scene, path)) {}

    Mesh convert_node(const aiNode& node, int depth = 1) {
        require_mesh_depth(depth);
        MeshData data;
        data.name = node.mName.C_Str();
        const aiMatrix4x4& m = node.mTransformation;
        data.T_parent_mesh.matrix() << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4,
            0, 0, 0, 1;
        add_meshes(node, data);
        for (unsigned i = 0; i < node.mNumChildren; ++i)
            data.children.push_back(convert_node(*node.mChildren[i], depth + 1));
        return Mesh(std::move(data));
    }

  private:
    void add_meshes(const aiNode& node, MeshData& data) {
        std::vector<const aiMesh*> meshes;
        for (unsigned i = 0; i < node.mNumMeshes; ++i) meshes.push_back(scene_.mMeshes[node.mMeshes[i]]);
        add_vertices(meshes, data);
        std::vector<int32_t> faces, edges;
        std::map<unsigned, int> used;
        int32_t first = 0;
        for (const aiMesh* mesh : meshes) {
            const auto [material, is_new] =
                used.try_emplace(mesh->mMaterialIndex, int(data.materials.size()));
            if (is_new)
                data.materials.push_back(
                    mesh->mMaterialIndex < materials_.size() ? materials_[mesh->mMaterialIndex] : Material());
            MeshPart part{mesh->mName.C_Str(), int(faces.size() / 3), 0, material->second};
            add_elements(*mesh, first, faces, edges);
            part.face_count = int(faces.size() / 3) - part.first_face;
            if (part.face_count) data.parts.push_back(std::move(part));
            first += int32_t(mesh->mNumVertices);
        }
        data.F = Array3i(Eigen::Map<const Array3i::Dense>(faces.data(), Eigen::Index(faces.size() / 3), 3));
        data.E = Array2i(Eigen::Map<const Array2i::Dense>(edges.data(), Eigen::Index(edges.size() / 2), 2));
    }

    static void add_elements(const aiMesh& mesh, int32_t first, std::vector<int32_t>& faces,
                             std::vector<int32_t>& edges) {
        for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
            const aiFace& face = mesh.mFaces[f];
            std::vector<int32_t>* to = face.mNumIndices == 3   ? &faces
                                       : face.mNumIndices == 2 ? &edges
                                                               : nullptr;
            for (unsigned k = 0; to && k < face.mNumIndices; ++k) {
                if (face.mIndices[k] >= mesh.mNumVertices)
                    throw FormatError(fmt::format("mesh '{}' has index {} of {} vertices", mesh.mName.C_Str(),
                                                  face.mIndices[k], mesh.mNumVertices));
                to->push_back(first + int32_t(face.mIndices[k]));
            }
        }
    }

    static void add_vertices(const std::vector<const aiMesh*>& meshes, MeshData& data) {
        Eigen::Index count = 0;
        bool normals = true, uvs = false, colors = false;
        for (const aiMesh* mesh : meshes) {
            count += mesh->mNumVertices;
            normals = normals && mesh->HasNormals();
            uvs = uvs || mesh->HasTextureCoords(0);
            colors = colors || mesh->HasVertexColors(0);
        }
        if (count > std::numeric_limits<int32_t>::max()) throw FormatError("more than 2^31 vertices");
        if (count == 0) return;
        Array3f::Dense V(count, 3), N(normals ? count : 0, 3);
        Array2f::Dense UV = Array2f::Dense::Zero(uvs ? count : 0, 2);
        ArrayXf::Dense C = ArrayXf::Dense::Ones(colors ? count : 0, 4);
        Eigen::Index row = 0;
        for (const aiMesh* mesh : meshes)
            for (unsigned i = 0; i < mesh->mNumVertices; ++i, ++row) {
                V.row(row) << mesh->mVertices[i].x, mesh->mVertices[i].y, mesh->mVertices[i].z;
                if (normals) N.row(row) << mesh->mNormals[i].x, mesh->mNormals[i].y, mesh->mNormals[i].z;
                if (mesh->HasTextureCoords(0))
                    UV.row(row) << mesh->mTextureCoords[0][i].x, mesh->mTextureCoords[0][i].y;
                if (const aiColor4D* color = mesh->mColors[0])
                    C.row(row) << color[i].r, color[i].g, color[i].b, color[i].a;
            }
        data.V = std::move(V);
        if (normals) data.N = std::move(N);
        if (uvs) data.UV = std::move(UV);
        if (colors) data.C = C.cwiseMax(0.0f).cwiseMin(1.0f);
    }

    const aiScene& scene_;
    std::vector<Material> materials_;
};

}  // namespace
}  // namespace easypbr::io

using namespace easypbr;

void easypbr_assimp_load(const std::filesystem::path& path, io::LoadedScene& out) {
    check_readable(path);
    Assimp::Importer importer;
    const aiScene* scene = importer.ReadFile(path.string(), io::steps);
    if (!scene || !scene->mRootNode)
        throw FormatError(fmt::format("cannot read {}: {}", path.string(), importer.GetErrorString()));
    if (scene->mNumMeshes == 0)
        throw FormatError(fmt::format("cannot read {}: there is no mesh in it", path.string()));
    try {
        MeshData root;
        root.name = path.stem().string();
        root.source = path;
        root.children.push_back(io::SceneConverter(*scene, path).convert_node(*scene->mRootNode));
        out.mesh = Mesh(std::move(root));
    } catch (const Error& error) {
        throw FormatError(fmt::format("cannot read {}: {}", path.string(), error.what()));
    }
}

void easypbr_assimp_extensions(std::vector<std::string>& out) {
    std::string list;
    Assimp::Importer().GetExtensionList(list);
    for (size_t at = 0; at < list.size();) {
        const size_t end = std::min(list.find(';', at), list.size());
        if (end - at > 2) out.push_back(list.substr(at + 2, end - at - 2));
        at = end + 1;
    }
    std::sort(out.begin(), out.end());
}
