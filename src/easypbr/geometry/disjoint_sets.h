// Sets of things that are joined step by step.
#pragma once

#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace easypbr::geometry {

/// Union by size with path halving.
class DisjointSets {
  public:
    explicit DisjointSets(size_t count) : parent_(count), size_(count, 1) {
        std::iota(parent_.begin(), parent_.end(), 0);
    }

    int32_t find(int32_t i) {
        while (parent_[size_t(i)] != i) {
            parent_[size_t(i)] = parent_[size_t(parent_[size_t(i)])];
            i = parent_[size_t(i)];
        }
        return i;
    }

    void unite(int32_t a, int32_t b) {
        a = find(a);
        b = find(b);
        if (a == b) return;
        if (size_[size_t(a)] < size_[size_t(b)]) std::swap(a, b);
        parent_[size_t(b)] = a;
        size_[size_t(a)] += size_[size_t(b)];
    }

  private:
    std::vector<int32_t> parent_, size_;
};

}  // namespace easypbr::geometry
