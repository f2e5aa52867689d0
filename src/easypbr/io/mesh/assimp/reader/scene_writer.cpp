#include "easypbr/io/mesh/assimp/reader/scene_writer.h"

#include <assimp/importerdesc.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <array>
#include <assimp/Importer.hpp>
#include <limits>
#include <map>
#include <stdexcept>
#include <string_view>

#include "easypbr/io/mesh/assimp/reader/material_writer.h"

namespace easypbr::io {
namespace {

constexpr unsigned steps =
    aiProcess_Triangulate | aiProcess_JoinIdenticalVertices | aiProcess_FindInvalidData;

struct Part {
    std::string name;
    int32_t first_face, faces, material;
};

/// What the faces of the meshes of a node become.
struct Elements {
    std::vector<int32_t> faces, edges;
    std::vector<Part> parts;
    std::vector<uint32_t> materials;
};

/// assimp fills the colours of an AMF file that has none with transparent black.
bool has_colors(const aiMesh& mesh) {
    const aiColor4D* const colors = mesh.mColors[0];
    return colors && std::any_of(colors, colors + mesh.mNumVertices,
                                 [](const aiColor4D& color) { return color != aiColor4D(0, 0, 0, 0); });
}

class SceneWriter {
  public:
    SceneWriter(const aiScene& scene, MessageWriter& out) : scene_(scene), out_(out) {}

    void write_node(const aiNode& node) {
        out_.put_text(node.mName.C_Str());
        const aiMatrix4x4& m = node.mTransformation;
        for (const auto value : {m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4})
            out_.put(float(value));
        std::vector<const aiMesh*> meshes;
        for (unsigned i = 0; i < node.mNumMeshes; ++i) meshes.push_back(scene_.mMeshes[node.mMeshes[i]]);
        write_vertices(meshes);
        write_elements(elements_of(meshes));
        out_.put_count(node.mNumChildren);
        for (unsigned i = 0; i < node.mNumChildren; ++i) write_node(*node.mChildren[i]);
    }

  private:
    static Elements elements_of(const std::vector<const aiMesh*>& meshes) {
        Elements out;
        std::map<unsigned, int32_t> used;
        int32_t first = 0;
        for (const aiMesh* mesh : meshes) {
            const auto [material, is_new] =
                used.try_emplace(mesh->mMaterialIndex, int32_t(out.materials.size()));
            if (is_new) out.materials.push_back(mesh->mMaterialIndex);
            Part part{mesh->mName.C_Str(), int32_t(out.faces.size() / 3), 0, material->second};
            add_elements(*mesh, first, out);
            part.faces = int32_t(out.faces.size() / 3) - part.first_face;
            if (part.faces) out.parts.push_back(std::move(part));
            first += int32_t(mesh->mNumVertices);
        }
        return out;
    }

    static void add_elements(const aiMesh& mesh, int32_t first, Elements& out) {
        for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
            const aiFace& face = mesh.mFaces[f];
            std::vector<int32_t>* to = face.mNumIndices == 3   ? &out.faces
                                       : face.mNumIndices == 2 ? &out.edges
                                                               : nullptr;
            for (unsigned k = 0; to && k < face.mNumIndices; ++k) {
                if (face.mIndices[k] >= mesh.mNumVertices)
                    throw std::runtime_error(std::string("mesh '") + mesh.mName.C_Str() + "' has index " +
                                             std::to_string(face.mIndices[k]) + " of " +
                                             std::to_string(mesh.mNumVertices) + " vertices");
                to->push_back(first + int32_t(face.mIndices[k]));
            }
        }
    }

    void write_elements(const Elements& elements) {
        write_indices(elements.faces, 3);
        write_indices(elements.edges, 2);
        out_.put_count(elements.materials.size());
        for (const uint32_t material : elements.materials) out_.put(material);
        out_.put_count(elements.parts.size());
        for (const Part& part : elements.parts) {
            out_.put_text(part.name);
            out_.put(std::array{part.first_face, part.faces, part.material});
        }
    }

    void write_indices(const std::vector<int32_t>& indices, size_t columns) {
        out_.put_count(indices.size() / columns);
        out_.put_bytes(indices.data(), indices.size() * sizeof(int32_t));
    }

    void write_vertices(const std::vector<const aiMesh*>& meshes) {
        uint64_t count = 0;
        bool normals = true, uvs = false, colors = false;
        for (const aiMesh* mesh : meshes) {
            count += mesh->mNumVertices;
            normals = normals && mesh->HasNormals();
            uvs = uvs || mesh->HasTextureCoords(0);
            colors = colors || has_colors(*mesh);
        }
        if (count > uint64_t(std::numeric_limits<int32_t>::max()))
            throw std::runtime_error("more than 2^31 vertices");
        out_.put_count(count);
        out_.put(uint8_t(normals * message_normals | uvs * message_uvs | colors * message_colors));
        for (const aiMesh* mesh : meshes) write_vectors(mesh->mVertices, mesh->mNumVertices);
        for (const aiMesh* mesh : meshes)
            if (normals) write_vectors(mesh->mNormals, mesh->mNumVertices);
        for (const aiMesh* mesh : meshes)
            if (uvs) write_uvs(*mesh);
        for (const aiMesh* mesh : meshes)
            if (colors) write_colors(*mesh);
    }

    void write_vectors(const aiVector3D* vectors, unsigned count) {
        for (unsigned i = 0; i < count; ++i)
            out_.put(std::array{float(vectors[i].x), float(vectors[i].y), float(vectors[i].z)});
    }

    /// Zeros for a mesh that has none beside one that has.
    void write_uvs(const aiMesh& mesh) {
        const aiVector3D* uvs = mesh.HasTextureCoords(0) ? mesh.mTextureCoords[0] : nullptr;
        for (unsigned i = 0; i < mesh.mNumVertices; ++i)
            out_.put(uvs ? std::array{float(uvs[i].x), float(uvs[i].y)} : std::array{0.0f, 0.0f});
    }

    /// White for a mesh that has none beside one that has.
    void write_colors(const aiMesh& mesh) {
        const aiColor4D* colors = has_colors(mesh) ? mesh.mColors[0] : nullptr;
        for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
            const aiColor4D color = colors ? colors[i] : aiColor4D(1, 1, 1, 1);
            out_.put(std::array{float(color.r), float(color.g), float(color.b), float(color.a)});
        }
    }

    const aiScene& scene_;
    MessageWriter& out_;
};

/// Whether the file that was read was a 3MF, whatever its name.
bool is_3mf(const Assimp::Importer& importer) {
    const int index = importer.GetPropertyInteger("importerIndex", -1);
    const aiImporterDesc* const description = index < 0 ? nullptr : importer.GetImporterInfo(size_t(index));
    return description &&
           std::string_view(description->mFileExtensions).find("3mf") != std::string_view::npos;
}

}  // namespace

void write_scene(const std::string& path, MessageWriter& out) {
    // Never freed: the process ends when the message is written, and freeing each face takes time.
    auto* importer = new Assimp::Importer;
    const aiScene* scene = importer->ReadFile(path, steps);
    if (!scene || !scene->mRootNode) throw std::runtime_error(importer->GetErrorString());
    if (scene->mNumMeshes == 0) throw std::runtime_error("there is no mesh in it");
    write_images(*scene, out);
    write_materials(*scene, is_3mf(*importer), out);
    SceneWriter(*scene, out).write_node(*scene->mRootNode);
}

void write_extensions(MessageWriter& out) {
    std::string list;
    Assimp::Importer().GetExtensionList(list);
    std::vector<std::string> extensions;
    for (size_t at = 0; at < list.size();) {
        const size_t end = std::min(list.find(';', at), list.size());
        if (end - at > 2) extensions.push_back(list.substr(at + 2, end - at - 2));
        at = end + 1;
    }
    std::sort(extensions.begin(), extensions.end());
    out.put_count(extensions.size());
    for (const std::string& extension : extensions) out.put_text(extension);
}

}  // namespace easypbr::io
