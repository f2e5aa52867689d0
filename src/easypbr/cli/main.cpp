#include "easypbr/cli/cli.h"

int main(int argc, char** argv) {
    return easypbr::cli::run(argc, argv);
}
