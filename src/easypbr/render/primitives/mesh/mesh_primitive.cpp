#include "easypbr/render/primitives/mesh/mesh_primitive.h"

#include <algorithm>

namespace easypbr::render {

void MeshPrimitive::draw_backs(const Frame& frame, DrawItems items, const GBuffer& targets,
                               const SurfaceOutputs& outputs) {
    std::vector<DrawItem> volumes(items.begin(), items.end());
    std::erase_if(volumes, [](const DrawItem& item) { return !item.is_volume(); });
    pass_.draw(frame, volumes, targets, outputs);
}

}  // namespace easypbr::render
