#include "easypbr/app/animation_player.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "easypbr/core/error.h"
#include "easypbr/core/suggest.h"

namespace easypbr::app {

struct AnimationPlayer::File {
    std::string name;
    Animations animations;
    std::optional<Scene> scene;
};

std::string light_name(const std::string& file, const std::string& light) {
    return file.empty() ? light : fmt::format("{}/{}", file, light);
}

void put_lights(Scene scene, const std::string& file, const Animations& animations, size_t index,
                double time_s, bool loop) {
    const std::vector<std::string> known = scene.light_names();
    for (auto& [name, moved] : animations.lights(index, time_s, loop)) {
        const std::string full = light_name(file, name);
        if (std::ranges::find(known, full) == known.end()) continue;
        const Light before = scene.light(full);
        Light light = moved;
        light.enabled = before.enabled;
        light.casts_shadows = before.casts_shadows;
        light.angular_radius_deg = before.angular_radius_deg;
        light.radius = before.radius;
        if (!(light == before)) scene.set_light(full, light);
    }
}

void AnimationPlayer::rebuild_names() {
    applied_.reset();
    places_.clear();
    names_.clear();
    for (size_t file = 0; file < files_.size(); ++file) {
        const std::vector<std::string> names = files_[file].animations.names();
        for (size_t index = 0; index < names.size(); ++index) {
            places_.push_back({file, index});
            const std::string name = names[index].empty() ? fmt::format("animation {}", index) : names[index];
            names_.push_back(files_[file].name.empty() ? name
                                                       : fmt::format("{}: {}", files_[file].name, name));
        }
    }
}

AnimationPlayer::AnimationPlayer(const Clock& clock) : clock_(clock) {}
AnimationPlayer::~AnimationPlayer() = default;

void AnimationPlayer::add(const std::string& file, const Animations& animations,
                          const std::optional<Scene>& scene) {
    const auto known = std::ranges::find(files_, file, &File::name);
    if (known != files_.end())
        *known = {file, animations, scene};
    else
        files_.push_back({file, animations, scene});
    rebuild_names();
    if (current_ >= places_.size()) {
        current_ = 0;
        playing_ = false;
    }
}

void AnimationPlayer::remove(const std::string& file) {
    const auto known = std::ranges::find(files_, file, &File::name);
    if (known == files_.end()) return;
    const size_t removed = size_t(known - files_.begin());
    const size_t first = size_t(std::ranges::find(places_, removed, &Place::file) - places_.begin());
    const size_t count = known->animations.names().size();
    files_.erase(known);
    rebuild_names();
    if (current_ >= first + count) {
        current_ -= count;
    } else if (current_ >= first) {
        current_ = 0;
        playing_ = false;
        base_ = 0;
    }
}

bool AnimationPlayer::has(const std::string& file) const {
    return std::ranges::find(files_, file, &File::name) != files_.end();
}

double AnimationPlayer::duration_s() const {
    if (empty()) return 0;
    const Place place = places_[current_];
    return files_[place.file].animations.duration_s(place.index);
}

void AnimationPlayer::play(size_t number) {
    if (number >= places_.size())
        throw NameError(fmt::format("no animation {}, there are {}", number, places_.size()));
    current_ = number;
    applied_.reset();
    seek(start_s());
    playing_ = true;
}

void AnimationPlayer::play(const std::string& file, const std::string& animation) {
    std::vector<std::string> files;
    for (const File& known : files_) files.push_back(known.name);
    const auto found = std::ranges::find(files, file);
    if (found == files.end())
        throw NameError(fmt::format("no animations of '{}'{}", file, did_you_mean(file, files)));
    const size_t number = size_t(found - files.begin());
    const size_t index = files_[number].animations.find(animation);
    for (size_t i = 0; i < places_.size(); ++i)
        if (places_[i].file == number && places_[i].index == index) play(i);
}

void AnimationPlayer::resume() {
    if (empty()) throw ArgumentError("there is no animation to play: give play() those of load_scene()");
    base_ = has_ended() ? start_s() : time();
    clock_base_ = clock_.time();
    playing_ = true;
}

double AnimationPlayer::start_s() const {
    return !loop_ && speed_ < 0 ? duration_s() : 0;
}

bool AnimationPlayer::has_ended() const {
    return !empty() && !loop_ && (speed_ < 0 ? time() <= 0 : time() >= duration_s());
}

void AnimationPlayer::pause() {
    base_ = time();
    playing_ = false;
}

double AnimationPlayer::time_after(double seconds) const {
    const double time_s = playing_ ? base_ + speed_ * (clock_.time() - clock_base_ + seconds) : base_;
    return loop_ ? time_s : std::clamp(time_s, 0.0, duration_s());
}

double AnimationPlayer::time() const {
    return time_after(0);
}

double AnimationPlayer::shown_time() const {
    if (empty()) return 0;
    const Place place = places_[current_];
    return files_[place.file].animations.time_in(place.index, time(), loop_);
}

void AnimationPlayer::seek(double time_s) {
    if (empty()) throw ArgumentError("there is no animation to play: give play() those of load_scene()");
    if (!std::isfinite(time_s))
        throw ArgumentError(fmt::format("animation: expected finite seconds, got {}", time_s));
    base_ = time_s;
    clock_base_ = clock_.time();
    apply();
}

void AnimationPlayer::set_speed(double speed) {
    if (!std::isfinite(speed))
        throw ArgumentError(fmt::format("animation: expected a finite speed, got {}", speed));
    base_ = time();
    clock_base_ = clock_.time();
    speed_ = speed;
}

void AnimationPlayer::set_loop(bool loop) {
    // What goes around no more goes on from where it is shown.
    base_ = loop ? time() : shown_time();
    clock_base_ = clock_.time();
    loop_ = loop;
}

void AnimationPlayer::follow_set_clock() {
    clock_base_ = std::min(clock_base_, clock_.time());
}

MovedMeshes AnimationPlayer::motion(double seconds) const {
    if (empty()) return {};
    const Place place = places_[current_];
    return files_[place.file].animations.motion(place.index, time() - seconds * speed_, time(), loop_);
}

double AnimationPlayer::seconds_ahead(double seconds) const {
    if (!is_playing() || speed_ == 0) return 0;
    return std::min(seconds, duration_s() / std::abs(speed_));
}

void AnimationPlayer::look_ahead(double seconds) {
    if (empty()) return;
    const Place place = places_[current_];
    const double time_s = seconds == 0 && applied_ ? *applied_ : time_after(seconds);
    files_[place.file].animations.apply(place.index, time_s, loop_);
}

void AnimationPlayer::update() {
    if (playing_) apply();
}

void AnimationPlayer::apply() {
    const Place place = places_[current_];
    File& file = files_[place.file];
    const double now = time();
    file.animations.apply(place.index, now, loop_);
    if (file.scene) put_lights(*file.scene, file.name, file.animations, place.index, now, loop_);
    const std::optional<double> before = std::exchange(applied_, now);
    if (!on_jump) return;
    const MovedMeshes moved = before ? file.animations.jumps(place.index, *before, now, loop_)
                                     : file.animations.motion(place.index, now, now, loop_);
    if (!moved.empty()) on_jump(moved);
}

}  // namespace easypbr::app
