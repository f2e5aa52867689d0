// What both stages of a mesh's shaders know of it.
#feature VERTEX_COLOR has_vertex_colors
#feature UV has_uv
#feature TANGENT has_tangents
#feature FLAT is_flat                // each face with its own normal
#feature FACE_NORMAL sees_by_faces   // the face, and not the winding, says which side is seen
#feature SURFACE_SHADER has_own_shader

bool needs_position() { return sees_by_faces || has_own_shader; }
