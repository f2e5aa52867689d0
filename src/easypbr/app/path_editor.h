// A camera path that is being made: keys are added, changed, moved; it is played and scrubbed.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "easypbr/scene/camera_path.h"

namespace easypbr::app {

class PathEditor {
  public:
    const std::vector<CameraKey>& keys() const { return keys_; }
    const CameraPathOptions& options() const { return options_; }
    void set_options(const CameraPathOptions& options);

    /// The path through the keys; nothing while there is none, with fewer than two keys or a combination that
    /// is no path. Then problem() says why (empty without keys).
    const std::optional<CameraPath>& path() const { return path_; }
    const std::string& problem() const { return problem_; }

    /// A key of the camera's pose, before key `at` (or the end); its time is that of the key before it. The
    /// angle of view is the camera's, where it has one. Throws NameError for a key there is not, as all here.
    void insert(size_t at, const Camera& camera);
    void add(const Camera& camera) { insert(keys_.size(), camera); }
    void replace(size_t key, const Camera& camera);
    void remove(size_t key);
    /// Changes the order: the key comes before the one that is `to` now, or after, going down.
    void move(size_t key, size_t to);
    /// Seconds to the next key. Throws ArgumentError unless above 0.
    void set_segment(size_t key, double seconds);
    void clear();
    /// Takes a path over as it is. An orbit has no keys: a key that is added replaces it.
    void set(const CameraPath& path);

    /// Where it is being played or scrubbed, in [0, duration].
    double time() const { return time_; }
    void seek(double time_s);
    bool is_playing() const { return playing_; }
    /// From the start when it is at the end. Nothing happens without a path.
    void play();
    void pause() { playing_ = false; }
    /// Lets time pass while it is played: an open path ends at its end, a closed one goes around. Returns
    /// whether the camera has to be moved to time(), also after seek().
    bool advance(double seconds);

  private:
    void require(size_t key) const;
    void rebuild();

    std::vector<CameraKey> keys_;
    CameraPathOptions options_;
    std::optional<CameraPath> path_;
    std::string problem_;
    double time_ = 0;
    bool playing_ = false, moved_ = false;
};

}  // namespace easypbr::app
