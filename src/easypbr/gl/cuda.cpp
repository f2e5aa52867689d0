#include "easypbr/gl/cuda.h"

#include <dlfcn.h>
#include <epoxy/gl.h>
#include <fmt/format.h>

#include <array>
#include <mutex>

#include "easypbr/core/error.h"

namespace easypbr::gl {
namespace {

// What is used of the driver's interface, as its reference manual has it (CUDA Driver API: Initialization,
// Primary Context Management, Memory Management, Graphics Interoperability, OpenGL Interoperability). Names
// with _v2 are those of CUDA 3.2 and later, whose sizes have 64 bits.
using Result = int;
using Device = int;
using CudaContext = struct CudaContextState*;
using Array = struct CudaArray*;
using Resource = struct CudaResource*;
using Stream = struct CudaStream*;
using Address = unsigned long long;

constexpr unsigned all_devices = 1;         // CU_GL_DEVICE_LIST_ALL
constexpr unsigned read_only = 1;           // CU_GRAPHICS_REGISTER_FLAGS_READ_ONLY
constexpr int on_device = 2, in_array = 3;  // CU_MEMORYTYPE_DEVICE, CU_MEMORYTYPE_ARRAY

/// CUDA_MEMCPY2D
struct Copy2d {
    size_t source_x_bytes = 0, source_y = 0;
    int source_type = in_array;
    const void* source_host = nullptr;
    Address source_device = 0;
    Array source_array = nullptr;
    size_t source_pitch = 0;
    size_t target_x_bytes = 0, target_y = 0;
    int target_type = on_device;
    void* target_host = nullptr;
    Address target_device = 0;
    Array target_array = nullptr;
    size_t target_pitch = 0;
    size_t width_bytes = 0, height = 0;
};

struct Driver {
    Result (*init)(unsigned) = nullptr;
    Result (*get_error_string)(Result, const char**) = nullptr;
    Result (*gl_get_devices)(unsigned*, Device*, unsigned, unsigned) = nullptr;
    Result (*retain_context)(CudaContext*, Device) = nullptr;
    Result (*push_context)(CudaContext) = nullptr;
    Result (*pop_context)(CudaContext*) = nullptr;
    Result (*allocate)(Address*, size_t) = nullptr;
    Result (*free)(Address) = nullptr;
    Result (*copy_2d)(const Copy2d*) = nullptr;
    Result (*synchronize)(Stream) = nullptr;
    Result (*register_image)(Resource*, unsigned, unsigned, unsigned) = nullptr;
    Result (*unregister)(Resource) = nullptr;
    Result (*map)(unsigned, Resource*, Stream) = nullptr;
    Result (*unmap)(unsigned, Resource*, Stream) = nullptr;
    Result (*mapped_array)(Array*, Resource, unsigned, unsigned) = nullptr;

    bool load();
};

bool Driver::load() {
    // Never closed: PyTorch and others use the same driver until the program ends.
    void* library = dlopen("libcuda.so.1", RTLD_LAZY | RTLD_LOCAL);
    if (!library) return false;
    bool complete = true;
    const auto find = [&](const char* name, auto& function) {
        function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(dlsym(library, name));
        complete &= function != nullptr;
    };
    find("cuInit", init);
    find("cuGetErrorString", get_error_string);
    find("cuGLGetDevices_v2", gl_get_devices);
    find("cuDevicePrimaryCtxRetain", retain_context);
    find("cuCtxPushCurrent_v2", push_context);
    find("cuCtxPopCurrent_v2", pop_context);
    find("cuMemAlloc_v2", allocate);
    find("cuMemFree_v2", free);
    find("cuMemcpy2D_v2", copy_2d);
    find("cuStreamSynchronize", synchronize);
    find("cuGraphicsGLRegisterImage", register_image);
    find("cuGraphicsUnregisterResource", unregister);
    find("cuGraphicsMapResources", map);
    find("cuGraphicsUnmapResources", unmap);
    find("cuGraphicsSubResourceGetMappedArray", mapped_array);
    return complete && init(0) == 0;
}

/// Null when there is none that works.
const Driver* driver() {
    static const std::optional<Driver> loaded = [] {
        Driver driver;
        return driver.load() ? std::optional(driver) : std::nullopt;
    }();
    return loaded ? &*loaded : nullptr;
}

void check(const Driver& cuda, Result result, const char* call) {
    if (result == 0) return;
    const char* text = nullptr;
    if (cuda.get_error_string(result, &text) != 0 || !text) text = "unknown error";
    throw ContextError(fmt::format("CUDA: {} failed: {} ({})", call, text, result));
}

/// The device's primary context, which PyTorch, CuPy and JAX use too. Kept until the program ends.
CudaContext primary_context(const Driver& cuda, Device device) {
    static std::mutex mutex;
    static std::array<CudaContext, 64> contexts{};
    const std::lock_guard lock(mutex);
    CudaContext& context = contexts.at(size_t(device));
    if (!context) check(cuda, cuda.retain_context(&context, device), "cuDevicePrimaryCtxRetain");
    return context;
}

class ContextOnTop {
  public:
    ContextOnTop(const Driver& cuda, Device device) : cuda_(cuda) {
        check(cuda, cuda.push_context(primary_context(cuda, device)), "cuCtxPushCurrent");
    }
    ContextOnTop(const ContextOnTop&) = delete;
    ContextOnTop& operator=(const ContextOnTop&) = delete;
    ~ContextOnTop() {
        CudaContext popped = nullptr;
        cuda_.pop_context(&popped);
    }

  private:
    const Driver& cuda_;
};

/// A texture that CUDA may read while this lives.
class MappedTexture {
  public:
    MappedTexture(const Driver& cuda, const Texture& texture) : cuda_(cuda) {
        check(cuda, cuda.register_image(&resource_, texture.id(), GL_TEXTURE_2D, read_only),
              "cuGraphicsGLRegisterImage");
        const Result mapped = cuda.map(1, &resource_, nullptr);
        if (mapped != 0) cuda.unregister(resource_);
        check(cuda, mapped, "cuGraphicsMapResources");
    }
    MappedTexture(const MappedTexture&) = delete;
    MappedTexture& operator=(const MappedTexture&) = delete;
    ~MappedTexture() {
        cuda_.unmap(1, &resource_, nullptr);
        cuda_.unregister(resource_);
    }
    Array array() const {
        Array array = nullptr;
        check(cuda_, cuda_.mapped_array(&array, resource_, 0, 0), "cuGraphicsSubResourceGetMappedArray");
        return array;
    }

  private:
    const Driver& cuda_;
    Resource resource_ = nullptr;
};

}  // namespace

std::optional<int> cuda_device() {
    const Driver* cuda = driver();
    unsigned count = 0;
    Device device = 0;
    if (!cuda || cuda->gl_get_devices(&count, &device, 1, all_devices) != 0 || count == 0)
        return std::nullopt;
    return device;
}

CudaPixels copy_to_cuda(const Texture& texture) {
    const std::optional<int> device = cuda_device();
    if (!device) throw ContextError("CUDA: the OpenGL context is not on a CUDA device");
    const Driver& cuda = *driver();
    const ContextOnTop context(cuda, *device);
    CudaPixels pixels;
    pixels.device_ = *device;
    pixels.width_ = texture.width();
    pixels.height_ = texture.height();
    pixels.format_ = texture.format();
    Copy2d copy;
    copy.width_bytes = copy.target_pitch = size_t(texture.width()) * pixel_bytes(texture.format());
    copy.height = size_t(texture.height());
    Address address = 0;
    check(cuda, cuda.allocate(&address, copy.width_bytes * copy.height), "cuMemAlloc");
    pixels.address_ = copy.target_device = address;
    const MappedTexture mapped(cuda, texture);
    copy.source_array = mapped.array();
    check(cuda, cuda.copy_2d(&copy), "cuMemcpy2D");
    // Copies within a device do not wait for their end.
    check(cuda, cuda.synchronize(nullptr), "cuStreamSynchronize");
    return pixels;
}

CudaPixels::~CudaPixels() {
    if (!address_) return;
    try {
        const Driver& cuda = *driver();
        const ContextOnTop context(cuda, device_);
        cuda.free(address_);
    } catch (const ContextError&) {  // The driver has shut down before: the memory went with it.
    }
}

}  // namespace easypbr::gl
