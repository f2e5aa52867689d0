// Layers that follow from surfaces alone.
#pragma once

#include "easypbr/dataset/ground_truth.h"
#include "easypbr/dataset/instances.h"

namespace easypbr::dataset {

/// The layer of this name if it follows from the surfaces and the instances: depth, distance, position, the
/// ids, object_coordinates, barycentrics, uv; else nothing.
std::optional<LayerArray> surface_layer(const std::string& name, const Surfaces& surfaces,
                                        const InstanceTable& table);

/// The same of what the G-buffer holds: normals, albedo, roughness, metallic.
std::optional<LayerArray> drawn_layer(const std::string& name, const app::Drawn& drawn,
                                      const Surfaces& surfaces);

/// Zeros.
template <class T>
LayerArray make_layer(Vec2i size, int channels) {
    return {size.x(), size.y(), channels,
            std::vector<T>(size_t(size.x()) * size_t(size.y()) * size_t(channels))};
}

}  // namespace easypbr::dataset
