#include "easypbr/render/primitives/surfaces.h"

#include <algorithm>
#include <functional>

#include "easypbr/gl/context.h"
#include "easypbr/scene/resolve.h"

namespace easypbr::render {
namespace {

/// The frames of one picture are jittered by up to a pixel, and edges are smoothed one pixel beyond them.
PixelRect with_margin(const PixelRect& r, Vec2i size) {
    constexpr int margin = 2;
    if (r.width == 0) return {};
    const int x0 = std::max(0, r.x - margin), y0 = std::max(0, r.y - margin);
    return {x0, y0, std::min(size.x(), r.x + r.width + margin) - x0,
            std::min(size.y(), r.y + r.height + margin) - y0};
}

}  // namespace

std::vector<Surfaces::Group> Surfaces::groups_of(const DrawList& list) const {
    std::vector<Group> groups;
    for (const auto& kind : primitives_)
        if (const DrawItems items = list.of(kind->mode()); !items.empty())
            groups.push_back({kind.get(), items});
    return groups;
}

bool Surfaces::is_native() const {
    return allow_native_ && gl::Context::current().info().software;
}

void Surfaces::rasterise(const Frame& frame, const SurfaceOutputs& outputs, std::vector<Group>& groups) {
    const auto by_driver = [](const Group& group) { return !group.kind->is_native(group.items); };
    if (std::ranges::all_of(groups, by_driver)) return;
    visible_.clear(frame.size, frame.covered);
    std::vector<Group> native = groups;
    std::erase_if(native, by_driver);
    // One that only the driver can draw may have added some of its items.
    for (auto next = native.begin(); next != native.end();) {
        if (next->kind->rasterise(frame, next->items, outputs.extensions, visible_)) {
            ++next;
            continue;
        }
        native.erase(next);
        visible_.clear(frame.size, frame.covered);
        next = native.begin();
    }
    std::erase_if(groups, [&](const Group& group) {
        return std::ranges::find(native, group.kind, &Group::kind) != native.end();
    });
}

PixelRect Surfaces::draw_groups(const Frame& frame, const DrawList& list, const GBuffer& targets,
                                const SurfaceOutputs& outputs) {
    std::vector<Group> groups = groups_of(list), means;
    const bool native = is_native(), is_empty = groups.empty();
    visible_.clear({0, 0}, {});
    const auto by_mean = [&](const Group& group) {
        return group.kind->is_mean() && (native || !group.kind->has_driver());
    };
    std::ranges::copy_if(groups, std::back_inserter(means), by_mean);
    std::erase_if(groups, by_mean);
    if (native) rasterise(frame, outputs, groups);
    const PixelRect seen = visible_.empty() ? PixelRect{} : visible_.crop();
    const bool in_host_memory = native && groups.empty();
    const SurfaceContents contents{.ids = outputs.ids,
                                   .emission = outputs.emission || list.has(&DrawItem::emits),
                                   .extensions = outputs.extensions != 0};
    const int fillings = list.of(DrawMode::points).empty() ? 0 : frame.resolved->settings.points.hole_filling;
    if (in_host_memory) {
        const bool whole = outputs.whole || !means.empty() || fillings > 0;
        SurfaceWriter writer(targets, whole ? frame.whole() : seen, contents);
        if (whole) writer.clear();
        visible_.resolve(frame, writer);
        for (const Group& group : means)
            group.kind->add_mean(frame, group.items, targets.depth.pixels<float>(), outputs, writer);
        if (fillings > 0) SurfaceComposite::fill_host_holes(frame, targets, fillings);
    } else {
        targets.clear(outputs.ids);
        for (const Group& group : groups) group.kind->draw(frame, group.items, targets, outputs);
        if (!visible_.empty()) {
            SurfaceWriter writer(composite_.staging(frame, outputs), seen, contents);
            visible_.resolve(frame, writer);
            composite_.draw(frame, targets, outputs, transfers_);
        }
        draw_means(frame, means, targets, outputs);
        if (fillings > 0) composite_.fill_holes(frame, targets, outputs, fillings);
    }
    const bool is_known = in_host_memory && means.empty() && list.overlays.empty() && !is_empty;
    return is_known ? with_margin(seen, frame.size) : frame.covered;
}

void Surfaces::draw_means(const Frame& frame, const std::vector<Group>& groups, const GBuffer& targets,
                          const SurfaceOutputs& outputs) {
    for (const Group& group : groups) {
        targets.depth.download(frame.whole(), transfers_);
        SurfaceWriter writer(composite_.staging(frame, outputs), frame.whole(), {.ids = outputs.ids});
        writer.clear();
        group.kind->add_mean(frame, group.items, targets.depth.pixels<float>(), outputs, writer);
        composite_.draw(frame, targets, outputs, transfers_);
    }
}

GBuffer& Surfaces::over(const Frame& frame) {
    if (over_.size() != frame.size) over_ = GBuffer(frame.size);
    return over_;
}

PixelRect Surfaces::draw(const Frame& frame, const DrawList& list, const GBuffer& targets,
                         const SurfaceOutputs& outputs) {
    if (!list.has(is_over)) return draw_groups(frame, list, targets, outputs);
    const bool native = is_native();
    SurfaceOutputs whole = outputs;
    whole.whole |= native;
    whole.emission = native && list.has(&DrawItem::emits);
    draw_groups(frame, list.without(is_over), targets, whole);
    GBuffer& over_everything = over(frame);
    if (outputs.ids) over_everything.add_ids();
    if (outputs.extensions) over_everything.add_extensions();
    draw_groups(frame, list.without(std::not_fn(is_over)), over_everything, whole);
    if (native && targets.depth.is_ahead() && over_everything.depth.is_ahead()) {
        SurfaceComposite::put_over(over_everything, targets);
        return frame.covered;
    }
    targets.upload(transfers_);
    over_everything.upload(transfers_);
    composite_.draw_over(frame, over_everything, targets, outputs);
    return frame.covered;
}

void Surfaces::draw_by_driver(const Frame& frame, const DrawList& list, const GBuffer& targets,
                              const SurfaceOutputs& outputs) {
    for (const Group& group : groups_of(list)) group.kind->draw(frame, group.items, targets, outputs);
}

std::vector<uint8_t> Surfaces::coverage(const Frame& frame, const DrawList& list) {
    const size_t count = size_t(frame.size.x()) * size_t(frame.size.y());
    std::vector<uint8_t> covered(count);
    if (list.empty() || covered.empty()) return covered;
    const auto covers = [&](const Group& group) { return group.kind->cover(frame, group.items, covered); };
    if (is_native() && std::ranges::all_of(groups_of(list), covers)) return covered;
    if (coverage_.size() != frame.size) coverage_ = GBuffer(frame.size);
    coverage_.add_ids();
    draw(frame, list, coverage_, {.ids = true});
    const std::vector<float> depth = coverage_.depth.read<float>(transfers_);
    for (size_t i = 0; i < count; ++i) covered[i] = depth[i] > 0;
    return covered;
}

std::vector<ScreenReach> Surfaces::reaches(const Frame& frame, const DrawList& list, size_t objects) const {
    std::vector<ScreenReach> reaches(objects);
    for (const Group& group : groups_of(list))
        for (const DrawItem& item : group.items)
            reaches[size_t(item.object - frame.scene->objects.data())].extend(
                group.kind->screen_reach(frame, item));
    // Holes between points are filled by one pixel at a time.
    if (!list.of(DrawMode::points).empty())
        for (ScreenReach& reach : reaches) reach.pixels += frame.resolved->settings.points.hole_filling;
    return reaches;
}

bool Surfaces::has_native_layers(const DrawList& list) const {
    return is_native() && std::ranges::all_of(groups_of(list), [](const Group& group) {
               return group.kind->has_native_layers(group.items);
           });
}

void Surfaces::rasterise_layer(const Frame& frame, const DrawList& list, ExtensionSet extensions,
                               const PeelLimits& limits) {
    visible_.clear(frame.size, frame.covered);
    visible_.buffer().begin_layer(limits);
    for (const Group& group : groups_of(list))
        group.kind->rasterise(frame, group.items, extensions, visible_);
}

void Surfaces::begin_native_layers(const Frame& frame, const DrawList& list, std::span<const float> opaque) {
    for (const Group& group : groups_of(list)) group.kind->begin_mean_layers(frame, group.items, opaque);
}

bool Surfaces::peel(const Frame& frame, const DrawList& list, const GBuffer& layer, ExtensionSet extensions,
                    PeelLimits& limits) {
    rasterise_layer(frame, list, extensions, limits);
    visible_.buffer().end_layer(limits);
    const PixelRect seen = visible_.crop();
    std::vector<Group> means = groups_of(list);
    std::erase_if(means, [](const Group& group) { return !group.kind->is_mean(); });
    bool drawn = seen.width > 0;
    if (!drawn && means.empty()) return false;
    SurfaceWriter writer(layer, means.empty() ? seen : frame.whole(),
                         {.emission = list.has(&DrawItem::emits), .extensions = extensions != 0});
    if (!means.empty()) writer.clear();
    visible_.resolve(frame, writer);
    for (const Group& group : means) drawn |= group.kind->add_mean_layer(frame, group.items, limits, writer);
    return drawn;
}

void Surfaces::peel_backs(const Frame& frame, const DrawList& list, const GBuffer& targets,
                          const PeelLimits& limits) {
    rasterise_layer(frame, list, 0, limits);
    SurfaceWriter writer(targets, visible_.crop(), {});
    visible_.resolve(frame, writer);
}

void Surfaces::find_nearest(const Frame& frame, const DrawList& list, const Target& depths) {
    visible_.clear(frame.size, frame.covered);
    for (const Group& group : groups_of(list)) group.kind->rasterise(frame, group.items, 0, visible_);
    depths.write(visible_.crop());
    std::ranges::transform(visible_.buffer().pixels(), depths.pixels<float>().begin(),
                           VisibilityBuffer::depth_of);
}

void Surfaces::begin_layers(const Frame& frame, const DrawList& list, const gl::Texture& opaque) {
    for (const Group& group : groups_of(list)) group.kind->begin_layers(frame, group.items, opaque);
}

void Surfaces::draw_layer(const Frame& frame, const DrawList& list, const GBuffer& layer,
                          const SurfaceOutputs& outputs) {
    for (const Group& group : groups_of(list)) group.kind->draw_layer(frame, group.items, layer, outputs);
}

void Surfaces::take_layer(const DrawList& list) {
    for (const Group& group : groups_of(list)) group.kind->take_layer(group.items);
}

void Surfaces::draw_backs(const Frame& frame, const DrawList& list, const GBuffer& targets,
                          const SurfaceOutputs& outputs) {
    for (const Group& group : groups_of(list)) group.kind->draw_backs(frame, group.items, targets, outputs);
}

}  // namespace easypbr::render
