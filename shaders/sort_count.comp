// How many keys of each block have each digit.
#include "common_sort.glsl"

shared uint found[256];

void main() {
    uint t = gl_LocalInvocationID.x;
    found[t] = 0u;
    barrier();
    uint first = gl_WorkGroupID.x * block_keys;
    for (uint i = first + t; i < min(first + block_keys, u_sorted); i += 256u) atomicAdd(found[digit_of(keys[i])], 1u);
    barrier();
    counts[t * u_blocks + gl_WorkGroupID.x] = found[t];
}
