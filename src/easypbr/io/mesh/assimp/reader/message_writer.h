// Writing of a message, through a buffer.
#pragma once

#include <cstring>
#include <string_view>
#include <type_traits>
#include <vector>

#include "easypbr/io/mesh/assimp/message.h"

namespace easypbr::io {

/// Writes one message to a file of its own. Where there is no room the process ends (reader_out_of_memory).
class MessageWriter {
  public:
    /// Empties the file.
    explicit MessageWriter(int descriptor);

    template <class T>
    void put(const T& value) {
        static_assert(std::is_trivially_copyable_v<T>);
        if (buffer_.size() - used_ < sizeof(T)) flush();
        std::memcpy(buffer_.data() + used_, &value, sizeof(T));
        used_ += sizeof(T);
    }
    void put_count(uint64_t count) { put(count); }
    void put_text(std::string_view text);
    void put_bytes(const void* bytes, size_t size);

    /// Completes the message.
    void finish(MessageKind kind);

  private:
    void flush();
    void write(const char* bytes, size_t size);

    int descriptor_;
    std::vector<char> buffer_;
    size_t used_ = 0;
    uint64_t written_ = 0;
};

}  // namespace easypbr::io
