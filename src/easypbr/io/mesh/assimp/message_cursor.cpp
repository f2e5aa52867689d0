#include "easypbr/io/mesh/assimp/message_cursor.h"

#include <fmt/format.h>

#include "easypbr/core/error.h"

namespace easypbr::io {

std::span<const std::byte> MessageCursor::take_bytes(uint64_t size) {
    if (size > message_.size() - at_) fail("it ends too early");
    const auto bytes = message_.subspan(at_, size_t(size));
    at_ += size_t(size);
    return bytes;
}

std::string MessageCursor::take_text() {
    const auto bytes = take_bytes(take_count(1, 1));
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

size_t MessageCursor::take_count(size_t bytes_each, size_t memory_each) {
    const auto count = take<uint64_t>();
    if (count > (message_.size() - at_) / bytes_each) fail("a count is larger than what follows");
    if (count > budget_ / memory_each) fail("it needs more memory than the limit");
    budget_ -= count * memory_each;
    return size_t(count);
}

void MessageCursor::fail(const char* what) const {
    throw FormatError(fmt::format("the answer of the assimp reader is damaged at byte {}: {}", at_, what));
}

}  // namespace easypbr::io
