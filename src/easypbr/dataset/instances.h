// Which instance each pixel belongs to, and annotations of each.
#pragma once

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "easypbr/dataset/ground_truth.h"
#include "easypbr/dataset/surfaces.h"

namespace easypbr::dataset {

/// Which instance an object's part belongs to.
class InstanceTable {
  public:
    /// `classes` gives a semantic id to the objects of these names, and to their instances. Names of
    /// instances differ: what the scene shows keeps its own, others get a number.
    InstanceTable(const SceneSnapshot& scene, InstancesBy by, const std::map<std::string, int>& classes);
    /// Of what has been drawn: boxes hold voxels, and that of the first part all that is drawn of vertices.
    InstanceTable(const Surfaces& surfaces, InstancesBy by, const std::map<std::string, int>& classes);

    /// Place in instances(); of an object's place in the snapshot and the part.
    size_t of(size_t object, size_t part) const {
        const auto& row = table_[object];
        return row[part < row.size() ? part : row.size() - 1];
    }
    size_t count() const { return instances_.size(); }
    /// Some object's parts are instances of their own.
    bool has_parts() const {
        return std::ranges::any_of(table_, [](const auto& row) { return row.size() > 1; });
    }
    /// Names, ids, poses of the objects; nothing of a picture yet.
    const std::vector<Instance>& instances() const { return instances_; }

  private:
    void extend(size_t place, const SceneSnapshot::Object& object, const MeshPart* part, double voxel_size);

    std::vector<std::vector<size_t>> table_;  ///< for each object, for each part
    std::vector<Instance> instances_;
};

/// All instances of a picture whose surfaces have been drawn, in the order of their ids.
/// Without `amodal`, amodal values are those of the visible pixels. With a lens that distorts, what lies
/// outside of the picture counts for `truncation` and `visible_fraction` as large as it is without
/// distortion, and for the box as far as the lens's polynomial grows.
std::vector<Instance> annotate(const app::Drawn& drawn, const Surfaces& surfaces, const InstanceTable& table,
                               bool amodal);

}  // namespace easypbr::dataset
