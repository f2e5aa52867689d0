#include "easypbr/io/mesh/ply/ply_header.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <utility>

#include "easypbr/io/source/text_scanner.h"

namespace easypbr::io {
namespace {

constexpr std::array<std::pair<std::string_view, ScalarType>, 16> type_names{{
    {"char", ScalarType::int8},
    {"int8", ScalarType::int8},
    {"uchar", ScalarType::uint8},
    {"uint8", ScalarType::uint8},
    {"short", ScalarType::int16},
    {"int16", ScalarType::int16},
    {"ushort", ScalarType::uint16},
    {"uint16", ScalarType::uint16},
    {"int", ScalarType::int32},
    {"int32", ScalarType::int32},
    {"uint", ScalarType::uint32},
    {"uint32", ScalarType::uint32},
    {"float", ScalarType::float32},
    {"float32", ScalarType::float32},
    {"double", ScalarType::float64},
    {"float64", ScalarType::float64},
}};

class PlyHeaderParser {
  public:
    explicit PlyHeaderParser(const Source& source)
        : source_(source), p_(source.begin()), end_(source.end()) {}

    PlyHeader parse() {
        if (word() != "ply") fail_here("'ply' expected at the file's begin");
        for (;;) {
            skip_line();
            if (p_ == end_) fail_here("the file ends before 'end_header'");
            const std::string_view keyword = word();
            if (keyword == "end_header") break;
            parse_line(keyword);
        }
        skip_line();
        if (!has_format_) fail_here("no 'format' line in the header");
        header_.body = p_;
        std::erase_if(header_.elements, [](const Element& element) { return element.properties.empty(); });
        return std::move(header_);
    }

  private:
    std::string_view word() { return read_word(p_, end_); }

    /// Headers end their lines by LF, CR LF or (old Macintosh files) CR alone.
    void skip_line() {
        while (p_ != end_ && *p_ != '\n' && *p_ != '\r') ++p_;
        if (p_ == end_) return;
        if (*p_ == '\r' && p_ + 1 != end_ && p_[1] == '\n') ++p_;
        ++p_;
    }

    void parse_line(std::string_view keyword) {
        if (keyword == "format") {
            parse_format();
        } else if (keyword == "element") {
            parse_element();
        } else if (keyword == "property") {
            parse_property();
        } else if (keyword == "comment") {
            parse_comment();
        } else if (keyword != "obj_info" && !keyword.empty()) {
            fail_here(fmt::format("header line '{}' is not understood", keyword.substr(0, 40)));
        }
    }

    void parse_format() {
        const std::string_view name = word();
        has_format_ = true;
        if (name == "ascii") {
            header_.format = PlyFormat::ascii;
        } else if (name == "binary_little_endian") {
            header_.format = PlyFormat::binary_little_endian;
        } else if (name == "binary_big_endian") {
            header_.format = PlyFormat::binary_big_endian;
        } else {
            fail_here(fmt::format("format '{}' is none of ascii, binary_little_endian, binary_big_endian",
                                  name.substr(0, 40)));
        }
    }

    void parse_element() {
        Element element;
        element.name = word();
        const std::string_view count = word();
        const auto result = std::from_chars(count.data(), count.data() + count.size(), element.count);
        if (result.ec != std::errc() || result.ptr != count.data() + count.size() ||
            element.count > INT32_MAX)
            fail_here(fmt::format("element '{}' has count '{}', expected 0 to {}", element.name.substr(0, 40),
                                  count.substr(0, 40), INT32_MAX));
        header_.elements.push_back(std::move(element));
    }

    void parse_property() {
        if (header_.elements.empty()) fail_here("a property stands before the first element");
        Property property;
        std::string_view type = word();
        if (type == "list") {
            property.count_type = parse_type(word());
            if (!is_integer(*property.count_type))
                fail_here("the length of a list must be of an integer type");
            type = word();
        }
        property.type = parse_type(type);
        property.name = word();
        if (property.name.empty()) fail_here("a property has no name");
        header_.elements.back().properties.push_back(std::move(property));
    }

    ScalarType parse_type(std::string_view name) {
        for (const auto& [known, type] : type_names)
            if (known == name) return type;
        fail_here(fmt::format("property type '{}' is not known", name.substr(0, 40)));
    }

    void parse_comment() {
        const std::string_view what = word();
        if (what == "TextureFile") header_.textures.emplace_back(read_rest(p_, end_));
        if (what != "up") return;
        Vec3d up;
        bool is_direction = true;
        for (double& part : up) is_direction &= read_number(p_, end_, part);
        if (is_direction && up.allFinite()) header_.up = up;
    }

    [[noreturn]] void fail_here(std::string_view message) { fail_at_line(source_, p_, message); }

    const Source& source_;
    const char* p_;
    const char* end_;
    bool has_format_ = false;
    PlyHeader header_;
};

}  // namespace

PlyHeader parse_ply_header(const Source& source) {
    return PlyHeaderParser(source).parse();
}

}  // namespace easypbr::io
