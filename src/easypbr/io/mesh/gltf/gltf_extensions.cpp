#include "easypbr/io/mesh/gltf/gltf_extensions.h"

#include "easypbr/core/math.h"

namespace easypbr::io {
namespace {

class ExtensionReader {
  public:
    ExtensionReader(const GltfDocument& document, const Json& material)
        : document_(document), material_(material) {}

    /// Whether the material has this extension, whose members are read next.
    bool open(const char* name) {
        json_ = extension(material_, name);
        return json_ != nullptr;
    }

    void number(const char* key, float& value) const {
        value = float(document_.number(*json_, key, double(value)));
    }

    void color(const char* key, Vec3& value) const {
        if (const auto numbers = document_.numbers(*json_, key, 3))
            value = Vec3(float((*numbers)[0]), float((*numbers)[1]), float((*numbers)[2]));
    }

    /// Strength of a normal texture.
    void scale(const char* key, float& value) const {
        if (const Json* info = member(*json_, key)) value = float(document_.number(*info, "scale", 1));
    }

    void degrees_of(const char* key, float& value) const {
        value = float(degrees(document_.number(*json_, key, radians(double(value)))));
    }

  private:
    const GltfDocument& document_;
    const Json& material_;
    const Json* json_ = nullptr;
};

void read_layers(ExtensionReader& reader, Material& out) {
    if (reader.open(khr_clearcoat)) {
        reader.number("clearcoatFactor", out.clearcoat);
        reader.number("clearcoatRoughnessFactor", out.clearcoat_roughness);
        reader.scale("clearcoatNormalTexture", out.clearcoat_normal_scale);
    }
    if (reader.open(khr_sheen)) {
        reader.color("sheenColorFactor", out.sheen_color);
        reader.number("sheenRoughnessFactor", out.sheen_roughness);
    }
    if (reader.open(khr_iridescence)) {
        reader.number("iridescenceFactor", out.iridescence);
        reader.number("iridescenceIor", out.iridescence_ior);
        reader.number("iridescenceThicknessMinimum", out.iridescence_thickness_min);
        reader.number("iridescenceThicknessMaximum", out.iridescence_thickness_max);
    }
}

}  // namespace

void read_gltf_extensions(const GltfDocument& document, const Json& json, Material& out) {
    ExtensionReader reader(document, json);
    read_layers(reader, out);
    if (reader.open(khr_specular)) {
        reader.number("specularFactor", out.specular);
        reader.color("specularColorFactor", out.specular_color);
    }
    if (reader.open(khr_ior)) reader.number("ior", out.ior);
    if (reader.open(khr_transmission)) reader.number("transmissionFactor", out.transmission);
    if (reader.open(khr_volume)) {
        reader.number("thicknessFactor", out.thickness);
        reader.color("attenuationColor", out.attenuation_color);
        reader.number("attenuationDistance", out.attenuation_distance);
    }
    if (reader.open(khr_dispersion)) reader.number("dispersion", out.dispersion);
    if (reader.open(khr_anisotropy)) {
        reader.number("anisotropyStrength", out.anisotropy);
        reader.degrees_of("anisotropyRotation", out.anisotropy_rotation_deg);
    }
}

}  // namespace easypbr::io
