// A limit on the memory that reading takes: files say how much they hold, and may lie.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace easypbr {

/// Bytes that a reading may take when nobody says: three quarters of what is available on the machine, in the
/// process's control groups and under its limit of address space.
uint64_t automatic_memory_limit();

/// What this thread reads while the object lives takes no more than a limit, all together. A scope without a
/// limit of its own inside of another one counts there.
class MemoryScope {
  public:
    /// `name` of what is read stands in messages. `limit` in bytes; 0: automatic_memory_limit(), or the outer
    /// scope's.
    explicit MemoryScope(std::string name, uint64_t limit = 0);
    ~MemoryScope();
    MemoryScope(const MemoryScope&) = delete;
    MemoryScope& operator=(const MemoryScope&) = delete;

  private:
    friend void charge_memory(uint64_t bytes, std::string_view what);
    std::string name_;
    uint64_t left_;
    uint64_t limit_;
    MemoryScope* outer_;
    bool shares_;  ///< counts in the outer one
};

/// Readers call it before they allocate `bytes` for `what` ("the pixels of a.png"), in the thread of the
/// scope. Without a scope what is asked for counts alone. Throws FormatError beyond the limit.
void charge_memory(uint64_t bytes, std::string_view what);

}  // namespace easypbr
