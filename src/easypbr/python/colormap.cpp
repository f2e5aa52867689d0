#include "easypbr/python/colormap.h"

#include "easypbr/core/error.h"
#include "easypbr/scene/colormap.h"

namespace easypbr::python {
namespace {

/// Whether the text is no name of a built-in map, and no list of colours.
bool is_foreign_name(const std::string& text) {
    try {
        parse_colormap(text);
    } catch (const NameError&) {
        return true;
    } catch (const ArgumentError&) {
    }
    return false;
}

}  // namespace

std::string colormap_text(nb::handle object) {
    if (nb::isinstance<nb::str>(object)) {
        const std::string text = nb::cast<std::string>(object);
        if (!is_foreign_name(text)) return text;
    }
    return nb::cast<std::string>(nb::module_::import_("easypbr.colormaps").attr("colormap_text")(object));
}

}  // namespace easypbr::python
