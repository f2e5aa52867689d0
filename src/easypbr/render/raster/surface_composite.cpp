#include "easypbr/render/raster/surface_composite.h"

#include <algorithm>
#include <array>
#include <span>
#include <utility>
#include <vector>

#include "easypbr/core/parallel.h"

namespace easypbr::render {

const GBuffer& SurfaceComposite::staging(const Frame& frame, const SurfaceOutputs& outputs) {
    if (staging_.size() != frame.size) staging_ = GBuffer(frame.size);
    if (outputs.ids) staging_.add_ids();
    if (outputs.extensions) staging_.add_extensions();
    return staging_;
}

void SurfaceComposite::draw(const Frame& frame, const GBuffer& targets, const SurfaceOutputs& outputs,
                            Transfers& transfers) {
    const PixelRect area = staging_.depth.area();
    const bool emission = staging_.emission.is_ahead(), extensions = staging_.extension[0].is_ahead();
    staging_.upload(transfers);
    copy(frame, staging_, area, targets, outputs, {.emission = emission, .extensions = extensions});
}

void SurfaceComposite::draw_over(const Frame& frame, const GBuffer& source, const GBuffer& targets,
                                 const SurfaceOutputs& outputs) {
    copy(frame, source, frame.whole(), targets, outputs,
         {.always = true, .emission = true, .extensions = outputs.extensions != 0});
}

namespace {

/// Binds what a G-buffer holds to the units and samplers of shaders that read surfaces.
void bind_surface(const gl::Program& program, const Frame& frame, const GBuffer& source, bool ids) {
    program.set("u_size", Vec2(frame.size.cast<float>()));
    const Target* sources[] = {&source.albedo,   &source.normal, &source.material, &source.depth,
                               &source.radiance, &source.id,     &source.element};
    const char* samplers[] = {"u_albedo",   "u_normal", "u_material", "u_depth_target",
                              "u_emission", "u_id",     "u_element"};
    for (unsigned unit = 0; unit < (ids ? 7u : 5u); ++unit) {
        sources[unit]->bind(unit);
        program.set(samplers[unit], int(unit));
    }
}

}  // namespace

void SurfaceComposite::copy(const Frame& frame, const GBuffer& source, const PixelRect& r,
                            const GBuffer& targets, const SurfaceOutputs& outputs, How how) {
    if (r.width == 0 || r.height == 0) return;
    std::vector<std::string> defines;
    if (outputs.ids) defines.emplace_back("OBJECT_ID");
    if (how.emission) defines.emplace_back("WITH_EMISSION");
    if (how.extensions) defines.emplace_back("WITH_EXTENSION");
    const gl::Program& program = programs_.get(defines);
    (outputs.ids      ? targets.surface_ids()
     : how.extensions ? targets.surface_extended()
                      : targets.surface_emission())
        .bind();
    program.use();
    bind_surface(program, frame, source, outputs.ids);
    for (unsigned i = 0; how.extensions && i < 2; ++i) {
        source.extension[i].bind(7 + i);
        program.set(i == 0 ? "u_extension0" : "u_extension1", int(7 + i));
    }
    gl::DrawState state = screen_state(r);
    state.depth_test = how.always ? gl::DepthTest::always : gl::DepthTest::greater;
    state.write_depth = true;
    gl::draw_screen(state);
}

namespace {

/// What host memory holds of a G-buffer, pixel by pixel.
class HostSurfaces {
  public:
    /// One pixel.
    struct Pixel {
        uint64_t albedo = 0;
        uint32_t normal = 0, material = 0, id = 0, element = 0;
        float depth = 0;
        std::array<float, 4> emission{0, 0, 0, 1};
        std::array<std::array<uint32_t, 4>, 2> extension{};
    };

    explicit HostSurfaces(const GBuffer& g)
        : albedo_(g.albedo.pixels<uint64_t>()),
          normal_(g.normal.pixels<uint32_t>()),
          material_(g.material.pixels<uint32_t>()),
          depth_(g.depth.pixels<float>()) {
        if (g.emission.is_ahead()) emission_ = g.emission.pixels<std::array<float, 4>>();
        if (g.id && g.id.is_ahead()) {
            id_ = g.id.pixels<uint32_t>();
            element_ = g.element.pixels<uint32_t>();
        }
        for (size_t i = 0; i < 2; ++i)
            if (g.extension[i] && g.extension[i].is_ahead())
                extension_[i] = g.extension[i].pixels<std::array<uint32_t, 4>>();
    }

    size_t size() const { return depth_.size(); }
    float depth(size_t i) const { return depth_[i]; }
    Pixel get(size_t i) const {
        Pixel p{.albedo = albedo_[i], .normal = normal_[i], .material = material_[i], .depth = depth_[i]};
        if (!id_.empty()) p.id = id_[i], p.element = element_[i];
        if (!emission_.empty()) p.emission = emission_[i];
        for (size_t k = 0; k < 2; ++k)
            if (!extension_[k].empty()) p.extension[k] = extension_[k][i];
        return p;
    }
    void put(size_t i, const Pixel& p) const {
        albedo_[i] = p.albedo;
        normal_[i] = p.normal;
        material_[i] = p.material;
        depth_[i] = p.depth;
        if (!id_.empty()) id_[i] = p.id, element_[i] = p.element;
        if (!emission_.empty()) emission_[i] = p.emission;
        for (size_t k = 0; k < 2; ++k)
            if (!extension_[k].empty()) extension_[k][i] = p.extension[k];
    }

  private:
    std::span<uint64_t> albedo_;
    std::span<uint32_t> normal_, material_;
    std::span<float> depth_;
    std::span<std::array<float, 4>> emission_;         ///< empty where nothing emits
    std::span<uint32_t> id_, element_;                 ///< empty where they are not asked for
    std::span<std::array<uint32_t, 4>> extension_[2];  ///< the same
};

/// Where gaps are, and what closes them: see fill_holes.frag.
class Gaps {
  public:
    Gaps(const Frame& frame, const HostSurfaces& surfaces)
        : size_(frame.size),
          orthographic_(frame.orthographic()),
          near_(float(frame.camera.near)),
          far_(float(frame.camera.far)),
          surfaces_(surfaces) {}

    /// The pixel whose surface closes a gap at another one; negative: there is none.
    long filler_of(int x, int y) const {
        std::array<float, 8> depths;
        float nearest = 0;
        long best = -1;
        size_t k = 0;
        for (int dy = -1; dy <= 1; ++dy)
            for (int dx = -1; dx <= 1; ++dx) {
                if (dx == 0 && dy == 0) continue;
                const size_t at =
                    index_of(std::clamp(x + dx, 0, size_.x() - 1), std::clamp(y + dy, 0, size_.y() - 1));
                depths[k] = surfaces_.depth(at);
                if (depths[k] > nearest) {
                    nearest = depths[k];
                    best = long(at);
                }
                ++k;
            }
        if (best < 0) return best;
        const float reach = axial(nearest) * 1.01f, own = surfaces_.depth(index_of(x, y));
        const auto count = std::ranges::count_if(depths, [&](float d) { return d > 0 && axial(d) <= reach; });
        return count < 5 || (own > 0 && axial(own) <= reach) ? -1 : best;
    }
    size_t index_of(int x, int y) const { return size_t(y) * size_t(size_.x()) + size_t(x); }

  private:
    /// Distance along the optical axis, where there is nothing too.
    float axial(float depth) const {
        if (orthographic_) return far_ + (near_ - far_) * depth;
        return depth > 0 ? near_ / depth : 3e38f;
    }

    Vec2i size_;
    bool orthographic_;
    float near_, far_;
    const HostSurfaces& surfaces_;
};

}  // namespace

void SurfaceComposite::put_over(const GBuffer& source, const GBuffer& targets) {
    const HostSurfaces from(source), to(targets);
    parallel_for(to.size(), size_t(1) << 14, [&](size_t i) {
        if (from.depth(i) > 0) to.put(i, from.get(i));
    });
}

void SurfaceComposite::fill_host_holes(const Frame& frame, const GBuffer& targets, int times) {
    const HostSurfaces surfaces(targets);
    const Gaps gaps(frame, surfaces);
    using Filled = std::pair<size_t, HostSurfaces::Pixel>;
    std::vector<std::vector<Filled>> rows(size_t(frame.size.y()));
    for (int i = 0; i < times; ++i) {
        parallel_for(rows.size(), 16, [&](size_t y) {
            rows[y].clear();
            for (int x = 0; x < frame.size.x(); ++x) {
                const long filler = gaps.filler_of(x, int(y));
                if (filler < 0) continue;
                HostSurfaces::Pixel pixel = surfaces.get(size_t(filler));
                pixel.emission = {0, 0, 0, 1};
                rows[y].emplace_back(gaps.index_of(x, int(y)), pixel);
            }
        });
        // All gaps are found before the first is closed.
        for (const auto& row : rows)
            for (const auto& [at, pixel] : row) surfaces.put(at, pixel);
    }
}

void SurfaceComposite::fill_holes(const Frame& frame, const GBuffer& targets, const SurfaceOutputs& outputs,
                                  int times) {
    staging(frame, outputs);
    std::vector<std::string> defines;
    if (frame.orthographic()) defines.emplace_back("ORTHOGRAPHIC");
    if (outputs.ids) defines.emplace_back("OBJECT_ID");
    for (int i = 0; i < times; ++i) {
        staging_.clear(outputs.ids);
        const gl::Program& program = fill_.get(defines);
        (outputs.ids ? staging_.surface_ids() : staging_.surface()).bind();
        program.use();
        bind_surface(program, frame, targets, outputs.ids);
        program.set("u_depth", Vec3(float(frame.camera.near), float(frame.camera.far), 0));
        gl::draw_screen({.depth_test = gl::DepthTest::always, .write_depth = true});
        copy(frame, staging_, frame.whole(), targets, outputs, {});
    }
}

}  // namespace easypbr::render
