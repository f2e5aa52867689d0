#include "easypbr/scene/object_key.h"

#include <map>
#include <string_view>
#include <tuple>
#include <utility>

namespace easypbr {
namespace {

/// Pairs those without a partner that have equal values, the first ones of a value with each other.
class Pairing {
  public:
    Pairing(const std::vector<ObjectKey>& objects, const std::vector<ObjectKey>& others)
        : objects_(objects), others_(others), partners_(objects.size()), is_taken_(others.size()) {}

    template <class ValueOf>
    void pair_by(const ValueOf& value_of) {
        if (left_ == 0) return;
        std::multimap<decltype(value_of(objects_.front())), size_t> free;  // equal ones keep their order
        for (size_t i = 0; i < others_.size(); ++i)
            if (!is_taken_[i]) free.emplace(value_of(others_[i]), i);
        for (size_t i = 0; i < objects_.size(); ++i) {
            if (partners_[i]) continue;
            const auto value = value_of(objects_[i]);
            const auto found = free.lower_bound(value);
            if (found == free.end() || found->first != value) continue;
            partners_[i] = found->second;
            is_taken_[found->second] = true;
            free.erase(found);
            --left_;
        }
    }
    std::vector<std::optional<size_t>> partners() && { return std::move(partners_); }

  private:
    const std::vector<ObjectKey>& objects_;
    const std::vector<ObjectKey>& others_;
    std::vector<std::optional<size_t>> partners_;
    std::vector<bool> is_taken_;
    size_t left_ = objects_.size();  ///< objects without a partner
};

}  // namespace

std::vector<ObjectKey> object_keys(const SceneSnapshot& scene) {
    std::vector<ObjectKey> keys;
    keys.reserve(scene.objects.size());
    for (const auto& object : scene.objects) keys.push_back({object.root, object.name, object.node});
    return keys;
}

std::vector<std::optional<size_t>> partners(const std::vector<ObjectKey>& objects,
                                            const std::vector<ObjectKey>& others) {
    using Name = std::string_view;
    Pairing pairing(objects, others);
    // A node that copies of MeshData have made the child of several is several objects: by their names.
    pairing.pair_by(
        [](const ObjectKey& key) { return std::tuple(key.node, Name(key.root), Name(key.name)); });
    pairing.pair_by([](const ObjectKey& key) { return std::pair(key.node, Name(key.root)); });
    pairing.pair_by([](const ObjectKey& key) { return key.node; });
    pairing.pair_by([](const ObjectKey& key) { return std::pair(Name(key.root), Name(key.name)); });
    return std::move(pairing).partners();
}

}  // namespace easypbr
