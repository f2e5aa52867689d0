// Counts the rays that a program asks Embree for, and the time within: loaded before Embree (LD_PRELOAD). See
// path_rays.py. One of 16 calls is timed for all: reading the clock takes as long as some of them.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <stdatomic.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <time.h>

enum { width = 16, timed = 16 };

struct counts {
    uint64_t met, shadowed, nanoseconds;
};

struct thread {
    struct counts counts;
    uint64_t calls;
    struct thread* next;
};

static _Atomic(struct thread*) threads;
static _Thread_local struct thread* own;

static struct thread* mine(void) {
    if (!own) {
        own = calloc(1, sizeof *own);
        if (!own) abort();
        own->next = atomic_load(&threads);
        while (!atomic_compare_exchange_weak(&threads, &own->next, own)) {
        }
    }
    return own;
}

static uint64_t now(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (uint64_t)t.tv_sec * 1000000000u + (uint64_t)t.tv_nsec;
}

static uint64_t active(const int* valid) {
    uint64_t count = 0;
    for (int i = 0; i < width; ++i) count += valid[i] != 0;
    return count;
}

// Versions 3 and 4 differ in the meaning of the pointers alone, which are passed on.
typedef void (*single)(void*, void*, void*);
typedef void (*packet)(const int*, void*, void*, void*);

// Python loads libraries out of reach of RTLD_NEXT.
static void* embree(const char* name) {
    const char* const libraries[] = {"libembree4.so.4", "libembree3.so.3"};
    for (int i = 0; i < 2; ++i) {
        void* library = dlopen(libraries[i], RTLD_NOW | RTLD_NOLOAD);
        if (library) return dlsym(library, name);
    }
    abort();
}

#define TIME(call)                                             \
    if (thread->calls++ % timed == 0) {                        \
        const uint64_t start = now();                          \
        call;                                                  \
        thread->counts.nanoseconds += timed * (now() - start); \
    } else {                                                   \
        call;                                                  \
    }
#define COUNT_SINGLE(name, counter)              \
    void name(void* a, void* b, void* c) {       \
        static single real;                      \
        if (!real) real = (single)embree(#name); \
        struct thread* thread = mine();          \
        ++thread->counts.counter;                \
        TIME(real(a, b, c))                      \
    }
#define COUNT_PACKET(name, counter)                          \
    void name(const int* valid, void* a, void* b, void* c) { \
        static packet real;                                  \
        if (!real) real = (packet)embree(#name);             \
        struct thread* thread = mine();                      \
        thread->counts.counter += active(valid);             \
        TIME(real(valid, a, b, c))                           \
    }

COUNT_SINGLE(rtcIntersect1, met)
COUNT_SINGLE(rtcOccluded1, shadowed)
COUNT_PACKET(rtcIntersect16, met)
COUNT_PACKET(rtcOccluded16, shadowed)

// Of all threads: rays to the nearest hit, shadow rays, nanoseconds within Embree.
void count_rays_total(uint64_t* total) {
    total[0] = total[1] = total[2] = 0;
    for (struct thread* t = atomic_load(&threads); t; t = t->next) {
        total[0] += t->counts.met;
        total[1] += t->counts.shadowed;
        total[2] += t->counts.nanoseconds;
    }
}
