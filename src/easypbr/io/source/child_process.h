// Programs that are run in processes of their own, and memory in which they answer.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
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

/// "ended with status 1", "was ended by signal 9", "took too long".
std::string text_of(const ChildEnd& end);

/// What a child has as its first descriptors; it has none other of this process. Negative: /dev/null, and
/// nothing as its answer. None may be below `first_free`.
struct ChildStreams {
    static constexpr int first_free = 4;
    int input = -1;   ///< its descriptor 0
    int output = -1;  ///< 1
    int errors = -1;  ///< 2
    int answer = -1;  ///< 3
};

/// A program that runs. It ends with its object, and leaves no zombie. It is in a session of its own, which
/// no key of a terminal reaches, and gets the environment and the folder of this process.
class ChildProcess {
  public:
    /// Throws FileError when it cannot be started.
    ChildProcess(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                 const ChildStreams& streams);
    ~ChildProcess();
    ChildProcess(const ChildProcess&) = delete;

    /// Waits until it ends, or kills it after `seconds` or when this thread is interrupted. Unknown: the
    /// program that the library runs in waits for all of its children itself. Throws Interrupted.
    ChildEnd wait(double seconds);
    /// Waits until it ends, whatever happens.
    ChildEnd join();

  private:
    std::optional<ChildEnd> ask(int flags);
    void kill();

    int process_;
    bool ended_ = false;
};

/// Runs a program that writes to `output`, as its descriptor 3, until it ends as ChildProcess::wait() says.
/// Throws FileError when it cannot be started; Interrupted.
ChildEnd run_child(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                   const SharedMemory& output, double seconds);

}  // namespace easypbr::io
