// EasyPBR: give it a mesh, it makes a physically based picture. This header is the whole library.
#pragma once

#include "easypbr/core/color.h"
#include "easypbr/core/compare.h"
#include "easypbr/core/error.h"
#include "easypbr/core/image.h"
#include "easypbr/core/log.h"
#include "easypbr/geometry/primitives.h"
#include "easypbr/io/image_io.h"
#include "easypbr/io/mesh_io.h"
#include "easypbr/scene/camera.h"
#include "easypbr/scene/environment.h"
#include "easypbr/scene/fields.h"
#include "easypbr/scene/mesh.h"
#include "easypbr/scene/normals.h"
#include "easypbr/scene/scene.h"
#include "easypbr/scene/settings.h"
#include "easypbr/viewer/viewer.h"
