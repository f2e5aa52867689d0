#include <csignal>

#include "easypbr/cli/cli.h"

int main(int argc, char** argv) {
    // A file beyond the user's limit (ulimit -f) is a write that fails, as on a full disk.
    std::signal(SIGXFSZ, SIG_IGN);
    return easypbr::cli::run(argc, argv);
}
