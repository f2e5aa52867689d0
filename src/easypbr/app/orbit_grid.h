// Cameras all around the content: a grid of directions.
#pragma once

#include <optional>
#include <vector>

#include "easypbr/app/session.h"

namespace easypbr::app {

struct OrbitGrid {
    int columns = 0;                     ///< around the up axis, counter-clockwise seen from above
    std::vector<double> elevations_deg;  ///< of the rows, growing
    int start_row = 0;                   ///< whose first camera is the session's
    std::vector<Camera> cameras;         ///< row by row
};

/// Throws ArgumentError for columns outside of 1 to 360, rows outside of 1 to 60, a step that is not above 0,
/// and rows that span more than 160 degrees.
void check_orbit_grid(int columns, int rows, double row_step_deg);

/// Turns the session's camera around the middle of the content: `columns` times around the up axis, and up
/// and down in steps, as many to each side as stay within 85 degrees. While the camera is automatic it is far
/// enough away for the content to stay in all pictures. Throws as check_orbit_grid() does.
OrbitGrid orbit_grid(Session& session, int columns, int rows, double row_step_deg,
                     std::optional<Vec2i> size = std::nullopt);

}  // namespace easypbr::app
