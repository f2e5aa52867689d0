// A limit on how deep JSON may be nested.
#pragma once

#include <string>
#include <string_view>

namespace easypbr::io {

/// Throws FormatError, "cannot read NAME: ...", when lists and objects lie more than 512 levels deep in each
/// other. To copy or to print such a value takes more stack than there is. Other damage is left to the
/// parser.
void check_json_depth(std::string_view text, const std::string& name);

}  // namespace easypbr::io
