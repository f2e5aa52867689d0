// A file mapped into memory, where what cannot be read any more is an error and not a signal.
#pragma once

#include <cstddef>
#include <utility>

namespace easypbr {

/// Bytes of a file that read as zero once the file has become shorter or a disk fails: plain mappings end the
/// process by SIGBUS then. Move-only.
class GuardedMap {
  public:
    GuardedMap() = default;
    /// Maps the first `size` bytes, read-only. Empty where the system has no room for it or too many files
    /// are mapped at once.
    GuardedMap(int descriptor, size_t size);
    ~GuardedMap();
    GuardedMap(GuardedMap&& other) noexcept { *this = std::move(other); }
    GuardedMap& operator=(GuardedMap&& other) noexcept {
        std::swap(slot_, other.slot_);
        return *this;
    }

    explicit operator bool() const { return slot_ >= 0; }
    const std::byte* data() const;
    /// Whether bytes have been read that are not the file's.
    bool is_broken() const;

  private:
    int slot_ = -1;
};

}  // namespace easypbr
