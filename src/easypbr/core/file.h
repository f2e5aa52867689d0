// Files as bytes: reading that neither blocks nor ends in a signal, writing that never leaves half a file
// behind.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "easypbr/core/guarded_map.h"
#include "easypbr/core/image.h"

namespace easypbr {

namespace fs = std::filesystem;

/// Closes a file descriptor at the end of its life. Move-only.
class Descriptor {
  public:
    explicit Descriptor(int value = -1) : value_(value) {}
    ~Descriptor();
    Descriptor(Descriptor&& other) noexcept : value_(std::exchange(other.value_, -1)) {}
    Descriptor& operator=(Descriptor&& other) noexcept {
        std::swap(value_, other.value_);
        return *this;
    }

    int get() const { return value_; }

  private:
    int value_;
};

/// A regular file opened for reading. Every file that the library reads is opened here. Move-only.
class InputFile {
  public:
    /// Throws FileError when the file is missing, not readable, or no regular file: a folder, a pipe, a
    /// socket or a device, which could block for ever; or when it lies outside of the folder of the thread's
    /// FolderScope. Never blocks. An OpenedFilesScope notes it.
    explicit InputFile(fs::path path);
    /// Of a file that is open; `path` stands in messages. Throws FileError when it is no regular one.
    InputFile(Descriptor file, fs::path path);

    const fs::path& path() const { return path_; }
    int descriptor() const { return file_.get(); }
    /// Bytes that the file had when it was opened.
    size_t size() const { return size_t(state_.size); }
    /// As it was when it was opened.
    const FileState& state() const { return state_; }
    /// Reads the bytes [from, from + out.size()). Throws FileError when the file has become shorter or cannot
    /// be read. Thread-safe.
    void read(size_t from, std::span<std::byte> out) const;

  private:
    void look();

    fs::path path_;
    Descriptor file_;
    FileState state_;
};

/// A file's bytes: a copy, or where they are many a guarded map. Move-only.
class FileBytes {
  public:
    FileBytes() = default;
    /// Throws FileError as InputFile does.
    explicit FileBytes(const fs::path& path) : FileBytes(InputFile(path)) {}
    explicit FileBytes(InputFile file);
    /// All that comes from a descriptor until its end, be it a pipe or a file; `name` stands in messages.
    /// Throws FileError.
    FileBytes(int descriptor, std::string_view name);
    ~FileBytes();
    FileBytes(FileBytes&& other) noexcept;
    FileBytes& operator=(FileBytes&& other) noexcept;

    std::span<const std::byte> bytes() const { return {data_, size_}; }
    std::string_view text() const { return {reinterpret_cast<const char*>(data_), size_}; }
    size_t size() const { return size_; }

    /// To be called when the bytes have been used. Throws FileError when the file became shorter, or could
    /// not be read, meanwhile: bytes were zero then that are not in the file.
    void check() const;

    /// Tells the system that bytes [0, end) are not needed again soon, so that they do not count as used
    /// memory.
    void release_until(size_t end) const;

  private:
    void copy();
    void grow(std::string_view name);

    std::optional<InputFile> file_;
    GuardedMap map_;
    std::byte* own_ = nullptr;  ///< memory of a copy
    size_t capacity_ = 0;       ///< of own_
    const std::byte* data_ = nullptr;
    size_t size_ = 0;
};

/// Whether there is something at `path`. Nothing outside of the folder of the thread's FolderScope is looked
/// at, and nothing is there.
bool exists_in_scope(const fs::path& path);

/// Throws FileError unless the file can be opened for reading and is a regular one.
void check_readable(const fs::path& path);

/// Writes beside the target, then renames: a reader sees the old file or the whole new one, unless the file
/// can only be written into (FileSet). Throws FileError, among others where a device, a pipe or a socket is
/// there.
void write_file(const fs::path& path, std::span<const std::byte> bytes);
void write_file(const fs::path& path, std::string_view text);

/// Throws FileError unless a file could be written at `path`: its folder exists and takes files, or the file
/// is there and can be written into; it is no folder. Leaves nothing behind.
void check_writable(const fs::path& path);

/// Extension in lower case without the dot: "ply" for "Drone.PLY", empty when there is none.
std::string extension_of(const fs::path& path);

}  // namespace easypbr
