#include "easypbr/io/mesh_io.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "easypbr/core/error.h"
#include "easypbr/core/suggest.h"
#include "easypbr/io/assimp_loader.h"
#include "easypbr/io/glb_writer.h"
#include "easypbr/io/gltf_reader.h"
#include "easypbr/io/mesh_readers.h"
#include "easypbr/scene/merge.h"

namespace easypbr::io {
namespace {

const std::vector<std::string> own_extensions{"ply", "obj", "stl", "off", "gltf", "glb", "pcd"};
const std::vector<std::string> writable_extensions{"ply", "obj", "glb"};

bool contains(const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

[[noreturn]] void fail_extension(const fs::path& path, const std::string& verb,
                                 const std::vector<std::string>& known) {
    const std::string extension = extension_of(path);
    throw FormatError(fmt::format("{}: files with extension '{}' cannot be {}{}; expected one of {}",
                                  path.string(), extension, verb, did_you_mean(extension, known),
                                  fmt::join(known, ", ")));
}

MeshData read(const Source& source, const std::string& extension, const LoadOptions& options) {
    if (extension == "ply") return read_ply(source);
    if (extension == "obj") return read_obj(source);
    if (extension == "stl") return read_stl(source, options);
    if (extension == "pcd") return read_pcd(source);
    return read_off(source);
}

LoadedScene load_by_reader(const fs::path& path, const std::string& extension, const LoadOptions& options) {
    const MappedFile file(path);
    MeshData data = read(Source(file, path), extension, options);
    data.name = path.stem().string();
    data.source = path;
    return {Mesh(std::move(data)), {}, {}};
}

void save_obj(const Mesh& mesh, const fs::path& path) {
    const fs::path library = fs::path(path).replace_extension(".mtl");
    const ObjText text =
        encode_obj(flatten(mesh), library.filename().string(), fs::absolute(path).parent_path());
    if (!text.mtl.empty()) write_file(library, text.mtl);
    write_file(path, text.obj);
}

}  // namespace

LoadedScene load_scene(const fs::path& path, const LoadOptions& options) {
    const std::string extension = extension_of(path);
    if (extension == "gltf" || extension == "glb") return load_gltf(path);
    if (contains(own_extensions, extension)) return load_by_reader(path, extension, options);
    if (contains(assimp_extensions(), extension)) return load_assimp(path);
    fail_extension(path, "read", readable_extensions());
}

Mesh load_mesh(const fs::path& path, const LoadOptions& options) {
    return load_scene(path, options).mesh;
}

void save_mesh(const Mesh& mesh, const fs::path& path) {
    const std::string extension = extension_of(path);
    if (!contains(writable_extensions, extension)) fail_extension(path, "written", writable_extensions);
    check_writable(path);
    if (extension == "glb") return save_glb(mesh, path);
    if (extension == "ply")
        return write_file(path, encode_ply(flatten(mesh), fs::absolute(path).parent_path()));
    save_obj(mesh, path);
}

std::vector<std::string> readable_extensions() {
    std::vector<std::string> all = own_extensions;
    for (const std::string& extension : assimp_extensions())
        if (!contains(all, extension)) all.push_back(extension);
    return all;
}

}  // namespace easypbr::io

namespace easypbr {

Mesh::Mesh(const fs::path& path) : Mesh(io::load_mesh(path)) {}

void Mesh::save(const fs::path& path) const {
    io::save_mesh(*this, path);
}

}  // namespace easypbr
