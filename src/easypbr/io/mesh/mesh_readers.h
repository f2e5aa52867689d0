// Readers and writers of the mesh formats, over bytes; mesh_io.h chooses among them by extension.
#pragma once

#include <map>
#include <memory>
#include <string>

#include "easypbr/core/image.h"
#include "easypbr/io/source/source.h"
#include "easypbr/scene/mesh_data.h"

namespace easypbr::io {

struct LoadOptions;

/// Each throws FormatError as load_scene() does. The result passes validate() and has no name yet.
MeshData read_ply(const Source& source);
MeshData read_obj(const Source& source, const LoadOptions& options);
MeshData read_stl(const Source& source, const LoadOptions& options);
MeshData read_off(const Source& source);

/// The same for point clouds. Points whose positions are not finite are left out with a warning.
MeshData read_pcd(const Source& source);
/// XYZ, CSV, and PTS, which has the intensity before the colour.
MeshData read_xyz(const Source& source, bool is_pts = false);
/// One array; an archive of named arrays, which may have faces.
MeshData read_npy(const Source& source);
MeshData read_npz(const Source& source);
/// A scan of KITTI; the labels of SemanticKITTI are looked for beside the source's path and in ../labels.
MeshData read_kitti(const Source& source);
/// SemanticKITTI's labels, one for each point of the mesh. Throws FormatError for another number.
void read_kitti_labels(const Source& source, MeshData& mesh);
MeshData read_las(const Source& source);
MeshData read_splat(const Source& source);
MeshData read_spz(const Source& source);

/// Binary little-endian PLY: V, N, C (as uchar), UV (as s, t), L, I, F, E, splats, and the base colour
/// texture of a mesh with one material, by its path relative to `folder`. Of splats the up axis is a comment.
std::string encode_ply(const MeshData& mesh, const fs::path& folder);

/// SPZ, version 3: splats alone. Codes of 8 bits and 24 for positions: it loses a little. Throws
/// ArgumentError for a mesh without splats, and for coordinates beyond 2^23.
std::string encode_spz(const MeshData& mesh);

/// OBJ, and MTL named `mtl_name`, with the textures' paths relative to `folder`; MTL is empty without
/// materials. Images that no file holds, of u8 or u16, are to be written into `folder` beside it, as PNG,
/// under the names that the MTL has for them: files of `folder` stay, but for the images of an MTL that is
/// replaced. Throws ArgumentError for names of files with a line break.
struct ObjText {
    std::string obj, mtl;
    std::map<std::string, std::shared_ptr<const Image>> images = {};
};
ObjText encode_obj(const MeshData& mesh, const std::string& mtl_name, const fs::path& folder);

}  // namespace easypbr::io
