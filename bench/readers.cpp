// Readers of files beside libraries that could take their place: milliseconds to read, and what becomes of
// damaged copies. Prints a table in Markdown. usage: bench_readers [ROUNDS]     default 5, of which the
// quickest counts Peers are those that are installed: libstb-dev, libtinyexr-dev, libtinyobjloader-dev,
// liblzf-dev, libminizip-dev.
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "easypbr/core/error.h"
#include "easypbr/core/stopwatch.h"
#include "easypbr/geometry/primitives.h"
#include "easypbr/io/archive/lzf.h"
#include "easypbr/io/image/image_io.h"
#include "easypbr/io/mesh/mesh_io.h"
#include "easypbr/scene/mesh.h"
#include "readers_peers.h"

namespace {

using namespace easypbr;
namespace fs = std::filesystem;

/// A reader of bytes: whether it took them.
using Reader = std::function<bool(const std::string&)>;

struct Case {
    std::string what, peer;
    std::function<std::string()> make;  ///< the file
    Reader ours, theirs;
};

double milliseconds(const Reader& reader, const std::string& bytes, int rounds) {
    double best = 1e30;
    for (int i = 0; i < rounds; ++i) {
        double seconds = 0;
        {
            const Stopwatch watch(seconds);
            if (!reader(bytes)) return -1;
        }
        best = std::min(best, 1000 * seconds);
    }
    return best;
}

/// Bytes of a file that ends early, or of which sixteen are others.
std::string damaged(const std::string& bytes, int number, int copies) {
    std::string found = bytes;
    if (number % 2 == 0) found.resize(bytes.size() * size_t(number + 1) / size_t(copies + 1));
    uint64_t state = uint64_t(number);
    for (int k = 0; number % 2 == 1 && k < 16; ++k) {
        state = state * 6364136223846793005u + 1442695040888963407u;
        found[size_t(state >> 20) % found.size()] = char(state >> 56);
    }
    return found;
}

/// Runs this program anew for one file, so that a crash is its own; eight seconds are counted as one.
int status_of(size_t which, const char* whose, const fs::path& file) {
    const pid_t child = ::fork();
    if (child == 0) {
        ::alarm(8);
        ::close(STDERR_FILENO);
        ::execl("/proc/self/exe", "bench_readers", "--read", std::to_string(which).c_str(), whose,
                file.c_str(), nullptr);
        ::_exit(127);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/// What a reader does with damaged copies: refused / taken / crashed or not done after eight seconds.
std::string fate(size_t which, const char* whose, const std::string& bytes, const fs::path& folder) {
    constexpr int copies = 32;
    int refused = 0, taken = 0, crashed = 0;
    const fs::path file = folder / "damaged";
    for (int i = 0; i < copies; ++i) {
        std::ofstream(file, std::ios::binary) << damaged(bytes, i, copies);
        const int status = status_of(which, whose, file);
        ++(status == 0 ? taken : status == 1 ? refused : crashed);
    }
    return fmt::format("{} / {} / {}", refused, taken, crashed);
}

std::string bytes_of(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

bool decodes(const std::string& bytes) {
    try {
        return io::decode_image(std::as_bytes(std::span(bytes)), "image").width() > 0;
    } catch (const Error&) {
        return false;
    }
}

Reader mesh_reader(const fs::path& path) {
    return [path](const std::string& bytes) {
        std::ofstream(path, std::ios::binary) << bytes;
        try {
            return io::load_mesh(path).V().rows() > 0;
        } catch (const Error&) {
            return false;
        }
    };
}

Image sky() {
    Image image(2048, 1024, 3, PixelType::f32);
    auto pixels = image.pixels<float>();
    for (size_t i = 0; i < pixels.size(); ++i)
        pixels[i] = 0.1f + 1.5f * float(i / 3 % 2048) / 2048 + float(i * 2654435761u % 97) / 300;
    return image;
}

std::string image_bytes(const fs::path& path) {
    io::save_image(sky(), path);
    return bytes_of(path);
}

std::string mesh_bytes(const fs::path& path) {
    io::save_mesh(make_torus(1, 0.3f, 512, 256), path);
    return bytes_of(path);
}

constexpr size_t packed_size = 8'000'000;

std::string packed() {
    std::string text(packed_size, ' ');
    for (size_t i = 0; i < text.size(); ++i) text[i] = char(i / 7 % 61 * (i % 4 + 1));
    return peers::lzf_pack(text);
}

bool unpacks(const std::string& bytes) {
    std::string out(packed_size, '\0');
    return io::lzf_decompress(bytes, out);
}

std::vector<Case> cases(const fs::path& folder) {
    const auto image = [&](const char* name) { return [file = folder / name] { return image_bytes(file); }; };
    const auto mesh = [&](const char* name) { return [file = folder / name] { return mesh_bytes(file); }; };
    const auto reads = [&](const char* name) { return mesh_reader(folder / name); };
    return {
        {"HDR, 2 megapixels", "stb_image", image("a.hdr"), decodes, peers::hdr},
        {"EXR, 2 megapixels", "tinyexr", image("a.exr"), decodes, peers::exr},
        {"OBJ, 0.26 M faces", "tinyobjloader", mesh("a.obj"), reads("b.obj"), peers::obj},
        {"PLY, 0.26 M faces", "none in Debian", mesh("a.ply"), reads("b.ply"), {}},
        {"NPY, 0.13 M points", "none in Debian", mesh("a.npy"), reads("b.npy"), {}},
        {"ZIP (NPZ), 0.13 M points", "minizip", mesh("a.npz"), reads("b.npz"), peers::zip},
        {"LZF, 8 MB", "liblzf", packed, unpacks,
         [](const std::string& bytes) { return peers::lzf(bytes, packed_size); }},
    };
}

std::string shown(double time) {
    return time < 0 ? "-" : fmt::format("{:.1f} ms", time);
}

}  // namespace

int main(int argc, char** argv) {
    const fs::path folder = fs::temp_directory_path() / fmt::format("easypbr_readers_{}", ::getpid());
    fs::create_directories(folder);
    const std::vector<Case> all = cases(folder);
    if (argc == 5 && std::string_view(argv[1]) == "--read") {
        const Case& each = all.at(size_t(std::atoi(argv[2])));
        const bool taken = (std::string_view(argv[3]) == "ours" ? each.ours : each.theirs)(bytes_of(argv[4]));
        fs::remove_all(folder);
        return taken ? 0 : 1;
    }
    const int rounds = argc > 1 ? std::max(1, std::atoi(argv[1])) : 5;
    fmt::print("| What | EasyPBR | peer | | damaged: EasyPBR | damaged: peer |\n|---|---|---|---|---|---|\n");
    for (size_t i = 0; i < all.size(); ++i) {
        const Case& each = all[i];
        const std::string bytes = each.make();
        if (bytes.empty()) continue;
        const bool has_peer = bool(each.theirs);
        const double ours = milliseconds(each.ours, bytes, rounds);
        const double theirs = has_peer ? milliseconds(each.theirs, bytes, rounds) : -1;
        fmt::print("| {} | {} | {} | {} | {} | {} |\n", each.what, shown(ours), shown(theirs), each.peer,
                   fate(i, "ours", bytes, folder), has_peer ? fate(i, "theirs", bytes, folder) : "-");
        std::fflush(stdout);
    }
    fs::remove_all(folder);
}
