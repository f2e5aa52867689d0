#include "easypbr/io/mesh/pcd/pcd_header.h"

#include <fmt/format.h>

#include <charconv>
#include <optional>

#include "easypbr/io/source/text_scanner.h"

namespace easypbr::io {
namespace {

/// Values of one point: more than any file has, few enough for rows of less than a megabyte.
constexpr size_t most_values = 100'000;

class PcdHeaderParser {
  public:
    explicit PcdHeaderParser(const Source& source)
        : source_(source), p_(source.begin()), end_(source.end()) {}

    PcdHeader parse() {
        while (!header_.body) {
            if (p_ == end_) fail_here("the file ends before its line 'DATA'");
            parse_line();
        }
        make_fields();
        count_points();
        return std::move(header_);
    }

  private:
    using Words = std::vector<std::string_view>;

    void parse_line() {
        const std::string_view keyword = read_word(p_, end_);
        if (keyword.empty() || keyword[0] == '#') {
        } else if (keyword == "FIELDS" || keyword == "COLUMNS") {
            names_ = words();
        } else if (keyword == "SIZE") {
            sizes_ = words();
        } else if (keyword == "TYPE") {
            types_ = words();
        } else if (keyword == "COUNT") {
            counts_ = words();
        } else if (keyword == "WIDTH") {
            width_ = number(keyword);
        } else if (keyword == "HEIGHT") {
            height_ = number(keyword);
        } else if (keyword == "POINTS") {
            points_ = number(keyword);
        } else if (keyword == "DATA") {
            parse_data();
        } else if (keyword != "VERSION" && keyword != "VIEWPOINT") {
            fail_here(fmt::format("header line '{}' is not understood", keyword.substr(0, 40)));
        }
        p_ = next_line(p_, end_);
        if (found_data_) header_.body = p_;
    }

    void parse_data() {
        const std::string_view form = read_word(p_, end_);
        found_data_ = true;
        if (form == "ascii") {
            header_.data = PcdData::ascii;
        } else if (form == "binary") {
            header_.data = PcdData::binary;
        } else if (form == "binary_compressed") {
            header_.data = PcdData::binary_compressed;
        } else {
            fail_here(
                fmt::format("DATA '{}' is none of ascii, binary, binary_compressed", form.substr(0, 40)));
        }
    }

    Words words() {
        Words result;
        for (std::string_view word = read_word(p_, end_); !word.empty(); word = read_word(p_, end_))
            result.push_back(word);
        return result;
    }

    size_t parse_number(std::string_view what, std::string_view word) const {
        size_t value = 0;
        const auto result = std::from_chars(word.data(), word.data() + word.size(), value);
        if (result.ec != std::errc() || result.ptr != word.data() + word.size() || value > INT32_MAX)
            fail_here(fmt::format("{} is '{}', expected 0 to {}", what, word.substr(0, 40), INT32_MAX));
        return value;
    }

    size_t number(std::string_view what) { return parse_number(what, read_word(p_, end_)); }

    ScalarType parse_type(std::string_view type, std::string_view size) const {
        static constexpr struct {
            std::string_view type, size;
            ScalarType scalar;
        } known[] = {
            {"I", "1", ScalarType::int8},    {"I", "2", ScalarType::int16},  {"I", "4", ScalarType::int32},
            {"I", "8", ScalarType::int64},   {"U", "1", ScalarType::uint8},  {"U", "2", ScalarType::uint16},
            {"U", "4", ScalarType::uint32},  {"U", "8", ScalarType::uint64}, {"F", "2", ScalarType::float16},
            {"F", "4", ScalarType::float32}, {"F", "8", ScalarType::float64}};
        for (const auto& entry : known)
            if (entry.type == type && entry.size == size) return entry.scalar;
        fail(
            source_,
            fmt::format("a field has TYPE '{}' and SIZE '{}', expected I or U with 1, 2, 4, 8 or F with 4, 8",
                        type.substr(0, 40), size.substr(0, 40)));
    }

    void make_fields() {
        if (names_.empty()) fail(source_, "no line 'FIELDS' in the header");
        if (counts_.empty()) counts_.assign(names_.size(), "1");
        for (const auto& [what, given] : {std::pair{"SIZE", &sizes_}, {"TYPE", &types_}, {"COUNT", &counts_}})
            if (given->size() != names_.size())
                fail(source_, fmt::format("{} has {} entries, expected {}, one for each of the FIELDS", what,
                                          given->size(), names_.size()));
        size_t values = 0;
        for (size_t i = 0; i < names_.size(); ++i) {
            header_.fields.push_back({std::string(names_[i]), parse_type(types_[i], sizes_[i]),
                                      parse_number("a field's COUNT", counts_[i])});
            values += header_.fields.back().count;
        }
        if (values > most_values)
            fail(source_, fmt::format("a point has {} values, at most {} are read", values, most_values));
    }

    void count_points() {
        if (!points_ && !width_) fail(source_, "neither POINTS nor WIDTH in the header");
        const size_t product = width_.value_or(0) * height_.value_or(1);
        if (points_ && width_ && product != *points_)
            fail(source_, fmt::format("the header contradicts itself: WIDTH {} x HEIGHT {} are not POINTS {}",
                                      *width_, height_.value_or(1), *points_));
        header_.rows = height_.value_or(1);
        header_.points = points_.value_or(product);
        if (header_.points > INT32_MAX)
            fail(source_,
                 fmt::format("{} points are more than the {} that are read", header_.points, INT32_MAX));
    }

    [[noreturn]] void fail_here(std::string_view message) const { fail_at_line(source_, p_, message); }

    const Source& source_;
    const char* p_;
    const char* end_;
    bool found_data_ = false;
    Words names_, sizes_, types_, counts_;
    std::optional<size_t> width_, height_, points_;
    PcdHeader header_;
};

}  // namespace

PcdHeader parse_pcd_header(const Source& source) {
    return PcdHeaderParser(source).parse();
}

}  // namespace easypbr::io
