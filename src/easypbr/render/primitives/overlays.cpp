#include "easypbr/render/primitives/overlays.h"

#include <algorithm>

namespace easypbr::render {
namespace {

using OverlayPart = OverlayStep::Part;

/// Calls draw(kind, items) for each kind that has items.
template <class Draw>
void for_each_kind(const Primitives& primitives, const ItemsByKind& items, Draw&& draw) {
    if (items.empty()) return;
    for (const auto& kind : primitives)
        if (const DrawItems of_kind = items_of(items, kind->mode()); !of_kind.empty()) draw(*kind, of_kind);
}

}  // namespace

void Overlays::begin(const Frame& frame, const ItemsByKind& items, const GBuffer& targets,
                     const Target& opaque, Transfers* host, bool by_gpu) {
    host_ = host;
    by_gpu_ = by_gpu;
    run(frame, items, targets, {.part = OverlayPart::begin, .opaque = &opaque});
}

void Overlays::draw(const Frame& frame, const ItemsByKind& items, const GBuffer& targets,
                    const GBuffer* next) {
    for (const OverlayPart part : {OverlayPart::behind, OverlayPart::front})
        run(frame, items, targets, {.part = part, .next = next});
}

void Overlays::draw_over(const Frame& frame, const ItemsByKind& items, const GBuffer& targets) {
    run(frame, items, targets, {.part = OverlayPart::over});
}

const Target* Overlays::nearest_lines(const ItemsByKind& items) const {
    const Target* found = nullptr;
    for_each_kind(primitives_, items, [&](const Primitive& kind, DrawItems) {
        if (const Target* lines = kind.nearest_lines()) found = lines;
    });
    return found;
}

void Overlays::run(const Frame& frame, const ItemsByKind& items, const GBuffer& targets, OverlayStep step) {
    step.host = host_;
    step.by_gpu = by_gpu_;
    step.others = others_;
    for_each_kind(primitives_, items, [&](Primitive& kind, DrawItems of_kind) {
        kind.draw_overlay(frame, of_kind, targets, step);
    });
    if (step.part == OverlayPart::begin) find_others(items);
}

void Overlays::find_others(const ItemsByKind& items) {
    others_.clear();
    bool around = false;
    for_each_kind(primitives_, items, [&](Primitive& kind, DrawItems) { around |= kind.lies_around(); });
    if (!around) return;
    for_each_kind(primitives_, items, [&](Primitive& kind, DrawItems) {
        std::vector<float> depths = kind.overlay_depths();
        if (others_.empty()) return others_.swap(depths);
        for (size_t i = 0; i < depths.size(); ++i) others_[i] = std::max(others_[i], depths[i]);
    });
}

}  // namespace easypbr::render
