#include "easypbr/scene/object_key.h"

#include <map>
#include <utility>

namespace easypbr {

std::vector<ObjectKey> object_keys(const SceneSnapshot& scene) {
    std::map<std::pair<std::string, std::string>, int> counts;
    std::vector<ObjectKey> keys;
    keys.reserve(scene.objects.size());
    for (const auto& object : scene.objects)
        keys.push_back({object.root, object.name, counts[{object.root, object.name}]++});
    return keys;
}

}  // namespace easypbr
