#include "easypbr/io/mesh/obj/mtl_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <type_traits>
#include <utility>

#include "easypbr/core/ascii.h"
#include "easypbr/core/log.h"
#include "easypbr/core/luminance.h"
#include "easypbr/core/memory_budget.h"
#include "easypbr/io/mesh/texture_mapping.h"
#include "easypbr/io/source/text_scanner.h"

namespace easypbr::io {
namespace {

/// What a material's lines say, before defaults are filled in.
struct MtlEntry {
    Material material;
    std::optional<Vec3> diffuse, emission;
    std::optional<float> roughness, metallic, exponent;
    std::optional<float> dissolve, transparency;  ///< d, Tr
};

/// Whether red, green and blue are the same in nearly all texels of data, but for what JPEG makes of them.
bool is_grey(const Image& image) {
    if (image.channels() < 3) return true;
    const Image texels = data_to_u8(image);
    size_t colored = 0;
    for (int y = 0; y < texels.height(); ++y)
        for (int x = 0; x < texels.width(); ++x) {
            const uint8_t* const c = texels.at<uint8_t>(x, y);
            const auto [least, most] = std::minmax({c[0], c[1], c[2]});
            if (most - least > 16) ++colored;
        }
    return colored * 100 <= texels.pixel_count();
}

/// VTK's exporter, which PyVista and ParaView use, writes the opacity as Tr.
bool is_written_by_vtk(const Source& source) {
    const char* const end = source.end();
    for (const char* p = source.begin(); p != end; p = next_line(p, end)) {
        const std::string text = ascii::to_lower(read_rest(p, end));
        if (!text.empty() && text[0] != '#') return false;
        if (text.find("visualization toolkit") != text.npos) return true;
    }
    return false;
}

/// The channel of an image's alpha; none without one, or where nothing is transparent.
std::optional<int> alpha_channel(const Image& image) {
    if (image.channels() % 2 != 0 || is_fully_opaque(image)) return {};
    return image.channels() - 1;
}

/// Luminance of texels as they are stored (ITU-R BT.709).
template <class T>
void fill_luminance(const Image& from, Image& out) {
    for (int y = 0; y < from.height(); ++y)
        for (int x = 0; x < from.width(); ++x) {
            const T* const c = from.at<T>(x, y);
            const float value = 0.2126f * float(c[0]) + 0.7152f * float(c[1]) + 0.0722f * float(c[2]);
            *out.at<T>(x, y) = T(std::is_integral_v<T> ? value + 0.5f : value);
        }
}

std::shared_ptr<const Image> luminance_of(const Image& image) {
    charge_memory(image.pixel_count() * size_of(image.type()), "the luminance of an image");
    auto out = std::make_shared<Image>(image.width(), image.height(), 1, image.type());
    if (image.type() == PixelType::u8) fill_luminance<uint8_t>(image, *out);
    if (image.type() == PixelType::u16) fill_luminance<uint16_t>(image, *out);
    if (image.type() == PixelType::f32) fill_luminance<float>(image, *out);
    return out;
}

/// Whether `opacity` is the alpha of `color`.
bool is_alpha_of(const Texture& color, const Texture& opacity) {
    if (!color || !opacity) return false;
    Texture alpha = color;
    alpha.channel = color.image->channels() - 1;
    return color.image->channels() % 2 == 0 && alpha == opacity;
}

/// An image with the options that stand before its name.
struct MapLine {
    Texture texture;
    char channel = 0;  ///< of -imfchan; 0: not given
    float bump = 1;
};

/// What was found by walking over images, once for each: many materials may share one.
template <class Key, class Value>
class FoundInImages {
  public:
    template <class Find>
    const Value& of(const Key& key, Find&& find) {
        const auto known = values_.find(key);
        return known != values_.end() ? known->second : values_.emplace(key, find()).first->second;
    }

  private:
    std::map<Key, Value> values_;
};

class MtlParser {
  public:
    MtlParser(const Source& source, TextureLoader& textures)
        : source_(source),
          textures_(textures),
          end_(source.end()),
          transparency_is_opacity_(is_written_by_vtk(source)) {}

    std::map<std::string, Material> parse() {
        for (p_ = source_.begin(); p_ != end_; p_ = next_line(p_, end_)) {
            const std::string keyword = ascii::to_lower(read_word(p_, end_));
            if (keyword == "newmtl") {
                finish();
                entry_.emplace();
                entry_->material.name = unquoted(read_rest(p_, end_));
            } else if (entry_ && !keyword.empty() && keyword[0] != '#') {
                parse_line(keyword);
            }
        }
        finish();
        warn_of_transparent();
        return std::move(materials_);
    }

  private:
    using ImagePointer = std::shared_ptr<const Image>;

    void parse_line(const std::string& keyword) {
        if (keyword.starts_with("map_") || keyword == "bump" || keyword == "norm" || keyword == "disp" ||
            keyword == "decal" || keyword == "refl") {
            parse_map(keyword);
        } else if (keyword == "kd") {
            entry_->diffuse = color();
        } else if (keyword == "ke") {
            entry_->emission = color();
        } else {
            parse_number_line(keyword);
        }
    }

    void parse_number_line(const std::string& keyword) {
        if (keyword == "pr") entry_->roughness = number();
        if (keyword == "pm") entry_->metallic = number();
        if (keyword == "ns") entry_->exponent = number();
        if (keyword == "d") entry_->dissolve = dissolve();
        if (keyword == "tr") entry_->transparency = number();
        if (keyword == "illum") entry_->material.unlit = number() == 0.0f;
    }

    /// The next number; nothing when there is none or it is not finite.
    std::optional<float> number() {
        float value = 0;
        if (!read_number(p_, end_, value) || !std::isfinite(value)) return {};
        return value;
    }

    /// "d 0.5", or "d -halo 0.5" for an opacity that depends on the direction, which is taken as constant.
    std::optional<float> dissolve() {
        const char* after = p_;
        if (read_word(after, end_) == "-halo") p_ = after;
        return number();
    }

    /// One number stands for all three.
    std::optional<Vec3> color() {
        const auto r = number(), g = number(), b = number();
        if (!r) return {};
        return Vec3(*r, g.value_or(*r), b.value_or(*r)).cwiseMax(0.0f);
    }

    void parse_map(const std::string& keyword) {
        Material& material = entry_->material;
        if (keyword == "map_kd") {
            material.base_color_texture = map_line().texture;
        } else if (keyword == "map_pr") {
            material.roughness_texture = map_line().texture;
        } else if (keyword == "map_pm") {
            material.metallic_texture = map_line().texture;
        } else if (keyword == "map_ke") {
            material.emissive_texture = map_line().texture;
        } else if (keyword == "map_d") {
            parse_opacity_map();
        } else if (keyword == "norm" || keyword == "bump" || keyword == "map_bump") {
            parse_normal_map(keyword);
        } else if (keyword != "map_ka") {
            log_warning(
                fmt::format("{}: '{}' is not supported and left out", source_.path.string(), keyword));
        }
    }

    /// Images with alpha are given for it; of others the luminance is meant.
    void parse_opacity_map() {
        MapLine map = map_line();
        if (const ImagePointer& image = map.texture.image; image && map.channel == 0)
            map.texture.channel =
                alpha_channels_.of(image, [&] { return alpha_channel(*image); }).value_or(0);
        entry_->material.opacity_texture = map.texture;
    }

    bool is_grey_image(const ImagePointer& image) {
        return greys_.of(image, [&] { return is_grey(*image); });
    }

    /// Exporters write normal maps under the keywords of height maps as well; a height map is grey.
    void parse_normal_map(const std::string& keyword) {
        const MapLine map = map_line();
        if (!map.texture) return;
        if (keyword != "norm" && is_grey_image(map.texture.image)) {
            log_warning(fmt::format("{}: height maps are not supported, '{}' is left out",
                                    source_.path.string(), map.texture.path));
            return;
        }
        entry_->material.normal_texture = map.texture;
        entry_->material.normal_scale = map.bump;
    }

    /// The next number of an option; none where it is the begin of a name, as in "2.png".
    std::optional<float> option_number() {
        const char* const before = p_;
        const auto value = number();
        if (value && (p_ == end_ || *p_ == '\n' || is_blank(*p_))) return value;
        p_ = before;
        return {};
    }

    MapLine map_line() {
        MapLine map;
        Eigen::Vector2f scale(1, 1), offset(0, 0);
        bool clamp = false;
        for (p_ = skip_blanks(p_, end_); p_ != end_ && *p_ == '-'; p_ = skip_blanks(p_, end_)) {
            const std::string option = ascii::to_lower(read_word(p_, end_));
            if (option == "-s")
                scale = pair(scale);
            else if (option == "-o")
                offset = pair(offset);
            else if (option == "-t" || option == "-mm")
                pair(offset);
            else if (option == "-bm")
                map.bump = option_number().value_or(1);
            else if (option == "-clamp")
                clamp = read_word(p_, end_) == "on";
            else if (option == "-imfchan")
                map.channel = channel_letter(read_word(p_, end_));
            else
                read_word(p_, end_);
        }
        map.texture = textures_.load(std::string(read_rest(p_, end_)), source_.path.parent_path());
        if (!map.texture) return map;
        take_channel(map.channel, map.texture);
        if (clamp) map.texture.wrap_u = map.texture.wrap_v = Wrap::clamp;
        map.texture.uv_transform << scale.x(), 0, offset.x(), 0, scale.y(), offset.y(), 0, 0, 1;
        return map;
    }

    /// One to three numbers of which the third (w) is of no use to an image.
    Eigen::Vector2f pair(const Eigen::Vector2f& otherwise) {
        Eigen::Vector2f value = otherwise;
        for (int i = 0; i < 3; ++i) {
            const auto next = option_number();
            if (!next) break;
            if (i < 2) value[i] = *next;
        }
        return value;
    }

    static char channel_letter(std::string_view name) {
        return name.size() == 1 ? ascii::to_lower(name)[0] : '\0';
    }

    /// r, g, b, m (matte: alpha) or l (luminance). The first where an image has no such channel.
    void take_channel(char letter, Texture& texture) {
        const int channels = texture.image->channels();
        if (letter == 'g' && channels >= 3) texture.channel = 1;
        if (letter == 'b' && channels >= 3) texture.channel = 2;
        if (letter == 'm' && channels % 2 == 0) texture.channel = channels - 1;
        if (letter == 'l' && channels >= 3) take_luminance(texture);
    }

    /// No file holds the luminance of a coloured image.
    void take_luminance(Texture& texture) {
        const ImagePointer luminance = luminances_.of(texture.image, [&] {
            return is_grey_image(texture.image) ? texture.image : luminance_of(*texture.image);
        });
        if (luminance == texture.image) return;
        texture.image = luminance;
        texture.path.clear();
        texture.file_state.reset();
    }

    void finish() {
        if (!entry_) return;
        Material& m = entry_->material;
        const Vec3 diffuse = entry_->diffuse.value_or(m.base_color_texture ? Vec3(1, 1, 1) : m.base_color);
        // Many exporters write black beside a map and mean the map alone.
        m.base_color = m.base_color_texture && diffuse.isZero() ? Vec3(1, 1, 1) : diffuse;
        m.base_color_given = entry_->diffuse.has_value();
        const Vec3 emission = entry_->emission.value_or(Vec3(0, 0, 0));
        m.emissive = m.emissive_texture && is_black(emission) ? Vec3(1, 1, 1) : emission;
        m.metallic = std::clamp(entry_->metallic.value_or(m.metallic_texture ? 1.0f : 0.0f), 0.0f, 1.0f);
        m.roughness = std::clamp(roughness(), 0.0f, 1.0f);
        m.opacity = std::clamp(opacity(), 0.0f, 1.0f);
        if (m.opacity < 1) m.alpha_mode = AlphaMode::blend;
        if (const Texture& map = m.opacity_texture)
            m.alpha_mode = alpha_modes_.of({map.image, {map.channel, m.opacity == 1}},
                                           [&] { return obj_alpha_mode(m.opacity, map); });
        // The alpha of base colours multiplies the opacity, so that it would count twice.
        if (is_alpha_of(m.base_color_texture, m.opacity_texture)) m.opacity_texture = {};
        materials_.try_emplace(m.name, m);
    }

    /// `d` counts wherever it stands. Nobody means a material that is not seen at all: `Tr 1` is the opacity
    /// of MeshLab, OpenMVS and others.
    float opacity() {
        if (entry_->dissolve) return *entry_->dissolve;
        const float transparency = entry_->transparency.value_or(0);
        if (!entry_->transparency || !(transparency_is_opacity_ || transparency == 1))
            return 1 - transparency;
        if (!transparency_is_opacity_ && ++opaque_count_ == 1) first_opaque_ = entry_->material.name;
        return transparency;
    }

    void warn_of_transparent() const {
        if (opaque_count_ > 0)
            log_warning(
                fmt::format("{}: 'Tr 1' without 'd' is taken as opaque, as MeshLab, OpenMVS and "
                            "mvs-texturing mean it, not "
                            "as invisible: material '{}'{}",
                            source_.path.string(), first_opaque_,
                            opaque_count_ > 1 ? fmt::format(", {} in all", opaque_count_) : ""));
    }

    float roughness() const {
        if (entry_->roughness) return *entry_->roughness;
        if (entry_->material.roughness_texture) return 1;
        if (!entry_->exponent) return entry_->material.roughness;
        return std::sqrt(std::sqrt(2 / (std::max(0.0f, *entry_->exponent) + 2)));
    }

    const Source& source_;
    TextureLoader& textures_;
    const char* p_ = nullptr;
    const char* end_;
    const bool transparency_is_opacity_;
    size_t opaque_count_ = 0;   ///< materials with 'Tr 1' that are opaque
    std::string first_opaque_;  ///< the name of the first
    std::optional<MtlEntry> entry_;
    std::map<std::string, Material> materials_;
    FoundInImages<ImagePointer, ImagePointer> luminances_;
    FoundInImages<ImagePointer, bool> greys_;
    FoundInImages<ImagePointer, std::optional<int>> alpha_channels_;
    /// By image, channel and whether the opacity beside it is 1.
    FoundInImages<std::pair<ImagePointer, std::pair<int, bool>>, AlphaMode> alpha_modes_;
};

}  // namespace

std::map<std::string, Material> read_mtl(const Source& source, TextureLoader& textures) {
    const TextSource text(source);
    return MtlParser(text.source(), textures).parse();
}

}  // namespace easypbr::io
