#include "easypbr/remote/page.h"

#include <algorithm>
#include <array>

namespace easypbr::remote {
namespace {

struct Embedded {
    std::string_view name, content;
};

constexpr Embedded embedded[] = {
#include "easypbr_page.inc"
};

constexpr Embedded offline[] = {
#include "easypbr_offline.inc"
};

constexpr std::string_view type_of(std::string_view name) {
    if (name.ends_with(".html")) return "text/html; charset=utf-8";
    if (name.ends_with(".js")) return "text/javascript; charset=utf-8";
    if (name.ends_with(".css")) return "text/css; charset=utf-8";
    return "image/svg+xml";
}

constexpr auto make_files() {
    std::array<PageFile, std::size(embedded)> files;
    for (size_t i = 0; i < files.size(); ++i)
        files[i] = {embedded[i].name, type_of(embedded[i].name), embedded[i].content};
    return files;
}

constexpr auto files = make_files();

}  // namespace

const PageFile* page_file(std::string_view name) {
    const auto found = std::ranges::find(files, name, &PageFile::name);
    return found == files.end() ? nullptr : &*found;
}

std::string_view offline_document(std::string_view name) {
    return std::ranges::find(offline, name, &Embedded::name)->content;
}

}  // namespace easypbr::remote
