#include "easypbr/scene/settings.h"

#include <filesystem>
#include <system_error>
#include <utility>

namespace easypbr {
namespace {

/// The name itself where the working folder is not there any more.
std::string absolute_path(const std::string& name) {
    if (name.empty()) return name;
    std::error_code failed;
    const std::filesystem::path path = std::filesystem::absolute(name, failed);
    return failed ? name : path.string();
}

}  // namespace

NamedFile::NamedFile(std::string name) : name_(std::move(name)), path_(absolute_path(name_)) {}

const std::string& NamedFile::path_from_here() const {
    return absolute_path(name_) == path_ ? name_ : path_;
}

}  // namespace easypbr
