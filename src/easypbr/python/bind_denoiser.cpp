// Open Image Denoise as the package pyoidn carries it (the extra [denoise]).
#include <filesystem>
#include <string>

#include "easypbr/python/bindings.h"
#include "easypbr/render/denoise/open_image_denoise.h"

namespace easypbr::python {

void bind_denoiser() {
    const nb::object spec = nb::module_::import_("importlib.util").attr("find_spec")("pyoidn");
    if (spec.is_none() || spec.attr("origin").is_none()) return;
    const std::filesystem::path origin = nb::cast<std::string>(nb::str(spec.attr("origin"))).c_str();
    render::add_denoiser_folder(origin.parent_path() / "oidn" / "lib");
}

}  // namespace easypbr::python
