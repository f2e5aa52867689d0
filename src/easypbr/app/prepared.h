// Everything that a picture is drawn from.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "easypbr/render/pipeline/renderer.h"
#include "easypbr/scene/resolve.h"
#include "easypbr/scene/scene.h"

namespace easypbr::app {

struct Prepared {
    SceneSnapshot scene;
    ResolvedSettings resolved;
    render::DrawOptions options;
    render::SettingsImages images;
    std::vector<std::pair<const render::Pass*, uint64_t>> passes = {};  ///< with their revisions
};

/// Whether the same is drawn, but for settings and what is inferred.
bool same_content(const Prepared& a, const Prepared& b);

/// Whether the same picture would be drawn. Data never change, so those that are the same object are the
/// same.
bool same_picture(const Prepared& a, const Prepared& b);

}  // namespace easypbr::app
