// A program outside of the tree, the same as the Python one: usage: outside MESH ENVIRONMENT OUT.png
#include <easypbr/easypbr.h>

int main(int, char** argv) {
    using namespace easypbr;
    Viewer view;
    view.load_environment_map(argv[2]);
    Mesh drone(argv[1]);
    show(drone, "drone");
    view.recorder.record(argv[3]);
}
