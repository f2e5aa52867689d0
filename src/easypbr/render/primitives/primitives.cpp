#include "easypbr/render/primitives/mesh/mesh_primitive.h"
#include "easypbr/render/primitives/points/point_primitive.h"
#include "easypbr/render/primitives/surfels/surfel_primitive.h"

namespace easypbr::render {

std::vector<std::unique_ptr<Primitive>> make_primitives(DataCaches& caches) {
    std::vector<std::unique_ptr<Primitive>> primitives;
    primitives.push_back(std::make_unique<MeshPrimitive>(caches));
    primitives.push_back(std::make_unique<PointPrimitive>(caches));
    primitives.push_back(std::make_unique<SurfelPrimitive>(caches));
    return primitives;
}

}  // namespace easypbr::render
