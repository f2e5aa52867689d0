#include "easypbr/io/mesh/gltf/gltf_reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "easypbr/core/error.h"
#include "easypbr/core/log.h"
#include "easypbr/io/mesh/gltf/gltf_animation.h"
#include "easypbr/io/mesh/gltf/gltf_document.h"
#include "easypbr/io/mesh/gltf/gltf_draco.h"
#include "easypbr/io/mesh/gltf/gltf_extensions.h"
#include "easypbr/io/mesh/gltf/gltf_instances.h"
#include "easypbr/io/mesh/gltf/gltf_materials.h"
#include "easypbr/io/mesh/gltf/gltf_mesh.h"
#include "easypbr/io/mesh/gltf/gltf_meshopt.h"
#include "easypbr/io/mesh/gltf/gltf_placed.h"
#include "easypbr/io/mesh/gltf/gltf_splats.h"
#include "easypbr/io/mesh/gltf/gltf_used_rows.h"
#include "easypbr/io/mesh/gltf/gltf_variants.h"
#include "easypbr/io/mesh/mesh_io.h"

namespace easypbr::io {
namespace {

constexpr std::string_view known_extensions[] = {khr_unlit,
                                                 khr_emissive_strength,
                                                 khr_clearcoat,
                                                 khr_sheen,
                                                 khr_specular,
                                                 khr_ior,
                                                 khr_transmission,
                                                 khr_volume,
                                                 khr_dispersion,
                                                 khr_iridescence,
                                                 khr_anisotropy,
                                                 "KHR_texture_transform",
                                                 "KHR_lights_punctual",
                                                 "KHR_mesh_quantization",
                                                 khr_variants,
                                                 khr_node_visibility,
                                                 khr_animation_pointer,
                                                 ext_mesh_gpu_instancing,
                                                 khr_draco,
                                                 ext_meshopt_compression,
                                                 ext_texture_webp,
                                                 khr_gaussian_splatting,
                                                 khr_splats_as_spz};

/// Names that a map does not have yet: of several of one name the second is "NAME 2".
class FreeNames {
  public:
    template <class Value>
    std::string free_name(const std::map<std::string, Value>& taken, const std::string& name) {
        if (!taken.contains(name)) return name;
        // Names are never given back: all numbers below are taken.
        int& number = next_number_.try_emplace(name, 2).first->second;
        std::string free;
        do free = fmt::format("{} {}", name, number++);
        while (taken.contains(free));
        return free;
    }

  private:
    std::map<std::string, int> next_number_;
};

class SceneReader {
  public:
    SceneReader(GltfDocument& document, const std::string& variant)
        : document_(document),
          materials_(document),
          pointers_(document, materials_),
          variants_(document, variant),
          shared_positions_(gltf_shared_positions(document)),
          meshes_(document.count("meshes")),
          lights_(read_gltf_lights(document)),
          cameras_(read_gltf_cameras(document)),
          visited_(document.count("nodes")) {}

    LoadedScene read() {
        require_extensions();
        warn_of_extensions();
        rig_ = read_gltf_rig(document_, pointers_);
        MeshData root;
        root.name = document_.path().stem().string();
        root.source = document_.path();
        root.up = Vec3d::UnitY();
        for (const size_t node : root_nodes())
            if (auto mesh = read_node(node, Eigen::Affine3d::Identity(), 1, Visibility::shown))
                root.children.push_back(*mesh);
        if (root.children.empty()) document_.fail("there is no mesh in its scene");
        out_.mesh = Mesh(std::move(root));
        out_.variants = variants_.names();
        if (rig_.nodes.empty()) return std::move(out_);
        const bool is_animated = !rig_.animations.empty();
        Animations animations(std::move(rig_));
        animations.put_at_rest();
        if (is_animated) out_.animations = std::move(animations);
        return std::move(out_);
    }

  private:
    /// Of a node with those above it; the greatest of them counts.
    enum class Visibility { shown, hidden_at_rest, hidden };

    /// The extensions of a list of the root that are not known.
    std::vector<std::string> unknown_extensions(const char* list) const {
        std::vector<std::string> unknown;
        const Json* names = member(document_.root(), list);
        if (!names || !names->is_array()) return unknown;
        for (const Json& entry : *names) {
            const std::string name = entry.is_string() ? entry.get<std::string>() : std::string();
            if (std::ranges::find(known_extensions, name) == std::end(known_extensions))
                unknown.push_back(name);
        }
        return unknown;
    }

    /// The glTF 2.0 specification, 3.12: what is required and not supported must fail.
    void require_extensions() const {
        const std::vector<std::string> unknown = unknown_extensions("extensionsRequired");
        if (unknown.empty()) return;
        document_.fail(
            fmt::format("it requires the extension {}, which is not supported: save it without; "
                        "supported are {}",
                        fmt::join(unknown, ", "), fmt::join(known_extensions, ", ")));
    }

    void warn_of_extensions() const {
        for (const std::string& name : unknown_extensions("extensionsUsed"))
            log_warning(fmt::format("{}: the extension {} is not known; it is drawn without",
                                    document_.path().string(), name));
    }

    std::vector<size_t> root_nodes() const {
        if (document_.count("scenes")) {
            const size_t scene = document_.optional_integer(document_.root(), "scene").value_or(0);
            return document_.integers(document_.item("scenes", scene), "nodes");
        }
        std::vector<bool> is_child(visited_.size(), false);
        for (size_t i = 0; i < is_child.size(); ++i)
            for (const size_t child : document_.integers(document_.item("nodes", i), "children"))
                if (child < is_child.size()) is_child[child] = true;
        std::vector<size_t> roots;
        for (size_t i = 0; i < is_child.size(); ++i)
            if (!is_child[i]) roots.push_back(i);
        return roots;
    }

    /// The node as a mesh; nothing when neither it nor what hangs below it has one.
    std::optional<Mesh> read_node(size_t index, const Eigen::Affine3d& T_world_parent, int depth,
                                  Visibility of_parent) {
        const Json& json = document_.item("nodes", index);
        if (visited_[index])
            document_.fail(fmt::format("nodes[{}] has two parents or is part of a circle", index));
        if (depth > max_mesh_depth - 1)
            document_.fail(fmt::format("nodes[{}] lies more than {} levels deep", index, max_mesh_depth - 1));
        visited_[index] = true;

        const auto mesh = document_.optional_integer(json, "mesh");
        const GltfMesh* source = mesh ? &mesh_of(*mesh) : nullptr;
        MeshData data = source ? source->data : MeshData();
        data.name =
            document_.text(json, "name", data.name.empty() ? fmt::format("node {}", index) : data.name);
        const auto copies = mesh ? read_gltf_instances(document_, json, index) : std::nullopt;
        if (copies)
            data = copied(*source, data.name, *copies);
        else if (source)
            add_children(*source, data);
        if (!is_visible(json)) data.style.visible = false;
        const Visibility visibility = std::max(of_parent, visibility_of(index));
        data.T_parent_mesh = pose_of(index);
        const Eigen::Affine3d T_world_node = T_world_parent * data.T_parent_mesh;
        add_camera(index, data.name, T_world_node);
        if (visibility != Visibility::hidden)
            add_light(index, data.name, T_world_node, visibility == Visibility::shown);
        for (const size_t child : document_.integers(json, "children"))
            if (auto below = read_node(child, T_world_node, depth + 1, visibility))
                data.children.push_back(*below);
        if (!mesh && data.children.empty()) return std::nullopt;
        const Mesh node(std::move(data));
        if (!rig_.nodes.empty()) animate(index, json, node, copies ? nullptr : source);
        if (rig_.animations.empty() || !copies) return node;
        const std::vector<Mesh> children = node.children();
        for (size_t i = 0; i < copies->size(); ++i) animate_materials(*source, children[i]);
        return node;
    }

    /// KHR_node_visibility; a parent that is not visible takes its children with it.
    bool is_visible(const Json& node) const {
        const Json* visibility = extension(node, khr_node_visibility);
        return !visibility || document_.boolean(*visibility, "visible", true);
    }

    Visibility visibility_of(size_t node) const {
        if (is_visible(document_.item("nodes", node))) return Visibility::shown;
        const bool changes = !rig_.animations.empty() && rig_.nodes[node].visible;
        return changes ? Visibility::hidden_at_rest : Visibility::hidden;
    }

    /// Handles of its own, which share the arrays.
    static void add_children(const GltfMesh& source, MeshData& data) {
        for (const GltfMesh& child : source.children) data.children.emplace_back(child.data);
    }

    /// A mesh without vertices, whose children are copies of a mesh; they share its arrays.
    static MeshData copied(const GltfMesh& source, const std::string& name,
                           const std::vector<Eigen::Affine3d>& poses) {
        MeshData out;
        out.name = name;
        for (const Eigen::Affine3d& pose : poses) {
            MeshData copy = source.data;
            copy.name = fmt::format("{} {}", name, out.children.size());
            copy.T_parent_mesh = pose;
            add_children(source, copy);
            out.children.emplace_back(std::move(copy));
        }
        return out;
    }

    /// Tells the animations, and the rest pose, which mesh is the node's. `source`: what it was read from.
    void animate(size_t index, const Json& json, const Mesh& mesh, const GltfMesh* source) {
        AnimationNode& node = rig_.nodes[index];
        node.mesh = mesh;
        if (!source) return;
        animate_materials(*source, mesh);
        node.deformation = source->deformation;
        node.weights = source->weights;
        if (const auto weights = document_.numbers(json, "weights", source->weights.size()))
            node.weights.assign(weights->begin(), weights->end());
        const std::vector<Mesh> children = mesh.children();
        for (size_t i = 0; i < source->children.size(); ++i)
            if (const Deformation& deformation = source->children[i].deformation; !deformation.empty())
                animate_part(index, children[i], deformation);
    }

    /// The same of a part of a node's mesh: it follows the node's joints, and its weights as they change.
    void animate_part(size_t of, const Mesh& part, const Deformation& deformation) {
        const int number = int(rig_.nodes.size());
        AnimationNode node;
        node.parent = int(of);
        node.mesh = part;
        node.skin = rig_.nodes[of].skin;
        node.weights = rig_.nodes[of].weights;
        node.deformation = deformation;
        rig_.nodes.push_back(std::move(node));
        for (Animation& animation : rig_.animations)
            for (size_t i = animation.channels.size(); i-- > 0;) {
                AnimationChannel channel = animation.channels[i];
                if (channel.property != AnimatedProperty::weights || channel.node != int(of)) continue;
                channel.node = number;
                animation.channels.push_back(std::move(channel));
            }
    }

    /// Tells the animations which materials of a mesh, and of its children, are those that they change.
    void animate_materials(const GltfMesh& source, const Mesh& mesh) {
        for (size_t place = 0; place < source.materials.size(); ++place)
            if (const auto animated =
                    source.materials[place] ? pointers_.animated(*source.materials[place]) : std::nullopt)
                rig_.materials[*animated].users.emplace_back(mesh, place);
        const std::vector<Mesh> children = mesh.children();
        for (size_t i = 0; i < source.children.size(); ++i)
            animate_materials(source.children[i], children[i]);
    }

    const GltfMesh& mesh_of(size_t index) {
        document_.item("meshes", index);
        auto& mesh = meshes_[index];
        if (mesh) return *mesh;
        // Meshes that differ in nothing but their names share their arrays.
        Json content = document_.item("meshes", index);
        content.erase("name");
        const auto [same, is_new] = first_of_.try_emplace(content.dump(), index);
        mesh = is_new ? read_gltf_mesh(document_, materials_, variants_, shared_positions_, index)
                      : *meshes_[same->second];
        mesh->data.name = document_.text(document_.item("meshes", index), "name");
        return *mesh;
    }

    Eigen::Affine3d pose_of(size_t index) const {
        const AnimationNode node = read_gltf_pose(document_, index);
        if (node.matrix) return *node.matrix;
        return Eigen::Translation3d(node.translation) * node.rotation * Eigen::Scaling(node.scale);
    }

    /// Named after its node, as viewers show it, else after the camera itself.
    void add_camera(size_t node, const std::string& fallback, const Eigen::Affine3d& T_world_node) {
        const Json& json = document_.item("nodes", node);
        const auto index = gltf_camera_of_node(document_, json);
        if (!index) return;
        const std::string own = document_.text(json, "name", "");
        const std::string name = camera_names_.free_name(
            out_.cameras, own.empty() ? gltf_camera_name(document_, *index, fallback) : own);
        const AnimatedItem<Camera>& camera = cameras_[*index];
        out_.cameras.emplace(name, camera.value(camera.parameters, T_world_node));
        if (!rig_.animations.empty()) rig_.cameras[*index].users.emplace_back(name, int(node));
    }

    /// One that is not visible, but may become so, has no intensity.
    void add_light(size_t node, const std::string& fallback, const Eigen::Affine3d& T_world_node,
                   bool visible) {
        const auto index = gltf_light_of_node(document_, document_.item("nodes", node));
        if (!index) return;
        const std::string name =
            light_names_.free_name(out_.lights, gltf_light_name(document_, *index, fallback));
        Light light = lights_[*index].value(lights_[*index].parameters, T_world_node);
        if (!visible) light.intensity = 0;
        out_.lights.emplace(name, light);
        if (!rig_.animations.empty()) rig_.lights[*index].users.emplace_back(name, int(node));
    }

    GltfDocument& document_;
    GltfMaterials materials_;
    GltfMaterialPointers pointers_;
    GltfVariants variants_;
    std::set<size_t> shared_positions_;
    std::vector<std::optional<GltfMesh>> meshes_;
    std::map<std::string, size_t> first_of_;  ///< meshes, by their JSON without names
    std::vector<AnimatedItem<Light>> lights_;
    std::vector<AnimatedItem<Camera>> cameras_;
    FreeNames light_names_, camera_names_;
    AnimationRig rig_;
    std::vector<bool> visited_;
    LoadedScene out_;
};

}  // namespace

LoadedScene load_gltf(const std::filesystem::path& path, const std::string& variant) {
    const FileBytes file(path);
    LoadedScene scene = decode_gltf(file.bytes(), path, variant);
    file.check();
    return scene;
}

LoadedScene decode_gltf(std::span<const std::byte> bytes, const std::filesystem::path& path,
                        const std::string& variant) {
    try {
        GltfDocument document(bytes, path);
        LoadedScene scene = SceneReader(document, variant).read();
        document.check_files();
        return scene;
    } catch (const ArgumentError& error) {
        throw FormatError(fmt::format("cannot read {}: {}", path.string(), error.what()));
    } catch (const Json::exception& error) {
        throw FormatError(fmt::format("cannot read {}: {}", path.string(), error.what()));
    }
}

}  // namespace easypbr::io
