#include "easypbr/app/recorded_content.h"

#include <algorithm>
#include <iterator>

#include "easypbr/app/session.h"
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
    // The legend is that of the scene: it names each object once.
    const Insets covered = session.insets().with(session.annotation_strip(size));
    return easypbr::resolve(content, session.settings(), size, {}, covered);
}

}  // namespace easypbr::app
