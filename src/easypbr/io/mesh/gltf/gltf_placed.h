// Lights (KHR_lights_punctual) and cameras, which nodes place in the world (glTF 2.0, section 3.10), and what
// KHR_animation_pointer names of them.
#pragma once

#include <optional>
#include <string_view>

#include "easypbr/io/mesh/gltf/gltf_document.h"
#include "easypbr/scene/animation.h"

namespace easypbr::io {

/// The light or camera that a node names, by its number in the file; nothing where it names none. Throws
/// FormatError for one that does not exist.
std::optional<size_t> gltf_light_of_node(const GltfDocument& document, const Json& node);
std::optional<size_t> gltf_camera_of_node(const GltfDocument& document, const Json& node);

/// The name that the file gives it, or `fallback`.
std::string gltf_light_name(const GltfDocument& document, size_t light, const std::string& fallback);
std::string gltf_camera_name(const GltfDocument& document, size_t camera, const std::string& fallback);

/// All lights and cameras of a file, without users. Throws FormatError for values of another kind.
std::vector<AnimatedItem<Light>> read_gltf_lights(const GltfDocument& document);
std::vector<AnimatedItem<Camera>> read_gltf_cameras(const GltfDocument& document);

/// Values of a light or camera, as KHR_animation_pointer names them.
struct GltfPlacedTarget {
    AnimatedProperty property = AnimatedProperty::light;
    int item = 0;       ///< number of the light or camera in the file
    int parameter = 0;  ///< of AnimatedItem, the first one
    int width = 1;      ///< how many
};

/// What a pointer ("/cameras/0/perspective/yfov") names; nothing where it cannot be animated. Throws
/// FormatError for a light or camera that does not exist.
std::optional<GltfPlacedTarget> find_gltf_placed(const GltfDocument& document, std::string_view pointer);

}  // namespace easypbr::io
