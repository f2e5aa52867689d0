// What pickle keeps of meshes, of what they are made of, and of what is found in pictures: everything but
// handles and caches.
#pragma once

#include "easypbr/app/picture.h"
#include "easypbr/dataset/ground_truth.h"
#include "easypbr/python/bindings.h"
#include "easypbr/python/handles.h"
#include "easypbr/python/settings_value.h"
#include "easypbr/scene/camera.h"
#include "easypbr/scene/camera_path.h"
#include "easypbr/scene/environment.h"
#include "easypbr/scene/light.h"

namespace easypbr::python {

// Each gives a class __getstate__ and __setstate__. A state that a newer version has written, of which this
// one does not know all, raises ArgumentError.

/// Children are kept, the parent is not. Arrays are numpy's, which pickle's protocol 5 keeps out of band.
void bind_pickle(nb::class_<Mesh>& mesh);
void bind_pickle(nb::class_<MaterialHandle>& material);
void bind_pickle(nb::class_<StyleHandle>& style);
void bind_pickle(nb::class_<Light>& light);
void bind_pickle(nb::class_<Camera>& camera);
void bind_pickle(nb::class_<CameraPath>& path);
void bind_pickle(nb::class_<Environment>& environment);
void bind_pickle(nb::class_<Automatic>& automatic);
void bind_pickle(nb::class_<Follow>& follow);
void bind_pickle(nb::class_<dataset::Instance>& instance);
void bind_pickle(nb::class_<app::Pick>& pick);

/// Raises TypeError that says what can be pickled instead.
[[noreturn]] void refuse_pickle(const char* name);

}  // namespace easypbr::python
