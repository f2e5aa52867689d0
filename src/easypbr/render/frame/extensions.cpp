#include "easypbr/render/frame/extensions.h"

#include "easypbr/core/luminance.h"

namespace easypbr::render {

ExtensionSet extensions_of(const Material& m) {
    if (m.unlit || !m.is_extended()) return 0;
    ExtensionSet set = dielectric_bit;
    if (m.clearcoat > 0) set |= clearcoat_bit;
    if (!is_black(m.sheen_color)) set |= sheen_bit;
    if (m.transmission > 0) set |= transmission_bit;
    if (m.iridescence > 0) set |= iridescence_bit;
    if (m.anisotropy > 0) set |= anisotropy_bit;
    return set;
}

void add_extension_defines(ExtensionSet extensions, std::vector<std::string>& defines) {
    if (extensions & clearcoat_bit) defines.emplace_back("CLEARCOAT");
    if (extensions & sheen_bit) defines.emplace_back("SHEEN");
    if (extensions & transmission_bit) defines.emplace_back("TRANSMISSION");
    if (extensions & iridescence_bit) defines.emplace_back("IRIDESCENCE");
    if (extensions & anisotropy_bit) defines.emplace_back("ANISOTROPY");
}

}  // namespace easypbr::render
