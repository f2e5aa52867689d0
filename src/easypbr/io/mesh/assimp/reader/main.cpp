// easypbr_read_assimp: reads one file by assimp, within limits, and writes the scene to descriptor 3. Started
// by libeasypbr alone: a file that makes assimp crash or loop ends this process and no other.
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <exception>
#include <new>

#include "easypbr/io/mesh/assimp/reader/scene_writer.h"

namespace {

using namespace easypbr::io;

void limit(__rlimit_resource_t resource, unsigned long value) {
    rlimit now{};
    if (::getrlimit(resource, &now) != 0) ::_exit(reader_misused);
    if (now.rlim_max != RLIM_INFINITY && now.rlim_max < value) value = now.rlim_max;
    const rlimit wanted{value, value};
    if (::setrlimit(resource, &wanted) != 0) ::_exit(reader_misused);
}

/// Nothing of this process outlives the parent, and no crash is dumped.
void tie_to(pid_t parent) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != parent) ::_exit(reader_misused);
    ::prctl(PR_SET_DUMPABLE, 0);
    limit(RLIMIT_CORE, 0);
}

void answer(const char* path, MessageWriter& out) {
    if (path) {
        write_scene(path, out);
        out.finish(MessageKind::scene);
    } else {
        write_extensions(out);
        out.finish(MessageKind::extensions);
    }
}

}  // namespace

/// Arguments: process of the parent, seconds of CPU time, bytes of memory, path; without a path it lists the
/// extensions.
int main(int count, char** arguments) {
    if (count < 4) return reader_misused;
    tie_to(pid_t(std::strtol(arguments[1], nullptr, 10)));
    limit(RLIMIT_CPU, std::strtoul(arguments[2], nullptr, 10));
    const unsigned long bytes = std::strtoul(arguments[3], nullptr, 10);
    limit(RLIMIT_AS, bytes);
    limit(RLIMIT_FSIZE, bytes);
    // assimp would make any other error of it.
    std::set_new_handler([] { ::_exit(reader_out_of_memory); });
    try {
        MessageWriter out(message_descriptor);
        answer(count > 4 ? arguments[4] : nullptr, out);
    } catch (const std::exception& error) {
        MessageWriter out(message_descriptor);
        out.put_text(error.what());
        out.finish(MessageKind::error);
    }
    ::_exit(reader_done);
}
