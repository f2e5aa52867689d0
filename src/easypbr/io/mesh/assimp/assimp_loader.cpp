#include "easypbr/io/mesh/assimp/assimp_loader.h"

#include <fmt/format.h>

#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "easypbr/io/mesh/assimp/module/module.h"
#include "easypbr/io/mesh/mesh_io.h"
#include "easypbr/io/source/module_loader.h"

namespace easypbr::io {
namespace {

constexpr const char* assimp_file = "libeasypbr_assimp.so";

struct AssimpModule : RuntimeModule {
    AssimpModule() : RuntimeModule(assimp_file) {
        find(load, "easypbr_assimp_load");
        find(extensions, "easypbr_assimp_extensions");
    }

    decltype(&easypbr_assimp_load) load = nullptr;
    decltype(&easypbr_assimp_extensions) extensions = nullptr;
};

const AssimpModule& assimp_module() {
    static const AssimpModule loaded;
    return loaded;
}

}  // namespace

LoadedScene load_assimp(const std::filesystem::path& path) {
    const AssimpModule& assimp = assimp_module();
    if (!assimp.reason().empty())
        throw FormatError(
            fmt::format("cannot read {}: '.{}' files are read by the assimp module, which cannot be "
                        "loaded ({}); install the package libassimp5 and keep {} beside libeasypbr.so",
                        path.string(), extension_of(path), assimp.reason(), assimp_file));
    LoadedScene out;
    assimp.load(path, out);
    return out;
}

std::vector<std::string> assimp_extensions() {
    std::vector<std::string> out;
    if (assimp_module().reason().empty()) assimp_module().extensions(out);
    return out;
}

}  // namespace easypbr::io
