#include "easypbr/io/source/module_loader.h"

#include <dlfcn.h>
#include <fmt/format.h>

namespace easypbr::io {
namespace {

/// Any address inside libeasypbr.so.
constexpr char inside_library = 0;

}  // namespace

std::filesystem::path beside_library(const char* file_name) {
    Dl_info self{};
    if (!::dladdr(&inside_library, &self) || !self.dli_fname) return {};
    return std::filesystem::path(self.dli_fname).parent_path() / file_name;
}

RuntimeModule::RuntimeModule(const char* file_name) : file_name_(file_name) {
    if (const auto beside = beside_library(file_name); !beside.empty())
        handle_ = ::dlopen(beside.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!handle_) handle_ = ::dlopen(file_name, RTLD_NOW | RTLD_LOCAL);
    if (handle_) return;
    const char* message = ::dlerror();
    reason_ = message ? message : "unknown reason";
}

void* RuntimeModule::symbol(const char* name) {
    void* found = handle_ ? ::dlsym(handle_, name) : nullptr;
    if (handle_ && !found) reason_ = fmt::format("{} is of another version", file_name_);
    return found;
}

}  // namespace easypbr::io
