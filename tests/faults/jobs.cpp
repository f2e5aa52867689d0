#include "faults/jobs.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "easypbr/app/session.h"
#include "easypbr/core/file.h"
#include "easypbr/core/hash.h"
#include "easypbr/geometry/primitives.h"
#include "easypbr/geometry/remesh.h"
#include "easypbr/geometry/repair.h"
#include "easypbr/geometry/sample.h"
#include "easypbr/geometry/surfels.h"
#include "easypbr/io/image/image_io.h"
#include "easypbr/io/mesh/mesh_io.h"
#include "easypbr/io/settings/camera_path_io.h"
#include "easypbr/io/settings/label_map_io.h"
#include "easypbr/io/settings/settings_io.h"

namespace easypbr::faults {
namespace {

std::string hash_of(const void* data, size_t bytes) {
    return content_hash({static_cast<const std::byte*>(data), bytes});
}

std::string hash_of(const Mesh& mesh) {
    const auto data = mesh.snapshot();
    std::string hash = hash_of(data->V.data(), size_t(data->V.size()) * sizeof(float)) +
                       hash_of(data->F.data(), size_t(data->F.size()) * sizeof(int32_t));
    for (const Mesh& child : data->children) hash += hash_of(child);
    return hash;
}

std::string hash_of(const Image& image) {
    return hash_of(image.bytes().data(), image.bytes().size());
}

Mesh sample_mesh() {
    Mesh mesh = make_sphere(1, 8);
    mesh.edit([](MeshData& data) {
        Array3f::Dense C(data.V.rows(), 3);
        C.setConstant(0.5f);
        data.C = std::move(C);
    });
    return mesh;
}

Image sample_image(PixelType type) {
    Image image(16, 12, 3, type);
    for (size_t i = 0; i < image.bytes().size(); ++i)
        image.bytes()[i] = std::byte(type == PixelType::f32 ? 0x3c : i);
    return image;
}

std::string read_file(const fs::path& path) {
    const std::string extension = extension_of(path);
    const std::string folder = path.parent_path().filename().string();
    if (folder == "image") return hash_of(io::load_image(path));
    if (folder == "settings") return io::to_json(io::load_settings(path));
    if (folder == "camera_path") return io::to_json(io::load_camera_path(path));
    if (folder.starts_with("label")) return io::load_label_map(path).name();
    return hash_of(io::load_mesh(path));
}

Memory memory_of(const fs::path& extension, const std::string& kind) {
    if (kind == "gltf") return Memory::large_may_fail;
    for (const char* other : {".json", ".webp", ".glb"})
        if (extension == other) return Memory::large_may_fail;
    return Memory::any_may_fail;
}

std::vector<Job> make_reading_jobs() {
    std::vector<Job> jobs;
    for (const char* kind :
         {"ply",   "obj",      "stl",         "off",        "gltf",       "pcd",       "xyz",
          "pts",   "npy",      "npz",         "las",        "bin",        "splat",     "spz",
          "image", "settings", "camera_path", "label_text", "label_json", "label_yaml"}) {
        std::vector<fs::path> files;
        for (const auto& entry : fs::directory_iterator(fs::path(EASYPBR_TESTS) / "fuzz/seeds" / kind))
            files.push_back(entry.path());
        std::ranges::sort(files);
        for (const fs::path& file : files) {
            try {
                read_file(file);
            } catch (const Error&) {
                continue;  // One that did harm.
            }
            jobs.push_back({fmt::format("reading {}/{}", kind, file.filename().string()),
                            [file](const fs::path&) { return read_file(file); },
                            memory_of(file.extension(), kind)});
        }
    }
    return jobs;
}

std::vector<Job> make_writing_jobs() {
    std::vector<Job> jobs;
    for (const char* extension : {"ply", "obj", "glb", "pcd", "xyz", "csv", "npy", "npz"})
        jobs.push_back({fmt::format("writing {}", extension),
                        [extension](const fs::path& folder) {
                            const fs::path path = folder / fmt::format("a.{}", extension);
                            io::save_mesh(sample_mesh(), path);
                            return hash_of(io::load_mesh(path));
                        },
                        memory_of(fs::path("a.").concat(extension).extension(), "")});
    const Mesh splats = io::load_mesh(fs::path(EASYPBR_TESTS) / "fuzz/seeds/splat/five.splat");
    jobs.push_back({"writing spz", [splats](const fs::path& folder) {
                        io::save_mesh(splats, folder / "a.spz");
                        return hash_of(io::load_mesh(folder / "a.spz"));
                    }});
    for (const char* extension : {"png", "jpg", "hdr", "exr"})
        jobs.push_back({fmt::format("writing {}", extension),
                        [extension](const fs::path& folder) {
                            const fs::path path = folder / fmt::format("a.{}", extension);
                            io::save_image(sample_image(PixelType::u8), path);
                            return hash_of(io::load_image(path));
                        },
                        std::string(extension) == "exr" ? Memory::none_may_fail : Memory::any_may_fail});
    jobs.push_back({"writing settings",
                    [](const fs::path& folder) {
                        io::save_settings({}, folder / "a.json");
                        return io::to_json(io::load_settings(folder / "a.json"));
                    },
                    Memory::large_may_fail});
    jobs.push_back({"writing a label map", [](const fs::path& folder) {
                        io::save_label_map(*built_in_label_map("cityscapes"), folder / "a.txt");
                        return io::load_label_map(folder / "a.txt").name();
                    }});
    return jobs;
}

std::string picture_of(const Mesh& mesh, int samples) {
    Scene scene;
    scene.show(mesh, "mesh");
    app::Session session(scene);
    session.use_device(DrawDevice::cpu);
    session.settings().image.size = Vec2i(32, 24);
    session.settings().image.samples = samples;
    return hash_of(session.render());
}

std::vector<Job> make_computing_jobs() {
    const Mesh sphere = sample_mesh();
    return {
        {"decimating",
         [sphere](const fs::path&) {
             return hash_of(decimate(sphere, {30, {}}));
         }},
        {"upsampling", [sphere](const fs::path&) { return hash_of(upsample(sphere)); }},
        {"smoothing", [sphere](const fs::path&) { return hash_of(smooth(sphere)); }},
        {"repairing", [sphere](const fs::path&) { return hash_of(remove_duplicate_vertices(sphere)); }},
        {"surfels",
         [sphere](const fs::path&) { return hash_of(estimate_surfels(sample_surface(sphere, 200))); }},
        {"voxels", [sphere](const fs::path&) { return hash_of(voxelize(sphere, 0.25)); }},
        {"a frame", [sphere](const fs::path&) { return picture_of(sphere, 1); }},
        {"a picture by paths", [sphere](const fs::path&) { return picture_of(sphere, 2); }},
    };
}

}  // namespace

const std::vector<Job>& reading_jobs() {
    static const std::vector<Job> jobs = make_reading_jobs();
    return jobs;
}

const std::vector<Job>& writing_jobs() {
    static const std::vector<Job> jobs = make_writing_jobs();
    return jobs;
}

const std::vector<Job>& computing_jobs() {
    static const std::vector<Job> jobs = make_computing_jobs();
    return jobs;
}

}  // namespace easypbr::faults
