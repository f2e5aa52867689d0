// Waits for the driver that can be interrupted.
#pragma once

#include "easypbr/gl/object.h"

namespace easypbr::gl {

/// Keeps a loop that draws close to the driver where somebody may interrupt it (core/interrupt.h): without, a
/// driver takes minutes of work at once, and a picture that nobody wants any more has to be waited for.
class Pace {
  public:
    /// Called after each round: waits until the driver has done the round before. Throws Interrupted.
    void step();

  private:
    Object fence_;
};

/// Waits until the driver has done all that it was given. Throws Interrupted. Does nothing where nobody may
/// interrupt: what follows waits by itself.
void wait_for_driver();

}  // namespace easypbr::gl
