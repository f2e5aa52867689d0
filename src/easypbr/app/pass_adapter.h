// Passes of a program's own as the renderer calls them.
#pragma once

#include <memory>

#include "easypbr/app/custom_pass.h"
#include "easypbr/render/pipeline/custom_pass.h"

namespace easypbr::app {

/// The renderer's face of a pass, which it keeps alive.
std::shared_ptr<render::Pass> renderer_pass(std::shared_ptr<Pass> pass);

}  // namespace easypbr::app
