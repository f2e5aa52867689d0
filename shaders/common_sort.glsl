// A sort by 8 bits of the keys at a time, from the lowest on (Knuth, "The Art of Computer Programming", 5.2.5). Groups
// of 256 take blocks of 2048 keys; counts are kept digit by digit, and of a digit block by block.
layout(local_size_x = 256) in;

layout(std430, binding = 0) buffer Keys { uint keys[]; };
layout(std430, binding = 1) buffer Values { uint values[]; };
layout(std430, binding = 2) buffer SortedKeys { uint sorted_keys[]; };
layout(std430, binding = 3) buffer SortedValues { uint sorted_values[]; };
layout(std430, binding = 4) buffer Counts { uint counts[]; };
layout(std430, binding = 5) buffer Totals { uint totals[]; };  // of the digits

uniform uint u_sorted;  // keys
uniform uint u_shift;   // of the digit
uniform uint u_blocks;

const uint block_keys = 2048u;

uint digit_of(uint key) { return (key >> u_shift) & 255u; }
