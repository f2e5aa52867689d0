#include "easypbr/scene/scene.h"

#include <fmt/format.h>

#include <limits>
#include <optional>
#include <set>

#include "easypbr/core/error.h"
#include "easypbr/core/parallel.h"
#include "easypbr/core/recent_values.h"
#include "easypbr/core/suggest.h"
#include "easypbr/scene/draw_style.h"
#include "easypbr/scene/mesh.h"
#include "easypbr/scene/spacing.h"

namespace easypbr {
namespace {

/// In fewer points none is an outlier.
constexpr Eigen::Index least_cloud = 100;

constexpr size_t vertex_grain = 1 << 15;

/// Objects whose bounds are kept: 8 MB of them.
constexpr size_t most_known = 1 << 14;

template <class Map>
std::vector<std::string> keys_of(const Map& map) {
    std::vector<std::string> keys;
    for (const auto& entry : map) keys.push_back(entry.first);
    return keys;
}

template <class Map>
auto& require_entry(Map& map, const std::string& name, const char* kind) {
    const auto found = map.find(name);
    if (found == map.end())
        throw NameError(
            fmt::format("the scene has no {} '{}'{}", kind, name, did_you_mean(name, keys_of(map))));
    return found->second;
}

/// Adds the node and its descendants, with the poses of V + offset; what is invisible takes its descendants
/// along. Descendants that are shown under a name of their own are left to that name.
void add_nodes(const Mesh& mesh, const std::string& name, const std::string& root,
               const Eigen::Affine3d& T_world_parent, int depth, const std::set<uint64_t>& shown,
               std::vector<SceneSnapshot::Object>& objects) {
    require_mesh_depth(depth);
    const auto data = mesh.snapshot();
    if (!data->style.visible.value_or(true)) return;
    const Eigen::Affine3d T_world_mesh = T_world_parent * data->T_parent_mesh;
    objects.push_back({name, data, T_world_mesh, root, mesh.identity()});
    set_reach(objects.back(), {});
    for (const Mesh& child : data->children)
        if (!shown.count(child.identity()))
            add_nodes(child, name + "/" + child.name(), root, T_world_mesh, depth + 1, shown, objects);
}

/// The offset of the first node with vertices among objects[first..end).
std::optional<Vec3d> first_offset(const std::vector<SceneSnapshot::Object>& objects, size_t first,
                                  size_t end) {
    for (size_t i = first; i < end; ++i)
        if (!objects[i].mesh->V.empty()) return objects[i].mesh->offset;
    return {};
}

}  // namespace

namespace {

using Box3f = Eigen::AlignedBox3f;

using Directions = SceneSnapshot::Directions;
using Support = SceneSnapshot::Support;

bool has_outliers(const MeshData& mesh) {
    return mesh.F.empty() && mesh.E.empty() && mesh.V.rows() >= least_cloud;
}

/// Scans have points far away that nobody wants to see the rest shrink for.
Box3f without_outliers(const Array3f& V) {
    static RecentValues<uint64_t, Box3d> known(most_known);
    const Box3d box = known.get(V.revision(), [&] { return trimmed_bounds(V); });
    return Box3f(Vec3(box.min().cast<float>()), Vec3(box.max().cast<float>()));
}

Support support_of(const MeshData& mesh, const Directions& directions) {
    const Array3f& V = mesh.V;
    std::optional<Box3f> kept;  // nothing: all vertices count
    if (has_outliers(mesh)) kept = without_outliers(V);
    Support result = Support::Constant(-std::numeric_limits<double>::infinity());
    std::mutex mutex;
    parallel_chunks(size_t(V.rows()), vertex_grain, [&](size_t begin, size_t end) {
        Support best = Support::Constant(-std::numeric_limits<double>::infinity());
        for (Eigen::Index i = Eigen::Index(begin); i < Eigen::Index(end); ++i)
            if (!kept || kept->contains(Vec3(V.row(i))))
                best =
                    best.cwiseMax(directions.col(0) * double(V(i, 0)) + directions.col(1) * double(V(i, 1)) +
                                  directions.col(2) * double(V(i, 2)));
        // A maximum is the same in any order, so the result does not depend on which thread comes first.
        std::lock_guard lock(mutex);
        result = result.cwiseMax(best);
    });
    return result;
}

struct SupportKey {
    uint64_t vertices;
    bool trimmed;
    Directions directions;

    bool operator==(const SupportKey&) const = default;

    struct Hash {
        size_t operator()(const SupportKey& key) const {
            return std::hash<uint64_t>()(key.vertices) ^ std::hash<double>()(key.directions.sum());
        }
    };
};

}  // namespace

SceneSnapshot::Support SceneSnapshot::support(const Directions& directions) const {
    // The bounds of a scene are asked for in each frame.
    static RecentValues<SupportKey, Support, SupportKey::Hash> known(most_known);
    Support result = Support::Constant(-std::numeric_limits<double>::infinity());
    for (const Object& object : objects) {
        if (object.mesh->V.empty()) continue;
        const Directions local = directions * object.T_world_mesh.linear();
        const Support own = known.get({object.mesh->V.revision(), has_outliers(*object.mesh), local},
                                      [&] { return support_of(*object.mesh, local); });
        const Support beyond = object.half_voxel * local.cwiseAbs().rowwise().sum() +
                               object.point_radius * directions.rowwise().norm();
        result = result.cwiseMax(Support(own + beyond + directions * object.T_world_mesh.translation()));
    }
    return result;
}

Box3d SceneSnapshot::bounds() const {
    Directions axes;
    axes << Mat3d::Identity(), -Mat3d::Identity();
    const Support extent = support(axes);
    if (!extent.allFinite()) return {};
    return Box3d(Vec3d(-extent.tail<3>()), Vec3d(extent.head<3>()));
}

struct Scene::Shared {
    struct Entry {
        Mesh mesh;
        uint64_t order;  ///< rises with the time when the name was first shown
        bool hidden = false;
    };

    mutable std::mutex mutex;
    std::map<std::string, Entry> meshes;
    std::map<std::string, Light> lights;
    Environment environment;
    uint64_t next_order = 0;
    std::optional<Vec3d> origin;  ///< none: nothing has been drawn yet
};

Scene::Scene() : shared_(std::make_shared<Shared>()) {}

void Scene::show(const Mesh& mesh, const std::string& name) {
    std::lock_guard lock(shared_->mutex);
    const auto known = shared_->meshes.find(name);
    const uint64_t order = known == shared_->meshes.end() ? shared_->next_order++ : known->second.order;
    shared_->meshes.insert_or_assign(name, Shared::Entry{mesh, order});
}

Mesh Scene::get(const std::string& name) const {
    std::lock_guard lock(shared_->mutex);
    return require_entry(shared_->meshes, name, "mesh").mesh;
}

void Scene::remove(const std::string& name) {
    std::lock_guard lock(shared_->mutex);
    require_entry(shared_->meshes, name, "mesh");
    shared_->meshes.erase(name);
}

void Scene::hide(const std::string& name, bool hidden) {
    std::lock_guard lock(shared_->mutex);
    require_entry(shared_->meshes, name, "mesh").hidden = hidden;
}

void Scene::clear() {
    std::lock_guard lock(shared_->mutex);
    shared_->meshes.clear();
    shared_->lights.clear();
    shared_->environment = {};
    shared_->origin.reset();
}

std::vector<std::string> Scene::names() const {
    std::lock_guard lock(shared_->mutex);
    return keys_of(shared_->meshes);
}

bool Scene::contains(const std::string& name) const {
    std::lock_guard lock(shared_->mutex);
    return shared_->meshes.count(name) > 0;
}

void Scene::set_light(const std::string& name, const Light& light) {
    std::lock_guard lock(shared_->mutex);
    shared_->lights.insert_or_assign(name, light);
}

Light Scene::light(const std::string& name) const {
    std::lock_guard lock(shared_->mutex);
    return require_entry(shared_->lights, name, "light");
}

void Scene::remove_light(const std::string& name) {
    std::lock_guard lock(shared_->mutex);
    require_entry(shared_->lights, name, "light");
    shared_->lights.erase(name);
}

std::vector<std::string> Scene::light_names() const {
    std::lock_guard lock(shared_->mutex);
    return keys_of(shared_->lights);
}

void Scene::latch_light_radius(const std::string& name, float radius) {
    std::lock_guard lock(shared_->mutex);
    const auto found = shared_->lights.find(name);
    if (found != shared_->lights.end() && !found->second.radius.value()) found->second.radius.latch(radius);
}

void Scene::release_light_radii() {
    std::lock_guard lock(shared_->mutex);
    for (auto& [name, light] : shared_->lights) light.radius.release();
}

void Scene::set_environment(const Environment& environment) {
    std::lock_guard lock(shared_->mutex);
    shared_->environment = environment;
}

Environment Scene::environment() const {
    std::lock_guard lock(shared_->mutex);
    return shared_->environment;
}

Vec3d Scene::origin() const {
    return snapshot().origin;
}

void Scene::set_origin(const Vec3d& origin) {
    if (!origin.allFinite())
        throw ArgumentError(fmt::format("scene origin: expected finite numbers, got ({}, {}, {})", origin.x(),
                                        origin.y(), origin.z()));
    std::lock_guard lock(shared_->mutex);
    shared_->origin = origin;
}

SceneSnapshot Scene::snapshot() const {
    SceneSnapshot result;
    std::lock_guard lock(shared_->mutex);
    uint64_t earliest = std::numeric_limits<uint64_t>::max();
    std::optional<Vec3d> origin;
    std::set<uint64_t> shown;
    for (const auto& [name, entry] : shared_->meshes) shown.insert(entry.mesh.identity());
    for (const auto& [name, entry] : shared_->meshes) {
        if (entry.hidden) continue;
        const size_t first = result.objects.size();
        const std::optional<Mesh> parent = entry.mesh.parent();
        add_nodes(entry.mesh, name, name, parent ? parent->T_world_mesh() : Eigen::Affine3d::Identity(), 0,
                  shown, result.objects);
        const auto offset = first_offset(result.objects, first, result.objects.size());
        if (offset && entry.order < earliest) origin = offset, earliest = entry.order;
    }
    if (!shared_->origin) shared_->origin = origin;
    result.origin = shared_->origin.value_or(Vec3d::Zero());
    for (SceneSnapshot::Object& object : result.objects)
        object.T_world_mesh.translate(object.mesh->offset - result.origin);
    result.lights = shared_->lights;
    result.environment = shared_->environment;
    return result;
}

}  // namespace easypbr
