#include <fcntl.h>

#include <cerrno>
#include <csignal>
#include <initializer_list>

#include "easypbr/cli/cli.h"

namespace {

/// No file that is opened later may become standard input, output or errors. What takes the place of a closed
/// one can be used as little: that is still an error.
void fill_closed_streams() {
    for (const int stream : {0, 1, 2})
        if (::fcntl(stream, F_GETFD) < 0 && errno == EBADF)
            if (::open("/dev/null", stream == 0 ? O_WRONLY : O_RDONLY) != stream) return;
}

}  // namespace

int main(int argc, char** argv) {
    fill_closed_streams();
    // A file beyond the user's limit (ulimit -f) is a write that fails, as on a full disk.
    std::signal(SIGXFSZ, SIG_IGN);
    return easypbr::cli::run(argc, argv);
}
