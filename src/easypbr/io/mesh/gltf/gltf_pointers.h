// What KHR_animation_pointer names of materials: factors, strengths and texture transforms.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "easypbr/io/mesh/gltf/gltf_document.h"
#include "easypbr/io/mesh/gltf/gltf_materials.h"
#include "easypbr/scene/animation.h"

namespace easypbr::io {

/// Some values of a material that are animated as one.
struct GltfMaterialTarget {
    int material = 0;   ///< into materials()
    int parameter = 0;  ///< of AnimatedMaterial, the first one
    int width = 0;      ///< how many
};

class GltfMaterialPointers {
  public:
    GltfMaterialPointers(const GltfDocument& document, const GltfMaterials& materials)
        : document_(document), materials_(materials) {}

    /// What a pointer ("/materials/0/alphaCutoff") names, which is an animated material from now on; nothing
    /// where it cannot be animated. Throws FormatError for a material that does not exist.
    std::optional<GltfMaterialTarget> find(std::string_view pointer);

    /// The animated materials without users.
    std::vector<AnimatedMaterial> materials() const;
    /// The place of a material of the file in materials(); nothing where it is not animated.
    std::optional<size_t> animated(size_t material) const;

  private:
    /// Parameters that make one value of a material together.
    struct Group {
        std::string name;
        std::vector<double> at_rest;
        std::function<void(const double*, Material&)> put;
    };
    struct Animated {
        size_t material = 0;  ///< of the file
        std::vector<Group> groups;
    };
    struct Place {
        Group group;
        int first = 0, width = 0;  ///< of its parameters
    };

    std::optional<Place> place_of(size_t material, std::string_view property) const;
    std::optional<Place> number_or_color(const Material& material, std::string_view property) const;
    std::optional<Place> texture_transform(const Json& json, std::string_view property) const;
    Place emission(const Json& json, bool strength) const;
    Animated& entry(size_t material);

    const GltfDocument& document_;
    const GltfMaterials& materials_;
    std::vector<Animated> animated_;
};

}  // namespace easypbr::io
