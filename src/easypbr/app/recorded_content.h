// What is seen over the time of a recording, for what is inferred once for all of its frames.
#pragma once

#include <functional>
#include <vector>

#include "easypbr/core/math.h"
#include "easypbr/scene/auto.h"
#include "easypbr/scene/scene.h"

namespace easypbr {
struct ResolvedSettings;
}

namespace easypbr::app {

class Session;

/// Puts what moves where it is at a time, in seconds.
using PutAt = std::function<void(double time_s)>;

/// The content at moments evenly from 0 to `end_s` as one: each object as often as there are moments. Lights
/// and the rest are those of time 0, which is put last.
SceneSnapshot content_until(const Scene& scene, double end_s, const PutAt& put);

/// Everything that a picture would be drawn with whose automatic camera frames this content in place of the
/// scene's. Nothing is latched. Throws as easypbr::resolve().
ResolvedSettings resolve_for(Session& session, const SceneSnapshot& content, const Vec2i& size);

/// Until the end of the scope an automatic ground rests below the content of all times, instead of sinking
/// with what falls. A height that is pinned or follows stays.
class RestingGround {
  public:
    /// `resolved`: for the content of all times; where it has no ground, nothing is put. Else time 0, the
    /// first one, is put last.
    RestingGround(Session& session, const ResolvedSettings& resolved, const std::vector<double>& times_s,
                  const PutAt& put);
    ~RestingGround();
    RestingGround(const RestingGround&) = delete;
    RestingGround& operator=(const RestingGround&) = delete;

  private:
    Session& session_;
    Auto<double> height_;
};

}  // namespace easypbr::app
