#include "easypbr/render/primitives/lines/line_primitive.h"
#include "easypbr/render/primitives/mesh/mesh_primitive.h"
#include "easypbr/render/primitives/points/point_primitive.h"
#include "easypbr/render/primitives/splats/splat_primitive.h"
#include "easypbr/render/primitives/surfels/surfel_primitive.h"
#include "easypbr/render/primitives/vertex_hits.h"

namespace easypbr::render {

std::unique_ptr<HitSurface> Primitive::hit_surface(const ResolvedSettings&, const DrawItem& item) {
    return std::make_unique<VertexHits>(item);
}

Primitives make_primitives(DataCaches& caches) {
    Primitives primitives;
    primitives.push_back(std::make_unique<MeshPrimitive>(caches));
    primitives.push_back(std::make_unique<PointPrimitive>(caches));
    primitives.push_back(std::make_unique<SurfelPrimitive>(caches));
    primitives.push_back(std::make_unique<SplatPrimitive>());
    primitives.push_back(std::make_unique<LinePrimitive>(caches.textures));
    return primitives;
}

}  // namespace easypbr::render
