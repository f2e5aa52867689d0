// The files of the page, embedded when the library is built; see web/ and cmake/embed.cmake.
#pragma once

#include <string_view>

namespace easypbr::remote {

struct PageFile {
    std::string_view name, type, content;
};

/// Null when there is none of this name.
const PageFile* page_file(std::string_view name);

/// A file that no server answers with: it is written, or handed on. It is there.
std::string_view offline_document(std::string_view name);

}  // namespace easypbr::remote
