// OBJ files of tests, read from their text.
#pragma once

#include <string>

#include "easypbr/io/mesh/mesh_io.h"
#include "easypbr/io/mesh/mesh_readers.h"

namespace easypbr::obj_text {

inline MeshData read(const std::string& text, const fs::path& path = "test.obj") {
    MeshData mesh = io::read_obj(io::Source(std::string_view(text), path), {});
    validate(mesh);
    return mesh;
}

/// The corners of a unit square, without faces.
inline const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

}  // namespace easypbr::obj_text
