#include "easypbr/io/mesh/assimp/reader/message_writer.h"

#include <unistd.h>

#include <cerrno>

namespace easypbr::io {

MessageWriter::MessageWriter(int descriptor) : descriptor_(descriptor), buffer_(1 << 18) {
    if (::ftruncate(descriptor_, 0) != 0 || ::lseek(descriptor_, 0, SEEK_SET) != 0) ::_exit(reader_misused);
    MessageHeader none;
    none.magic = 0;
    put(none);
}

void MessageWriter::put_text(std::string_view text) {
    put_count(text.size());
    put_bytes(text.data(), text.size());
}

void MessageWriter::put_bytes(const void* bytes, size_t size) {
    flush();
    write(static_cast<const char*>(bytes), size);
}

void MessageWriter::finish(MessageKind kind) {
    flush();
    MessageHeader header;
    header.kind = kind;
    header.size = written_;
    if (::pwrite(descriptor_, &header, sizeof(header), 0) != ssize_t(sizeof(header)))
        ::_exit(reader_out_of_memory);
}

void MessageWriter::flush() {
    write(buffer_.data(), used_);
    used_ = 0;
}

void MessageWriter::write(const char* bytes, size_t size) {
    while (size > 0) {
        const ssize_t count = ::write(descriptor_, bytes, size);
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) ::_exit(reader_out_of_memory);
        bytes += count, size -= size_t(count), written_ += uint64_t(count);
    }
}

}  // namespace easypbr::io
