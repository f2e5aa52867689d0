// Layers: pictures beside the final one, read from the G-buffer.
#pragma once

#include <string>
#include <vector>

#include "easypbr/core/image.h"
#include "easypbr/render/drawables/drawable_scene.h"
#include "easypbr/render/frame/gbuffer.h"
#include "easypbr/render/frame/surface_kind.h"
#include "easypbr/scene/camera.h"

namespace easypbr::render {

/// Pictures beside the final one, read from the frame drawn last: of a picture of one sample, through the
/// pixels' centres.
enum class Layer {
    albedo,             ///< RGBA f32, linear base colour, alpha 1 where there is geometry
    normal_world,       ///< RGB f32, unit world normal, 0 where there is nothing
    depth,              ///< one channel f32, distance along the optical axis, 0 where there is nothing
    roughness,          ///< one channel f32
    metallic,           ///< one channel f32
    occlusion,          ///< one channel f32, the material's
    ambient_occlusion,  ///< one channel f32, part of the surroundings that is seen; needs ssao.enabled
    object_id,  ///< one channel f32, 1 + place of the object in the snapshot, 0 where there is nothing; exact
    element_id  ///< one channel f32, 1 + index of the face or point in its object, 0 where there is nothing;
                ///< exact up to 2^24
};

/// "albedo", "normal_world", ... Throws NameError with the nearest name, or with what a former name became.
Layer layer_named(const std::string& name);
/// In the order of Layer.
const std::vector<std::string>& layer_names();
/// What a layer is called now that was "normal", "id" or "element"; empty for other names.
std::string layer_formerly(const std::string& name);

/// Reads a layer of what the targets hold, seen by `camera`; `sources` of the objects that were drawn. Throws
/// ArgumentError for ids that were not drawn.
Image read_layer(Layer layer, const GBuffer& targets, const Camera& camera,
                 const std::vector<ElementSources>& sources, Transfers& transfers);

/// Where surfaces of a kind are seen: u8, one channel, 255 there, else 0.
Image mask_of_kind(SurfaceKind kind, const GBuffer& targets, Transfers& transfers);

}  // namespace easypbr::render
