#include "easypbr/io/image/image_io.h"
#include "easypbr/scene/environment.h"

namespace easypbr {

Environment::Environment(const std::filesystem::path& path)
    : Environment(to_linear_f32(io::load_image(path)), path.string()) {}

}  // namespace easypbr
