#include "easypbr/io/source/child_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <optional>
#include <thread>
#include <utility>

#include "easypbr/core/error.h"
#include "easypbr/core/interrupt.h"

namespace easypbr::io {
namespace {

using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

[[noreturn]] void fail_memory(int error) {
    throw FileError(fmt::format("cannot share memory with a child process: {}", std::strerror(error)));
}

/// What happens in the child between its start and the program: posix_spawn() makes no copy of this process,
/// so that it is safe beside other threads, and quick whatever this process holds.
class SpawnPlan {
  public:
    explicit SpawnPlan(const ChildStreams& streams) {
        ::posix_spawn_file_actions_init(&files_);
        ::posix_spawnattr_init(&attributes_);
        give(streams.input, 0);
        give(streams.output, 1);
        give(streams.errors, 2);
        if (streams.answer >= 0) give(streams.answer, 3);
        check(::posix_spawn_file_actions_addclosefrom_np(&files_, streams.answer >= 0 ? 4 : 3));
        sigset_t none, all;
        sigemptyset(&none);
        sigfillset(&all);
        check(::posix_spawnattr_setsigmask(&attributes_, &none));
        check(::posix_spawnattr_setsigdefault(&attributes_, &all));
        check(::posix_spawnattr_setflags(
            &attributes_, POSIX_SPAWN_SETSID | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF));
    }
    ~SpawnPlan() {
        ::posix_spawn_file_actions_destroy(&files_);
        ::posix_spawnattr_destroy(&attributes_);
    }
    SpawnPlan(const SpawnPlan&) = delete;

    pid_t start(const fs::path& program, const std::vector<std::string>& arguments) const {
        std::vector<char*> texts{const_cast<char*>(program.c_str())};
        for (const std::string& argument : arguments) texts.push_back(const_cast<char*>(argument.c_str()));
        texts.push_back(nullptr);
        pid_t child = 0;
        const int error =
            ::posix_spawn(&child, program.c_str(), &files_, &attributes_, texts.data(), environ);
        if (error)
            throw FileError(fmt::format("cannot start {}: {}", program.string(), std::strerror(error)));
        return child;
    }

  private:
    void give(int own, int standard) {
        if (own < 0)
            check(::posix_spawn_file_actions_addopen(&files_, standard, "/dev/null", O_RDWR, 0));
        else
            check(::posix_spawn_file_actions_adddup2(&files_, own, standard));
    }

    static void check(int error) {
        if (error) throw FileError(fmt::format("cannot start a child process: {}", std::strerror(error)));
    }

    posix_spawn_file_actions_t files_;
    posix_spawnattr_t attributes_;
};

}  // namespace

SharedMemory::SharedMemory() {
    const Descriptor file{::memfd_create("easypbr", MFD_CLOEXEC | MFD_ALLOW_SEALING)};
    if (file.get() < 0) fail_memory(errno);
    // Beyond those that a child's standard streams and output take.
    file_ = Descriptor{::fcntl(file.get(), F_DUPFD_CLOEXEC, ChildStreams::first_free)};
    if (file_.get() < 0) fail_memory(errno);
}

SharedMemory::~SharedMemory() {
    if (data_) ::munmap(const_cast<std::byte*>(data_), size_);
}

SharedMemory::SharedMemory(SharedMemory&& other) noexcept
    : file_(std::move(other.file_)),
      data_(std::exchange(other.data_, nullptr)),
      size_(std::exchange(other.size_, 0)) {}

void SharedMemory::seal() {
    // Fails where a process that the child left behind can still write: what is checked must be what is used.
    constexpr int seals = F_SEAL_SEAL | F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_WRITE;
    struct stat info {};
    if (::fcntl(file_.get(), F_ADD_SEALS, seals) != 0 || ::fstat(file_.get(), &info) != 0) fail_memory(errno);
    if (info.st_size == 0) return;
    void* pages = ::mmap(nullptr, size_t(info.st_size), PROT_READ, MAP_SHARED, file_.get(), 0);
    if (pages == MAP_FAILED) fail_memory(errno);
    data_ = static_cast<const std::byte*>(pages);
    size_ = size_t(info.st_size);
}

std::string text_of(const ChildEnd& end) {
    switch (end.how) {
        case ChildEnd::How::exited:
            return fmt::format("ended with status {}", end.code);
        case ChildEnd::How::signalled:
            return fmt::format("was ended by signal {}", end.code);
        case ChildEnd::How::killed_late:
            return "took too long";
        case ChildEnd::How::unknown:
            break;
    }
    return "ended";
}

ChildProcess::ChildProcess(const fs::path& program, const std::vector<std::string>& arguments,
                           const ChildStreams& streams)
    : process_(SpawnPlan(streams).start(program, arguments)) {}

ChildProcess::~ChildProcess() {
    kill();
}

/// Asks again after 2 % of the time so far: what that adds to a long job cannot be felt, nor can what asking
/// costs.
ChildEnd ChildProcess::wait(double seconds) {
    using namespace std::chrono_literals;
    const auto start = Clock::now();
    for (;;) {
        if (const auto end = ask(WNOHANG)) return *end;
        check_interrupt();
        const auto elapsed = Clock::now() - start;
        if (Seconds(elapsed).count() > seconds) {
            kill();
            return {ChildEnd::How::killed_late};
        }
        std::this_thread::sleep_for(std::clamp<Clock::duration>(elapsed / 50, 100us, 20ms));
    }
}

ChildEnd ChildProcess::join() {
    return ask(0).value_or(ChildEnd{ChildEnd::How::unknown});
}

void ChildProcess::kill() {
    if (ended_) return;
    ::kill(process_, SIGKILL);
    ask(0);
}

/// Nothing while it runs.
std::optional<ChildEnd> ChildProcess::ask(int flags) {
    if (ended_) return ChildEnd{ChildEnd::How::unknown};
    int status = 0;
    pid_t process;
    do process = ::waitpid(process_, &status, flags);
    while (process < 0 && errno == EINTR);
    if (process == 0) return std::nullopt;
    ended_ = true;
    // A program may ignore SIGCHLD, or wait for children that are not its own.
    if (process < 0) return ChildEnd{ChildEnd::How::unknown};
    if (WIFSIGNALED(status)) return ChildEnd{ChildEnd::How::signalled, WTERMSIG(status)};
    return ChildEnd{ChildEnd::How::exited, WEXITSTATUS(status)};
}

ChildEnd run_child(const fs::path& program, const std::vector<std::string>& arguments,
                   const SharedMemory& output, double seconds) {
    ChildProcess child(program, arguments, {.answer = output.descriptor()});
    return child.wait(seconds);
}

}  // namespace easypbr::io
