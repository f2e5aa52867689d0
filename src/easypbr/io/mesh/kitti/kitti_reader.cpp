// Scans of KITTI and SemanticKITTI (Behley et al., "SemanticKITTI: A Dataset for Semantic Scene Understanding
// of LiDAR Sequences", 2019): x y z and remission as float32, and labels beside them, whose lower 16 bits are
// the class and whose upper 16 bits the instance. Scans of nuScenes (Caesar et al., "nuScenes: A Multimodal
// Dataset for Autonomous Driving", 2020), whose names end in ".pcd.bin", have the laser's ring, too.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstring>

#include "easypbr/core/log.h"
#include "easypbr/core/parallel.h"
#include "easypbr/io/mesh/cloud_reader.h"
#include "easypbr/io/mesh/mesh_readers.h"
#include "easypbr/scene/label_map.h"

namespace easypbr::io {
namespace {

constexpr size_t label_size = 4, grain = 1 << 16;

/// What a point of a scan has, each as float32.
struct ScanLayout {
    std::string_view format;
    std::vector<std::string_view> fields;

    size_t point_size() const { return fields.size() * size_of(ScalarType::float32); }
};

ScanLayout scan_layout_of(const fs::path& scan) {
    if (extension_of(scan.stem()) == "pcd") return {"nuScenes", {"x", "y", "z", "intensity", "ring"}};
    return {"KITTI", {"x", "y", "z", "intensity"}};
}

/// The scan's labels: sequences/00/velodyne/000000.bin has sequences/00/labels/000000.label; or beside it.
std::optional<fs::path> find_labels(const fs::path& scan) {
    const fs::path folder = scan.parent_path(), name = scan.stem().string() + ".label";
    const fs::path above = fs::absolute(scan).parent_path().parent_path();
    std::error_code ignored;  // A longer name than the file system has is that of no file.
    for (const fs::path& path : {above / "labels" / name, folder / name})
        if (fs::exists(path, ignored)) return path;
    return {};
}

void set_label_map(const fs::path& path, MeshData& mesh) {
    const auto map = built_in_label_map("semantic_kitti");
    for (const int32_t label : mesh.L)
        if (!map->accepts(label)) {
            log_warning(fmt::format("{}: label {} is none of SemanticKITTI's: generated colours are used",
                                    path.string(), label));
            return;
        }
    mesh.label_map = map;
}

}  // namespace

void read_kitti_labels(const Source& source, MeshData& mesh) {
    const size_t count = size_t(mesh.V.rows());
    if (source.bytes.size() != count * label_size)
        fail(
            source,
            fmt::format("{} labels of {} bytes expected, one for each point of {}, but the file has {} bytes",
                        count, label_size, mesh.source.filename().string(), source.bytes.size()));
    Array1i::Dense labels{Eigen::Index(count)};
    Array1f::Dense instances{Eigen::Index(count)};
    parallel_for(count, grain, [&](size_t i) {
        uint32_t code;
        std::memcpy(&code, source.begin() + i * label_size, label_size);
        labels[Eigen::Index(i)] = int32_t(code & 0xffff);
        instances[Eigen::Index(i)] = float(code >> 16);
    });
    const bool has_instances = (instances.array() != 0).any();
    mesh.L = std::move(labels);
    if (has_instances) mesh.scalars.push_back({"instance", std::move(instances)});
    set_label_map(source.path, mesh);
}

MeshData read_kitti(const Source& source) {
    if (source.bytes.empty()) fail(source, "the file is empty");
    const ScanLayout layout = scan_layout_of(source.path);
    if (source.bytes.size() % layout.point_size())
        fail(source,
             fmt::format("no {} scan: {} bytes are not a multiple of {} ({} as float32)", layout.format,
                         source.bytes.size(), layout.point_size(), fmt::join(layout.fields, ", ")));
    Element points{"point", source.bytes.size() / layout.point_size(), {}};
    for (const std::string_view name : layout.fields)
        points.properties.push_back({std::string(name), ScalarType::float32, {}, 1, 0});
    MeshData mesh = read_binary_cloud(source, {{source, source.begin(), std::endian::little, {points}}});
    mesh.source = source.path;
    if (const auto labels = find_labels(source.path)) {
        const FileBytes file(*labels);
        read_kitti_labels({file, *labels}, mesh);
        file.check();
    }
    drop_points_without_position(source, mesh);
    mesh.up = Vec3d::UnitZ();
    return mesh;
}

}  // namespace easypbr::io
