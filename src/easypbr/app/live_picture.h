// LivePicture: a picture of a session that follows what changes: drawn quickly while something moves, refined
// at rest.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "easypbr/app/session.h"
#include "easypbr/gl/texture.h"

namespace easypbr::app {

/// What the drawing takes.
struct LiveStatistics {
    uint64_t pictures = 0;      ///< drawn since the beginning, refinement apart
    int frames = 0, total = 0;  ///< of the picture that is being refined
    double frame_seconds = 0;   ///< of the last frame
    Vec2i size{0, 0};           ///< of the picture, smaller while it moves on slow machines
    std::vector<std::pair<std::string, double>> passes;  ///< milliseconds of the last frame, when measured
};

/// What is to be shown.
struct LiveShot {
    Vec2i size{1, 1};
    std::string channel = "picture";  ///< this, "slices", or a layer's name
    bool moving = false;              ///< frames should come quickly
    double resolution = 1;            ///< share of `size` that moving pictures have at most
    bool pass_times = false;          ///< measure LiveStatistics::passes
    bool surfaces = false;            ///< known_surfaces() is asked for at rest
    bool refines = true;              ///< at rest it gets better; else the single frame stays
    double longest_s = 0.07;  ///< that a moving one takes on a software context, where a smaller helps
    /// What motion_blur.enabled shows: asked with the camera of each new picture. Another `motion_key` is
    /// another motion.
    std::function<Session::RefinedMotion(const Camera& now)> motion = {};
    std::pair<double, double> motion_key{};
    /// A frame that refines is given up, and the picture begun anew, when this says so: input waits.
    /// Called often; empty: never. finish() does not ask.
    std::function<bool()> interrupt = {};
};

/// A picture that has changed is drawn once as a single frame, smoothed, then refined frame by frame up to
/// image.samples: Session::render()'s picture, bit for bit. A sum of fewer than four frames is not shown, for
/// it would be worse than the single one. While something moves on a software context the resolution follows
/// the time that frames take. What has changed is found out by Session::picture_version().
class LivePicture {
  public:
    /// The session must outlive it. Nothing is drawn yet.
    explicit LivePicture(Session& session) : session_(session) {}

    /// Takes one step: a new picture, one more frame of it, or, when it is complete, what lies under the
    /// pointer; nothing when there is nothing to do. Returns whether what is shown has changed. What cannot
    /// be drawn becomes failure(), leaves the last picture, and is tried again when something changes: true
    /// with has_failed() is a failure that is new. What was lost with the context is drawn again by the next
    /// steps, unless Session::context() throws. Makes the session's context current.
    bool draw(const LiveShot& shot);
    /// As many steps as it takes, as if nothing moved.
    void finish(LiveShot shot);

    bool is_complete() const { return frames_ >= statistics_.total; }
    bool has_failed() const { return failure_.has_value(); }
    const std::string& failure() const { return last_error_; }

    /// Whether there is anything to show.
    bool has_image() const { return !pixels_.empty() || texture_; }
    /// What is shown, stretched over the picture's place; empty before there is any. In the session's
    /// context, which has to be current; pixels that are not there yet are uploaded.
    const gl::Texture& texture() const;
    /// The same, read: RGBA u8, row 0 on top; needs no driver where none draws. Throws ArgumentError before
    /// there is any, gl::ContextLost.
    Image image() const;
    /// Shows another image, RGBA u8, until the next draw(); `draw()` then begins anew.
    void show(const Image& image);
    bool shows_other() const { return shows_other_; }

    const LiveStatistics& statistics() const { return statistics_; }
    /// Of the last frame; none before.
    const ResolvedSettings* resolved() const { return resolved_.get(); }

    /// Where the pointer is; `seen`: nothing lies over the picture there.
    void point_at(Vec2d pixel, bool seen);
    /// What lies there, once it has been looked up.
    const std::optional<Pick>& hovered() const { return hovered_; }

    /// Surfaces of the session as it is now, drawn when they are not known. Throws as
    /// Session::pick_buffer().
    const PickBuffer& surfaces(Vec2i size);
    /// Of what is shown, where they are known; else null.
    const PickBuffer* known_surfaces() const;

  private:
    /// What tells pictures apart.
    struct Key {
        uint64_t version = 0;  ///< see Session::picture_version(); 0: nothing
        std::string channel;
        Vec2i size{0, 0};
        std::pair<double, double> motion{};
    };
    bool step(const LiveShot& shot, uint64_t version);
    /// What was drawn is gone with its context.
    void forget_device();
    bool fail(const std::string& what, const LiveShot& shot, uint64_t version);
    void draw_quickly(const LiveShot& shot, bool adapt);
    bool refine(const LiveShot& shot);
    void show_picture(const Drawn& drawn);
    void show_pixels(Image image);
    void forget_image();
    bool is_stale(const LiveShot& shot, uint64_t version) const;

    Session& session_;
    Image pixels_;                 ///< what is shown, where it is in host memory; else empty
    mutable gl::Texture texture_;  ///< the same, or older than pixels_
    mutable bool is_uploaded_ = false;
    uint64_t device_ = 0;  ///< that it is of, see Session::device_number()
    Key shown_;
    bool shows_other_ = false;
    std::optional<Key> failure_;  ///< what could not be drawn; version 0: nothing had been begun
    std::string last_error_;
    Session::RefinedMotion motion_;  ///< that is refined, with motion_blur.enabled
    int frames_ = 0;                 ///< refined so far
    double reduction_ = 1;           ///< of the resolution while something moves
    LiveStatistics statistics_;
    std::shared_ptr<const ResolvedSettings> resolved_;

    struct Surfaces {
        PickBuffer buffer;
        uint64_t version;
    };
    std::optional<Surfaces> surfaces_;
    Vec2d pointer_{-1, -1};
    bool wants_surfaces_ = false;
    std::optional<Pick> hovered_;
};

}  // namespace easypbr::app
