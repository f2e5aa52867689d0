#include "easypbr/app/recording_target.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <system_error>
#include <vector>

#include "easypbr/core/ascii.h"
#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "easypbr/core/log.h"
#include "easypbr/core/parallel.h"
#include "easypbr/io/image/image_codecs.h"
#include "easypbr/io/image/image_io.h"
#include "easypbr/io/video/video.h"
#include "easypbr/scene/settings.h"

namespace easypbr::app {
namespace {

/// The "%04d" of a name: where it is, and how many digits at least.
struct Number {
    size_t begin, end;
    int digits;
};

std::optional<Number> number_in(const std::string& name) {
    const size_t begin = name.find('%');
    if (begin == name.npos) return {};
    size_t end = begin + 1;
    while (end < name.size() && ascii::is_digit(name[end])) ++end;
    const std::string digits = name.substr(begin + 1, end - begin - 1);
    if (end == name.size() || name[end] != 'd' || digits.size() > 3 || name.find('%', end) != name.npos)
        return {};
    return Number{begin, end + 1, digits.empty() ? 1 : std::stoi(digits)};
}

bool is_folder(const fs::path& path) {
    std::error_code unreadable;  // The check before writing reports it.
    return !path.has_filename() || fs::is_directory(path, unreadable) || extension_of(path).empty();
}

/// The path with a number in its name.
fs::path numbered(const fs::path& path) {
    return is_folder(path) && !number_in(path.filename().string()) ? path / "frame_%05d.png" : path;
}

bool is_there(const fs::path& path) {
    std::error_code unreadable;  // The check before writing reports it.
    return fs::exists(path, unreadable);
}

bool holds_recording(const fs::path& path) {
    return is_there(io::is_video(path) ? path : frame_path(path, 0));
}

/// "NAME_2.EXTENSION" of a file, "NAME_2" of a folder.
fs::path counted(const fs::path& path, int count) {
    if (!path.has_filename()) return counted(path.parent_path(), count) / "";
    return path.parent_path() /
           fmt::format("{}_{}{}", path.stem().string(), count, path.extension().string());
}

fs::path free_path(const fs::path& path, bool (*is_taken)(const fs::path&)) {
    fs::path found = path;
    for (int count = 2; is_taken(found); ++count) found = counted(path, count);
    return found;
}

/// The names that recordings may have, for messages.
std::string known_kinds() {
    return fmt::format("a video ({}) or numbered pictures ({}), for example out/frame_%04d.png",
                       fmt::join(io::video_extensions(), ", "),
                       fmt::join(io::writable_image_extensions(), ", "));
}

/// The number that frame_path() wrote into a file's name; nothing for other names.
std::optional<int> number_of(const std::string& name, const fs::path& pattern) {
    const std::string own = pattern.filename().string();
    const std::optional<Number> number = number_in(own);
    const size_t after = number ? own.size() - number->end : 0;
    if (!number || name.size() <= number->begin + after) return {};
    const char* const end = name.data() + name.size() - after;
    int index = 0;
    const auto read = std::from_chars(name.data() + number->begin, end, index);
    const bool is_number = read.ec == std::errc() && read.ptr == end && index >= 0;
    if (!is_number || frame_path(pattern, index).filename() != name) return {};
    return index;
}

/// Pictures of an earlier, longer recording stay: they may be someone's. A program that reads the pictures by
/// their numbers would show both.
void warn_of_older_frames(const fs::path& pattern, int count) {
    std::vector<int> older;
    std::error_code unreadable;
    const fs::path folder = pattern.has_parent_path() ? pattern.parent_path() : fs::path(".");
    for (fs::directory_iterator entry(folder, unreadable), end; !unreadable && entry != end;
         entry.increment(unreadable)) {
        const std::optional<int> index = number_of(entry->path().filename().string(), pattern);
        if (index && *index >= count) older.push_back(*index);
    }
    if (older.empty()) return;
    const auto [first, last] = std::ranges::minmax(older);
    const std::string which = first == last ? frame_path(pattern, first).string()
                                            : fmt::format("{} to {}", frame_path(pattern, first).string(),
                                                          frame_path(pattern, last).string());
    log_warning(
        fmt::format("{}: {} older picture{} left behind the {} of this recording ({}): programs that "
                    "read numbered pictures take them as well",
                    pattern.string(), older.size(), older.size() == 1 ? " is" : "s are", count, which));
}

/// Files appear in order, so that a recording that is killed has no gaps.
class PictureFrames final : public FrameWriter {
  public:
    /// `made`: the folder was made for them.
    PictureFrames(fs::path path, bool made) : path_(std::move(path)), made_(made) {}
    void write(int index, const Image& picture) override {
        const Turn turn{*this, index};
        const fs::path path = frame_path(path_, index);
        const std::vector<std::byte> bytes = io::encode_image(picture, path);
        turn.wait();
        write_file(path, bytes);
    }
    void finish() override {
        std::error_code ignored;
        // A folder that something else was put into stays.
        if (made_ && next_ == 0) fs::remove(path_.parent_path(), ignored);
        if (next_ > 0) warn_of_older_frames(path_, next_);
    }
    int threads() const override { return std::clamp(thread_count(), 1, 8); }

  private:
    /// That of a picture to be written; the next one's comes when it ends, by a failure too.
    struct Turn {
        ~Turn() {
            std::unique_lock lock(frames.mutex_);
            frames.changed_.wait(lock, [this] { return frames.next_ == index; });
            ++frames.next_;
            frames.changed_.notify_all();
        }
        void wait() const {
            std::unique_lock lock(frames.mutex_);
            frames.changed_.wait(lock, [this] { return frames.next_ == index; });
        }

        PictureFrames& frames;
        int index;
    };

    fs::path path_;
    bool made_;
    std::mutex mutex_;
    std::condition_variable changed_;
    int next_ = 0;
};

class VideoFrames final : public FrameWriter {
  public:
    explicit VideoFrames(std::unique_ptr<io::VideoWriter> video) : video_(std::move(video)) {}
    void write(int, const Image& picture) override { video_->add(picture); }
    void finish() override { video_->finish(); }

  private:
    std::unique_ptr<io::VideoWriter> video_;
};

/// The folder of numbered pictures, which may be made.
void check_folder(const fs::path& pattern) {
    const fs::path folder = pattern.parent_path();
    std::error_code unreadable;  // The check reports it.
    if (folder.empty() || fs::is_directory(folder, unreadable))
        check_writable(frame_path(pattern, 0));
    else
        check_writable(fs::path(folder.string()).lexically_normal());
}

}  // namespace

bool is_recording_name(const fs::path& path) {
    const bool names_folder = path.has_relative_path() && is_folder(path);
    return io::is_video(path) || number_in(path.filename().string()) || names_folder;
}

fs::path frame_path(const fs::path& path, int index) {
    const fs::path pattern = numbered(path);
    const std::string name = pattern.filename().string();
    const std::optional<Number> number = number_in(name);
    if (!number)
        throw ArgumentError(
            fmt::format("cannot record to {}: one picture cannot hold many frames; expected {}",
                        path.string(), known_kinds()));
    return pattern.parent_path() / fmt::format("{}{:0{}d}{}", name.substr(0, number->begin), index,
                                               number->digits, name.substr(number->end));
}

fs::path free_picture(const fs::path& path) {
    // What cannot be written to is reported when the picture is written.
    return path.has_relative_path() ? free_path(path, is_there) : path;
}

fs::path free_recording(const fs::path& path) {
    // What cannot be recorded to is reported when the recording begins.
    return is_recording_name(path) ? free_path(path, holds_recording) : path;
}

Encoding encoding_for_recording(const fs::path& path, bool deep) {
    return io::is_video(path) ? Encoding::srgb8 : encoding_for(frame_path(path, 0), deep);
}

void check_recording_name(const fs::path& path) {
    if (io::is_video(path)) return;
    const std::string extension = extension_of(numbered(path));
    if (std::ranges::count(io::writable_image_extensions(), extension) == 0)
        throw ArgumentError(fmt::format("cannot record to {}: unknown extension '{}'; expected {}",
                                        path.string(), extension, known_kinds()));
    frame_path(path, 0);
}

void check_recording(const fs::path& path, const Settings& settings, const RecordingOptions& options) {
    if (!(options.rate() > 0) || !std::isfinite(options.rate()))
        throw ArgumentError(fmt::format("cannot record {}: expected above 0 frames per second, got {}",
                                        path.string(), options.rate()));
    const bool transparent = settings.background.mode == BackgroundMode::transparent;
    if (io::is_video(path)) {
        if (transparent)
            throw ArgumentError(
                fmt::format("cannot record {}: videos have no transparency; record PNG or EXR pictures "
                            "(out/frame_%04d.png), or choose another background",
                            path.string()));
        if (options.deep)
            throw ArgumentError(
                fmt::format("cannot record {}: 16 bits per channel need PNG pictures", path.string()));
        io::check_video(path, options.codec);
        return check_writable(path);
    }
    check_recording_name(path);
    encoding_for_recording(path, options.deep);
    if (!options.codec.empty())
        throw ArgumentError(
            fmt::format("cannot record {}: pictures have no codec, got '{}'", path.string(), options.codec));
    if (transparent) check_holds_alpha(path);
    check_picture_fits(frame_path(path, 0), options.size.value_or(settings.image.size));
    check_folder(numbered(path));
}

std::unique_ptr<FrameWriter> make_frame_writer(const fs::path& path, const Vec2i& size,
                                               const RecordingOptions& options) {
    if (io::is_video(path))
        return std::make_unique<VideoFrames>(io::open_video(path, {size, options.rate(), options.codec}));
    const fs::path pattern = numbered(path);
    std::error_code failed;
    const fs::path folder = pattern.parent_path();
    const bool made = !folder.empty() && fs::create_directory(folder, failed);
    if (failed)
        throw FileError(fmt::format("cannot make the folder {}: {}", folder.string(), failed.message()));
    return std::make_unique<PictureFrames>(pattern, made);
}

}  // namespace easypbr::app
