// Whether a picture has time for another frame.
#pragma once

namespace easypbr::render {

/// How long a picture's frames took, in seconds.
struct FrameTimes {
    int frames = 0;
    double all = 0;
    double first = 0;

    void add(double seconds) {
        if (frames == 0) first = seconds;
        all += seconds;
        ++frames;
    }

    /// Whether another frame ends within a budget if it takes as long as the others did. The first one does
    /// not tell: geometry, tables and shaders are made ready in it. So the second is tried while there is
    /// time.
    bool has_time(double budget) const {
        if (frames < 2) return frames == 0 || all < budget;
        return all + (all - first) / (frames - 1) <= budget;
    }
};

}  // namespace easypbr::render
