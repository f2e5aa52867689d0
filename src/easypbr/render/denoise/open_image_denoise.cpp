#include "easypbr/render/denoise/open_image_denoise.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <mutex>
#include <span>
#include <vector>

#include "easypbr/core/error.h"
#include "easypbr/core/parallel.h"

namespace easypbr::render {
namespace {

namespace fs = std::filesystem;

// The C interface of the library (oidn.h): handles are pointers, and these numbers stand for its
// enumerations.
constexpr int cpu_device = 1, format_float3 = 3;

/// That the library may take for an image: less takes longer for one of 1920 x 1080 pixels, while without a
/// limit memory grows with the image.
constexpr int most_memory_mb = 800;

struct Library {
    void* (*new_device)(int type);
    void (*release_device)(void* device);
    void (*commit_device)(void* device);
    void (*set_device_int)(void* device, const char* name, int value);
    void (*set_device_bool)(void* device, const char* name, bool value);
    int (*get_device_int)(void* device, const char* name);
    int (*get_error)(void* device, const char** message);
    void* (*new_filter)(void* device, const char* type);
    void (*release_filter)(void* filter);
    void (*set_image)(void* filter, const char* name, void* pixels, int format, size_t width, size_t height,
                      size_t offset, size_t pixel_stride, size_t row_stride);
    void (*set_filter_bool)(void* filter, const char* name, bool value);
    void (*set_filter_int)(void* filter, const char* name, int value);
    void (*commit_filter)(void* filter);
    void (*execute_filter)(void* filter);
};

struct Loaded {
    std::mutex mutex;
    std::vector<fs::path> folders;  ///< of add_denoiser_folder()
    void* handle = nullptr;
    Library library{};
};

Loaded& loaded() {
    static Loaded the_one;
    return the_one;
}

/// By EASYPBR_OIDN alone where that is set; else in these folders, then where the system looks.
void* open_library(const std::vector<fs::path>& folders) {
    const char* given = std::getenv("EASYPBR_OIDN");
    const bool is_given = given && *given;
    const std::vector<fs::path> looked_in = is_given ? std::vector<fs::path>{given} : folders;
    for (const char* name : {"libOpenImageDenoise.so.2", "libOpenImageDenoise.so.1"}) {
        for (const fs::path& folder : looked_in)
            if (folder.is_absolute())
                if (void* handle = ::dlopen((folder / name).c_str(), RTLD_NOW | RTLD_LOCAL)) return handle;
        if (is_given) continue;
        if (void* handle = ::dlopen(name, RTLD_NOW | RTLD_LOCAL)) return handle;
    }
    return nullptr;
}

/// The first name is that of version 2, the second that of version 1. Whether one of them is there.
template <class Function>
bool load(void* handle, Function*& function, const char* name, const char* old_name = nullptr) {
    void* symbol = ::dlsym(handle, name);
    if (!symbol && old_name) symbol = ::dlsym(handle, old_name);
    function = reinterpret_cast<Function*>(symbol);
    return symbol != nullptr;
}

bool load_all(void* handle, Library& to) {
    return load(handle, to.new_device, "oidnNewDevice") &&
           load(handle, to.release_device, "oidnReleaseDevice") &&
           load(handle, to.commit_device, "oidnCommitDevice") &&
           load(handle, to.set_device_int, "oidnSetDeviceInt", "oidnSetDevice1i") &&
           load(handle, to.set_device_bool, "oidnSetDeviceBool", "oidnSetDevice1b") &&
           load(handle, to.get_device_int, "oidnGetDeviceInt", "oidnGetDevice1i") &&
           load(handle, to.get_error, "oidnGetDeviceError") && load(handle, to.new_filter, "oidnNewFilter") &&
           load(handle, to.release_filter, "oidnReleaseFilter") &&
           load(handle, to.set_image, "oidnSetSharedFilterImage") &&
           load(handle, to.set_filter_bool, "oidnSetFilterBool", "oidnSetFilter1b") &&
           load(handle, to.set_filter_int, "oidnSetFilterInt", "oidnSetFilter1i") &&
           load(handle, to.commit_filter, "oidnCommitFilter") &&
           load(handle, to.execute_filter, "oidnExecuteFilter");
}

/// Null where the library is not there: it is looked for again the next time.
const Library* library() {
    Loaded& known = loaded();
    const std::lock_guard lock(known.mutex);
    if (known.handle) return &known.library;
    void* handle = open_library(known.folders);
    if (!handle || !load_all(handle, known.library)) return nullptr;
    known.handle = handle;
    return &known.library;
}

void check(const Library& oidn, void* device) {
    const char* message = nullptr;
    if (oidn.get_error(device, &message) != 0)
        throw Error(
            fmt::format("path.denoise: Open Image Denoise failed: {}", message ? message : "no reason"));
}

}  // namespace

void add_denoiser_folder(const fs::path& folder) {
    Loaded& known = loaded();
    const std::lock_guard lock(known.mutex);
    known.folders.push_back(folder);
}

OpenImageDenoise::OpenImageDenoise() = default;

OpenImageDenoise::~OpenImageDenoise() {
    if (const Library* oidn = device_ ? library() : nullptr) oidn->release_device(device_);
}

std::string OpenImageDenoise::version() {
    const Library* oidn = library();
    if (!oidn) return {};
    void* device = oidn->new_device(cpu_device);
    const int number = oidn->get_device_int(device, "version");
    oidn->release_device(device);
    return fmt::format("{}.{}.{}", number / 10000, number / 100 % 100, number % 100);
}

const Target& OpenImageDenoise::denoise(const NoisyLight& noisy) {
    const Library* oidn = library();
    if (!oidn)
        throw Error(
            "path.denoise: Open Image Denoise is not there: `pip install pyoidn`, or name the folder of "
            "libOpenImageDenoise.so by EASYPBR_OIDN; filter needs nothing");
    if (!device_) {
        device_ = oidn->new_device(cpu_device);
        oidn->set_device_int(device_, "numThreads", thread_count());
        oidn->set_device_bool(device_, "setAffinity", false);
        oidn->commit_device(device_);
        check(*oidn, device_);
    }
    noisy.scratch.write(noisy.scratch.whole());
    const size_t count = noisy.light.pixels<Vec4>().size();
    std::vector<Vec3> normal(count, Vec3::Zero()), albedo(count, Vec3::Zero());
    const std::span<Vec4> light = noisy.light.pixels<Vec4>(), output = noisy.scratch.pixels<Vec4>();
    // A catcher beside surfaces is a white one, whose shadows are dark: what it lets through.
    const auto turn_coverage = [&](std::span<Vec4> values, size_t i, Noisy of) {
        if (!noisy.is_white && of == Noisy::coverage)
            values[i].head<3>() = Vec3::Ones() - values[i].head<3>();
    };
    noisy.each([&](size_t i, const SurfaceMean& surface, Noisy of) {
        if (surface.frames == 0) return;
        normal[i] = surface.mean_normal();
        albedo[i] = noisy.reflectance(surface);
        turn_coverage(light, i, of);
    });
    void* filter = oidn->new_filter(device_, "RT");
    const auto image = [&](const char* name, auto pixels) {
        oidn->set_image(filter, name, pixels.data(), format_float3, size_t(noisy.light.width()),
                        size_t(noisy.light.height()), 0, sizeof pixels[0], 0);
    };
    image("color", light);
    image("albedo", std::span(albedo));
    image("normal", std::span(normal));
    image("output", output);
    oidn->set_filter_bool(filter, "hdr", true);
    oidn->set_filter_int(filter, "maxMemoryMB", most_memory_mb);
    oidn->commit_filter(filter);
    oidn->execute_filter(filter);
    oidn->release_filter(filter);
    check(*oidn, device_);
    noisy.each([&](size_t i, const SurfaceMean& /*surface*/, Noisy of) { turn_coverage(output, i, of); });
    return noisy.scratch;
}

}  // namespace easypbr::render
