#include "readers_peers.h"

#include <cstdlib>
#include <cstring>
#include <sstream>
#include <vector>

#if __has_include(<stb/stb_image.h>)
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_HDR
#include <stb/stb_image.h>
#endif
#if __has_include(<tinyexr.h>)
#include <tinyexr.h>
#endif
#if __has_include(<tiny_obj_loader.h>)
#define TINYOBJLOADER_IMPLEMENTATION
#include <tiny_obj_loader.h>
#endif
#ifdef EASYPBR_BENCH_LZF
#include <lzf.h>
#endif
#ifdef EASYPBR_BENCH_MINIZIP
#include <minizip/ioapi.h>
#include <minizip/unzip.h>
#include <unistd.h>
#endif

namespace peers {

#ifdef STB_IMAGE_IMPLEMENTATION
const Reader hdr = [](const std::string& bytes) {
    int width = 0, height = 0, channels = 0;
    float* pixels = stbi_loadf_from_memory(reinterpret_cast<const unsigned char*>(bytes.data()),
                                           int(bytes.size()), &width, &height, &channels, 0);
    std::free(pixels);
    return pixels != nullptr;
};
#else
const Reader hdr;
#endif

#if __has_include(<tinyexr.h>)
const Reader exr = [](const std::string& bytes) {
    float* pixels = nullptr;
    int width = 0, height = 0;
    const char* message = nullptr;
    const int result =
        LoadEXRFromMemory(&pixels, &width, &height, reinterpret_cast<const unsigned char*>(bytes.data()),
                          bytes.size(), &message);
    if (message) FreeEXRErrorMessage(message);
    std::free(pixels);
    return result == TINYEXR_SUCCESS;
};
#else
const Reader exr;
#endif

#ifdef TINYOBJLOADER_IMPLEMENTATION
const Reader obj = [](const std::string& bytes) {
    tinyobj::ObjReader reader;
    return reader.ParseFromString(bytes, "") && !reader.GetAttrib().vertices.empty();
};
#else
const Reader obj;
#endif

#ifdef EASYPBR_BENCH_LZF
bool lzf(const std::string& packed, size_t size) {
    std::string out(size, '\0');
    return lzf_decompress(packed.data(), unsigned(packed.size()), out.data(), unsigned(out.size())) == size;
}
std::string lzf_pack(const std::string& bytes) {
    std::string out(bytes.size(), '\0');
    out.resize(lzf_compress(bytes.data(), unsigned(bytes.size()), out.data(), unsigned(out.size())));
    return out;
}
#else
bool lzf(const std::string&, size_t) {
    return false;
}
std::string lzf_pack(const std::string&) {
    return {};
}
#endif

#ifdef EASYPBR_BENCH_MINIZIP
namespace {

bool read_entry(unzFile file) {
    unz_file_info64 info;
    if (unzGetCurrentFileInfo64(file, &info, nullptr, 0, nullptr, 0, nullptr, 0) != UNZ_OK) return false;
    if (info.uncompressed_size > (uint64_t(1) << 31) || unzOpenCurrentFile(file) != UNZ_OK) return false;
    std::vector<char> out(size_t(info.uncompressed_size) + 1);
    const int read = unzReadCurrentFile(file, out.data(), unsigned(out.size()));
    // Closing compares the checksum.
    return unzCloseCurrentFile(file) == UNZ_OK && read >= 0 && uint64_t(read) == info.uncompressed_size;
}

}  // namespace

// From a file, for minizip reads no memory without custom callbacks.
const Reader zip = [](const std::string& bytes) {
    char name[] = "/tmp/easypbr_bench_XXXXXX";
    const int target = ::mkstemp(name);
    const bool wrote = target >= 0 && ::write(target, bytes.data(), bytes.size()) == ssize_t(bytes.size());
    if (target >= 0) ::close(target);
    unzFile file = wrote ? unzOpen64(name) : nullptr;
    bool good = file && unzGoToFirstFile(file) == UNZ_OK;
    while (good) {
        good = read_entry(file);
        if (!good || unzGoToNextFile(file) != UNZ_OK) break;
    }
    if (file) unzClose(file);
    ::unlink(name);
    return good;
};
#else
const Reader zip;
#endif

}  // namespace peers
