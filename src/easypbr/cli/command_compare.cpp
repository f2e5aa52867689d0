#include <fmt/format.h>

#include <cstdio>

#include "easypbr/cli/command.h"
#include "easypbr/cli/console.h"
#include "easypbr/cli/parse_errors.h"
#include "easypbr/core/image.h"
#include "easypbr/io/image/image_io.h"

namespace easypbr::cli {
namespace {

struct CompareOptions {
    std::string a, b;
    double max_difference = 0;
};

void declare_compare(CLI::App& command, CompareOptions& options) {
    command.add_option("A", options.a, "Image file");
    command.add_option("B", options.b, "Image file of the same size and type");
    command
        .add_option("--max-difference", options.max_difference,
                    "Largest difference per channel that passes, in units of the type (0 to 255 for 8 bits); "
                    "0 by default")
        ->option_text("N")
        ->check(at_least_zero());
}

int run_compare(const CompareOptions& options) {
    require(!options.b.empty(), "compare", "two image files");
    const Image a = io::load_image(options.a), b = io::load_image(options.b);
    // A picture with opaque alpha is the same as one without, and a grey one the same as one of equal
    // colours.
    const bool has_color = std::max(a.channels(), b.channels()) >= 3;
    const bool has_alpha = a.channels() % 2 == 0 || b.channels() % 2 == 0;
    const int channels = (has_color ? 3 : 1) + (has_alpha ? 1 : 0);
    const ImageDifference d = compare(with_channels(a, channels), with_channels(b, channels));
    fmt::print("max {:.6g}, mean {:.6g}, rmse {:.6g}, psnr {:.2f} dB, {} of {} pixels differ\n", d.max,
               d.mean, d.rmse, d.psnr, d.different, a.pixel_count());
    std::fflush(stdout);
    // Not "greater", so that images with NaN never pass.
    if (d.max <= options.max_difference) return 0;
    print_error(fmt::format("{} and {} differ by up to {:.6g}, more than {:.6g}", options.a, options.b, d.max,
                            options.max_difference));
    return 1;
}

}  // namespace

void add_compare(CLI::App& app, Job& job) {
    set_job<CompareOptions>(*app.add_subcommand("compare", "Compare two images"), job, declare_compare,
                            run_compare);
}

}  // namespace easypbr::cli
