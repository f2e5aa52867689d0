#include "easypbr/io/mesh/assimp/colors_of_3mf.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <utility>

#include "easypbr/core/ascii.h"
#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "easypbr/core/log.h"
#include "easypbr/io/archive/zip_reader.h"
#include "easypbr/io/source/source.h"

namespace easypbr::io {
namespace {

constexpr std::string_view model_ending = ".model";
constexpr std::string_view base_materials = "basematerials";

/// Elements that hold colours, by their names without a prefix, and what messages call them.
constexpr std::array<std::pair<std::string_view, std::string_view>, 5> color_groups{
    {{base_materials, "base materials"},
     {"colorgroup", "colour groups (m:colorgroup)"},
     {"texture2dgroup", "textures (m:texture2dgroup)"},
     {"compositematerials", "composite materials (m:compositematerials)"},
     {"multiproperties", "multi-properties (m:multiproperties)"}}};

/// The tags of an XML text, one after another.
class XmlTags {
  public:
    explicit XmlTags(std::string_view text) : text_(text) {}

    /// False at the end, and where a tag does not end.
    bool next() {
        for (;;) {
            const size_t begin = text_.find('<', place_);
            if (begin == std::string_view::npos) return false;
            const std::string_view rest = text_.substr(begin);
            if (rest.starts_with("<!--")) {
                if (!skip(begin, "-->")) return false;
            } else if (rest.starts_with("<![CDATA[")) {
                if (!skip(begin, "]]>")) return false;
            } else if (rest.starts_with("<?") || rest.starts_with("<!")) {
                if (!skip(begin, ">")) return false;
            } else {
                return read_tag(begin + 1);
            }
        }
    }

    /// Without a prefix; empty: an end tag.
    std::string_view name() const { return name_; }

    /// Calls `use` with the name and the value of each attribute.
    template <class Use>
    void for_each_attribute(const Use& use) const {
        std::string_view rest = content_;
        for (;;) {
            const size_t equals = rest.find('=');
            const size_t quote = rest.find_first_of("\"'", equals);
            if (quote == std::string_view::npos) return;
            const size_t end = rest.find(rest[quote], quote + 1);
            if (end == std::string_view::npos) return;
            use(trimmed(rest.substr(0, equals)), rest.substr(quote + 1, end - quote - 1));
            rest.remove_prefix(end + 1);
        }
    }

    std::string_view attribute(std::string_view wanted) const {
        std::string_view found;
        for_each_attribute([&](std::string_view name, std::string_view value) {
            if (name == wanted) found = value;
        });
        return found;
    }

  private:
    bool skip(size_t begin, std::string_view end) {
        const size_t found = text_.find(end, begin);
        if (found == std::string_view::npos) return false;
        place_ = found + end.size();
        return true;
    }

    /// Attributes may hold '>'.
    bool read_tag(size_t begin) {
        size_t end = begin;
        while (end < text_.size() && text_[end] != '>') {
            if (text_[end] == '"' || text_[end] == '\'') end = text_.find(text_[end], end + 1);
            if (end == std::string_view::npos) return false;
            ++end;
        }
        if (end >= text_.size()) return false;
        content_ = text_.substr(begin, end - begin);
        size_t size = 0;
        while (size < content_.size() && !ascii::is_space(content_[size]) && content_[size] != '/') ++size;
        name_ = content_.substr(0, size);
        content_.remove_prefix(size);
        name_.remove_prefix(name_.find(':') + 1);  // 0 where there is none
        place_ = end + 1;
        return true;
    }

    static std::string_view trimmed(std::string_view text) {
        while (!text.empty() && ascii::is_space(text.front())) text.remove_prefix(1);
        while (!text.empty() && ascii::is_space(text.back())) text.remove_suffix(1);
        return text;
    }

    std::string_view text_, name_, content_;
    size_t place_ = 0;
};

/// A material or colour: a member of a group.
struct ColorMember {
    std::string_view group, index;  ///< empty: none

    bool operator==(const ColorMember&) const = default;
};

class ColorScan {
  public:
    explicit ColorScan(std::string_view model) {
        XmlTags tags(model);
        while (tags.next()) read(tags);
        end_object();
    }

    std::vector<std::string> left_out() const {
        std::vector<std::string> names;
        for (const auto& [kind, what] : color_groups)
            if (kind != base_materials && is_used(kind)) names.emplace_back(what);
        if (mixed_objects_)
            names.push_back(fmt::format("materials of single triangles (objects: {})", mixed_objects_));
        const bool is_one_taken = has_group(base_materials) || has_group("texture2dgroup");
        if (bare_objects_ && is_one_taken)
            names.push_back(fmt::format(
                "the default material of objects without one, which get the file's first (objects: {})",
                bare_objects_));
        return names;
    }

  private:
    void read(const XmlTags& tags) {
        if (tags.name() == "triangle")
            read_triangle(tags);
        else if (tags.name() == "object")
            begin_object(tags);
        else if (const auto group = std::ranges::find(color_groups, tags.name(),
                                                      &std::pair<std::string_view, std::string_view>::first);
                 group != color_groups.end())
            groups_[tags.attribute("id")].kind = group->first;
    }

    void begin_object(const XmlTags& tags) {
        end_object();
        own_ = {tags.attribute("pid"), tags.attribute("pindex")};
        if (!own_.group.empty()) meet(own_);
    }

    void end_object() {
        if (is_mixed_) ++mixed_objects_;
        if (has_triangles_ && !is_mixed_ && met_->group.empty()) ++bare_objects_;
        own_ = {};
        met_.reset();
        has_triangles_ = is_mixed_ = false;
    }

    /// What a triangle does not say the object does; its second and third corner have the first's index.
    void read_triangle(const XmlTags& tags) {
        ColorMember property;
        std::string_view second, third;
        tags.for_each_attribute([&](std::string_view name, std::string_view value) {
            if (name == "pid") property.group = value;
            if (name == "p1") property.index = value;
            if (name == "p2") second = value;
            if (name == "p3") third = value;
        });
        has_triangles_ = true;
        if (property.index.empty()) property = own_;
        if (property.group.empty()) property.group = own_.group;
        meet(property);
        is_mixed_ = is_mixed_ || (!second.empty() && second != property.index) ||
                    (!third.empty() && third != property.index);
    }

    void meet(const ColorMember& property) {
        if (met_ == property) return;
        is_mixed_ = is_mixed_ || met_.has_value();
        met_ = property;
        if (!property.group.empty()) groups_[property.group].is_used = true;
    }

    bool is_used(std::string_view kind) const {
        return std::ranges::any_of(
            groups_, [&](const auto& group) { return group.second.kind == kind && group.second.is_used; });
    }

    bool has_group(std::string_view kind) const {
        return std::ranges::any_of(groups_, [&](const auto& group) { return group.second.kind == kind; });
    }

    struct Group {
        std::string_view kind;
        bool is_used = false;
    };
    std::map<std::string_view, Group> groups_;  ///< by their ids
    size_t mixed_objects_ = 0, bare_objects_ = 0;

    // Of the object that is being read.
    ColorMember own_;
    std::optional<ColorMember> met_;  ///< the last one
    bool has_triangles_ = false, is_mixed_ = false;
};

}  // namespace

std::vector<std::string> colors_left_out_of_3mf(std::string_view model) {
    return ColorScan(model).left_out();
}

void warn_of_colors_of_3mf(const std::filesystem::path& path) {
    const FileBytes bytes(path);
    std::vector<ZipEntry> models;
    try {
        models = read_zip(Source(bytes, path), model_ending);
    } catch (const FormatError&) {
        return;  // assimp has read what it could
    }
    for (const ZipEntry& model : models) {
        const std::vector<std::string> names = colors_left_out_of_3mf(model.bytes);
        if (!names.empty())
            log_warning(fmt::format("{}: one base material is read for each object; left out: {}",
                                    path.string(), fmt::join(names, ", ")));
    }
}

}  // namespace easypbr::io
