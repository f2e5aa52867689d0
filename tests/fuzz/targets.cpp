#include "fuzz/targets.h"

#include <sys/mman.h>
#include <unistd.h>

#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "easypbr/core/log.h"
#include "easypbr/core/memory_budget.h"
#include "easypbr/gl/program.h"
#include "easypbr/io/image/image_io.h"
#include "easypbr/io/image/texture_loader.h"
#include "easypbr/io/mesh/assimp/message_decoder.h"
#include "easypbr/io/mesh/content_format.h"
#include "easypbr/io/mesh/gltf/gltf_reader.h"
#include "easypbr/io/mesh/mesh_io.h"
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

template <class Read>
void refuse_or(Read&& read) {
    try {
        read();
    } catch (const Error&) {
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
        if (!scene.animations.empty()) scene.animations.apply(0, 0.5);
    });
}

/// A mesh from standard input.
void read_any_mesh(std::span<const std::byte> bytes) {
    refuse_or([&] {
        io::load_scene(file_of(bytes), "/nowhere/fuzz",
                       {.memory_gb = memory_gb, .format = io::format_of_content(text_of(bytes))});
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
        io::decode_image(bytes, "fuzz");
    });
}

void read_settings(std::span<const std::byte> bytes) {
    refuse_or([&] { io::parse_settings(std::string(text_of(bytes)), "fuzz"); });
}

void read_camera_path(std::span<const std::byte> bytes) {
    refuse_or([&] { io::parse_camera_path(std::string(text_of(bytes)), "fuzz"); });
}

void read_label_text(std::span<const std::byte> bytes) {
    refuse_or([&] { io::parse_label_map(text_of(bytes), "fuzz.txt"); });
}

void read_label_json(std::span<const std::byte> bytes) {
    refuse_or([&] { io::parse_label_map(text_of(bytes), "fuzz.json"); });
}

void read_label_yaml(std::span<const std::byte> bytes) {
    refuse_or([&] { io::parse_label_map(text_of(bytes), "fuzz.yaml"); });
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
