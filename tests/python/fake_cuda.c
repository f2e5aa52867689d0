/* A driver of CUDA's for tests: "device memory" is the host's, arrays are read from OpenGL's textures by the context
   that is current. Every call is logged; one that is out of order fails as the real driver would. */
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { invalid_value = 1, no_context = 201, not_mapped = 211, no_memory = 2, all_devices = 1, read_only = 1 };
enum { device_memory = 2, array_memory = 3, gl_texture_2d = 0x0DE1 };

struct resource {
    unsigned texture;
    int mapped;
};
struct copy {
    size_t source_x, source_y;
    int source_type;
    const void* source_host;
    unsigned long long source_device;
    struct resource* source_array;
    size_t source_pitch, target_x, target_y;
    int target_type;
    void* target_host;
    unsigned long long target_device;
    void* target_array;
    size_t target_pitch, width, height;
};

static char calls[1 << 16];
static int contexts, resources, mapped, allocations, devices = 1;
static const char* failing = "";

static int note(const char* name) {
    if (strlen(calls) + strlen(name) + 2 < sizeof calls) strcat(strcat(calls, name), " ");
    return strcmp(failing, name) == 0 ? no_memory : 0;
}
const char* fake_calls(void) { return calls; }
void fake_reset(void) { calls[0] = 0; failing = ""; devices = 1; }
void fake_fail(const char* name) { failing = strdup(name); }
void fake_devices(int count) { devices = count; }
int fake_left(void) { return contexts + resources + mapped + allocations; }

#define CALL(name) do { const int failed = note(name); if (failed) return failed; } while (0)
#define NEEDS_CONTEXT do { if (contexts < 1) return no_context; } while (0)

int cuInit(unsigned flags) { return flags ? invalid_value : 0; }
int cuGetErrorString(int code, const char** text) {
    *text = code == no_memory ? "out of memory" : code == no_context ? "invalid device context" : "something else";
    return 0;
}
int cuGLGetDevices_v2(unsigned* count, int* list, unsigned most, unsigned which) {
    *count = devices;
    if (which != all_devices || most < 1) return invalid_value;
    if (devices) list[0] = 0;
    return 0;
}
int cuDevicePrimaryCtxRetain(void** context, int device) {
    CALL("retain");
    *context = &contexts;
    return device;
}
int cuCtxPushCurrent_v2(void* context) {
    if (context != &contexts) return invalid_value;
    ++contexts;
    return 0;
}
int cuCtxPopCurrent_v2(void** context) {
    NEEDS_CONTEXT;
    --contexts;
    *context = &contexts;
    return 0;
}
int cuMemAlloc_v2(unsigned long long* address, size_t bytes) {
    NEEDS_CONTEXT;
    CALL("allocate");
    *address = (unsigned long long)malloc(bytes);
    ++allocations;
    return 0;
}
int cuMemFree_v2(unsigned long long address) {
    NEEDS_CONTEXT;
    CALL("free");
    free((void*)address);
    --allocations;
    return 0;
}
int cuGraphicsGLRegisterImage(struct resource** resource, unsigned texture, unsigned target, unsigned flags) {
    NEEDS_CONTEXT;
    CALL("register");
    if (target != gl_texture_2d || flags != read_only) return invalid_value;
    *resource = calloc(1, sizeof **resource);
    (*resource)->texture = texture;
    ++resources;
    return 0;
}
int cuGraphicsUnregisterResource(struct resource* resource) {
    NEEDS_CONTEXT;
    CALL("unregister");
    if (resource->mapped) return invalid_value;
    free(resource);
    --resources;
    return 0;
}
int cuGraphicsMapResources(unsigned count, struct resource** list, void* stream) {
    NEEDS_CONTEXT;
    CALL("map");
    if (count != 1 || stream || list[0]->mapped) return invalid_value;
    list[0]->mapped = 1;
    ++mapped;
    return 0;
}
int cuGraphicsUnmapResources(unsigned count, struct resource** list, void* stream) {
    NEEDS_CONTEXT;
    CALL("unmap");
    if (count != 1 || stream) return invalid_value;
    if (!list[0]->mapped) return not_mapped;
    list[0]->mapped = 0;
    --mapped;
    return 0;
}
int cuGraphicsSubResourceGetMappedArray(struct resource** array, struct resource* resource, unsigned index, unsigned level) {
    NEEDS_CONTEXT;
    CALL("array");
    if (!resource->mapped) return not_mapped;
    *array = resource;
    return index || level ? invalid_value : 0;
}
int cuStreamSynchronize(void* stream) {
    NEEDS_CONTEXT;
    CALL("wait");
    return stream ? invalid_value : 0;
}

/* Layout and type that a texture's pixels are read in, by its internal format. */
static int layout_of(int internal, unsigned* layout, unsigned* type) {
    static const unsigned table[][3] = {{0x8058, 0x1908, 0x1401}, {0x8C43, 0x1908, 0x1401}, {0x822C, 0x8227, 0x1403},
                                        {0x805B, 0x1908, 0x1403}, {0x822E, 0x1903, 0x1406}, {0x8236, 0x8D94, 0x1405},
                                        {0x8814, 0x1908, 0x1406}, {0x881A, 0x1908, 0x140B}};
    for (unsigned i = 0; i < sizeof table / sizeof table[0]; ++i)
        if ((int)table[i][0] == internal) {
            *layout = table[i][1];
            *type = table[i][2];
            return 1;
        }
    return 0;
}

int cuMemcpy2D_v2(const struct copy* copy) {
    NEEDS_CONTEXT;
    CALL("copy");
    const struct resource* source = copy->source_array;
    if (copy->source_type != array_memory || copy->target_type != device_memory || !source->mapped) return invalid_value;
    if (copy->source_x || copy->source_y || copy->target_x || copy->target_y || copy->target_pitch < copy->width) return invalid_value;
    void* gl = dlopen("libOpenGL.so.0", RTLD_LAZY);
    void (*parameter)(unsigned, int, unsigned, int*) = gl ? dlsym(gl, "glGetTextureLevelParameteriv") : 0;
    void (*image)(unsigned, int, unsigned, unsigned, int, void*) = gl ? dlsym(gl, "glGetTextureImage") : 0;
    void (*store)(unsigned, int) = gl ? dlsym(gl, "glPixelStorei") : 0;
    if (!parameter || !image || !store) return invalid_value;
    int height = 0, internal = 0;
    unsigned layout, type;
    parameter(source->texture, 0, 0x1001, &height);
    parameter(source->texture, 0, 0x1003, &internal);
    if ((size_t)height != copy->height || !layout_of(internal, &layout, &type)) return invalid_value;
    store(0x0D05, 1);
    image(source->texture, 0, layout, type, (int)(copy->width * copy->height), (void*)copy->target_device);
    return 0;
}
