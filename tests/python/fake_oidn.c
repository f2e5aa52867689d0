/* A denoiser for tests in the place of Open Image Denoise: it changes nothing, and writes the images that it is given to
   $FAKE_OIDN_FOLDER, each as rows of 32-bit floats, and the numbers it is set to. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct image {
    const char* name;
    char* pixels;
    size_t width, height, stride;
};
static struct image images[4];
static int count;
static char device, filter;

static FILE* file(const char* name) {
    char path[4096];
    snprintf(path, sizeof path, "%s/%s", getenv("FAKE_OIDN_FOLDER"), name);
    return fopen(path, "a");
}

void* oidnNewDevice(int type) { return type == 1 ? &device : NULL; }
void oidnReleaseDevice(void* d) { (void)d; }
void oidnCommitDevice(void* d) { (void)d; }
void oidnSetDeviceInt(void* d, const char* name, int value) { (void)d, (void)name, (void)value; }
void oidnSetDeviceBool(void* d, const char* name, int value) { (void)d, (void)name, (void)value; }
int oidnGetDeviceInt(void* d, const char* name) { return (void)d, (void)name, 20300; }
int oidnGetDeviceError(void* d, const char** message) { return (void)d, (void)message, 0; }
void* oidnNewFilter(void* d, const char* type) {
    (void)d;
    count = 0;
    return strcmp(type, "RT") == 0 ? &filter : NULL;
}
void oidnReleaseFilter(void* f) { (void)f; }
void oidnSetSharedFilterImage(void* f, const char* name, void* pixels, int format, size_t width, size_t height, size_t offset,
                              size_t stride, size_t row) {
    const struct image made = {name, (char*)pixels + offset, width, height, stride};
    (void)f, (void)format, (void)row;
    images[count++] = made;
}
void oidnSetFilterBool(void* f, const char* name, int value) { (void)f, (void)name, (void)value; }
void oidnSetFilterInt(void* f, const char* name, int value) {
    FILE* to = file("numbers");
    (void)f;
    fprintf(to, "%s %d\n", name, value);
    fclose(to);
}
void oidnCommitFilter(void* f) { (void)f; }
void oidnExecuteFilter(void* f) {
    (void)f;
    for (int i = 0; i < count; ++i) {
        const struct image* image = &images[i];
        if (strcmp(image->name, "output") == 0) {
            for (size_t p = 0; p < image->width * image->height; ++p)
                memcpy(image->pixels + p * image->stride, images[0].pixels + p * images[0].stride, 12);
            continue;
        }
        FILE* to = file(image->name);
        for (size_t p = 0; p < image->width * image->height; ++p) fwrite(image->pixels + p * image->stride, 4, 3, to);
        fclose(to);
    }
}
