#include "easypbr/io/mesh/gltf/gltf_splats.h"

#include <fmt/format.h>

#include <algorithm>

#include "easypbr/core/color.h"
#include "easypbr/core/log.h"
#include "easypbr/core/parallel.h"
#include "easypbr/io/mesh/gltf/gltf_accessor.h"
#include "easypbr/io/mesh/gltf/gltf_values.h"
#include "easypbr/io/mesh/mesh_readers.h"
#include "easypbr/io/tables/splat_rows.h"
#include "easypbr/scene/splat_basis.h"

namespace easypbr::io {
namespace {

constexpr size_t points_mode = 0, gltf_splat_grain = 1 << 14;
constexpr int most_gltf_degree = 3;

/// Encodes colours that are linear: exactly what all directions see, and to first order what differs.
void encode_harmonics(ArrayXf::Dense& sh) {
    parallel_for(size_t(sh.rows()), gltf_splat_grain, [&](size_t row) {
        const auto i = Eigen::Index(row);
        for (Eigen::Index channel = 0; channel < 3; ++channel) {
            constexpr float step = 1e-3f;
            const float linear = std::max(0.0f, 0.5f + splat_constant * sh(i, channel));
            const float encoded = srgb_from_linear(linear);
            const float slope = (srgb_from_linear(linear + step) - encoded) / step;
            sh(i, channel) = (encoded - 0.5f) / splat_constant;
            for (Eigen::Index k = channel + 3; k < sh.cols(); k += 3) sh(i, k) *= slope;
        }
    });
}

class SplatPrimitiveReader {
  public:
    SplatPrimitiveReader(GltfDocument& document, const Json& primitive, const std::string& mesh)
        : document_(document),
          extension_(*extension(primitive, khr_gaussian_splatting)),
          attributes_(*member(primitive, "attributes")),
          mesh_(mesh) {
        if (document.optional_integer(primitive, "mode") != points_mode)
            fail("has splats whose mode is not POINTS");
        warn_unless("kernel", {"ellipse"});
        warn_unless("projection", {"perspective"});
        warn_unless("colorSpace", {"srgb_rec709_display", "lin_rec709_display"});
    }

    MeshData read() {
        MeshData data = read_values();
        if (document_.text(extension_, "colorSpace") == "lin_rec709_display") {
            ArrayXf::Dense sh = data.splats.sh;
            encode_harmonics(sh);
            data.splats.sh = std::move(sh);
        }
        data.up = Vec3d::Zero();
        std::set<std::string> names;
        find_gltf_values(document_, attributes_, names);
        for (const std::string& name : names)
            if (count_ > 0)
                add_gltf_values(name, require(name, 1, 4),
                                gltf_rounding(document_, document_.integer(attributes_, name.c_str())),
                                document_.path(), data);
        return data;
    }

  private:
    [[noreturn]] void fail(const std::string& what) const { document_.fail(mesh_ + " " + what); }

    void warn_unless(const char* key, std::initializer_list<std::string_view> known) const {
        const std::string value = document_.text(extension_, key, std::string(*known.begin()));
        if (std::ranges::find(known, value) == known.end())
            log_warning(fmt::format("{}: {} of splats has the {} '{}', which is not known: drawn as '{}'",
                                    document_.path().string(), mesh_, key, value, *known.begin()));
    }

    MeshData read_values() {
        if (const Json* packed = extension(extension_, khr_splats_as_spz)) {
            const auto bytes = document_.buffer_view(document_.integer(*packed, "bufferView"));
            return read_spz(
                Source({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, document_.path()));
        }
        const ArrayXf::Dense V = require("POSITION", 3);
        count_ = V.rows();
        const int degree = find_degree();
        const Source source(std::string_view(), document_.path());
        SplatRows rows(source, size_t(count_), degree);
        rows.V = V;
        rows.scales = require(splat_scale_attribute, 3);
        const ArrayXf::Dense xyzw = require(splat_rotation_attribute, 4);
        rows.rotations << xyzw.col(3), xyzw.leftCols(3);
        rows.opacities = require(splat_opacity_attribute, 1).col(0);
        if (!(rows.opacities.minCoeff() >= 0 && rows.opacities.maxCoeff() <= 1))
            fail("has opacities of splats that are not from 0 to 1");
        Eigen::Index column = 0;
        for (int l = 0; l <= degree; ++l)
            for (int k = 0; k <= 2 * l; ++k, column += 3)
                rows.sh.middleCols(column, 3) = require(splat_harmonic_name(l, k), 3);
        return rows.finish(source, Vec3d::Zero());
    }

    /// The highest degree of which there is a harmonic.
    int find_degree() const {
        int degree = 0;
        for (int l = 1; l <= most_gltf_degree; ++l)
            for (int k = 0; k <= 2 * l; ++k)
                if (member(attributes_, splat_harmonic_name(l, k).c_str())) degree = l;
        return degree;
    }

    ArrayXf::Dense require(const std::string& name, int columns) { return require(name, columns, columns); }

    ArrayXf::Dense require(const std::string& name, int least, int most) {
        const auto accessor = document_.optional_integer(attributes_, name.c_str());
        if (!accessor) fail("has splats without " + name);
        ArrayXf::Dense values = read_floats(document_, *accessor, least, most);
        if (count_ && values.rows() != count_)
            fail(fmt::format("has {} splats, but accessors[{}] has {} rows", count_, *accessor,
                             values.rows()));
        return values;
    }

    GltfDocument& document_;
    const Json& extension_;
    const Json& attributes_;
    std::string mesh_;
    Eigen::Index count_ = 0;
};

}  // namespace

std::string splat_harmonic_name(int degree, int k) {
    return fmt::format("{}:SH_DEGREE_{}_COEF_{}", khr_gaussian_splatting, degree, k);
}

bool has_gltf_splats(const Json& primitive) {
    return extension(primitive, khr_gaussian_splatting);
}

MeshData read_gltf_splats(GltfDocument& document, const Json& primitive, const std::string& mesh) {
    return SplatPrimitiveReader(document, primitive, mesh).read();
}

}  // namespace easypbr::io
