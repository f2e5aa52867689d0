// Which settings name files.
#pragma once

#include "easypbr/scene/material_table.h"
#include "easypbr/scene/settings.h"

namespace easypbr {

/// Calls visit(file) with the NamedFile of every setting that names a file, empty where none is named.
/// Changes to it go into the settings unless they are constant.
template <class S, class Visit>
void for_each_file(S& settings, Visit&& visit) {
    visit(settings.environment.file);
    visit(settings.background.image);
    for (const MaterialTexture& row : replaceable_textures()) visit(settings.material.*row.setting);
    visit(settings.material.shader);
}

}  // namespace easypbr
