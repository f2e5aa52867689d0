#include "easypbr/app/picking.h"

#include <cmath>

#include "easypbr/app/view_point.h"
#include "easypbr/scene/draw_style.h"

namespace easypbr::app {

PickBuffer::PickBuffer(SceneSnapshot scene, const Style& overrides, const Camera& camera, Image id,
                       Image element, Image depth)
    : scene_(std::move(scene)),
      overrides_(overrides),
      camera_(camera),
      id_(std::move(id)),
      element_(std::move(element)),
      depth_(std::move(depth)) {}

std::optional<Pick> PickBuffer::at(Vec2d pixel) const {
    const int x = int(std::floor(pixel.x())), y = int(std::floor(pixel.y()));
    if (x < 0 || y < 0 || x >= id_.width() || y >= id_.height()) return {};
    const size_t at = size_t(y) * size_t(id_.width()) + size_t(x);
    const size_t object = size_t(id_.pixels<float>()[at]);
    if (object == 0 || object > scene_.objects.size()) return {};
    const SceneSnapshot::Object& seen = scene_.objects[object - 1];
    Pick pick;
    pick.object = seen.name;
    pick.is_face = resolve_style(*seen.mesh, overrides_).mode == DrawMode::mesh;
    pick.element = int(element_.pixels<float>()[at]) - 1;
    for (size_t i = 0; pick.is_face && i < seen.mesh->parts.size(); ++i) {
        const MeshPart& part = seen.mesh->parts[i];
        if (pick.element < part.first_face || pick.element >= part.first_face + part.face_count) continue;
        pick.part = part.name;
        pick.part_index = int(i);
    }
    pick.depth = double(depth_.pixels<float>()[at]);
    // Depths are those of the pixels' centres.
    pick.position = point_at(camera_, Vec2d(x + 0.5, y + 0.5), size(), pick.depth);
    return pick;
}

}  // namespace easypbr::app
