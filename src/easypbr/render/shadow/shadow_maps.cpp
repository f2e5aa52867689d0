#include "easypbr/render/shadow/shadow_maps.h"

#include <algorithm>
#include <cmath>

#include "easypbr/core/hash.h"
#include "easypbr/core/parallel.h"
#include "easypbr/scene/light_falloff.h"
#include "easypbr/scene/material_table.h"
#include "easypbr/scene/resolve.h"

namespace easypbr::render {
namespace {

/// Elements past the last one that vectors of any instruction set may read (native/simd/samplers.h).
constexpr size_t read_past = 16;

/// Bytes that all maps together may take; more lights than that are drawn in turns.
constexpr size_t memory_limit = size_t(512) << 20;
/// Every driver's least limit of layers in an array.
constexpr size_t layer_limit = 2048;

constexpr gl::Format map_format = gl::Format::r32f, tint_format = gl::Format::rgba32f;

int most_layers(int resolution, bool tinted) {
    const size_t texel = gl::pixel_bytes(map_format) + (tinted ? 2 * gl::pixel_bytes(tint_format) : 0);
    const size_t bytes = size_t(resolution) * size_t(resolution) * texel;
    return int(std::clamp(memory_limit / bytes, size_t(6), layer_limit));
}

/// Receivers may stand so far beyond the casters' bounds, in their diagonals: positions that are taken from
/// the depth of a distant camera are rounded.
constexpr double slack = 0.01;

FacePlane ground_of(const ResolvedSettings& resolved) {
    return {parse_up(resolved.settings.camera.up), double(resolved.settings.ground.height)};
}

/// Whether a light reaches a box at all: beyond its range it is zero.
bool reaches(const ResolvedLight& light, const Box3d& box) {
    if (light.type == LightType::directional || is_area(light.type) || !(light.range > 0)) return true;
    return box.squaredExteriorDistance(light.position) <= double(light.range) * double(light.range);
}

/// What softens a light's shadows: its radius, or the tangent of a directional light's; of a rectangle the
/// radius of a disc of the same area.
double extent_of(const ResolvedLight& light) {
    if (light.type == LightType::rectangle) return std::sqrt(emitting_area(light) / pi);
    return light.type == LightType::directional ? std::tan(radians(light.angular_radius_deg))
                                                : double(light.radius);
}

}  // namespace

ShadowMaps::Shaded ShadowMaps::shaded_by(const DrawItem& item) {
    const Material& m = item.material;
    Shaded shaded{m.shader.text, {m.unlit ? 1.0f : 0.0f, item.style.flat ? 1.0f : 0.0f}, {}};
    for (const MaterialNumber& row : material_numbers()) shaded.numbers.push_back(m.*row.value);
    for (const MaterialColor& row : material_colors())
        for (const float channel : m.*row.value) shaded.numbers.push_back(channel);
    for (const MaterialTexture& row : material_textures())
        shaded.images.push_back((m.*row.texture).image.get());
    return shaded;
}

ShadowMaps::Caster ShadowMaps::caster_of(const DrawItem& item) {
    const MeshData& mesh = item.mesh();
    const Material& m = item.material;
    Caster caster{};
    caster.first_face = item.part.first_face;
    caster.face_count = item.part.face_count;
    caster.T_world_mesh = item.object->T_world_mesh.matrix().topRows<3>();
    if (m.shader) caster.shaded = shaded_by(item);
    if (item.alpha == AlphaMode::opaque && !item.casts_tint() && !m.shader) return caster;
    caster.revisions = {mesh.UV.revision(), item.with_colors ? mesh.C.revision() : 0};
    caster.alpha_mode = item.alpha;
    caster.images = {m.base_color_texture.image.get(), m.opacity_texture.image.get()};
    caster.alpha = {m.opacity, m.alpha_cutoff, float(m.opacity_texture.channel)};
    if (!item.casts_tint()) return caster;
    caster.images[2] = m.transmission_texture.image.get();
    caster.through = m.transmittance(AlphaMode::opaque);
    caster.thickness = {m.thickness, float(m.transmission_texture.channel)};
    return caster;
}

void ShadowMaps::note_casters(const DrawList& list, const Box3d& bounds) {
    std::vector<Caster> casters;
    for (const auto& kind : primitives_)
        for (const DrawItem& item : list.of(kind->mode())) {
            casters.push_back(caster_of(item));
            casters.back().kind = kind->mode();
            casters.back().shape = kind->shadow_shape(item);
        }
    const bool same_bounds = bounds.min() == bounds_.min() && bounds.max() == bounds_.max();
    if (casters == casters_ && same_bounds && casters_generation_ != 0) return;
    casters_ = std::move(casters);
    bounds_ = bounds;
    casters_generation_ = next_revision();
}

ShadowMaps::Request ShadowMaps::request_of(const ResolvedLight& light, const Frame& frame,
                                           Receivers receivers) const {
    const ShadowSettings& settings = frame.resolved->settings.shadows;
    Request request;
    request.light = &light;
    if (!settings.enabled || !light.casts_shadows || receivers == Receivers::none) return request;
    const Vec3d margin = Vec3d::Constant(slack * (bounds_.isEmpty() ? 0 : bounds_.diagonal().norm()));
    const Box3d lit(bounds_.min() - margin, bounds_.max() + margin);
    const bool bounded = receivers == Receivers::within && !bounds_.isEmpty();
    if (bounded && !reaches(light, lit)) return request;
    const double extent = settings.mode == ShadowMode::soft ? extent_of(light) : 0;
    const int samples = extent > 0 ? frame.sample_count : 1;
    const ResolvedLight sampled = sampled_light(light, frame.sample_index, samples);
    const auto ground =
        receivers == Receivers::on_ground ? std::optional(ground_of(*frame.resolved)) : std::nullopt;
    request.casters = useful_casters(light, extent_.last(), extent, ground);
    const auto projection = project_shadows(sampled, request.casters.bounds, settings.resolution,
                                            most_pushed * extent_.last().reach);
    if (!projection) return request;
    request.shadowed = true;
    request.projection = *projection;
    request.needed = bounded ? needed_maps(*projection, lit) : (1u << projection->count) - 1;
    // What one sample stands for is as large a part of the light as it is of all samples.
    request.radius = extent / std::sqrt(double(samples));
    const Vec3d position = light.type == LightType::directional ? Vec3d(Vec3d::Zero()) : sampled.position;
    const Vec3 direction = light.type == LightType::point ? Vec3(Vec3::Zero()) : sampled.direction;
    request.key = {double(light.type), position.x(),  position.y(),  position.z(),
                   direction.x(),      direction.y(), direction.z(), light.outer_cone_deg};
    for (const Vec3d& end : {request.casters.bounds.min(), request.casters.bounds.max()})
        request.key.insert(request.key.end(), end.begin(), end.end());
    request.key.insert(request.key.end(), request.casters.left_out.begin(), request.casters.left_out.end());
    return request;
}

void ShadowMaps::set_resolution(int resolution) {
    if (resolution == resolution_) return;
    entries_.clear();
    taken_.clear();
    framebuffers_.clear();
    tint_framebuffers_.clear();
    maps_ = gl::Texture();
    host_maps_.clear();
    least_.clear();
    largest_.clear();
    host_absorption_.clear();
    host_moment_.clear();
    tints_ = {};
    resolution_ = resolution;
}

void ShadowMaps::keep_in_host_memory(bool host) {
    if (host == in_host_memory_) return;
    const int resolution = resolution_;
    set_resolution(0);
    resolution_ = resolution;
    in_host_memory_ = host;
    prepare_tints();
}

void ShadowMaps::begin(const Frame& frame, const DrawList& casters, Receivers receivers) {
    note_casters(casters, extent_.of(casters, primitives_).bounds);
    list_ = &casters;
    ++frame_;
    requests_.clear();
    next_ = 0;
    wanted_layers_ = 0;
    for (const ResolvedLight& light : frame.resolved->lights) {
        requests_.push_back(request_of(light, frame, receivers));
        if (requests_.back().shadowed) wanted_layers_ += requests_.back().projection.count;
    }
    const bool any = std::ranges::any_of(requests_, &Request::shadowed);
    set_resolution(any ? frame.resolved->settings.shadows.resolution : 0);
    tinted_ = casters.has(&DrawItem::casts_tint);
    prepare_tints();
    const auto rank = [](const Request& r) { return !r.shadowed ? 0 : r.projection.is_cube() ? 2 : 1; };
    std::ranges::stable_sort(requests_, {}, rank);
    for (const Request& request : requests_)
        if (const auto found = entries_.find(request.key); request.shadowed && found != entries_.end())
            found->second.last_frame = frame_;
}

bool ShadowMaps::has_native_tints() const {
    return std::ranges::all_of(primitives_, [&](const auto& kind) {
        std::vector<DrawItem> tinting;
        for (const DrawItem& item : list_->of(kind->mode()))
            if (item.casts_tint()) tinting.push_back(item);
        return tinting.empty() || kind->has_native_tints(tinting);
    });
}

LightBlock ShadowMaps::next_block() {
    LightBlock block;
    ++block_;
    for (; next_ < requests_.size() && block.lights.size() < lights_per_block; ++next_) {
        const Request& request = requests_[next_];
        if (request.shadowed) {
            const Entry* entry = acquire(request);
            if (!entry) break;
            block.shadows.push_back({&request.projection, entry->first_layer, request.radius});
            block.cubes += request.projection.is_cube();
        }
        block.lights.push_back(request.light);
    }
    block.resolution = resolution_;
    block.maps = &maps_;
    block.host_maps = {
        .data = host_maps_.data(), .size = resolution_, .least = least_.data(), .largest = largest_.data()};
    if (tints_) block.tints = &tints_;
    if (!host_absorption_.empty()) {
        block.host_absorption = {.data = host_absorption_.data(), .size = resolution_};
        block.host_moment = {.data = host_moment_.data(), .size = resolution_};
    }
    return block;
}

const ShadowMaps::Entry* ShadowMaps::acquire(const Request& request) {
    auto found = entries_.find(request.key);
    if (found != entries_.end() && found->second.layers != request.projection.count) {
        take(found->second.first_layer, found->second.layers, false);
        entries_.erase(found);
        found = entries_.end();
    }
    if (found == entries_.end()) {
        const int first = allocate(request.projection.count);
        if (first < 0) return nullptr;
        take(first, request.projection.count, true);
        found = entries_.emplace(request.key, Entry{first, request.projection.count}).first;
    }
    Entry& entry = found->second;
    entry.last_frame = frame_;
    entry.last_block = block_;
    if (entry.casters != casters_generation_) entry.drawn = 0;
    entry.casters = casters_generation_;
    draw(request, entry);
    return &entry;
}

void ShadowMaps::draw(const Request& request, Entry& entry) {
    const unsigned missing = request.needed & ~entry.drawn;
    if (missing == 0) return;
    std::vector<const SceneSnapshot::Object*> left_out;
    for (const size_t caster : request.casters.left_out) left_out.push_back(extent_.object(caster));
    const MapCasters casters{*list_, left_out};
    for (int i = 0; i < entry.layers; ++i) {
        if (!(missing >> i & 1)) continue;
        const ShadowView& view = request.projection.views[size_t(i)];
        const int layer = entry.first_layer + i;
        if (in_host_memory_) {
            draw_in_host_memory(view, casters, layer);
            continue;
        }
        pass_.draw(view, casters, maps_, layer, framebuffers_[size_t(layer)]);
        if (tints_) pass_.draw_tints(view, casters, tint_framebuffers_[size_t(layer)]);
    }
    entry.drawn |= missing;
    ++drawn_;
}

std::span<float> ShadowMaps::host_layer(std::vector<float>& values, int layer, int channels) const {
    const size_t count = size_t(resolution_) * size_t(resolution_) * size_t(channels);
    return std::span(values).subspan(size_t(layer) * count, count);
}

void ShadowMaps::draw_in_host_memory(const ShadowView& view, const MapCasters& casters, int layer) {
    pass_.draw(view, casters, resolution_, host_layer(host_maps_, layer, 1));
    note_bounds(layer);
    if (host_absorption_.empty()) return;
    TintLayer tints(host_layer(host_absorption_, layer, 4), host_layer(host_moment_, layer, 4), resolution_,
                    no_shadow_depth);
    pass_.draw_tints(view, casters, tints);
}

void ShadowMaps::note_bounds(int layer) {
    constexpr int side = native::Layers::block_size;
    using Map = Eigen::Array<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    const Eigen::Map<const Map> map(host_layer(host_maps_, layer, 1).data(), resolution_, resolution_);
    const int blocks = native::Layers::blocks_of(resolution_);
    const size_t first = size_t(layer) * size_t(blocks) * size_t(blocks);
    parallel_for(size_t(blocks), 4, [&](size_t row) {
        const int y = int(row) * side, height = std::min(side, resolution_ - y);
        for (int column = 0; column < blocks; ++column) {
            const int x = column * side, width = std::min(side, resolution_ - x);
            const auto texels = map.block(y, x, height, width);
            const size_t at = first + row * size_t(blocks) + size_t(column);
            least_[at] = texels.minCoeff();
            largest_[at] = texels.maxCoeff();
        }
    });
}

int ShadowMaps::allocate(int layers) {
    const auto run_after = [&](auto&& make_room) {
        int first = free_run(layers);
        while (first < 0 && make_room()) first = free_run(layers);
        return first;
    };
    // What this frame has not asked for goes first, then memory is taken, then maps of earlier blocks go.
    int first = run_after([&] { return evict_before(frame_, block_); });
    if (first < 0) first = run_after([&] { return grow(layers); });
    if (first < 0) first = run_after([&] { return evict_before(frame_ + 1, block_); });
    return first;
}

int ShadowMaps::free_run(int layers) const {
    int run = 0;
    for (size_t i = 0; i < taken_.size(); ++i) {
        run = taken_[i] ? 0 : run + 1;
        if (run == layers) return int(i) + 1 - layers;
    }
    return -1;
}

bool ShadowMaps::evict_before(uint64_t frame, uint64_t block) {
    auto oldest = entries_.end();
    for (auto it = entries_.begin(); it != entries_.end(); ++it) {
        const Entry& entry = it->second;
        if (entry.last_frame >= frame || entry.last_block >= block) continue;
        // Of those that the next frame asks for again, the one just drawn from is asked for last.
        const auto goes_first = [](const Entry& a, const Entry& b) {
            return a.last_frame != b.last_frame ? a.last_frame < b.last_frame : a.last_block > b.last_block;
        };
        if (oldest == entries_.end() || goes_first(entry, oldest->second)) oldest = it;
    }
    if (oldest == entries_.end()) return false;
    take(oldest->second.first_layer, oldest->second.layers, false);
    entries_.erase(oldest);
    return true;
}

bool ShadowMaps::grow(int layers) {
    const int before = int(taken_.size()), most = most_layers(resolution_, tinted_);
    if (before >= most) return false;
    const int after = std::min(most, std::max({before + layers, before * 3 / 2, wanted_layers_}));
    const auto enlarge = [&](gl::Texture& texture, gl::Format format) {
        gl::Texture larger = gl::Texture::layered(format, resolution_, resolution_, after);
        if (before > 0) gl::copy_layers(texture, larger, before);
        texture = std::move(larger);
    };
    taken_.resize(size_t(after), false);
    if (in_host_memory_) {
        host_maps_.resize(size_t(after) * size_t(resolution_) * size_t(resolution_));
        const auto blocks = size_t(native::Layers::blocks_of(resolution_));
        least_.resize(size_t(after) * blocks * blocks + read_past);
        largest_.resize(size_t(after) * blocks * blocks + read_past);
        prepare_tints();
        return true;
    }
    enlarge(maps_, map_format);
    if (tinted_) enlarge(tints_.absorption, tint_format);
    if (tinted_) enlarge(tints_.moment, tint_format);
    make_framebuffers();
    return true;
}

void ShadowMaps::prepare_tints() {
    // What casts has changed, so that all maps are drawn anew.
    const size_t host_size = tinted_ && in_host_memory_ ? 4 * host_maps_.size() : 0;
    host_absorption_.resize(host_size);
    host_moment_.resize(host_size);
    if (!tinted_ || resolution_ == 0) tints_ = {};
    if (tinted_ == bool(tints_) || !maps_) return;
    tints_.absorption = gl::Texture::layered(tint_format, resolution_, resolution_, maps_.layers());
    tints_.moment = gl::Texture::layered(tint_format, resolution_, resolution_, maps_.layers());
    make_framebuffers();
}

void ShadowMaps::make_framebuffers() {
    framebuffers_.clear();
    tint_framebuffers_.clear();
    for (int layer = 0; layer < maps_.layers(); ++layer) {
        framebuffers_.emplace_back(maps_, layer);
        if (tints_)
            tint_framebuffers_.push_back(gl::Framebuffer({&tints_.absorption, &tints_.moment}, layer));
    }
}

void ShadowMaps::take(int first, int layers, bool taken) {
    std::fill_n(taken_.begin() + first, layers, taken);
}

}  // namespace easypbr::render
