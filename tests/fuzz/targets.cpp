#include "fuzz/targets.h"

#include <sys/mman.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <optional>

#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "easypbr/core/log.h"
#include "easypbr/core/memory_budget.h"
#include "easypbr/gl/program.h"
#include "easypbr/io/image/image_codecs.h"
#include "easypbr/io/image/image_io.h"
#include "easypbr/io/image/texture_loader.h"
#include "easypbr/io/mesh/assimp/message_decoder.h"
#include "easypbr/io/mesh/content_format.h"
#include "easypbr/io/mesh/file_scene.h"
#include "easypbr/io/mesh/gltf/gltf_reader.h"
#include "easypbr/io/mesh/mesh_io.h"
#include "easypbr/io/mesh/mesh_readers.h"
#include "easypbr/io/mesh/obj/mtl_reader.h"
#include "easypbr/io/settings/camera_path_io.h"
#include "easypbr/io/settings/label_map_text.h"
#include "easypbr/io/settings/settings_io.h"
#include "easypbr/remote/messages.h"
#include "easypbr/scene/fields.h"
#include "easypbr/scene/settings.h"

namespace easypbr::fuzz {
namespace {

constexpr double memory_gb = 0.5;
/// Side of the largest images that are written again, pixels.
constexpr int largest_written = 64;

template <class Read>
void refuse_or(Read&& read) {
    try {
        read();
    } catch (const Error&) {
    }
}

/// What was read may be refused by what writes; but what was written must be read. The process ends where it
/// is not.
template <class Write, class Read>
void write_and_read(Write&& write, Read&& read) {
    std::optional<decltype(write())> written;
    refuse_or([&] { written = write(); });
    if (!written) return;
    try {
        read(*written);
    } catch (const Error& error) {
        std::fprintf(stderr, "ERROR: what was written is refused: %s\n", error.what());
        std::abort();
    }
}

std::string_view text_of(std::span<const std::byte> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// The bytes in a file without a name.
Descriptor unnamed_file(std::span<const std::byte> bytes) {
    Descriptor file(memfd_create("fuzz", MFD_CLOEXEC));
    if (write(file.get(), bytes.data(), bytes.size()) != ssize_t(bytes.size()) ||
        lseek(file.get(), 0, SEEK_SET))
        throw std::runtime_error("no memory for a file");
    return file;
}

/// What readers of files are given.
FileBytes file_of(std::span<const std::byte> bytes) {
    return {unnamed_file(bytes).get(), "fuzz"};
}

/// The format is the name of the target.
template <char... letters>
void read_mesh(std::span<const std::byte> bytes) {
    refuse_or([&] {
        io::LoadedScene scene = io::load_scene(file_of(bytes), "/nowhere/fuzz",
                                               {.memory_gb = memory_gb, .format = std::string{letters...}});
        if (scene.animations.empty()) return;
        scene.animations.apply(0, 0.5);
        scene.animations.lights(0, 0.5);
        scene.animations.cameras(0, 0.5);
    });
}

/// A mesh of a file whose name does not say what it is.
void read_any_mesh(std::span<const std::byte> bytes) {
    const Descriptor file = unnamed_file(bytes);
    refuse_or([&] {
        io::load_scene("/proc/self/fd/" + std::to_string(file.get()),
                       {.memory_gb = memory_gb, .format = io::format_of_content(text_of(bytes))});
    });
}

/// Labels of as many points as there are.
void read_labels(std::span<const std::byte> bytes) {
    refuse_or([&] {
        MeshData mesh;
        mesh.V = Array3f::Dense::Zero(Eigen::Index(bytes.size() / 4), 3);
        io::read_kitti_labels({text_of(bytes), "fuzz.label"}, mesh);
    });
}

void read_materials(std::span<const std::byte> bytes) {
    refuse_or([&] {
        io::TextureLoader textures("/nowhere/fuzz");
        io::read_mtl({text_of(bytes), "fuzz"}, textures);
    });
}

void read_assimp_answer(std::span<const std::byte> bytes) {
    refuse_or([&] { io::decode_scene(bytes, "/nowhere/fuzz", uint64_t(memory_gb * 1e9)); });
    refuse_or([&] { io::decode_extensions(bytes, "fuzz"); });
}

/// A shader of a user's own with all that it includes.
void read_shader(std::span<const std::byte> bytes) {
    const Descriptor file = unnamed_file(bytes);
    refuse_or([&] { gl::shader_stage("/proc/self/fd/" + std::to_string(file.get())); });
}

/// Lines NAME=VALUE, as --set takes them.
void read_assignments(std::span<const std::byte> bytes) {
    Settings settings;
    for (std::string_view rest = text_of(bytes); !rest.empty();) {
        const std::string_view line = rest.substr(0, rest.find('\n'));
        rest.remove_prefix(std::min(line.size() + 1, rest.size()));
        const size_t equals = line.find('=');
        if (equals == line.npos) continue;
        refuse_or([&] { set_from_text(settings, line.substr(0, equals), line.substr(equals + 1)); });
    }
}

void read_image(std::span<const std::byte> bytes) {
    refuse_or([&] {
        const MemoryScope scope("fuzz", uint64_t(memory_gb * 1e9));
        const Image image = io::decode_image(bytes, "fuzz");
        if (image.width() > largest_written || image.height() > largest_written) return;
        io::upright(image, io::jpeg_orientation(bytes));
        const Image eight = to_u8(image), linear = to_linear_f32(image);
        const auto read = [](const std::vector<std::byte>& written) { io::decode_image(written, "again"); };
        write_and_read([&] { return io::encode_png(eight); }, read);
        write_and_read([&] { return io::encode_jpeg(eight, 90); }, read);
        write_and_read([&] { return io::encode_webp(with_channels(eight, 4), 90); }, read);
        write_and_read([&] { return io::encode_hdr(linear); }, read);
        write_and_read([&] { return io::encode_exr(linear); }, read);
    });
}

void read_settings(std::span<const std::byte> bytes) {
    refuse_or([&] {
        const io::SettingsFile file = io::parse_settings(std::string(text_of(bytes)), "fuzz");
        write_and_read([&] { return io::to_json(file); },
                       [](const std::string& text) { io::parse_settings(text, "again"); });
    });
}

void read_camera_path(std::span<const std::byte> bytes) {
    refuse_or([&] {
        const CameraPath path = io::parse_camera_path(std::string(text_of(bytes)), "fuzz");
        write_and_read([&] { return io::to_json(path); },
                       [](const std::string& text) { io::parse_camera_path(text, "again"); });
    });
}

void read_label_map(std::span<const std::byte> bytes, const char* name) {
    refuse_or([&] {
        const LabelMap map = io::parse_label_map(text_of(bytes), name);
        for (const char* again : {"again.json", "again.txt"})
            write_and_read([&] { return io::format_label_map(map, again); },
                           [&](const std::string& text) { io::parse_label_map(text, again); });
    });
}

void read_label_text(std::span<const std::byte> bytes) {
    read_label_map(bytes, "fuzz.txt");
}

void read_label_json(std::span<const std::byte> bytes) {
    read_label_map(bytes, "fuzz.json");
}

void read_label_yaml(std::span<const std::byte> bytes) {
    read_label_map(bytes, "fuzz.yaml");
}

void read_message(std::span<const std::byte> bytes) {
    try {
        remote::parse_message(text_of(bytes));
    } catch (const remote::ProtocolError&) {
    }
}

}  // namespace

const std::vector<Target>& targets() {
    static const std::vector<Target> all = {
        {"ply", read_mesh<'p', 'l', 'y'>},
        {"obj", read_mesh<'o', 'b', 'j'>},
        {"stl", read_mesh<'s', 't', 'l'>},
        {"off", read_mesh<'o', 'f', 'f'>},
        {"gltf", read_mesh<'g', 'l', 't', 'f'>},
        {"pcd", read_mesh<'p', 'c', 'd'>},
        {"xyz", read_mesh<'x', 'y', 'z'>},
        {"pts", read_mesh<'p', 't', 's'>},
        {"npy", read_mesh<'n', 'p', 'y'>},
        {"npz", read_mesh<'n', 'p', 'z'>},
        {"las", read_mesh<'l', 'a', 's'>},
        {"bin", read_mesh<'b', 'i', 'n'>},
        {"splat", read_mesh<'s', 'p', 'l', 'a', 't'>},
        {"content", read_any_mesh},
        {"label", read_labels},
        {"mtl", read_materials},
        {"assimp", read_assimp_answer},
        {"shader", read_shader},
        {"set", read_assignments},
        {"spz", read_mesh<'s', 'p', 'z'>},
        {"image", read_image},
        {"settings", read_settings},
        {"camera_path", read_camera_path},
        {"label_text", read_label_text},
        {"label_json", read_label_json},
        {"label_yaml", read_label_yaml},
        {"message", read_message},
    };
    return all;
}

}  // namespace easypbr::fuzz
