// Random numbers that are the same on every machine.
#pragma once

#include <cstdint>

namespace easypbr::geometry {

/// Numbers by their place: which thread asks for them, and when, makes no difference. SplitMix64 (Steele, Lea
/// and Flood 2014, Fast Splittable Pseudorandom Number Generators).
class RandomNumbers {
  public:
    explicit RandomNumbers(uint64_t seed) : seed_(mixed(seed + step)) {}

    /// Uniform in [0, 1), multiples of 2^-53.
    double uniform(uint64_t place) const { return double(mixed(seed_ + (place + 1) * step) >> 11) * 0x1p-53; }

  private:
    static constexpr uint64_t step = 0x9e3779b97f4a7c15;

    static uint64_t mixed(uint64_t z) {
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
        z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
        return z ^ (z >> 31);
    }

    uint64_t seed_;
};

}  // namespace easypbr::geometry
