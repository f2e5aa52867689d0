// Questions to the driver about what was drawn.
#pragma once

#include "easypbr/gl/object.h"

namespace easypbr::gl {

/// Whether anything was drawn between begin() and end().
class OcclusionQuery {
  public:
    OcclusionQuery() = default;
    static OcclusionQuery make();

    void begin() const;
    void end() const;
    /// Waits for the driver.
    bool any_drawn() const;

    explicit operator bool() const { return bool(object_); }

  private:
    Object object_;
};

}  // namespace easypbr::gl
