// A program that is run for one answer, which it writes to memory that it shares with this process.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "easypbr/core/file.h"

namespace easypbr::io {

/// Memory that a child process fills. Move-only.
class SharedMemory {
  public:
    /// Throws FileError.
    SharedMemory();
    ~SharedMemory();
    SharedMemory(SharedMemory&& other) noexcept;
    SharedMemory& operator=(SharedMemory&&) = delete;

    int descriptor() const { return file_.get(); }

    /// What the child wrote; from now on nobody can change it. To be called once, when the child has ended.
    /// Throws FileError where somebody can, or where there is no room to map it.
    void seal();
    /// Empty before seal().
    std::span<const std::byte> bytes() const { return {data_, size_}; }

  private:
    Descriptor file_;
    const std::byte* data_ = nullptr;
    size_t size_ = 0;
};

/// How a child process ended.
struct ChildEnd {
    enum class How { exited, signalled, killed_late, unknown };
    How how;
    int code = 0;  ///< exit status, or number of the signal
};

/// Runs a program until it ends, or kills it `seconds` after its start or when this thread is interrupted. It
/// has `output` as its descriptor 3, none other of this process, and /dev/null as standard input and output;
/// it is in a session of its own, which no key of a terminal reaches. It gets the environment and the folder
/// of this process. Unknown: the program that the library runs in waits for all of its children itself.
/// Throws FileError when it cannot be started; Interrupted.
ChildEnd run_child(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                   const SharedMemory& output, double seconds);

}  // namespace easypbr::io
