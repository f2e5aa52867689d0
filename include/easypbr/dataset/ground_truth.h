// Ground truth: a picture's layers in exact values through the pixels' centres, and annotations of its
// instances.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "easypbr/app/picture.h"
#include "easypbr/core/math.h"
#include "easypbr/core/picture.h"
#include "easypbr/scene/camera.h"

namespace easypbr::app {
class Session;
}  // namespace easypbr::app

namespace easypbr::dataset {

/// What counts as an instance: an object shown with all its children, each node of its hierarchy, or each
/// part (range of faces with a material) of each node.
enum class InstancesBy { object, node, part };

/// "object", "node", "part". Throws NameError with the nearest name.
InstancesBy instances_by_named(const std::string& name);

/// A rectangle of pixels that may lie outside of the picture; width 0: nothing. `width` counts pixels: from x
/// to x + width - 1.
using PixelBox = PixelRect;

/// Pixels of a rectangle, 1 or 0, row by row.
struct Bitmap {
    PixelBox area;
    std::vector<uint8_t> pixels;
};

struct Instance {
    int id = 0;  ///< from 1 on, what the layer instance_id holds
    /// Of the object, node, or node:part. What the scene shows keeps its name; where others have one that is
    /// taken already, a number follows: "car/wheel#2".
    std::string name;
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
    /// In the object's frame, of all vertices: points and surfels are not counted as large as they are drawn,
    /// voxels with their whole cubes.
    Box3d box;
    /// Corners of the box: bit 0 of the row is x, bit 1 y, bit 2 z (0: least).
    Eigen::Matrix<double, 8, 3> corners_world = Eigen::Matrix<double, 8, 3>::Zero();
    Eigen::Matrix<double, 8, 3> corners_cam = Eigen::Matrix<double, 8, 3>::Zero();
    /// NaN behind the camera, and where the lens's polynomial folds.
    Eigen::Matrix<double, 8, 2> corners_px = Eigen::Matrix<double, 8, 2>::Zero();
};

/// Values of every pixel, row 0 on top, `channels` to a pixel.
struct LayerArray {
    int width = 0, height = 0, channels = 1;
    std::variant<std::vector<float>, std::vector<int32_t>, std::vector<uint8_t>> values;

    const std::vector<float>& floats() const { return std::get<std::vector<float>>(values); }
    const std::vector<int32_t>& integers() const { return std::get<std::vector<int32_t>>(values); }
    const std::vector<uint8_t>& bytes() const { return std::get<std::vector<uint8_t>>(values); }
};

/// Layers and what they hold; 0 where there is nothing but where another value is named. Flow
/// is 0 there while the camera moves, too: depth or instance_id tells where a pixel holds a surface.
///   color               u8 x 4, the picture: sRGB, anti-aliased as any
///   hdr                 f32 x 4, the picture: linear radiance, premultiplied
///   depth               f32, distance along the optical axis
///   distance            f32, distance from the camera's centre (orthographic: from its plane)
///   position            f32 x 3, in the world
///   normal_world        f32 x 3, unit, as it is shaded
///   normal_camera       f32 x 3, the same in the camera's frame, OpenCV's axes (x right, y down, z forward)
///   albedo              f32 x 3, linear
///   roughness, metallic f32
///   instance_id         i32, Instance::id
///   semantic_id         i32: label of the face or vertex that is seen if the mesh has labels (where they
///                       belong to vertices, of a face that of most of its corners, of the first one when
///                       all differ), else the instance's
///   object_coordinates  f32 x 3, NOCS: (p - centre) / diagonal + 0.5 of the instance's box, in its frame; of
///                       what is no face and reaches beyond the box, the nearest place in it
///   face_id             i32, index in the user's F of the face that is seen; in V of points and surfels, of
///                       vertices on top of faces and of the first vertex in a voxel; -1 of nothing
///   barycentrics        f32 x 3, weights of the face's corners; 0 on what is no face
///   uv                  f32 x 2
///   flow_forward        f32 x 2, from the pixel to where its point is in the next frame, pixels; NaN where
///                       it has no place there: behind the camera, where the lens's polynomial folds, or its
///                       object is not shown
///   occlusion_forward   u8, 1 where that point is not seen in the next frame: its nearest pixel is outside,
///                       or none of those around shows its surface from the same side
///   flow_backward, occlusion_backward   the same of the previous frame
const std::vector<std::string>& truth_layer_names();

struct TruthOptions {
    std::optional<Vec2i> size;
    std::optional<int> samples;  ///< of color and hdr
    InstancesBy instances_by = InstancesBy::object;
    std::map<std::string, int> classes;  ///< semantic ids by the names of objects
    const app::Moment* previous = nullptr;
    const app::Moment* next = nullptr;
    bool instances = false;  ///< fill in GroundTruth::instances
    bool amodal = true;      ///< of each instance, as if it were alone
};

struct GroundTruth {
    Vec2i size{0, 0};
    Camera camera;
    std::map<std::string, LayerArray> layers;
    std::vector<Instance> instances;
};

/// Draws what a session shows: that of Viewer::session(). Throws NameError for an unknown layer (with the
/// nearest), ArgumentError for a flow without its other frame, and what Viewer::render() throws.
GroundTruth ground_truth(app::Session& session, const std::vector<std::string>& layers,
                         const TruthOptions& options = {});

}  // namespace easypbr::dataset
