#include "easypbr/io/video/ffmpeg_program.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <mutex>
#include <sstream>
#include <utility>

#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "easypbr/core/log.h"
#include "easypbr/core/program.h"
#include "easypbr/io/source/child_process.h"
#include "easypbr/io/video/encoders.h"

namespace easypbr::io {
namespace {

using Arguments = std::vector<std::string>;

std::mutex finder_mutex;
std::function<fs::path()> finder;

/// What the program prints when it is asked about itself.
std::string answer_of(const fs::path& program, const Arguments& arguments) {
    constexpr double seconds = 30;
    SharedMemory output;
    ChildProcess child(program, arguments, {.output = output.descriptor(), .errors = output.descriptor()});
    const ChildEnd end = child.wait(seconds);
    output.seal();
    if (end.how == ChildEnd::How::signalled || end.how == ChildEnd::How::killed_late)
        throw FormatError(fmt::format("{} does not work: asked for {} it {}", program.string(),
                                      fmt::join(arguments, " "), text_of(end)));
    const auto bytes = output.bytes();
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// The last line that says something.
std::string last_line(std::span<const std::byte> bytes) {
    std::istringstream lines(std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
    std::string last;
    for (std::string line; std::getline(lines, line);)
        if (line.find_first_not_of(" \r\t") != std::string::npos) last = line;
    return last;
}

/// The first of the kinds of pictures that we can make which the encoder takes.
std::string pixel_format_of(const fs::path& program, const std::string& encoder) {
    constexpr const char* known[] = {"yuv420p", "yuvj420p", "yuv444p", "rgb24", "rgba", "bgr0", "rgb8"};
    constexpr std::string_view title = "Supported pixel formats:";
    const std::string about = answer_of(program, {"-hide_banner", "-h", "encoder=" + encoder});
    const size_t begin = about.find(title);
    if (begin == std::string::npos) return known[0];
    std::istringstream line(
        about.substr(begin + title.size(), about.find('\n', begin) - begin - title.size()));
    Arguments taken;
    for (std::string name; line >> name;) taken.push_back(name);
    for (const char* name : known)
        if (std::ranges::count(taken, name)) return name;
    throw ArgumentError(
        fmt::format("the encoder {} takes none of the kinds of pictures that can be made for it", encoder));
}

void add_to(Arguments& arguments, std::initializer_list<std::string> more) {
    arguments.insert(arguments.end(), more);
}

/// Colours of BT.709, and tags that say so.
void add_colors(Arguments& arguments, const std::string& pixels) {
    const bool is_yuv = pixels.starts_with("yuv");
    const std::string range = pixels == "yuvj420p" ? "pc" : "tv";
    if (is_yuv)
        add_to(
            arguments,
            {"-vf",
             fmt::format("scale=in_range=pc:out_range={0}:out_color_matrix=bt709:flags=bicubic+accurate_rnd+"
                         "full_chroma_inp,format={1},setparams=range={0}:color_primaries=bt709:"
                         "color_trc=bt709:colorspace=bt709",
                         range, pixels),
             "-color_range", range, "-color_primaries", "bt709", "-color_trc", "bt709", "-colorspace",
             "bt709"});
    add_to(arguments, {"-pix_fmt", pixels});
}

/// 256 colours for each picture, and an ordered dither, which stays in place from one frame to the next.
void add_palette(Arguments& arguments) {
    add_to(arguments, {"-filter_complex",
                       "split[a][b];[a]palettegen=stats_mode=single:reserve_transparent=0[p];"
                       "[b][p]paletteuse=new=1:dither=bayer:bayer_scale=4"});
}

void add_encoder(Arguments& arguments, const std::string& encoder, double fps) {
    add_to(arguments,
           {"-c:v", encoder, "-g", fmt::format("{}", std::max(1, int(std::lround(fps)))), "-bf", "0"});
    const auto options = encoder_options(encoder);
    for (const auto& [name, value] : options) add_to(arguments, {fmt::format("-{}:v", name), value});
    if (options.empty()) add_to(arguments, {"-q:v", fmt::format("{}", fixed_quantiser)});
}

/// What the program is told: pictures of this size come through its standard input. `path`: absolute.
Arguments arguments_for(const fs::path& path, const Vec2i& size, double fps, const std::string& encoder,
                        const std::string& pixels) {
    Arguments arguments{"-hide_banner", "-loglevel", "error",    "-nostats",
                        "-f",           "rawvideo",  "-pix_fmt", "rgb0"};
    add_to(arguments, {"-video_size", fmt::format("{}x{}", size.x(), size.y()), "-framerate",
                       fmt::format("{}", fps), "-i", "pipe:0", "-an"});
    if (encoder == "gif") {
        add_palette(arguments);
        add_to(arguments, {"-c:v", encoder});
    } else {
        add_colors(arguments, pixels);
        add_encoder(arguments, encoder, fps);
    }
    const std::string container = container_of(path).name;
    if (container == "mp4" || container == "mov") add_to(arguments, {"-movflags", "+faststart"});
    add_to(arguments, {"-f", container, "-y", "file:" + path.string()});
    return arguments;
}

/// Two ends of a connection. Unlike a pipe it can be written to without a signal when nobody reads.
std::pair<Descriptor, Descriptor> connection() {
    int ends[2];
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
        throw FileError(fmt::format("cannot connect a child process: {}", std::strerror(errno)));
    Descriptor ours{ends[0]}, low{ends[1]};
    Descriptor theirs{::fcntl(low.get(), F_DUPFD_CLOEXEC, ChildStreams::first_free)};
    if (theirs.get() < 0)
        throw FileError(fmt::format("cannot connect a child process: {}", std::strerror(errno)));
    return {std::move(ours), std::move(theirs)};
}

class ProgramVideo final : public VideoWriter {
  public:
    ProgramVideo(const fs::path& program, VideoFile file, const VideoOptions& options)
        : file_(std::move(file)), path_(file_.name()), size_(options.size), padded_(options.size) {
        check_video_options(path_, options);
        const std::string encoder = choose_encoder(path_, options.codec, encoders_of_program(program));
        const std::string pixels = encoder == "gif" ? "" : pixel_format_of(program, encoder);
        // Planes of half the size need an even one.
        if (pixels == "yuv420p" || pixels == "yuvj420p") padded_ += Vec2i(size_.x() & 1, size_.y() & 1);
        auto [ours, theirs] = connection();
        feed_ = std::move(ours);
        child_.emplace(program, arguments_for(file_.path(), padded_, options.fps, encoder, pixels),
                       ChildStreams{.input = theirs.get(), .errors = errors_.descriptor()});
    }

    ~ProgramVideo() override {
        try {
            finish();
        } catch (const Error& error) {
            log_warning(error.what());
        }
    }

    void add(const Image& picture) override {
        check_video_picture(path_, size_, picture);
        is_empty_ = false;
        whole_or_none([&] {
            for (int y = 0; y < padded_.y(); ++y)
                send_row(picture.at<uint8_t>(0, std::min(y, size_.y() - 1)));
        });
    }

    void finish() override {
        if (finished_) return;
        finished_ = true;
        if (is_empty_) return remove();
        whole_or_none([&] {
            require_end();
            file_.keep();
        });
    }

  private:
    /// A video that cannot be written to its end is removed: nothing tells half of one from a whole one.
    template <class Write>
    void whole_or_none(Write&& write) {
        try {
            write();
        } catch (...) {
            finished_ = true;
            remove();
            throw;
        }
    }

    void remove() {
        child_.reset();
        file_.remove();
    }

    /// The last pixel is sent twice where the sides are padded.
    void send_row(const uint8_t* row) {
        const size_t bytes = 4 * size_t(size_.x());
        send_all(row, bytes);
        if (padded_.x() > size_.x()) send_all(row + bytes - 4, 4);
    }

    void send_all(const uint8_t* bytes, size_t size) {
        while (size > 0) {
            const ssize_t sent = ::send(feed_.get(), bytes, size, MSG_NOSIGNAL);
            if (sent < 0 && errno == EINTR) continue;
            if (sent < 0) require_end(), fail("it did not take all pictures");
            bytes += sent;
            size -= size_t(sent);
        }
    }

    void require_end() {
        feed_ = Descriptor{};
        const ChildEnd end = child_->join();
        if (end.how == ChildEnd::How::exited && end.code == 0) return;
        errors_.seal();
        const std::string said = last_line(errors_.bytes());
        if (end.how == ChildEnd::How::unknown && said.empty()) return;
        fail(said.empty() ? fmt::format("ffmpeg {}", text_of(end)) : said);
    }

    [[noreturn]] void fail(const std::string& reason) const {
        throw FileError(fmt::format("cannot write {}: {}", path_.string(), reason));
    }

    VideoFile file_;
    fs::path path_;  ///< the file's name in messages
    Vec2i size_, padded_;
    SharedMemory errors_;
    Descriptor feed_;
    std::optional<ChildProcess> child_;
    bool is_empty_ = true, finished_ = false;
};

}  // namespace

void set_ffmpeg_finder(std::function<fs::path()> find) {
    const std::scoped_lock lock(finder_mutex);
    finder = std::move(find);
}

fs::path ffmpeg_program() {
    if (const auto program = program_in_path("ffmpeg")) return *program;
    std::unique_lock lock(finder_mutex);
    const std::function<fs::path()> find = finder;
    lock.unlock();
    return find ? find() : fs::path();
}

std::vector<std::string> encoders_of_program(const fs::path& program) {
    std::istringstream lines(answer_of(program, {"-hide_banner", "-encoders"}));
    std::vector<std::string> names;
    // Below a legend and a line of dashes: flags, of which V stands for pictures, and a name.
    bool below = false;
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line);
        std::string flags, name;
        words >> flags >> name;
        if (below && flags.starts_with('V')) names.push_back(name);
        below = below || flags.starts_with("---");
    }
    if (names.empty())
        throw FormatError(fmt::format("{} does not work: it lists no encoders", program.string()));
    std::ranges::sort(names);
    return names;
}

std::unique_ptr<VideoWriter> open_video_by_program(const fs::path& program, VideoFile file,
                                                   const VideoOptions& options) {
    return std::make_unique<ProgramVideo>(program, std::move(file), options);
}

}  // namespace easypbr::io
