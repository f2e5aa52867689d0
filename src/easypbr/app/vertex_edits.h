// What a person removes of clouds and splats by hand, in the window and in the browser's page; with undo.
#pragma once

#include "easypbr/app/live_drawing.h"
#include "easypbr/app/widgets.h"

namespace easypbr::app {

/// Whether vertices can be removed from it: it has some, and neither faces nor edges.
bool has_loose_vertices(const MeshData& mesh);

/// Removes vertices of the selected object, with all that they have. Throws ArgumentError when nothing is
/// selected or was clicked, the object has faces or edges, its vertices have changed since the click, no
/// clip.box is set, or no vertex would stay.
void remove_vertices(LiveDrawing& live, const VertexFilter& filter);

/// The widgets for it, of the selected object; nothing where has_loose_vertices() is false.
void vertex_tool(Widgets& ui, LiveDrawing& live);

}  // namespace easypbr::app
