// A place in a message of the assimp reader. Nothing of a message is believed: who sent it may be under the
// control of the file that it read.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>

namespace easypbr::io {

/// Takes values off a message. Everything throws FormatError where the message ends before.
class MessageCursor {
  public:
    /// `budget`: bytes of memory that what is made of the message may take.
    MessageCursor(std::span<const std::byte> message, uint64_t budget) : message_(message), budget_(budget) {}

    template <class T>
    T take() {
        static_assert(std::is_trivially_copyable_v<T>);
        T value;
        std::memcpy(&value, take_bytes(sizeof(T)).data(), sizeof(T));
        return value;
    }

    std::span<const std::byte> take_bytes(uint64_t size);
    std::string take_text();
    /// The number of things that follow, each of at least `bytes_each` bytes of the message (above 0), and
    /// made into `memory_each` bytes. Throws FormatError when the message cannot hold so many, or the budget.
    size_t take_count(size_t bytes_each, size_t memory_each);

    bool at_end() const { return at_ == message_.size(); }
    /// Throws FormatError that says where.
    [[noreturn]] void fail(const char* what) const;

  private:
    std::span<const std::byte> message_;
    size_t at_ = 0;
    uint64_t budget_;
};

}  // namespace easypbr::io
