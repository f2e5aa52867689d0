#include "easypbr/io/mesh/assimp/assimp_loader.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <csignal>

#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "easypbr/core/folder.h"
#include "easypbr/io/mesh/assimp/colors_of_3mf.h"
#include "easypbr/io/mesh/assimp/message.h"
#include "easypbr/io/mesh/assimp/message_decoder.h"
#include "easypbr/io/mesh/mesh_io.h"
#include "easypbr/io/source/module_loader.h"

namespace easypbr::io {
namespace {

constexpr const char* reader_file = "easypbr_read_assimp";

/// Exit status of a program whose libraries the system cannot load.
constexpr int not_loaded = 127;

const fs::path& reader() {
    static const fs::path beside = beside_library(reader_file);
    return beside;
}

[[noreturn]] void fail_assimp(const std::string& file, const std::string& why) {
    throw FormatError(fmt::format("cannot read {}: {}", file, why));
}

[[noreturn]] void fail_missing(const std::string& file, const std::string& why) {
    fail_assimp(file,
                fmt::format("files of this kind are read by the assimp reader, which cannot be started ({}); "
                            "install the package libassimp5 and keep {} beside libeasypbr.so",
                            why, reader_file));
}

[[noreturn]] void fail_late(const std::string& file, const AssimpLimits& limits) {
    fail_assimp(file, fmt::format("the assimp reader took longer than {:.3g} s", limits.seconds));
}

[[noreturn]] void fail_large(const std::string& file, const AssimpLimits& limits) {
    fail_assimp(file, fmt::format("the assimp reader needs more than {} bytes of memory", limits.bytes));
}

[[noreturn]] void fail_signal(const std::string& file, int number, const AssimpLimits& limits) {
    if (number == SIGXCPU) fail_late(file, limits);
    if (number == SIGXFSZ) fail_large(file, limits);
    if (number == SIGKILL)
        fail_assimp(file, "the assimp reader was killed, as when the machine is out of memory");
    fail_assimp(file, fmt::format("the assimp reader crashed (signal {})", number));
}

void require_end(const ChildEnd& end, const std::string& file, const AssimpLimits& limits) {
    using How = ChildEnd::How;
    if (end.how == How::killed_late) fail_late(file, limits);
    if (end.how == How::signalled) fail_signal(file, end.code, limits);
    if (end.how == How::unknown || end.code == reader_done) return;
    if (end.code == reader_out_of_memory) fail_large(file, limits);
    if (end.code == not_loaded) fail_missing(file, "a library that it needs is not there");
    fail_assimp(file, fmt::format("the assimp reader ended with status {}", end.code));
}

/// `file` stands in messages; without `arguments` the extensions are asked for.
SharedMemory ask(const std::string& file, std::vector<std::string> arguments, const AssimpLimits& limits) {
    std::error_code ignored;
    if (!fs::exists(reader(), ignored)) fail_missing(file, fmt::format("{} is missing", reader_file));
    const std::vector<std::string> tie{fmt::format("{}", ::getpid()),
                                       fmt::format("{}", uint64_t(std::ceil(limits.seconds))),
                                       fmt::format("{}", limits.bytes)};
    arguments.insert(arguments.begin(), tie.begin(), tie.end());
    SharedMemory answer;
    require_end(run_child(reader(), arguments, answer, limits.seconds), file, limits);
    answer.seal();
    return answer;
}

std::vector<std::string> ask_extensions() {
    const std::string name = "the list of extensions";
    return decode_extensions(ask(name, {}, {}).bytes(), name);
}

}  // namespace

AssimpLimits assimp_limits(uint64_t file_bytes) {
    AssimpLimits limits;
    // assimp takes up to 0.06 s for each MiB of text on an idle machine (ASCII FBX); thirty times that is a
    // machine that is very busy. Its scenes take up to 28 times a file's size; twice that are files that are
    // compressed.
    limits.seconds += 2 * double(file_bytes) / (1 << 20);
    limits.bytes += 64 * file_bytes;
    return limits;
}

SharedMemory ask_assimp(const fs::path& path, const AssimpLimits& limits) {
    if (FolderScope::current())
        throw FormatError(
            fmt::format("{}: this format is read by a process that opens what a file names, wherever it "
                        "lies, which is not allowed here",
                        path.string()));
    check_readable(path);
    return ask(path.string(), {path.string()}, limits);
}

LoadedScene load_assimp(const fs::path& path) {
    return load_assimp(path, assimp_limits(InputFile(path).size()));
}

LoadedScene load_assimp(const fs::path& path, const AssimpLimits& limits) {
    LoadedScene scene = decode_scene(ask_assimp(path, limits).bytes(), path, limits.bytes);
    if (extension_of(path) == "3mf") warn_of_colors_of_3mf(path);
    return scene;
}

std::vector<std::string> assimp_extensions() {
    try {
        static const std::vector<std::string> known = ask_extensions();
        return known;
    } catch (const Error&) {
        // Asked again at the next call: it may have been for want of descriptors or memory.
        return {};
    }
}

}  // namespace easypbr::io
