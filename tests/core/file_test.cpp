#include "easypbr/core/file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <random>
#include <string>
#include <thread>

#include "easypbr/core/error.h"
#include "easypbr/core/parallel.h"
#include "easypbr/core/suggest.h"

namespace easypbr::file_test {

namespace {

/// A new folder for every test, gone afterwards.
class FileTest : public testing::Test {
  protected:
    FileTest() {
        std::string name = (fs::temp_directory_path() / "easypbr_core_XXXXXX").string();
        folder_ = mkdtemp(name.data());
    }
    ~FileTest() override { fs::remove_all(folder_); }

    size_t file_count() const { return size_t(std::distance(fs::directory_iterator(folder_), {})); }

    fs::path folder_;
};

using File = FileTest;

std::string random_text(size_t size) {
    std::string text(size, ' ');
    std::minstd_rand generator(1);
    for (char& c : text) c = char(generator());
    return text;
}

/// Of the FileError that is thrown.
std::string message_of(const std::function<void()>& act) {
    try {
        act();
    } catch (const FileError& error) {
        return error.what();
    }
    return "no FileError";
}

}  // namespace

TEST_F(File, ReplacesTheWholeFile) {
    write_file(folder_ / "a.txt", std::string_view("a long first content"));
    // The bytes are those of the replaced file.
    const FileBytes before(folder_ / "a.txt");
    write_file(folder_ / "a.txt", std::string_view("short"));
    EXPECT_EQ(before.text(), "a long first content");
    EXPECT_EQ(FileBytes(folder_ / "a.txt").text(), "short");
    EXPECT_EQ(file_count(), 1u);
}

TEST_F(File, LeavesTheOldFileWhenWritingFails) {
    fs::create_directory(folder_ / "taken");
    write_file(folder_ / "taken" / "inside", std::string_view("x"));
    EXPECT_THROW(write_file(folder_ / "taken", std::string_view("y")), FileError);
    EXPECT_THROW(write_file(folder_ / "missing" / "a.txt", std::string_view("y")), FileError);
    EXPECT_EQ(FileBytes(folder_ / "taken" / "inside").text(), "x");
    EXPECT_EQ(file_count(), 1u);
}

TEST_F(File, NeverTakesThePlaceOfASpecialFile) {
    const fs::path pipe = folder_ / "pipe", link = folder_ / "link";
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0666), 0);
    fs::create_symlink(pipe, link);
    for (const fs::path& path : {pipe, link}) {
        EXPECT_NE(message_of([&] { write_file(path, "text"); }).find("a pipe"), std::string::npos);
        EXPECT_THROW(check_writable(path), FileError);
        EXPECT_TRUE(fs::is_fifo(path));
    }
    EXPECT_EQ(file_count(), 2u);
}

TEST_F(File, TellsBeforehandWhetherItCanWrite) {
    EXPECT_NO_THROW(check_writable(folder_ / "new.png"));
    EXPECT_THROW(check_writable(folder_), FileError);
    EXPECT_THROW(check_writable(folder_ / "missing" / "a.png"), FileError);
    EXPECT_EQ(file_count(), 0u);
}

TEST_F(File, OpensOnlyRegularFilesAndNeverBlocks) {
    write_file(folder_ / "empty", std::string_view());
    EXPECT_EQ(FileBytes(folder_ / "empty").size(), 0u);
    // Nobody writes into the pipe: who opens it as a file waits for ever.
    ASSERT_EQ(mkfifo((folder_ / "pipe").c_str(), 0600), 0);
    const int socket = ::socket(AF_UNIX, SOCK_STREAM, 0);
    sockaddr_un address{AF_UNIX, {}};
    (folder_ / "socket").string().copy(address.sun_path, sizeof address.sun_path - 1);
    ASSERT_EQ(::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    const std::map<fs::path, std::string> expected{{folder_, "it is a folder"},
                                                   {folder_ / "pipe", "it is a pipe"},
                                                   {folder_ / "socket", "it is a socket"},
                                                   {"/dev/zero", "it is a device"},
                                                   {folder_ / "missing", "No such file"}};
    for (const auto& [path, message] : expected) {
        EXPECT_EQ(message_of([&] { FileBytes{path}; }).find("cannot read " + path.string() + ": " + message),
                  0u)
            << message_of([&] { FileBytes{path}; });
        EXPECT_THROW(check_readable(path), FileError);
    }
    EXPECT_NO_THROW(check_readable(folder_ / "empty"));
    ::close(socket);
}

TEST_F(File, TruncatedIsAnErrorAndNoSignal) {
    // What is small is copied.
    const std::string few = random_text(100'000);
    write_file(folder_ / "small", few);
    const FileBytes small(folder_ / "small");
    InputFile opened(folder_ / "small");
    fs::resize_file(folder_ / "small", 50'000);
    EXPECT_TRUE(small.text() == few);
    EXPECT_NO_THROW(small.check());
    const std::string message = message_of([&] { FileBytes{std::move(opened)}; });
    EXPECT_NE(message.find("it had 100000 bytes, now it ends at byte 50000"), std::string::npos) << message;

    // What is large is mapped: bytes that are gone are zero.
    const std::string many = random_text(10'000'000);
    write_file(folder_ / "large", many);
    const FileBytes whole(folder_ / "large"), other(folder_ / "large");
    EXPECT_TRUE(whole.text() == many);
    fs::resize_file(folder_ / "large", 5'000'000);
    EXPECT_TRUE(whole.text().substr(0, 5'000'000) == std::string_view(many).substr(0, 5'000'000));
    EXPECT_NO_THROW(whole.check());
    EXPECT_EQ(whole.text().substr(6'000'000), std::string(4'000'000, '\0'));
    EXPECT_NE(message_of([&] { whole.check(); }).find("truncated"), std::string::npos);
    // The place is free for others.
    EXPECT_NO_THROW(other.check());
}

TEST_F(File, MayBeMappedManyTimes) {
    const std::string text = random_text(2'000'000);
    write_file(folder_ / "a", text);
    std::vector<FileBytes> files(300);
    for (FileBytes& file : files) file = FileBytes(folder_ / "a");
    EXPECT_TRUE(std::ranges::all_of(files, [&](const FileBytes& file) { return file.text() == text; }));
}

TEST_F(File, GivesMemoryBack) {
    const std::string text = random_text(10'000'000);
    write_file(folder_ / "a", text);
    const FileBytes file(folder_ / "a");
    file.release_until(7'000'000);
    EXPECT_TRUE(file.text() == text);
}

// The guard is not in the way of signals that have nothing to do with it.
TEST_F(File, LeavesOtherBusErrorsAlone) {
    write_file(folder_ / "a", random_text(2'000'000));
    const FileBytes file(folder_ / "a");
    EXPECT_EXIT(::raise(SIGBUS), testing::KilledBySignal(SIGBUS), "");
}

struct sigaction found_action;

void say(std::string_view text) {
    static_cast<void>(!::write(STDERR_FILENO, text.data(), text.size()));
}

/// As Python's faulthandler: it says something, puts back what it found and raises the signal again.
void tell_and_give_up(int signal) {
    say("gave up.");
    ::sigaction(signal, &found_action, nullptr);
    ::raise(signal);
}

/// As Python's faulthandler once it has been disabled.
void tell_and_return(int) {
    say("told.");
}

/// Makes it what SIGBUS does, and puts back what it did before.
class Handler {
  public:
    explicit Handler(void (*handler)(int)) {
        struct sigaction action {};
        action.sa_handler = handler;
        action.sa_flags = SA_NODEFER;
        ::sigaction(SIGBUS, &action, &found_action);
    }
    ~Handler() { ::sigaction(SIGBUS, &found_action, nullptr); }
    Handler(const Handler&) = delete;
    Handler& operator=(const Handler&) = delete;
};

/// Reads what a file mapped by the test itself has lost: a fault that no guard mends.
void read_what_is_gone(const fs::path& path) {
    const Descriptor file(::open(path.c_str(), O_RDWR));
    const auto* bytes =
        static_cast<const volatile char*>(::mmap(nullptr, 8192, PROT_READ, MAP_SHARED, file.get(), 0));
    fs::resize_file(path, 0);
    static_cast<void>(bytes[5000]);
}

// A program may enable its own handler after the first large file.
TEST_F(File, TruncatedIsNoSignalBehindALaterHandler) {
    const std::string text = random_text(2'000'000);
    write_file(folder_ / "first", text);
    const FileBytes first(folder_ / "first");
    const Handler handler(tell_and_give_up);
    for (const char* name : {"second", "third"}) {
        write_file(folder_ / name, text);
        const FileBytes file(folder_ / name);
        fs::resize_file(folder_ / name, 1'000'000);
        EXPECT_EQ(file.text().substr(1'100'000), std::string(900'000, '\0'));
        EXPECT_THROW(file.check(), FileError);
    }
}

// Each handler is called once, the newest first, and the process ends as without the guard.
TEST_F(File, LeavesOtherBusErrorsToALaterHandler) {
    write_file(folder_ / "a", random_text(2'000'000));
    write_file(folder_ / "gone", random_text(8192));
    const FileBytes first(folder_ / "a");
    const Handler handler(tell_and_give_up);
    const FileBytes second(folder_ / "a");
    EXPECT_EXIT(::raise(SIGBUS), testing::KilledBySignal(SIGBUS), "^gave up\\.$");
    EXPECT_EXIT(read_what_is_gone(folder_ / "gone"), testing::KilledBySignal(SIGBUS), "^gave up\\.$");
}

// One that returns has dealt with a signal that was sent. From a fault that it has not mended it would return
// for ever.
TEST_F(File, ABusErrorThatNobodyMendsEndsTheProcess) {
    write_file(folder_ / "a", random_text(2'000'000));
    write_file(folder_ / "gone", random_text(8192));
    const FileBytes first(folder_ / "a");
    const Handler handler(tell_and_return);
    const FileBytes second(folder_ / "a");
    const auto send_and_read = [&] {
        ::raise(SIGBUS);
        ::raise(SIGBUS);
        read_what_is_gone(folder_ / "gone");
    };
    // Other tests' handler may still be known.
    EXPECT_EXIT(send_and_read(), testing::KilledBySignal(SIGBUS), "^(told\\.){3}(gave up\\.)?$");
}

TEST_F(File, ReadsAPipeToItsEnd) {
    const std::string text = random_text(10'000'000);
    int ends[2];
    ASSERT_EQ(::pipe2(ends, O_NONBLOCK), 0);
    std::thread writer([&, file = Descriptor(ends[1])] {
        ::fcntl(file.get(), F_SETFL, 0);
        for (size_t at = 0; at < text.size();) {
            const ssize_t count =
                ::write(file.get(), text.data() + at, std::min<size_t>(77'777, text.size() - at));
            if (count > 0) at += size_t(count);
        }
    });
    const FileBytes bytes(ends[0], "pipe");
    writer.join();
    EXPECT_TRUE(bytes.text() == text);
    // There is no file to read them from again.
    bytes.release_until(bytes.size());
    EXPECT_TRUE(bytes.text() == text);
    ::close(ends[0]);
    EXPECT_THROW(FileBytes(ends[0], "pipe"), FileError);
}

TEST_F(File, KnowsExtensions) {
    EXPECT_EQ(extension_of("a/b.c/Drone.PLY"), "ply");
    EXPECT_EQ(extension_of("a/b.c/drone"), "");
}

TEST(Suggest, FindsTheNearestName) {
    const std::vector<std::string> names = {"roughness", "metallic", "size"};
    EXPECT_EQ(did_you_mean("rougness", names), " (did you mean 'roughness'?)");
    EXPECT_EQ(nearest("metalic", names), "metallic");
    EXPECT_EQ(did_you_mean("banana", names), "");
    EXPECT_EQ(did_you_mean("size", {}), "");
}

TEST(Parallel, VisitsEveryIndexOnceInFixedChunks) {
    std::vector<int> visits(100001);
    parallel_chunks(visits.size(), 1000, [&](size_t begin, size_t end) {
        EXPECT_EQ(begin % 1000, 0u);
        EXPECT_EQ(end, std::min(begin + 1000, visits.size()));
        for (size_t i = begin; i < end; ++i) ++visits[i];
    });
    EXPECT_EQ(std::count(visits.begin(), visits.end(), 1), std::ptrdiff_t(visits.size()));
    EXPECT_THROW(parallel_for(100000, 10,
                              [](size_t i) {
                                  if (i == 77777) throw ArgumentError("passed on");
                              }),
                 ArgumentError);
}

}  // namespace easypbr::file_test
