#include "easypbr/app/picking.h"

#include <cmath>

#include "easypbr/app/view_point.h"

namespace easypbr::app {

std::optional<Pick> PickBuffer::at(Vec2d pixel) const {
    const int x = int(std::floor(pixel.x())), y = int(std::floor(pixel.y()));
    if (x < 0 || y < 0 || x >= size().x() || y >= size().y()) return {};
    size_t at = size_t(y) * size_t(size().x()) + size_t(x);
    if (!lens_->is_identity()) at = lens_->nearest(at);
    if (frame_.object[at] == 0) return {};
    const SceneSnapshot::Object& seen = frame_.scene.objects[frame_.object[at] - 1];
    Pick pick;
    pick.object = seen.name;
    pick.is_face = frame_.is_face[at];
    pick.element = int(frame_.element[at]) - 1;
    if (pick.is_face && !seen.mesh->parts.empty()) {
        pick.part_index = int(frame_.part[at]);
        pick.part = seen.mesh->parts[frame_.part[at]].name;
    }
    pick.depth = double(frame_.depth[at]);
    // Depths are those of the pixels' centres.
    pick.position = point_at(camera_, Vec2d(x + 0.5, y + 0.5), size(), pick.depth);
    return pick;
}

}  // namespace easypbr::app
