#include "easypbr/render/effects/bloom/bloom_effect.h"
#include "easypbr/render/effects/depth_of_field/depth_of_field_effect.h"
#include "easypbr/render/effects/outline/outline_effect.h"

namespace easypbr::render {
namespace {

template <class... Effects>
std::vector<std::unique_ptr<Effect>> list_of() {
    std::vector<std::unique_ptr<Effect>> list;
    (list.push_back(std::make_unique<Effects>()), ...);
    return list;
}

}  // namespace

std::vector<std::unique_ptr<Effect>> make_effects() {
    return list_of<OutlineEffect, DepthOfFieldEffect, BloomEffect>();
}

}  // namespace easypbr::render
