#include "easypbr/app/path_editor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "easypbr/core/error.h"

namespace easypbr::app {
void PathEditor::require(size_t key) const {
    if (key >= keys_.size())
        throw NameError(fmt::format("camera path: no key {}, there are {}", key, keys_.size()));
}

void PathEditor::rebuild() {
    path_.reset();
    problem_.clear();
    playing_ = playing_ && keys_.size() > 1;
    if (keys_.empty()) return;
    if (keys_.size() == 1) {
        problem_ = "A path needs two keys: look elsewhere and add another.";
        return;
    }
    try {
        path_.emplace(keys_, options_);
        time_ = std::min(time_, path_->duration_s());
    } catch (const ArgumentError& error) {
        problem_ = error.what();
    }
}

void PathEditor::set_options(const CameraPathOptions& options) {
    options_ = options;
    if (!keys_.empty()) rebuild();
}

void PathEditor::insert(size_t at, const Camera& camera) {
    if (at != keys_.size()) require(at);
    const double segment = at > 0 ? keys_[at - 1].segment_s : 1;
    keys_.insert(keys_.begin() + std::ptrdiff_t(at), CameraKey::at(camera, segment));
    rebuild();
}

void PathEditor::replace(size_t key, const Camera& camera) {
    require(key);
    keys_[key] = CameraKey::at(camera, keys_[key].segment_s);
    rebuild();
}

void PathEditor::remove(size_t key) {
    require(key);
    keys_.erase(keys_.begin() + std::ptrdiff_t(key));
    rebuild();
}

void PathEditor::move(size_t key, size_t to) {
    require(key);
    require(to);
    const CameraKey moved = keys_[key];
    keys_.erase(keys_.begin() + std::ptrdiff_t(key));
    keys_.insert(keys_.begin() + std::ptrdiff_t(to), moved);
    rebuild();
}

void PathEditor::set_segment(size_t key, double seconds) {
    require(key);
    if (!(seconds > 0 && std::isfinite(seconds)))
        throw ArgumentError(
            fmt::format("camera path: key {}: expected above 0 seconds, got {}", key, seconds));
    keys_[key].segment_s = seconds;
    rebuild();
}

void PathEditor::clear() {
    keys_.clear();
    time_ = 0;
    rebuild();
}

void PathEditor::set(const CameraPath& path) {
    keys_ = path.keys();
    options_ = path.options();
    problem_.clear();
    path_ = path;
    time_ = 0;
    playing_ = false;
}

void PathEditor::seek(double time_s) {
    if (!std::isfinite(time_s)) throw ArgumentError("camera path: expected finite seconds");
    time_ = std::clamp(time_s, 0.0, path_ ? path_->duration_s() : 0.0);
    moved_ = true;
}

void PathEditor::play() {
    if (!path_) return;
    if (!path_->is_closed() && time_ >= path_->duration_s()) time_ = 0;
    playing_ = moved_ = true;
}

bool PathEditor::advance(double seconds) {
    const bool moved = std::exchange(moved_, false);
    if (!path_) return playing_ = false;
    if (!playing_) return moved;
    // The first frame shows where it begins.
    if (moved) return true;
    time_ += seconds;
    if (path_->is_closed()) {
        time_ = std::fmod(time_, path_->duration_s());
    } else if (time_ >= path_->duration_s()) {
        time_ = path_->duration_s();
        playing_ = false;
    }
    return true;
}

}  // namespace easypbr::app
