// Ground truth: a picture's layers in exact values through the pixels' centres, and annotations of its
// instances.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "easypbr/dataset/instances.h"
#include "easypbr/dataset/surfaces.h"

namespace easypbr::dataset {

/// Values of every pixel, row 0 on top, `channels` to a pixel.
struct LayerArray {
    int width = 0, height = 0, channels = 1;
    std::variant<std::vector<float>, std::vector<int32_t>, std::vector<uint8_t>> values;

    const std::vector<float>& floats() const { return std::get<std::vector<float>>(values); }
    const std::vector<int32_t>& integers() const { return std::get<std::vector<int32_t>>(values); }
    const std::vector<uint8_t>& bytes() const { return std::get<std::vector<uint8_t>>(values); }
};

/// Layers and what they hold; 0 where there is nothing but where another value is named.
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
///   semantic_id         i32: label of the face or vertex that is seen if the mesh has labels (of the nearest
///                       corner, where they belong to vertices), else the instance's
///   object_coordinates  f32 x 3, NOCS: (p - centre) / diagonal + 0.5 of the instance's box, in its frame
///   face_id             i32, index in the user's F of the face that is seen; in V of points and surfels, of
///                       vertices on top of faces and of the first vertex in a voxel; -1 of nothing
///   barycentrics        f32 x 3, weights of the face's corners; 0 on what is no face
///   uv                  f32 x 2
///   flow_forward        f32 x 2, from the pixel to where its point is in the next frame, pixels
///   occlusion_forward   u8, 1 where that point is not seen in the next frame
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

/// Draws what the session shows. Throws NameError for an unknown layer (with the nearest), ArgumentError for
/// a flow without its other frame, and what Session::render() throws.
GroundTruth ground_truth(app::Session& session, const std::vector<std::string>& layers,
                         const TruthOptions& options = {});

/// Where the points of `now` are in `other`, and whether they are not seen there: flow and occlusion.
void optical_flow(const Surfaces& now, const Surfaces& other, LayerArray& flow, LayerArray& occlusion);

}  // namespace easypbr::dataset
