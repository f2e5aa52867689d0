// Moves the keys of a block, and what goes with them, to their places by this digit; of equal digits the order stays.
#include "common_sort.glsl"

shared uint next[256];      // place of the next key of a digit
shared uint masks[256][8];  // threads whose key has the digit

void main() {
    uint t = gl_LocalInvocationID.x;
    next[t] = totals[t];
    barrier();
    for (uint step = 1u; step < 256u; step *= 2u) {
        uint before = t >= step ? next[t - step] : 0u;
        barrier();
        next[t] += before;
        barrier();
    }
    uint start = next[t] - totals[t] + counts[t * u_blocks + gl_WorkGroupID.x];
    barrier();
    next[t] = start;
    for (uint round = 0u; round < block_keys / 256u; ++round) {
        for (uint word = 0u; word < 8u; ++word) masks[t][word] = 0u;
        barrier();
        uint i = gl_WorkGroupID.x * block_keys + round * 256u + t;
        bool is_one = i < u_sorted;
        uint key = is_one ? keys[i] : 0u, digit = digit_of(key);
        if (is_one) atomicOr(masks[digit][t / 32u], 1u << (t % 32u));
        barrier();
        if (is_one) {
            uint to = next[digit] + uint(bitCount(masks[digit][t / 32u] & ((1u << (t % 32u)) - 1u)));
            for (uint word = 0u; word < t / 32u; ++word) to += uint(bitCount(masks[digit][word]));
            sorted_keys[to] = key;
            sorted_values[to] = values[i];
        }
        barrier();
        for (uint word = 0u; word < 8u; ++word) next[t] += uint(bitCount(masks[t][word]));
        barrier();
    }
}
