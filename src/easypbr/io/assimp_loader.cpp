#include "easypbr/io/assimp_loader.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "easypbr/io/assimp/module.h"

namespace easypbr::io {
namespace {

constexpr const char* module_name = "libeasypbr_assimp.so";

/// The module's functions, or the reason why there are none. It is never unloaded: its exceptions may outlive
/// a call.
struct Module {
    Module() {
        void* handle = nullptr;
        Dl_info self{};
        if (::dladdr(reinterpret_cast<void*>(&load_assimp), &self) && self.dli_fname)
            handle = ::dlopen((fs::path(self.dli_fname).parent_path() / module_name).c_str(),
                              RTLD_NOW | RTLD_LOCAL);
        if (!handle) handle = ::dlopen(module_name, RTLD_NOW | RTLD_LOCAL);
        if (!handle) {
            const char* message = ::dlerror();
            reason = message ? message : "unknown reason";
            return;
        }
        load = reinterpret_cast<decltype(load)>(::dlsym(handle, "easypbr_assimp_load"));
        extensions = reinterpret_cast<decltype(extensions)>(::dlsym(handle, "easypbr_assimp_extensions"));
        if (!load || !extensions) reason = fmt::format("{} is of another version", module_name);
    }

    decltype(&easypbr_assimp_load) load = nullptr;
    decltype(&easypbr_assimp_extensions) extensions = nullptr;
    std::string reason;
};

const Module& assimp_module() {
    static const Module loaded;
    return loaded;
}

}  // namespace

LoadedScene load_assimp(const std::filesystem::path& path) {
    const Module& assimp = assimp_module();
    if (!assimp.reason.empty())
        throw FormatError(
            fmt::format("cannot read {}: '.{}' files are read by the assimp module, which cannot be "
                        "loaded ({}); install the package libassimp5 and keep {} beside libeasypbr.so",
                        path.string(), extension_of(path), assimp.reason, module_name));
    LoadedScene out;
    assimp.load(path, out);
    return out;
}

std::vector<std::string> assimp_extensions() {
    std::vector<std::string> out;
    if (assimp_module().reason.empty()) assimp_module().extensions(out);
    return out;
}

}  // namespace easypbr::io
