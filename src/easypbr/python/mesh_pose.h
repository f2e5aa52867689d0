// Members of Mesh about where it is and what hangs below it.
#pragma once

#include <nanobind/nanobind.h>

#include "easypbr/scene/mesh.h"

namespace easypbr::python {

void bind_mesh_pose(nanobind::class_<Mesh>& mesh);

}  // namespace easypbr::python
