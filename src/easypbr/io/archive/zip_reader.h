// ZIP archives (PKWARE, "APPNOTE.TXT - .ZIP File Format Specification", with ZIP64): stored entries are read
// in place, deflated ones are inflated.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "easypbr/io/source/source.h"

namespace easypbr::io {

/// A file in an archive. What was inflated belongs to it.
struct ZipEntry {
    std::string name;
    std::string_view bytes;
    std::shared_ptr<const void> owner;
};

/// The entries whose names end with `ending`, in the order of the archive's directory; those that are stored
/// refer to the source. Throws FormatError for damage of one of them (checksums included), encryption and
/// other compressions, and when they would take more memory than reading may.
std::vector<ZipEntry> read_zip(const Source& source, std::string_view ending);

}  // namespace easypbr::io
