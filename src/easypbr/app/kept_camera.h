// Puts the camera back at the end of a scope.
#pragma once

#include "easypbr/app/session.h"
#include "easypbr/scene/settings.h"

namespace easypbr::app {

class KeptCamera {
  public:
    explicit KeptCamera(Session& session) : session_(session), camera_(session.settings().camera) {}
    ~KeptCamera() { session_.settings().camera = camera_; }
    KeptCamera(const KeptCamera&) = delete;
    KeptCamera& operator=(const KeptCamera&) = delete;

  private:
    Session& session_;
    CameraSettings camera_;
};

}  // namespace easypbr::app
