#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <future>
#include <span>

#include "easypbr/app/kept_camera.h"
#include "easypbr/app/output.h"
#include "easypbr/app/recorded_content.h"
#include "easypbr/app/recorder.h"
#include "easypbr/app/recording_target.h"
#include "easypbr/app/scene_files.h"
#include "easypbr/app/session.h"
#include "easypbr/cli/command.h"
#include "easypbr/cli/console.h"
#include "easypbr/cli/drawable.h"
#include "easypbr/cli/file_animation.h"
#include "easypbr/cli/object_styles.h"
#include "easypbr/cli/open_file.h"
#include "easypbr/cli/render_options.h"
#include "easypbr/cli/stage_times.h"
#include "easypbr/cli/standard_output.h"
#include "easypbr/cli/terminal_image.h"
#include "easypbr/cli/truth_layers.h"
#include "easypbr/cli/user_config.h"
#include "easypbr/cli/written_paths.h"
#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "easypbr/drawing/line_drawing.h"
#include "easypbr/io/image/image_io.h"
#include "easypbr/io/mesh/mesh_io.h"
#include "easypbr/io/settings/camera_path_io.h"
#include "easypbr/io/settings/label_map_io.h"
#include "easypbr/io/video/video.h"
#include "easypbr/scene/resolve.h"
#include "easypbr/scene/setting_files.h"
#include "easypbr/scene/settings.h"

namespace easypbr::cli {
namespace {

/// One picture to make.
struct Picture {
    std::vector<std::string> files, names;
    std::string output, save_settings;
};

/// What every picture of a batch starts from.
struct Look {
    Settings settings;
    std::map<std::string, Light> lights;
};

std::string with_name(std::string pattern, const std::string& name) {
    const std::string place = "{name}";
    for (size_t at = 0; (at = pattern.find(place, at)) != pattern.npos; at += name.size())
        pattern.replace(at, place.size(), name);
    return pattern;
}

std::vector<Picture> pictures_of(const RenderOptions& options) {
    const std::vector<std::string> names = unique_names(options.files);
    if (!options.batch) return {{options.files, names, options.output, options.save_settings}};
    std::vector<Picture> pictures;
    for (size_t i = 0; i < names.size(); ++i)
        pictures.push_back({{options.files[i]},
                            {names[i]},
                            with_name(options.output, names[i]),
                            with_name(options.save_settings, names[i])});
    return pictures;
}

/// Of a picture of these files: the user's defaults, a preset, a settings file, options, each before the
/// next.
Look look_of(const RenderOptions& options, const std::vector<std::string>& files) {
    app::Session session;
    apply_user_config(files, session.settings());
    apply(options.start, session);
    apply(options, session.settings());
    Look look{session.settings(), {}};
    for (const std::string& name : session.scene().light_names())
        look.lights[name] = session.scene().light(name);
    return look;
}

app::RecordingOptions recording_of(const RenderOptions& options) {
    app::RecordingOptions recording;
    recording.fps = options.fps.value_or(recording.rate());
    recording.codec = options.codec;
    recording.deep = options.bit_depth == 16;
    return recording;
}

std::vector<NamedPath> written_for(const std::vector<Picture>& pictures, const RenderOptions& options) {
    std::vector<NamedPath> paths;
    for (const Picture& picture : pictures) {
        const bool is_file = !picture.output.empty() && picture.output != "-";
        // Of numbered pictures the first.
        const bool is_numbered =
            options.records() && !io::is_video(picture.output) && app::is_recording_name(picture.output);
        if (is_file)
            paths.push_back(
                {"-o", is_numbered ? app::frame_path(picture.output, 0) : fs::path(picture.output)});
        for (const std::string& layer : options.layers)
            paths.push_back({"--layers", truth_path(picture.output, layer)});
        if (!picture.save_settings.empty()) paths.push_back({"--save-settings", picture.save_settings});
    }
    return paths;
}

std::vector<NamedPath> read_for(const RenderOptions& options, const Settings& settings) {
    // Not those of --settings: they are read as a whole, and may be saved again with what was changed.
    std::vector<NamedPath> paths = {{"--preset", options.start.preset},
                                    {"--camera-pose", options.camera_pose},
                                    {"--camera-path", options.camera_path},
                                    {"--label-map", options.label_map}};
    for (const std::string& file : options.files)
        if (file != standard_input) paths.push_back({"FILE", file});
    for (const std::string& pass : options.passes)
        paths.push_back({"--pass", pass.substr(pass.find('=') + 1)});
    for_each_file(settings, [&](const std::string& file) { paths.push_back({"a setting", file}); });
    std::erase_if(paths, [](const NamedPath& named) { return named.path.empty(); });
    return paths;
}

/// Throws FileError, ArgumentError before anything is loaded or drawn.
void check_files(const Picture& picture, const Settings& settings, const RenderOptions& options) {
    if (options.records())
        app::check_recording(picture.output, settings, recording_of(options));
    else if (options.is_page())
        remote::check_orbit_page(picture.output, settings, page_options_of(options));
    else if (options.is_line_drawing())
        drawing::check_line_drawing(picture.output);
    else if (picture.output != "-" && !picture.output.empty())
        app::check_picture(picture.output, settings);
    if (const auto pixel = parse_focus(options.focus))
        of_options([&] { app::check_focus(*pixel, settings.image.size); });
    for (const std::string& layer : options.layers) check_writable(truth_path(picture.output, layer));
    if (!picture.save_settings.empty()) check_writable(picture.save_settings);
    for (const std::string& file : picture.files)
        if (file != standard_input) check_readable(file);
    for_each_file(settings, [](const std::string& file) {
        if (!file.empty()) check_readable(file);
    });
}

std::vector<io::LoadedScene> load_all(const std::vector<std::string>& files, const io::LoadOptions& options) {
    std::vector<io::LoadedScene> loaded;
    for (const std::string& file : files) loaded.push_back(load_drawable(file, options));
    return loaded;
}

class RenderJob {
  public:
    RenderJob(const RenderOptions& options, const Terminal& terminal)
        : options_(options),
          terminal_(terminal),
          look_(look_of(options, options.files)),
          opener_(options.open ? opening_program() : ""),
          styles_(parse_styles(options.styles, unique_names(options.files))),
          label_map_(options.label_map.empty() ? nullptr : io::find_label_map(options.label_map)) {
        add_passes(options.passes, session_);
        if (!options.camera_path.empty()) camera_path_ = io::load_camera_path(options.camera_path);
        if (options.output.empty()) {
            Vec2i& size = look_.settings.image.size;
            size = fitted_to(terminal_, size);
        }
    }

    int run() {
        const std::vector<Picture> pictures = pictures_of(options_);
        check_paths("render", written_for(pictures, options_), read_for(options_, look_.settings));
        if (!options_.batch) {
            check_files(pictures.front(), look_.settings, options_);
            make(pictures.front());
            return 0;
        }
        int code = 0;
        for (const Picture& picture : pictures) code = std::max(code, try_to_make(picture));
        return code;
    }

  private:
    /// One file that cannot be drawn must not keep the others from it.
    int try_to_make(const Picture& picture) {
        try {
            look_ = look_of(options_, picture.files);
            check_files(picture, look_.settings, options_);
            make(picture);
            return 0;
        } catch (const Error& error) {
            print_error(error.what());
            return 1;
        }
    }

    void make(const Picture& picture) {
        StageTimes times;
        start_look();
        load(picture, times);
        if (const auto pixel = parse_focus(options_.focus)) session_.focus_at(pixel->x(), pixel->y());
        if (options_.records() || options_.is_page() || options_.is_line_drawing()) {
            if (options_.is_page())
                remote::save_orbit_page(session_, picture.output, page_options_of(options_));
            else if (options_.is_line_drawing())
                drawing::save_line_drawing(session_, picture.output, line_drawing_options_of(options_));
            else
                record(picture);
            times.lap("record");
            save_settings(picture);
        } else {
            draw(picture, times);
        }
        open(picture);
        if (options_.timing) print_note("timing: " + times.summary());
    }

    void draw(const Picture& picture, StageTimes& times) {
        begin_motion();
        const Image image = session_.render({std::nullopt, std::nullopt, encoding_of(picture)});
        times.add("context", session_.timing().context);
        times.add("images", session_.timing().images);
        times.add("draw", session_.timing().draw);
        times.add("read", session_.timing().read);
        times.restart();
        write(picture, image);
        times.lap("write");
    }

    void open(const Picture& picture) const {
        if (!opener_.empty()) open_with(opener_, picture.output);
    }

    void record(const Picture& picture) {
        const app::RecordingOptions recording = recording_of(options_);
        app::Clock clock;
        app::Recorder recorder(session_, clock);
        if (animation_) return record_animation(picture, recorder, recording);
        const CameraPath path = camera_path_ ? *camera_path_ : app::turntable(session_, turn_s(recording));
        recorder.record_path(path, picture.output, recording, options_.turntable);
    }

    /// From --animation-time on. The camera and the ground are inferred for all of its frames; without a
    /// path, the camera is the one of the file that the animation moves, or rests.
    void record_animation(const Picture& picture, app::Recorder& recorder,
                          const app::RecordingOptions& recording) {
        const std::vector<double> times = frame_times(recording.rate());
        const auto put = [this](double time_s) { animate(time_s); };
        // After its duration it goes around.
        const double seen_s = std::min(times.back(), animation_->duration_s());
        const SceneSnapshot seen = app::content_until(session_.scene(), seen_s, put);
        std::optional<CameraPath> path = camera_path_;
        if (options_.turntable) path = app::turntable(session_, turn_s(recording), seen);
        const ResolvedSettings rest = app::resolve_for(session_, seen, session_.settings().image.size);
        const app::RestingGround ground(session_, rest, times, put);
        const app::KeptCamera kept(session_);
        session_.set_camera(rest.camera);
        animate_frame_before();
        if (path) {
            const auto play = [&](int frame, int, double) { animate_next(times[size_t(frame)]); };
            recorder.record_path(*path, picture.output, recording, options_.turntable, play);
        } else {
            const auto camera = [&](double time_s) {
                return animation_->camera(time_of(time_s)).value_or(rest.camera);
            };
            const auto play = [&](int, int, double time_s) { animate_next(time_s); };
            recorder.record_frames(times, -frame_s(), camera, picture.output, recording, play);
        }
    }

    double turn_s(const app::RecordingOptions& recording) const {
        return options_.turntable.value_or(1) / recording.rate();
    }

    /// Of a recording of the animation, in seconds from its first frame on.
    std::vector<double> frame_times(double fps) const {
        size_t count = size_t(std::max(1.0, std::round(animation_->duration_s() * fps)));
        if (camera_path_) count = camera_path_->frame_times(fps).size();
        if (options_.turntable) count = size_t(*options_.turntable);
        std::vector<double> times(count);
        for (size_t i = 0; i < count; ++i) times[i] = double(i) / fps;
        return times;
    }

    double time_of(double time_s) const { return options_.animation_time.value_or(0) + time_s; }

    /// Puts what --animation names where it is `time_s` seconds after --animation-time.
    void animate(double time_s) {
        if (animation_) animation_->apply(session_, time_of(time_s));
    }

    /// An image has the motion blur of a recording's frame: the motion since the previous frame.
    void begin_motion() {
        if (!animation_ || !session_.settings().motion_blur.enabled) return;
        animate_frame_before();
        session_.begin_motion();
        animate_next(0);
    }

    double frame_s() const { return 1 / recording_of(options_).rate(); }
    void animate_frame_before() { animate(-frame_s()); }
    /// The next frame, after that of the time before. What the animation jumps by is no motion.
    void animate_next(double time_s) {
        animate(time_s);
        const bool camera = !options_.turntable && !camera_path_;
        if (animation_)
            animation_->replace_jumps(session_, time_of(time_s - frame_s()), time_of(time_s), camera);
    }

    void start_look() {
        session_.replace_settings(look_.settings);
        session_.scene().clear();
    }

    /// Reads the files while the GL context is made, for all of it takes long.
    void load(const Picture& picture, StageTimes& times) {
        // Deferred where the system gives no thread: then they are read when they are asked for.
        constexpr auto beside = std::launch::async | std::launch::deferred;
        auto loading =
            std::async(beside, load_all, picture.files, app::load_options(look_.settings, options_.format));
        auto lighting = std::async(beside, [this] { load_environment(); });
        session_.context_info();
        times.lap("context");
        const std::vector<io::LoadedScene> loaded = loading.get();
        lighting.get();
        times.lap("load");
        for (size_t i = 0; i < loaded.size(); ++i) {
            style_object(picture.names[i], styles_, label_map_, loaded[i].mesh);
            show(session_.scene(), loaded[i], picture.names[i]);
        }
        if (!options_.camera.empty()) session_.set_camera(find_camera(loaded, options_.camera).camera);
        animation_.reset();
        if (!options_.animation.empty())
            animation_.emplace(loaded, picture.names, options_.animation, options_.camera);
        animate(0);
        for (const auto& [name, light] : look_.lights) session_.scene().set_light(name, light);
    }

    void load_environment() {
        const std::string& file = look_.settings.environment.file;
        if (loaded_environment_ == file) return;
        if (!file.empty()) session_.load_environment(file);
        loaded_environment_ = file;
    }

    app::Encoding encoding_of(const Picture& picture) const {
        const bool deep = options_.bit_depth == 16;
        const bool is_file = picture.output != "-" && !picture.output.empty();
        return app::encoding_for(is_file ? picture.output : "-.png", deep);
    }

    void write(const Picture& picture, const Image& image) {
        if (picture.output.empty()) {
            const std::string text = terminal_text(image, terminal_.protocol);
            write_to_stdout(std::as_bytes(std::span(text)));
        } else if (picture.output == standard_output) {
            write_to_stdout(io::encode_png(image));
        } else {
            io::save_image(image, picture.output);
        }
        write_layers(picture);
        save_settings(picture);
    }

    void write_layers(const Picture& picture) {
        const std::vector<std::string> truth = truth_layers_of(options_.layers);
        std::vector<std::string> own = options_.layers;
        std::erase_if(own,
                      [&](const std::string& name) { return std::ranges::find(truth, name) != truth.end(); });
        if (!own.empty()) app::layers_to_files(session_, picture.output, own);
        if (!truth.empty()) write_truth(session_, picture.output, truth);
    }

    void save_settings(const Picture& picture) {
        if (!picture.save_settings.empty())
            app::save_settings(session_, {picture.files.begin(), picture.files.end()}, picture.save_settings);
    }

    const RenderOptions& options_;
    Terminal terminal_;  ///< shows what goes to no file
    Look look_;
    std::string opener_;  ///< program of --open
    std::vector<StyleOption> styles_;
    std::shared_ptr<const LabelMap> label_map_;
    std::optional<CameraPath> camera_path_;
    std::optional<FileAnimation> animation_;
    app::Session session_;
    std::string loaded_environment_;
};

int run_render(const RenderOptions& options) {
    if (options.quiet) be_quiet();
    if (options.open && options.output == "-") throw UsageError("render: --open needs a file: -o FILE");
    if (options.output == standard_output) check_standard_output("render");
    Terminal terminal;
    if (options.output.empty()) {
        terminal = terminal_of_stdout();
        if (terminal.protocol == TerminalProtocol::none)
            throw UsageError(
                ::isatty(STDOUT_FILENO)
                    ? "render: this terminal is not known to show images: expected -o OUT.png, or "
                      "EASYPBR_TERMINAL"
                    : "render: expected -o OUT.png");
    }
    return RenderJob(options, terminal).run();
}

}  // namespace

void add_render(CLI::App& app, Job& job) {
    set_job<RenderOptions>(*app.add_subcommand("render", "Render mesh files to an image"), job,
                           declare_render_options, run_render, check_usage);
}

}  // namespace easypbr::cli
