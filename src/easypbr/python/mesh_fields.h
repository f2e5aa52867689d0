// A mesh's labels, label map and scalars in Python. Used by bind_mesh.cpp.
#pragma once

#include <functional>

#include "easypbr/python/bindings.h"
#include "easypbr/scene/mesh_data.h"

namespace easypbr::python {

/// Something read from Python (with the GIL) that is put in place without it.
using MeshChange = std::function<void(MeshData&)>;

/// Warns where float32 takes what tells them apart.
MeshChange prepare_intensities(nb::handle object);
/// Throws ArgumentError for what is no labels; for logits it says argmax.
MeshChange prepare_labels(nb::handle object);
/// A dict of name to values, or None.
MeshChange prepare_scalars(nb::handle object);
/// What to_label_map() takes.
MeshChange prepare_label_map(nb::handle object);

/// label_map, scalars, add_scalar, remove_scalar.
void bind_mesh_fields(nb::class_<Mesh>& mesh);

}  // namespace easypbr::python
