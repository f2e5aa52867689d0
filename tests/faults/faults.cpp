#include "faults/faults.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <sys/uio.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>

extern "C" {
void* __libc_malloc(size_t size);
void* __libc_calloc(size_t count, size_t size);
void* __libc_realloc(void* old, size_t size);
void* __libc_memalign(size_t alignment, size_t size);
}

namespace easypbr::faults {
namespace {

/// Bytes that short reads and writes take: more than the head of any file, so that none is taken for another.
constexpr size_t few = 61;

std::atomic<Kind> current{Kind::none};
std::atomic<long> count{0}, wanted{0};
std::atomic<bool> has_happened{false};
char job_name[256] = "";

/// Whether this call is the one that fails.
bool strikes(Kind kind) {
    if (current.load(std::memory_order_relaxed) != kind) return false;
    const long number = ++count;
    const long n = wanted;
    const bool goes_on = kind == Kind::write || kind == Kind::thread;
    if (n == 0 || (goes_on ? number < n : number != n)) return false;
    has_happened = true;
    return true;
}

bool has_no_memory(size_t size) {
    constexpr size_t large = 8192;
    return strikes(Kind::allocation) || (size >= large && strikes(Kind::large_allocation));
}

bool is_interrupted() {
    if (current != Kind::interruptions) return false;
    if (++count % 2 == 0) return false;
    has_happened = true;
    errno = EINTR;
    return true;
}

size_t shortened(size_t size) {
    if (current != Kind::short_reads || size <= few) return size;
    ++count;
    has_happened = true;
    return few;
}

/// What the program would call without this file.
template <class Function>
Function* real(const char* name) {
    return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

void fail_with(int code) {
    errno = code;
}

/// Says which fault a crash came by, then lets it happen.
void tell(int signal_number) {
    char text[400];
    const int length = std::snprintf(text, sizeof text, "signal %d: %s, fault kind %d, call %ld\n",
                                     signal_number, job_name, int(current.load()), wanted.load());
    if (length > 0 && ::write(2, text, size_t(length)) < 0) std::_Exit(3);
    ::signal(signal_number, SIG_DFL);
    ::raise(signal_number);
}

}  // namespace

Fault::Fault(Kind kind, long n) {
    for (const int number : {SIGSEGV, SIGABRT, SIGFPE}) ::signal(number, tell);
    count = 0;
    has_happened = false;
    wanted = n;
    current = kind;
}

Fault::~Fault() {
    current = Kind::none;
}

long Fault::calls() {
    return count;
}

bool Fault::happened() {
    return has_happened;
}

void Fault::name(const std::string& job) {
    std::snprintf(job_name, sizeof job_name, "%s", job.c_str());
}

}  // namespace easypbr::faults

using namespace easypbr::faults;

extern "C" {

void* malloc(size_t size) {
    if (has_no_memory(size)) return fail_with(ENOMEM), nullptr;
    return __libc_malloc(size);
}

void* calloc(size_t count, size_t size) {
    if (has_no_memory(count * size)) return fail_with(ENOMEM), nullptr;
    return __libc_calloc(count, size);
}

void* realloc(void* old, size_t size) {
    if (size > 0 && has_no_memory(size)) return fail_with(ENOMEM), nullptr;
    return __libc_realloc(old, size);
}

void* aligned_alloc(size_t alignment, size_t size) {
    if (has_no_memory(size)) return fail_with(ENOMEM), nullptr;
    return __libc_memalign(alignment, size);
}

int posix_memalign(void** out, size_t alignment, size_t size) {
    if (has_no_memory(size)) return ENOMEM;
    *out = __libc_memalign(alignment, size);
    return *out ? 0 : ENOMEM;
}

ssize_t read(int file, void* out, size_t size) {
    static auto* const next = real<ssize_t(int, void*, size_t)>("read");
    if (is_interrupted()) return -1;
    if (strikes(Kind::read)) return fail_with(EIO), -1;
    return next(file, out, shortened(size));
}

ssize_t pread64(int file, void* out, size_t size, off64_t from) {
    static auto* const next = real<ssize_t(int, void*, size_t, off64_t)>("pread64");
    if (is_interrupted()) return -1;
    if (strikes(Kind::read)) return fail_with(EIO), -1;
    return next(file, out, shortened(size), from);
}

ssize_t pread(int file, void* out, size_t size, off_t from) {
    return pread64(file, out, size, from);
}

ssize_t write(int file, const void* bytes, size_t size) {
    static auto* const next = real<ssize_t(int, const void*, size_t)>("write");
    if (file <= 2) return next(file, bytes, size);
    if (is_interrupted()) return -1;
    if (strikes(Kind::write)) {
        // What still fits; then nothing does.
        if (count == wanted && size > 1) return next(file, bytes, size / 2);
        return fail_with(ENOSPC), -1;
    }
    return next(file, bytes, shortened(size));
}

ssize_t writev(int file, const iovec* parts, int number) {
    static auto* const next = real<ssize_t(int, const iovec*, int)>("writev");
    if (file <= 2) return next(file, parts, number);
    if (is_interrupted()) return -1;
    if (strikes(Kind::write)) return fail_with(ENOSPC), -1;
    return current == Kind::short_reads ? write(file, parts->iov_base, parts->iov_len)
                                        : next(file, parts, number);
}

int open64(const char* path, int flags, ...) {
    static auto* const next = real<int(const char*, int, ...)>("open64");
    va_list more;
    va_start(more, flags);
    const mode_t mode = flags & (O_CREAT | O_TMPFILE) ? va_arg(more, mode_t) : 0;
    va_end(more);
    if (is_interrupted()) return -1;
    if (strikes(Kind::open)) return fail_with(EACCES), -1;
    return next(path, flags, mode);
}

int open(const char* path, int flags, ...) {
    va_list more;
    va_start(more, flags);
    const mode_t mode = flags & (O_CREAT | O_TMPFILE) ? va_arg(more, mode_t) : 0;
    va_end(more);
    return open64(path, flags, mode);
}

int rename(const char* from, const char* to) {
    static auto* const next = real<int(const char*, const char*)>("rename");
    if (strikes(Kind::rename)) return fail_with(EACCES), -1;
    return next(from, to);
}

int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*body)(void*),
                   void* argument) noexcept {
    static auto* const next =
        real<int(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*)>("pthread_create");
    return strikes(Kind::thread) ? EAGAIN : next(thread, attributes, body, argument);
}

int clock_gettime(clockid_t clock, timespec* out) {
    static auto* const next = real<int(clockid_t, timespec*)>("clock_gettime");
    const int done = next(clock, out);
    if (current == Kind::clock && clock == CLOCK_REALTIME) {
        // Three years ahead, then three years back.
        constexpr time_t years = 3 * 365 * 24 * 3600;
        out->tv_sec += ++count % 2 ? years : -years;
        has_happened = true;
    }
    return done;
}

}  // extern "C"
