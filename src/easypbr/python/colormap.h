// Colour maps as Python gives them.
#pragma once

#include <string>

#include "easypbr/python/bindings.h"

namespace easypbr::python {

/// The text for parse_colormap() of a name, of one that matplotlib knows, of n x 3 or n x 4 colours, of texts
/// of colours, or of a Colormap of matplotlib. A name that nobody knows stays as it is. Throws ArgumentError
/// for other objects.
std::string colormap_text(nb::handle object);

}  // namespace easypbr::python
