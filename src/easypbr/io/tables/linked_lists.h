// Lists whose elements move from one to another.
#pragma once

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace easypbr::io {

/// Lists of the elements 0, 1, 2, ...; each is in one of them at most. All it does takes constant time.
class LinkedLists {
  public:
    static constexpr uint32_t none = UINT32_MAX;

    LinkedLists(size_t elements, size_t lists)
        : elements_(elements), before_(elements + lists), after_(elements + lists) {
        std::iota(before_.begin(), before_.end(), 0u);
        after_ = before_;
    }

    /// none: the list is empty.
    uint32_t first(size_t list) const {
        const uint32_t element = after_[elements_ + list];
        return element < elements_ ? element : none;
    }

    /// Puts an element at the end of a list, wherever it was.
    void move(uint32_t element, size_t list) {
        remove(element);
        const uint32_t head = uint32_t(elements_ + list), last = before_[head];
        after_[last] = before_[head] = element;
        before_[element] = last;
        after_[element] = head;
    }

    /// Takes an element out of the list that it is in, if any.
    void remove(uint32_t element) {
        const uint32_t before = before_[element], after = after_[element];
        after_[before] = after;
        before_[after] = before;
        before_[element] = after_[element] = element;
    }

  private:
    size_t elements_;
    std::vector<uint32_t> before_, after_;  ///< rings of elements; a list's head comes behind all elements
};

}  // namespace easypbr::io
