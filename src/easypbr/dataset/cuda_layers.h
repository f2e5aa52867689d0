// Layers that stay on the GPU, for tensors in CUDA memory.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "easypbr/dataset/ground_truth.h"
#include "easypbr/dataset/instances.h"
#include "easypbr/dataset/surfaces.h"
#include "easypbr/gl/cuda.h"

namespace easypbr::dataset {

/// Targets as they were drawn, and what is needed to make layers of them.
struct CudaLayers {
    /// "color", "hdr": the picture. "depth", "normal", "albedo", "material", "id": see render/gbuffer.h;
    /// depth is 0 where there is nothing, where the others hold garbage.
    std::map<std::string, gl::CudaPixels> targets;
    double near = 0, far = 0;
    bool orthographic = false;
    RaySlopes rays;
    Mat4d T_world_cam;              ///< OpenCV's axes
    std::vector<int> instance_ids;  ///< by what the target "id" holds; 0 for nothing
    std::vector<int> semantic_ids;  ///< the same; empty where elements have labels of their own
};

/// color, hdr, depth, distance, position, normal_camera, normal_world, albedo, roughness, metallic,
/// instance_id, semantic_id.
const std::vector<std::string>& cuda_layer_names();

/// Draws what the session shows and copies the targets that the layers (some of cuda_layer_names()) are made
/// of. Nothing, with a warning that says why, when they cannot stay on the GPU: the context is on no CUDA
/// device, the camera's lens distorts, a legend or colour bar is drawn into the picture, or instances are
/// parts. Throws what Session::draw_surfaces() and gl::copy_to_cuda() throw.
std::optional<CudaLayers> cuda_layers(app::Session& session, const std::vector<std::string>& layers,
                                      const TruthOptions& options = {});

}  // namespace easypbr::dataset
