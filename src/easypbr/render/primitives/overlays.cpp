#include "easypbr/render/primitives/overlays.h"

namespace easypbr::render {
namespace {

/// Calls draw(kind, items) for each kind that has items.
template <class Draw>
void for_each_kind(const Primitives& primitives, const ItemsByKind& items, Draw&& draw) {
    if (items.empty()) return;
    for (const auto& kind : primitives)
        if (const DrawItems of_kind = items_of(items, kind->mode()); !of_kind.empty()) draw(*kind, of_kind);
}

}  // namespace

void Overlays::begin(const Frame& frame, const ItemsByKind& items, const GBuffer& targets,
                     const gl::Texture& opaque) {
    for_each_kind(primitives_, items, [&](Primitive& kind, DrawItems of_kind) {
        kind.begin_overlay(frame, of_kind, targets, opaque);
    });
}

void Overlays::draw_behind(const Frame& frame, const ItemsByKind& items, const GBuffer& targets,
                           const GBuffer& layer) {
    for_each_kind(primitives_, items, [&](Primitive& kind, DrawItems of_kind) {
        kind.draw_overlay_behind(frame, of_kind, targets, layer);
    });
}

void Overlays::draw_rest(const Frame& frame, const ItemsByKind& items, const GBuffer& targets) {
    for_each_kind(primitives_, items, [&](Primitive& kind, DrawItems of_kind) {
        kind.draw_overlay_rest(frame, of_kind, targets);
    });
}

void Overlays::draw_over(const Frame& frame, const ItemsByKind& items, const GBuffer& targets) {
    for_each_kind(primitives_, items, [&](Primitive& kind, DrawItems of_kind) {
        kind.draw_overlay_over(frame, of_kind, targets);
    });
}

void Overlays::shade(const Frame& frame, const ItemsByKind& items, const GBuffer& targets,
                     Transfers& transfers) {
    for_each_kind(primitives_, items, [&](Primitive& kind, DrawItems of_kind) {
        kind.shade_overlay(frame, of_kind, targets, transfers);
    });
}

}  // namespace easypbr::render
