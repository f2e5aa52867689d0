#include "easypbr/io/mesh/gltf/gltf_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "easypbr/io/mesh/gltf/gltf_mesh_builder.h"
#include "easypbr/io/mesh/gltf/gltf_splats.h"

namespace easypbr::io {
namespace {

GltfKind kind_of(GltfMode mode) {
    return mode >= GltfMode::triangles ? GltfKind::faces
           : mode == GltfMode::points  ? GltfKind::points
                                       : GltfKind::lines;
}

/// What EasyPBR wrote in the extras of an object; null: nothing.
const Json* own_extra(const Json& object, const char* key) {
    const Json* extras = member(object, "extras");
    return extras && extras->is_object() ? member(*extras, key) : nullptr;
}

/// Whether a primitive of lines is E of a mesh with faces, as EasyPBR wrote it: faces are drawn without.
bool has_edges_of_faces(const Json& primitive) {
    return own_extra(primitive, gltf_edges_of_faces) != nullptr;
}

/// 0: the mesh is no voxels.
float gltf_voxel_size_of(const Json& mesh) {
    const Json* size = own_extra(mesh, gltf_voxel_size);
    const float value = size && size->is_number() ? size->get<float>() : 0;
    return value > 0 && std::isfinite(value) ? value : 0;
}

/// Reads a mesh as one for each group of its primitives.
class MeshReader {
  public:
    MeshReader(GltfDocument& document, const GltfMaterials& materials, const GltfVariants& variants,
               const std::set<size_t>& shared_positions, size_t index)
        : document_(document),
          materials_(materials),
          variants_(variants),
          shared_positions_(shared_positions),
          source_{document.item("meshes", index), fmt::format("meshes[{}]", index)} {}

    GltfMesh read() {
        const Json* primitives = member(source_.json, "primitives");
        if (!primitives || !primitives->is_array() || primitives->empty()) fail("has no primitives");
        has_faces_ = std::ranges::any_of(*primitives, [&](const Json& primitive) {
            return document_.optional_integer(primitive, "mode").value_or(size_t(GltfMode::triangles)) >=
                   size_t(GltfMode::triangles);
        });
        source_.target_count = target_count(*primitives);
        for (const Json& primitive : *primitives) add(primitive);
        std::stable_partition(groups_.begin(), groups_.end(),
                              [](const GltfPrimitiveGroup& group) { return group.kind == GltfKind::faces; });
        const std::string name = document_.text(source_.json, "name");
        const float voxel_size = gltf_voxel_size_of(source_.json);
        if (groups_.empty() && splats_.size() == 1) {
            splats_[0].data.name = name;
            splats_[0].data.voxel_size = voxel_size;
            return std::move(splats_[0]);
        }
        GltfMesh mesh;
        if (!groups_.empty()) mesh = build(groups_[0]);
        mesh.data.name = name;
        mesh.data.voxel_size = voxel_size;
        for (GltfMesh& splats : splats_) add_child(mesh, "splats", std::move(splats));
        for (size_t i = 1; i < groups_.size(); ++i)
            add_child(mesh, groups_[i].kind == GltfKind::lines ? "lines" : "points", build(groups_[i]));
        return mesh;
    }

  private:
    [[noreturn]] void fail(const std::string& what) const { document_.fail(source_.name + " " + what); }

    static size_t target_count(const Json& primitives) {
        size_t count = 0;
        for (const Json& primitive : primitives)
            if (const Json* targets = member(primitive, "targets"); targets && targets->is_array())
                count = std::max(count, targets->size());
        return count;
    }

    void add(const Json& json) {
        const Json* attributes = member(json, "attributes");
        if (!attributes || !member(*attributes, "POSITION")) fail("has a primitive without POSITION");
        if (has_gltf_splats(json)) {
            splats_.push_back({read_gltf_splats(document_, json, source_.name), {}, {}, {}, {}});
            return;
        }
        const size_t mode = document_.optional_integer(json, "mode").value_or(size_t(GltfMode::triangles));
        if (mode > size_t(GltfMode::triangle_fan))
            fail(fmt::format("has a primitive of unknown mode {}", mode));
        const bool is_part_of_faces =
            kind_of(GltfMode(mode)) == GltfKind::lines && has_faces_ && has_edges_of_faces(json);
        const GltfPrimitive primitive{&json, GltfMode(mode),
                                      is_part_of_faces ? GltfKind::faces : kind_of(GltfMode(mode)),
                                      variants_.material_of(json)};
        // Faces of all materials are one mesh.
        const bool is_face = primitive.kind == GltfKind::faces;
        const auto [group, is_new] = group_of_.try_emplace(
            {primitive.kind, is_face ? std::nullopt : primitive.material}, groups_.size());
        if (is_new) groups_.push_back({primitive.kind, {}});
        groups_[group->second].primitives.push_back(primitive);
    }

    GltfMesh build(const GltfPrimitiveGroup& group) {
        return build_gltf_mesh(document_, materials_, shared_positions_, source_, group);
    }

    static void add_child(GltfMesh& mesh, const char* what, GltfMesh child) {
        child.data.name = fmt::format("{} {}", what, mesh.children.size());
        mesh.children.push_back(std::move(child));
    }

    GltfDocument& document_;
    const GltfMaterials& materials_;
    const GltfVariants& variants_;
    const std::set<size_t>& shared_positions_;
    GltfMeshSource source_;
    bool has_faces_ = false;
    std::vector<GltfPrimitiveGroup> groups_;
    /// Places in groups_ as they are added, by kind and, of lines and points, material.
    std::map<std::pair<GltfKind, std::optional<size_t>>, size_t> group_of_;
    std::vector<GltfMesh> splats_;
};

}  // namespace

GltfMesh read_gltf_mesh(GltfDocument& document, const GltfMaterials& materials, const GltfVariants& variants,
                        const std::set<size_t>& shared_positions, size_t index) {
    return MeshReader(document, materials, variants, shared_positions, index).read();
}

}  // namespace easypbr::io
