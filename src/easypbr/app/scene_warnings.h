// Warnings about what is asked for and cannot be seen, each told once until it is mended.
#pragma once

#include <string>

#include "easypbr/app/annotation.h"
#include "easypbr/scene/scene.h"

namespace easypbr {
struct ResolvedSettings;
struct Settings;
}  // namespace easypbr

namespace easypbr::app {

class SceneWarnings {
  public:
    /// Logs what is new: a lens for an orthographic camera; a style that needs normals for a mesh without
    /// any, which is drawn as points; a material with a shader that has no faces to act on; paths that are
    /// asked for where a material has extensions of glTF.
    void check(const SceneSnapshot& scene, const Settings& settings, const ResolvedSettings& resolved);
    /// The same, of a picture that is begun: paths in closed content that no light is within. Takes time
    /// where the camera is within the content.
    void check_light(const SceneSnapshot& scene, const Settings& settings, const ResolvedSettings& resolved);
    /// The same: a legend or a colour bar that there is nothing for, or that a picture of this size has no
    /// room for; characters that the font lacks.
    void check(const Annotation& annotation, const BasicAnnotationSettings<Inferred>& settings, Vec2i size);

  private:
    /// Remembers whether something is wrong; logs `text` when it was not before.
    struct Once {
        bool told = false;
        void tell(const std::string& text);
    };
    Once lens_, normals_, shaders_, light_, legend_, colorbar_, font_, room_;
};

}  // namespace easypbr::app
