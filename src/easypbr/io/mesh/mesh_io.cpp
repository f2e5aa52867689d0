#include "easypbr/io/mesh/mesh_io.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <span>

#include "easypbr/core/ascii.h"
#include "easypbr/core/error.h"
#include "easypbr/core/file_set.h"
#include "easypbr/core/log.h"
#include "easypbr/core/memory_budget.h"
#include "easypbr/core/opened_files.h"
#include "easypbr/core/suggest.h"
#include "easypbr/io/image/image_io.h"
#include "easypbr/io/image/texture_loader.h"
#include "easypbr/io/mesh/assimp/assimp_loader.h"
#include "easypbr/io/mesh/cloud_writers.h"
#include "easypbr/io/mesh/content_format.h"
#include "easypbr/io/mesh/file_scene.h"
#include "easypbr/io/mesh/gltf/glb_textures.h"
#include "easypbr/io/mesh/gltf/glb_writer.h"
#include "easypbr/io/mesh/gltf/gltf_reader.h"
#include "easypbr/io/mesh/gltf/gltf_values.h"
#include "easypbr/io/mesh/left_out.h"
#include "easypbr/io/mesh/mesh_readers.h"
#include "easypbr/io/mesh/texture_mapping.h"
#include "easypbr/io/tables/vertex_rows.h"
#include "easypbr/scene/crease.h"
#include "easypbr/scene/merge.h"
#include "easypbr/scene/mesh_arrays.h"

namespace easypbr::io {
namespace {

const std::vector<std::string> splat_extensions{"ply", "glb", "spz"};

bool contains(const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

[[noreturn]] void fail_extension(const fs::path& path, const std::string& extension, const std::string& verb,
                                 const std::vector<std::string>& known) {
    throw FormatError(fmt::format("{}: files with extension '{}' cannot be {}{}; expected one of {}",
                                  path.string(), extension, verb, did_you_mean(extension, known),
                                  fmt::join(known, ", ")));
}

using Reader = std::function<MeshData(const Source&, const LoadOptions&)>;

Reader without_options(MeshData (*read)(const Source&)) {
    return [read](const Source& source, const LoadOptions&) { return read(source); };
}

MeshData read_columns(const Source& source, const LoadOptions&) {
    return read_xyz(source);
}

MeshData read_pts(const Source& source, const LoadOptions&) {
    return read_xyz(source, true);
}

/// The readers of formats that hold a single mesh.
const std::map<std::string, Reader>& readers() {
    static const std::map<std::string, Reader> all{{"ply", without_options(read_ply)},
                                                   {"obj", read_obj},
                                                   {"stl", read_stl},
                                                   {"off", without_options(read_off)},
                                                   {"pcd", without_options(read_pcd)},
                                                   {"xyz", read_columns},
                                                   {"pts", read_pts},
                                                   {"csv", read_columns},
                                                   {"txt", read_columns},
                                                   {"asc", read_columns},
                                                   {"npy", without_options(read_npy)},
                                                   {"npz", without_options(read_npz)},
                                                   {"bin", without_options(read_kitti)},
                                                   {"las", without_options(read_las)},
                                                   {"laz", without_options(read_las)},
                                                   {"splat", without_options(read_splat)},
                                                   {"spz", without_options(read_spz)}};
    return all;
}

bool is_gltf(const std::string& format) {
    return format == "gltf" || format == "glb";
}

/// `format` is glTF's or that of one of the readers.
LoadedScene decode(const Source& source, const std::string& format, const LoadOptions& options) {
    const fs::path& path = source.path;
    if (is_gltf(format)) return decode_gltf(std::as_bytes(std::span(source.bytes)), path, options.variant);
    MeshData data = readers().at(format)(source, options);
    if (source.file) source.file->check();
    // Of a cloud these are the points that were kept.
    const bool lost = data.F.empty() && data.E.empty() && !data.source_vertex.empty();
    if (options.strict && lost)
        throw FormatError(
            fmt::format("{}: there are points without a finite position; without strict they are left out",
                        path.string()));
    data.name = path.stem().string();
    data.source = path;
    return {Mesh(std::move(data)), {}, {}};
}

[[noreturn]] void fail_format(const fs::path& path, const std::string& format) {
    const std::vector<std::string> known = native_extensions();
    if (format.empty())
        throw FormatError(fmt::format("{}: its format cannot be told from its content; name it, one of {}",
                                      path.string(), fmt::join(known, ", ")));
    throw FormatError(fmt::format("{}: '{}' cannot be read without a file{}; expected one of {}",
                                  path.string(), format, did_you_mean(format, known),
                                  fmt::join(known, ", ")));
}

/// Formats that have points only leave out faces, and say so.
void warn_of_faces(const MeshData& mesh, const fs::path& path) {
    if (!mesh.F.empty() || !mesh.E.empty())
        log_warning(fmt::format("{}: the format has points only: {} faces and {} edges are left out",
                                path.string(), mesh.F.rows(), mesh.E.rows()));
}

void warn_of_splats(const Mesh& mesh, const fs::path& path) {
    for_each_node(mesh, [&](const std::shared_ptr<const MeshData>& data, const Eigen::Affine3d&) {
        if (!data->splats.empty())
            log_warning(
                fmt::format("{}: the format has no splats: those of '{}' are written as points; {} "
                            "have them",
                            path.string(), data->name, fmt::join(splat_extensions, ", ")));
    });
}

void warn_of_left_out(const std::vector<std::string>& names, const fs::path& path, const std::string& of) {
    if (!names.empty())
        log_warning(fmt::format("{}: the format has no place for {}: left out{}", path.string(),
                                fmt::join(names, ", "), of.empty() ? "" : fmt::format(" of '{}'", of)));
}

/// GLB has any name, and OBJ and SPZ have no scalars.
void warn_of_renamed(const MeshData& mesh, const fs::path& path) {
    const std::vector<std::string> renamed = renamed_scalars(mesh);
    if (!renamed.empty() && extension_of(path) != "spz")
        log_warning(fmt::format("{}: scalars get names that the format holds: {}", path.string(),
                                fmt::join(renamed, ", ")));
}

/// PLY names the texture's file, which must hold what is drawn.
void warn_of_changed_texture(const MeshData& mesh, const fs::path& path) {
    if (mesh.materials.size() != 1) return;
    const Texture& texture = mesh.materials[0].base_color_texture;
    if (!texture.path.empty() && !is_in_file(texture))
        log_warning(
            fmt::format("{}: the texture is left out: its file {} is gone or has changed since it "
                        "was read; OBJ and GLB are written with the texture as it was read",
                        path.string(), texture.path));
}

std::string encode(const MeshData& mesh, const fs::path& path, const std::string& extension) {
    if (extension == "ply") return encode_ply(mesh, fs::absolute(path).parent_path());
    if (extension == "npz") return encode_npz(mesh);
    warn_of_faces(mesh, path);
    if (extension == "spz") return encode_spz(mesh);
    if (extension == "pcd") return encode_pcd(mesh);
    if (extension == "npy") return encode_npy(mesh);
    if (extension == "csv") return encode_xyz(mesh, ',');
    if (extension == "xyz" || extension == "txt" || extension == "asc") return encode_xyz(mesh, ' ');
    throw std::logic_error("no writer of ." + extension);
}

/// Whether vertices were split from one, as at seams of texture coordinates.
bool has_split_vertices(const MeshData& mesh) {
    if (mesh.source_vertex.empty()) return false;
    const Array1i sources = numbers_below(8 * mesh.source_vertex.rows(), mesh.source_vertex);
    std::vector<bool> seen(size_t(sources.maxCoeff()) + 1);
    return std::ranges::any_of(std::span(sources.data(), size_t(sources.size())), [&](int32_t source) {
        const bool again = seen[size_t(source)];
        seen[size_t(source)] = true;
        return again;
    });
}

/// The mesh as one node, for a format that has no hierarchy. Files do not say which vertices count as one for
/// smooth normals (source_vertex): where some do, the normals that are drawn are written. Texture transforms
/// that a format does not have become part of the texture coordinates.
MeshData flattened_for(const std::string& extension, const Mesh& mesh) {
    MeshData flat = flatten(mesh);
    const bool has_faces = extension == "obj" || extension == "ply" || extension == "npz";
    if (has_faces && flat.N.empty() && !flat.F.empty() && !flat.style.flat.value_or(false) &&
        has_split_vertices(flat))
        add_drawn_normals(flat);
    if (const TextureMapping* mapping = texture_mapping(flat, extension)) bake_uv_transforms(*mapping, flat);
    return flat;
}

void save_obj(const MeshData& flat, const fs::path& path) {
    const fs::path library = fs::path(path).replace_extension(".mtl");
    const ObjText text = encode_obj(flat, library.filename().string(), fs::absolute(path).parent_path());
    FileSet files;
    for (const auto& [name, image] : text.images) files.add(path.parent_path() / name, encode_png(*image));
    if (!text.mtl.empty()) files.add(library, text.mtl);
    files.add(path, text.obj);
    files.commit();
}

void require_vertices(const Mesh& mesh, const fs::path& path) {
    bool has_some = false;
    for_each_node(mesh, [&](const std::shared_ptr<const MeshData>& data, const Eigen::Affine3d&) {
        has_some = has_some || !data->V.empty();
    });
    if (!has_some)
        throw ArgumentError(fmt::format("cannot write {}: the mesh has no vertices", path.string()));
}

/// Whether any mesh of the tree is voxels. Joined, those of different sizes have no size.
bool has_voxels(const Mesh& mesh) {
    bool has_some = false;
    for_each_node(mesh, [&](const std::shared_ptr<const MeshData>& data, const Eigen::Affine3d&) {
        has_some = has_some || data->voxel_size > 0;
    });
    return has_some;
}

/// `beside`: what of a scene is left out beside the mesh.
void save(const Mesh& mesh, const std::vector<std::string>& beside, const fs::path& path) {
    const std::string extension = extension_of(path);
    check_mesh_extension(path);
    require_vertices(mesh, path);
    check_writable(path);
    if (!contains(splat_extensions, extension)) warn_of_splats(mesh, path);
    if (extension == "glb") {
        warn_of_left_out(beside, path, "");
        for_each_node(mesh, [&](const std::shared_ptr<const MeshData>& data, const Eigen::Affine3d&) {
            std::vector<std::string> names = left_out_of_gltf(*data);
            std::ranges::move(left_out(*data, extension), std::back_inserter(names));
            std::ranges::move(mappings_left_out_of_gltf(*data), std::back_inserter(names));
            warn_of_left_out(names, path, data->name);
        });
        return save_glb(mesh, path);
    }
    const MeshData own = flattened_for(extension, mesh);
    const MeshData flat = extension == "obj" ? own : with_material_colors(own);
    std::vector<std::string> names = left_out(flat, extension);
    if (flat.voxel_size == 0 && has_voxels(mesh)) names.emplace_back(left_out_voxel_size);
    names.insert(names.end(), beside.begin(), beside.end());
    warn_of_left_out(names, path, flat.name);
    if (extension == "obj") return save_obj(flat, path);
    if (extension == "ply") warn_of_changed_texture(flat, path);
    warn_of_renamed(flat, path);
    write_file(path, encode(flat, path, extension));
}

uint64_t limit_of(const LoadOptions& options) {
    if (!(options.memory_gb >= 0))
        throw ArgumentError(fmt::format("memory: expected 0 or more GB, got {}", options.memory_gb));
    return uint64_t(std::min(options.memory_gb, 1e9) * 1e9);
}

/// The format of the options as an extension; empty: they name none.
std::string format_of(const LoadOptions& options) {
    return ascii::to_lower(options.format);
}

LoadedScene read_scene(const fs::path& path, const LoadOptions& options) {
    const std::string format = options.format.empty() ? extension_of(path) : format_of(options);
    if (is_gltf(format)) return load_gltf(path, options.variant);
    if (readers().contains(format)) {
        const FileBytes bytes(path);
        return decode(Source(bytes, path), format, options);
    }
    if (contains(assimp_extensions(), format)) return load_assimp(path);
    fail_extension(path, format, "read", readable_extensions());
}

/// Colours that a file says no light falls on, such as those of photogrammetry, are shown as they are.
void show_unlit_exactly(Mesh& mesh) {
    const auto data = mesh.snapshot();
    if (!data->materials.empty() && std::ranges::all_of(data->materials, &Material::unlit)) {
        Style style = mesh.style();
        style.lit = false;
        mesh.set_style(style);
    }
    for (Mesh child : mesh.children()) show_unlit_exactly(child);
}

/// A file is found again after the working folder has changed.
void make_source_absolute(Mesh& mesh) {
    const fs::path source = mesh.snapshot()->source;
    if (source.is_relative() && !source.empty())
        mesh.edit([&](MeshData& data) { data.source = fs::absolute(source); });
}

/// What every file takes that is read, of whatever format.
void finish(LoadedScene& scene, const fs::path& path, const LoadOptions& options, const OpenedFiles& files) {
    if (!options.variant.empty() && scene.variants.empty())
        log_warning(
            fmt::format("{} has no material variants: '{}' changes nothing", path.string(), options.variant));
    show_unlit_exactly(scene.mesh);
    scene.files = files.times();
}

LoadedScene load_content(const Source& source, const LoadOptions& options) {
    const MemoryScope memory(source.path.string(), limit_of(options));
    if (source.bytes.empty())
        throw FormatError(fmt::format("{}: there is nothing to read", source.path.string()));
    const std::string format = options.format.empty() ? format_of_content(source.bytes) : format_of(options);
    if (!is_gltf(format) && !readers().contains(format)) fail_format(source.path, format);
    OpenedFiles files;
    const OpenedFilesScope noted(&files);
    LoadedScene scene = decode(source, format, options);
    finish(scene, source.path, options, files);
    return scene;
}

}  // namespace

LoadedScene load_scene(const fs::path& path, const LoadOptions& options) {
    const MemoryScope memory(path.string(), limit_of(options));
    OpenedFiles files;
    const OpenedFilesScope noted(&files);
    LoadedScene scene = read_scene(path, options);
    make_source_absolute(scene.mesh);
    finish(scene, path, options, files);
    return scene;
}

LoadedScene load_scene(const FileBytes& bytes, const fs::path& name, const LoadOptions& options) {
    return load_content(Source(bytes, name), options);
}

LoadedScene load_scene(std::span<const std::byte> bytes, const fs::path& name, const LoadOptions& options) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    return load_content(Source(text, name), options);
}

Mesh load_mesh(const fs::path& path, const LoadOptions& options) {
    return load_scene(path, options).mesh;
}

const std::vector<std::string>& writable_extensions() {
    static const std::vector<std::string> all{"ply", "obj", "glb", "pcd", "xyz", "txt",
                                              "asc", "csv", "npy", "npz", "spz"};
    return all;
}

void check_mesh_extension(const fs::path& path) {
    if (!contains(writable_extensions(), extension_of(path)))
        fail_extension(path, extension_of(path), "written", writable_extensions());
}

void save_mesh(const Mesh& mesh, const fs::path& path) {
    save(mesh, {}, path);
}

void save_scene(const LoadedScene& scene, const fs::path& path) {
    save(scene.mesh, left_out(scene), path);
}

std::vector<std::string> native_extensions() {
    std::vector<std::string> all{"gltf", "glb"};
    for (const auto& [extension, reader] : readers()) all.push_back(extension);
    return all;
}

std::vector<std::string> readable_extensions() {
    std::vector<std::string> all = native_extensions();
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
