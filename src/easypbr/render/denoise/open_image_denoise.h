// Intel Open Image Denoise, 1.4 or later, loaded when it is first asked for.
#pragma once

#include <filesystem>
#include <string>

#include "easypbr/render/denoise/noisy_light.h"

namespace easypbr::render {

/// A network that was trained to take Monte Carlo noise out of pictures, guided by reflectance and normal.
/// Runs on the CPU. The library is looked for in the folder that EASYPBR_OIDN names, where that is set; else
/// in those of add_denoiser_folder(), and where the system keeps libraries.
class OpenImageDenoise {
  public:
    OpenImageDenoise();
    ~OpenImageDenoise();
    OpenImageDenoise(const OpenImageDenoise&) = delete;
    OpenImageDenoise& operator=(const OpenImageDenoise&) = delete;

    /// "2.5.1", empty where the library is not there.
    static std::string version();

    /// Writes the light without its noise to `scratch`, which is returned. Throws Error when the library is
    /// not there, with what to install, or fails.
    const Target& denoise(const NoisyLight& noisy);

  private:
    void* device_ = nullptr;
};

/// A folder with the library, which is looked into from now on.
void add_denoiser_folder(const std::filesystem::path& folder);

}  // namespace easypbr::render
