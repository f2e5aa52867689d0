// The entry of libFuzzer: the environment variable EASYPBR_FUZZ_TARGET names the target.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "easypbr/core/log.h"
#include "easypbr/scene/label_colors.h"
#include "fuzz/targets.h"

namespace {

const easypbr::fuzz::Target& chosen() {
    const char* name = std::getenv("EASYPBR_FUZZ_TARGET");
    for (const easypbr::fuzz::Target& target : easypbr::fuzz::targets())
        if (name && target.name == name) return target;
    std::fputs("EASYPBR_FUZZ_TARGET: expected one of", stderr);
    for (const easypbr::fuzz::Target& target : easypbr::fuzz::targets())
        std::fprintf(stderr, " %s", target.name.c_str());
    std::fputs("\n", stderr);
    std::exit(2);
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
    easypbr::set_log_sink([](easypbr::LogLevel, std::string_view) {});
    // They are chosen once, for seconds with sanitizers: no file's fault.
    if (chosen().name.starts_with("label"))
        easypbr::GeneratedColors colors(easypbr::generated_color_count - 1);
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    static const easypbr::fuzz::Target& target = chosen();
    target.run({reinterpret_cast<const std::byte*>(data), size});
    return 0;
}
