#include "easypbr/remote/orbit_page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "easypbr/app/kept_camera.h"
#include "easypbr/app/orbit_grid.h"
#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "easypbr/core/log.h"
#include "easypbr/core/markup.h"
#include "easypbr/core/step_progress.h"
#include "easypbr/io/image/image_codecs.h"
#include "easypbr/io/source/base64.h"
#include "easypbr/remote/page.h"
#include "easypbr/scene/scene.h"
#include "easypbr/scene/settings.h"

namespace easypbr::remote {
namespace {

/// What a picture takes at least, however small: limits below that are mistakes.
constexpr double least_picture_bytes = 200;
/// Before the size of the pictures goes down.
constexpr int least_quality = 40;
constexpr int least_side = 16;
/// Of the document without pictures, about.
constexpr double page_bytes = 10000;
/// Before the first picture: "data:image/...;base64,".
constexpr size_t most_prefix = 32;

/// The document with its places, {{title}} and so on, filled once.
std::string filled(std::string_view document, const std::map<std::string_view, std::string>& places) {
    std::string out;
    for (;;) {
        const size_t open = document.find("{{"), close = document.find("}}", open);
        if (close == std::string_view::npos) return out.append(document);
        const auto place = places.find(document.substr(open + 2, close - open - 2));
        // Braces of the script stand for themselves.
        const size_t kept = place == places.end() ? open + 1 : open;
        out.append(document.substr(0, kept));
        if (place != places.end()) out += place->second;
        document.remove_prefix(place == places.end() ? kept : close + 2);
    }
}

std::vector<std::byte> encoded(const Image& image, const app::OrbitPageOptions& options, int quality) {
    return options.format == "jpeg" ? io::encode_jpeg(image, quality) : io::encode_webp(image, quality);
}

/// Bytes of base 64 text for so many of a file.
size_t text_bytes(size_t bytes) {
    return (bytes + 2) / 3 * 4;
}

/// The picture at the best quality that takes at most `budget` bytes of text; the least one where none does.
std::vector<std::byte> encoded_within(const Image& image, const app::OrbitPageOptions& options,
                                      double budget) {
    const auto fits = [&](const std::vector<std::byte>& bytes) {
        return double(text_bytes(bytes.size())) <= budget;
    };
    std::vector<std::byte> best = encoded(image, options, options.quality);
    if (fits(best)) return best;
    int low = 1, high = options.quality;
    best = encoded(image, options, low);
    while (high - low > 1) {
        const int middle = (low + high) / 2;
        std::vector<std::byte> bytes = encoded(image, options, middle);
        if (!fits(bytes)) {
            high = middle;
            continue;
        }
        low = middle;
        best = std::move(bytes);
    }
    return best;
}

class OrbitPage {
  public:
    OrbitPage(app::Session& session, const fs::path& path, const app::OrbitPageOptions& options)
        : session_(session),
          path_(path),
          options_(options),
          size_(options.size.value_or(session.settings().image.size)),
          grid_(app::orbit_grid(session, options.columns, options.rows, options.row_step_deg, size_)) {
        if (options_.title.empty())
            options_.title = fmt::format("{}", fmt::join(session.scene().names(), ", "));
        if (options_.title.empty()) options_.title = path.stem().string();
        options_.title = valid_utf8(options_.title);
        const size_t rest = document(std::vector<std::string>(grid_.cameras.size())).size();
        left_ = options.most_megabytes * 1e6 - double(rest + most_prefix);
    }

    void write() {
        const app::KeptCamera kept(session_);
        std::vector<std::string> pictures(grid_.cameras.size());
        StepProgress progress(path_.filename().string(), "picture", int(pictures.size()), 0.2);
        // What is inferred follows from the picture that is shown first.
        const size_t start = start_index();
        pictures[start] = first_picture();
        for (size_t i = 0, done = 1; i < pictures.size(); ++i) {
            if (i == start) continue;
            progress.done(int(done));
            const size_t others = pictures.size() - done++;
            pictures[i] = picture(drawn(i), left_ / double(others));
        }
        write_file(path_, document(std::move(pictures)));
    }

  private:
    size_t start_index() const { return size_t(grid_.start_row) * size_t(grid_.columns); }

    Image drawn(size_t index) {
        session_.set_camera(grid_.cameras[index]);
        session_.forget_motion();
        return session_.render({size_, options_.samples});
    }

    /// Throws ArgumentError when it takes more than is left.
    std::string picture(const Image& image, double budget) {
        std::string text = io::base64_encoded(encoded_within(image, options_, budget));
        left_ -= double(text.size());
        if (left_ < 0) fail("the pictures do not fit into it");
        return text;
    }

    /// Finds the size at which pictures have a quality that can be looked at.
    std::string first_picture() {
        const double budget = left_ / double(grid_.cameras.size());
        const Vec2i wanted = size_;
        app::OrbitPageOptions least = options_;
        least.quality = std::min(options_.quality, least_quality);
        for (;;) {
            const Image image = drawn(start_index());
            const double bytes = double(text_bytes(encoded(image, least, least.quality).size()));
            if (bytes <= budget) {
                if (size_ != wanted) warn_of_size();
                return picture(image, budget);
            }
            const double scale = std::min(0.9, 0.95 * std::sqrt(budget / bytes));
            size_ = (size_.cast<double>() * scale).array().round().cast<int>();
            if (size_.minCoeff() < least_side) fail("the pictures do not fit into it");
        }
    }

    void warn_of_size() const {
        log_warning(fmt::format("{}: its pictures are {}x{}, so that the file stays within {} MB",
                                path_.string(), size_.x(), size_.y(), options_.most_megabytes));
    }

    [[noreturn]] void fail(std::string_view why) const {
        throw ArgumentError(fmt::format("cannot write {} with at most {} MB: {}", path_.string(),
                                        options_.most_megabytes, why));
    }

    std::string document(std::vector<std::string> pictures) const {
        const std::string type = "image/" + options_.format;
        const std::string start = std::exchange(pictures[start_index()], {});
        const nlohmann::json orbit = {{"columns", grid_.columns},
                                      {"rows", grid_.elevations_deg},
                                      {"start", grid_.start_row},
                                      {"width", size_.x()},
                                      {"height", size_.y()},
                                      {"type", type},
                                      {"pictures", std::move(pictures)}};
        return filled(offline_document("orbit.html"),
                      {{"title", markup_escaped(options_.title)},
                       {"width", std::to_string(size_.x())},
                       {"height", std::to_string(size_.y())},
                       {"start", start.empty() ? "" : fmt::format("data:{};base64,{}", type, start)},
                       {"orbit", orbit.dump()}});
    }

    app::Session& session_;
    fs::path path_;
    app::OrbitPageOptions options_;
    Vec2i size_;
    app::OrbitGrid grid_;
    double left_ = 0;  ///< bytes of the file
};

void check_size(const Vec2i& size) {
    if (size.minCoeff() < 1 || size.maxCoeff() > max_image_side)
        throw ArgumentError(fmt::format("picture size {}x{}: expected width and height from 1 to {}",
                                        size.x(), size.y(), max_image_side));
}

}  // namespace

void check_orbit_options(const app::OrbitPageOptions& options) {
    app::check_orbit_grid(options.columns, options.rows, options.row_step_deg);
    if (options.format != "webp" && options.format != "jpeg")
        throw ArgumentError(
            fmt::format("orbit page: expected pictures as webp or jpeg, got '{}'", options.format));
    if (options.quality < 1 || options.quality > 100)
        throw ArgumentError(
            fmt::format("orbit page: expected a quality of 1 to 100, got {}", options.quality));
    const double least = (options.columns * options.rows * least_picture_bytes + page_bytes) / 1e6;
    if (!(options.most_megabytes >= least))
        throw ArgumentError(fmt::format("orbit page: {} pictures need {} MB at least, got a limit of {}",
                                        options.columns * options.rows, least, options.most_megabytes));
}

void check_orbit_page(const fs::path& path, const Settings& settings, const app::OrbitPageOptions& options) {
    check_orbit_options(options);
    check_size(options.size.value_or(settings.image.size));
    if (settings.background.mode == BackgroundMode::transparent && options.format == "jpeg")
        throw ArgumentError(fmt::format(
            "cannot write {}: JPEG has no transparency; take webp, or another background", path.string()));
    check_writable(path);
}

fs::path save_orbit_page(app::Session& session, const fs::path& path, const app::OrbitPageOptions& options) {
    check_orbit_page(path, session.settings(), options);
    OrbitPage(session, path, options).write();
    return path;
}

}  // namespace easypbr::remote
