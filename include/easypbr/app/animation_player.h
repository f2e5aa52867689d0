// Plays the animations of files by a clock.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "easypbr/app/clock.h"
#include "easypbr/core/math.h"
#include "easypbr/scene/animation.h"
#include "easypbr/scene/scene.h"

namespace easypbr::app {

/// The name of a file's light in a scene: "robot/lamp", of a file without a name "lamp".
std::string light_name(const std::string& file, const std::string& light);

/// Puts the lights of a file that an animation moves or changes where they are at a time, those that the
/// scene has under light_name(). Whether they are enabled, cast shadows and how large they are stays as it
/// is. Throws as Animations::apply().
void put_lights(Scene scene, const std::string& file, const Animations& animations, size_t index,
                double time_s, bool loop = true);

/// One animation plays at a time. Its time follows the clock's: that of a recording, of a fixed step, or real
/// time; setting the clock's time back sets the animation back, at most to where it began to play.
class AnimationPlayer {
  public:
    /// The clock must outlive the player.
    explicit AnimationPlayer(const Clock& clock);
    ~AnimationPlayer();

    /// Makes a file's animations known under its name; those of a file of this name are replaced. Nothing
    /// plays yet. They move the file's lights in `scene`, see put_lights().
    void add(const std::string& file, const Animations& animations,
             const std::optional<Scene>& scene = std::nullopt);
    /// Forgets those of a file; the one that played ends with it. Nothing happens when there are none.
    void remove(const std::string& file);
    /// "robot: Walk" for each that is known; "Walk" of a file without a name.
    const std::vector<std::string>& names() const { return names_; }
    bool empty() const { return names_.empty(); }
    /// Whether animations of a file of this name are known.
    bool has(const std::string& file) const;

    /// Which of names() is played, and the file's own name for it.
    size_t current() const { return current_; }
    double duration_s() const;

    /// Plays animation `number` of names() from its start, backwards without a loop from its end. Throws
    /// NameError for a number there is not.
    void play(size_t number);
    /// By the file's name and the animation's name or number. Throws NameError with the nearest name.
    void play(const std::string& file, const std::string& animation);
    /// Goes on from where it was; from its start when it is at its end, without a loop. Throws ArgumentError
    /// when no animation is known.
    void resume();
    void pause();
    /// Neither paused nor, without a loop, at its end.
    bool is_playing() const { return playing_ && !has_ended(); }

    /// Seconds of the animation, not yet wound around; without a loop within its duration.
    double time() const;
    /// The time within its duration that is shown, see Animations::time_in().
    double shown_time() const;
    /// Puts the meshes where they are at a time; it then goes on from there. Throws ArgumentError when the
    /// time is not finite or no animation is known.
    void seek(double time_s);
    /// How fast it plays, 1 as it was made; below 0 backwards. Throws ArgumentError when it is not finite.
    void set_speed(double speed);
    double speed() const { return speed_; }
    /// Whether it goes around; else it rests at its end.
    void set_loop(bool loop);
    bool loops() const { return loop_; }

    /// How the animation's meshes moved in the `seconds` of the clock before now, playing or not; see
    /// Animations::motion(). At its beginning the animation has not moved.
    MovedMeshes motion(double seconds) const;

    /// In how many of the clock's next `seconds` all is shown that they show: at most one time around, and 0
    /// when nothing plays.
    double seconds_ahead(double seconds) const;
    /// Puts the meshes where they will be `seconds` of the clock from now, while it plays; 0: back where they
    /// were put last. Time and lights stay as they are. Nothing happens when no animation is known.
    void look_ahead(double seconds);

    /// After the clock's tick: puts the meshes where they are now, while it plays.
    void update();
    /// After the clock's time was set.
    void follow_set_clock();
    /// Called when meshes are put where they jumped to, with the motion they have in place of that: where an
    /// animation begins or goes around, and at steps; see Animations::jumps().
    std::function<void(const MovedMeshes&)> on_jump;

  private:
    struct File;
    struct Place {
        size_t file, index;
    };
    void apply();
    /// `seconds` of the clock from now.
    double time_after(double seconds) const;
    bool has_ended() const;
    double start_s() const;
    void rebuild_names();

    const Clock& clock_;
    std::vector<File> files_;
    std::vector<Place> places_;
    std::vector<std::string> names_;
    size_t current_ = 0;
    double speed_ = 1, base_ = 0, clock_base_ = 0;
    bool playing_ = false, loop_ = true;
    std::optional<double> applied_;  ///< time of the current animation that the meshes were put to last
};

}  // namespace easypbr::app
