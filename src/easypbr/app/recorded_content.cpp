#include "easypbr/app/recorded_content.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <ranges>

#include "easypbr/app/session.h"
#include "easypbr/scene/auto_parameters.h"
#include "easypbr/scene/resolve.h"
#include "easypbr/scene/settings.h"

namespace easypbr::app {

SceneSnapshot content_until(const Scene& scene, double end_s, const PutAt& put) {
    constexpr int moments = 16;
    SceneSnapshot all;
    for (int i = moments - 1; i >= 0; --i) {
        put(end_s * i / (moments - 1));
        SceneSnapshot now = scene.snapshot();
        std::ranges::move(all.objects, std::back_inserter(now.objects));
        all = std::move(now);
    }
    return all;
}

ResolvedSettings resolve_for(Session& session, const SceneSnapshot& content, const Vec2i& size) {
    session.resolve(size);  // Releases what is latched for less content.
    // Not by Session::resolve_framed(), which takes the legend from what it frames: the content has each
    // object many times, and the scene's legend, which is drawn, names it once.
    const Insets covered = session.insets().with(session.annotation_strip(size));
    return easypbr::resolve(content, session.settings(), size, {}, covered);
}

RestingGround::RestingGround(Session& session, const ResolvedSettings& resolved,
                             const std::vector<double>& times_s, const PutAt& put)
    : session_(session), height_(session.settings().ground.height) {
    if (height_.is_pinned() || height_.is_follow()) return;
    if (resolved.settings.ground.mode == GroundMode::none) return;
    const Vec3d up = parse_up(resolved.settings.camera.up);
    double lowest = height_.value_or(std::numeric_limits<double>::infinity());
    for (auto time_s = times_s.rbegin(); time_s != times_s.rend(); ++time_s) {
        put(*time_s);
        const SceneSnapshot scene = session.scene().snapshot();
        const detail::Content content(scene, session.settings().style);
        lowest = std::min(lowest, detail::ground_below(content.bounds(), up));
    }
    // Pinned, not latched: an object that appears later releases what is latched.
    if (std::isfinite(lowest)) session.settings().ground.height = lowest;
}

RestingGround::~RestingGround() {
    session_.settings().ground.height = height_;
}

}  // namespace easypbr::app
