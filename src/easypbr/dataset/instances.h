// Annotations of what is in a picture, one for each instance: masks, boxes, pose, visibility.
#pragma once

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "easypbr/dataset/surfaces.h"

namespace easypbr::dataset {

/// What counts as an instance: an object shown with all its children, each node of its hierarchy, or each
/// part (range of faces with a material) of each node.
enum class InstancesBy { object, node, part };

/// "object", "node", "part". Throws NameError with the nearest name.
InstancesBy instances_by_named(const std::string& name);

/// A rectangle of pixels that may lie outside of the picture; width 0: nothing. `width` counts pixels: from x
/// to x + width - 1.
using PixelBox = render::PixelRect;

/// Pixels of a rectangle, 1 or 0, row by row.
struct Bitmap {
    PixelBox area;
    std::vector<uint8_t> pixels;
};

struct Instance {
    int id = 0;        ///< from 1 on, what the layer instance_id holds
    std::string name;  ///< of the object, node, or node:part
    int semantic_id = 0;

    int pixels_visible = 0;
    /// Of the instance alone: inside the picture, and on a canvas three times as wide and high around it.
    int pixels_amodal_inside = 0, pixels_amodal = 0;
    double visible_fraction = 0;  ///< visible / amodal, as BOP has it; 0 without amodal pixels
    double truncation = 0;        ///< part of the amodal pixels that is outside of the picture
    PixelBox box_visible, box_amodal;
    Vec2i picture{0, 0};  ///< size of the picture
    Bitmap visible;
    Bitmap amodal;  ///< of the part inside the picture

    Eigen::Affine3d T_world_obj = Eigen::Affine3d::Identity();
    Eigen::Affine3d T_cam_obj = Eigen::Affine3d::Identity();  ///< OpenCV's camera axes
    Box3d box;                                                ///< of all vertices, in the object's frame
    /// Corners of the box: bit 0 of the row is x, bit 1 y, bit 2 z (0: least).
    Eigen::Matrix<double, 8, 3> corners_world, corners_cam;
    Eigen::Matrix<double, 8, 2> corners_px;  ///< NaN behind the camera
};

/// Which instance an object's part belongs to.
class InstanceTable {
  public:
    /// `shown` are the names in the scene; `classes` gives a semantic id to the objects of these names, and
    /// to their instances.
    InstanceTable(const SceneSnapshot& scene, const std::vector<std::string>& shown, InstancesBy by,
                  const std::map<std::string, int>& classes);

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
