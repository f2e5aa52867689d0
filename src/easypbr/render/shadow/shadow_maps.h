// Which light gets which shadow maps, and which of them must be drawn anew.
#pragma once

#include <algorithm>
#include <array>
#include <map>
#include <vector>

#include "easypbr/render/frame/frame.h"
#include "easypbr/render/shadow/caster_bounds.h"
#include "easypbr/render/shadow/light_block.h"
#include "easypbr/render/shadow/shadow_pass.h"

namespace easypbr::render {

/// Keeps the maps of all lights in the layers of one texture, by what they show: a map is drawn when its
/// light, what casts, or the ground has changed, not when the camera has. Lights beyond its memory are drawn
/// from maps made anew for every frame.
class ShadowMaps {
  public:
    /// Both must outlive this.
    ShadowMaps(const Primitives& primitives, Transfers& transfers)
        : primitives_(primitives), pass_(primitives, transfers) {}

    /// Where surfaces are that receive shadows: nowhere for a bare cloud or labels in their own colours,
    /// within the bounds of what casts, a little beyond them, or on the ground too.
    enum class Receivers { none, within, around, on_ground };

    /// Takes note of a frame's lights and of what casts. Only maps that receivers need are drawn. `casters`
    /// must live until its last block.
    void begin(const Frame& frame, const DrawList& casters, Receivers receivers);

    /// Whether some light of the frame has maps.
    bool has_shadows() const { return std::ranges::any_of(requests_, &Request::shadowed); }

    /// Whether some casters weaken light instead of stopping it.
    bool has_tints() const { return tinted_; }
    /// Whether these can be drawn natively.
    bool has_native_tints() const;
    /// Where the maps of the frame's lights are from now on; with tints in host memory if has_native_tints().
    void keep_in_host_memory(bool host);

    /// Goes back to the first block.
    void rewind() { next_ = 0; }

    /// The next lights in the order of a block, with their maps drawn. Valid until the next call.
    LightBlock next_block();
    bool has_more() const { return next_ < requests_.size(); }

    /// See ShadowPass.
    void allow_native(bool allow) { pass_.allow_native(allow); }

    /// Changes with what casts shadows and its bounds; of the last frame, as are the bounds.
    uint64_t casters_generation() const { return casters_generation_; }
    const Box3d& caster_bounds() const { return bounds_; }

    /// How often the maps of a light have been drawn since the beginning; a cube counts once.
    uint64_t drawn() const { return drawn_; }

  private:
    /// All that decides about a light's maps, but the casters themselves: the light, and which casters the
    /// maps show.
    using LightKey = std::vector<double>;
    struct Entry {
        int first_layer = 0, layers = 0;
        uint64_t casters = 0;     ///< generation of the casters that it shows
        unsigned drawn = 0;       ///< its maps that are, as bits
        uint64_t last_frame = 0;  ///< that asked for it
        uint64_t last_block = 0;
    };
    struct Request {
        const ResolvedLight* light = nullptr;
        bool shadowed = false;
        LightKey key;
        UsefulCasters casters;
        ShadowProjection projection;
        unsigned needed = 0;  ///< maps, as bits
        double radius = 0;
    };
    /// What the shader of a caster sees of its material.
    struct Shaded {
        std::string text;
        std::vector<float> numbers;
        std::vector<const void*> images;
        bool operator==(const Shaded&) const = default;
    };
    /// A part of an object as far as its shadow is concerned.
    struct Caster {
        DrawMode kind{};
        ShadowShape shape;
        Shaded shaded;
        std::array<uint64_t, 2> revisions;
        AlphaMode alpha_mode{};
        std::array<const void*, 3> images;
        std::array<float, 3> alpha;
        Vec3 through{0, 0, 0};
        std::array<float, 2> thickness;
        int first_face, face_count;
        Eigen::Matrix<double, 3, 4> T_world_mesh;
        bool operator==(const Caster&) const = default;
    };

    static Shaded shaded_by(const DrawItem& item);
    static Caster caster_of(const DrawItem& item);
    void note_casters(const DrawList& list, const Box3d& bounds);
    Request request_of(const ResolvedLight& light, const Frame& frame, Receivers receivers) const;
    /// Forgets all maps of another size; 0: no maps.
    void set_resolution(int resolution);
    /// The entry of a request, its maps drawn; null when there is no room beside the others of this block.
    const Entry* acquire(const Request& request);
    /// Draws the maps of a request that are not drawn yet.
    void draw(const Request& request, Entry& entry);

    /// First of so many free layers, made free if need be; -1 when there are none.
    int allocate(int layers);
    int free_run(int layers) const;
    /// Gives back the layers of the entry that has not been asked for the longest, but for those asked for
    /// since a frame and block.
    bool evict_before(uint64_t frame, uint64_t block);
    /// To what all requests of the frame need, as far as there is memory.
    bool grow(int layers);
    void make_framebuffers();
    void draw_in_host_memory(const ShadowView& view, const MapCasters& casters, int layer);
    /// A layer of something in host memory, so many floats a texel.
    std::span<float> host_layer(std::vector<float>& values, int layer, int channels) const;
    /// Finds the bounds of the blocks of a layer, see native::Layers.
    void note_bounds(int layer);
    /// Keeps tints beside the maps only while something needs them.
    void prepare_tints();
    void take(int first, int layers, bool taken);

    const Primitives& primitives_;
    ShadowPass pass_;
    bool in_host_memory_ = false;
    gl::Texture maps_;
    std::vector<float> host_maps_;
    std::vector<float> least_, largest_;                ///< of the blocks of host_maps_
    std::vector<float> host_absorption_, host_moment_;  ///< tints_ in host memory
    ShadowTints tints_;                                 ///< beside the maps while some casters weaken light
    std::vector<gl::Framebuffer> framebuffers_, tint_framebuffers_;  ///< of each layer
    std::vector<bool> taken_;                                        ///< layers
    std::map<LightKey, Entry> entries_;
    std::vector<Caster> casters_;
    CasterBounds extent_;
    Box3d bounds_;
    uint64_t casters_generation_ = 0;  ///< changes with what casts and its bounds

    const DrawList* list_ = nullptr;
    int resolution_ = 0;
    bool tinted_ = false;  ///< some casters weaken light instead of stopping it
    uint64_t frame_ = 0, block_ = 0, drawn_ = 0;
    int wanted_layers_ = 0;  ///< of all requests together
    std::vector<Request> requests_;
    size_t next_ = 0;
};

}  // namespace easypbr::render
