// Turns the counts of a digit, one group each, into the sums of those of the blocks before.
#include "common_sort.glsl"

shared uint sums[256];

void main() {
    uint t = gl_LocalInvocationID.x, digit = gl_WorkGroupID.x, part = (u_blocks + 255u) / 256u;
    uint first = digit * u_blocks + min(t * part, u_blocks), end = digit * u_blocks + min((t + 1u) * part, u_blocks);
    uint sum = 0u;
    for (uint i = first; i < end; ++i) sum += counts[i];
    sums[t] = sum;
    barrier();
    for (uint step = 1u; step < 256u; step *= 2u) {
        uint before = t >= step ? sums[t - step] : 0u;
        barrier();
        sums[t] += before;
        barrier();
    }
    if (t == 255u) totals[digit] = sums[t];
    uint before = sums[t] - sum;
    for (uint i = first; i < end; ++i) {
        uint count = counts[i];
        counts[i] = before;
        before += count;
    }
}
