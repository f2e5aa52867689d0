// Mesh files to values and back.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "easypbr/scene/animation.h"
#include "easypbr/scene/camera.h"
#include "easypbr/scene/light.h"
#include "easypbr/scene/mesh.h"

namespace easypbr::io {

/// All that a file holds. Formats with a hierarchy fill children; a file without one gives a single mesh.
struct LoadedScene {
    Mesh mesh;
    std::map<std::string, Light> lights;     ///< in world space (glTF KHR_lights_punctual)
    std::map<std::string, Camera> cameras;   ///< in world space (glTF)
    Animations animations = {};              ///< what moves the mesh and its children (glTF)
    std::vector<std::string> variants = {};  ///< names of material variants (glTF KHR_materials_variants)
    /// Paths of the file and of those that were read with it, or are missing: MTL, buffers, images, labels. Not
    /// those that assimp's process reads by itself. With the time of the last change of each, as it was before
    /// the file was opened; the least time of one that is missing.
    std::map<std::filesystem::path, std::filesystem::file_time_type> files = {};
};

struct LoadOptions {
    /// STL, and OBJ without normals: edges between faces at a larger angle, degrees, are sharp; none: 30 of
    /// STL, 60 of OBJ.
    std::optional<float> crease_angle_deg = {};
    double memory_gb = 0;      ///< most that the arrays and images of the file may take; 0: three quarters of
                               ///< what the machine has left
    std::string format = {};   ///< extension of the format that a file is in, in any case; empty: its own
    std::string variant = {};  ///< glTF: the material variant; empty: the file's own materials
    bool strict = false;       ///< points without a finite position are an error: FormatError
};

/// Reads PLY, OBJ (+ MTL), STL, OFF, glTF, GLB, the point clouds PCD, XYZ, PTS, CSV (also txt, asc), NPY,
/// NPZ, LAS, LAZ, the splats SPLAT and SPZ, and the BIN of KITTI and nuScenes, and by way of assimp, in a process of its own, what that
/// library reads. Points of clouds whose positions are not finite are left out with a warning that counts
/// them. What is missing or unknown beside the geometry (a texture file, an element) is logged as a warning
/// and left out. Throws FileError when the file cannot be read; FormatError, with line or byte, when it is
/// empty, damaged, lies about its counts, has indices out of range or positions that are not finite, would
/// take more memory than the options allow, or when its extension is unknown; NameError for a variant that a
/// file with variants has not.
LoadedScene load_scene(const std::filesystem::path& path, const LoadOptions& options = {});

/// The same from bytes in memory. The format is that of the options, else it is told from the content. `name`
/// stands in messages; what the content names is looked for beside it. Throws FormatError, also when the
/// format cannot be told or is one that assimp reads.
LoadedScene load_scene(std::span<const std::byte> bytes, const std::filesystem::path& name,
                       const LoadOptions& options = {});

/// The mesh of load_scene().
Mesh load_mesh(const std::filesystem::path& path, const LoadOptions& options = {});

/// Writes PLY (binary), OBJ (+ MTL), GLB, NPZ, splats as SPZ, or the points as PCD (binary), XYZ (also txt, asc), CSV or
/// NPY, by the extension; children are merged in world space for all but GLB. Formats without materials get
/// their colours and opacities as colours of vertices. A warning names what the format has no place for.
/// Throws FileError, FormatError for an unknown extension, or ArgumentError for a mesh without vertices.
/// Never leaves half a file.
void save_mesh(const Mesh& mesh, const std::filesystem::path& path);

/// save_mesh() of the scene's mesh. The warning names the rest too, which no format takes.
void save_scene(const LoadedScene& scene, const std::filesystem::path& path);

/// Throws FormatError where save_mesh() does for the extension alone.
void check_mesh_extension(const std::filesystem::path& path);

/// Extensions that save_mesh() writes.
const std::vector<std::string>& writable_extensions();

/// Extensions that load_scene() reads without assimp's reader, and all.
std::vector<std::string> native_extensions();
std::vector<std::string> readable_extensions();

}  // namespace easypbr::io
