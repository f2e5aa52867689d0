#include "easypbr/io/tables/python_literal.h"

#include <charconv>

#include "easypbr/core/ascii.h"

namespace easypbr::io {
namespace {

constexpr int deepest = 20;

class LiteralParser {
  public:
    explicit LiteralParser(std::string_view text) : p_(text.data()), end_(p_ + text.size()) {}

    PythonLiteral parse(int depth = 0) {
        PythonLiteral value;
        if (depth > deepest || at_end()) return value;
        const char c = *p_;
        if (c == '\'' || c == '"') return parse_string();
        if (c == '(' || c == '[') return parse_list(c == '(' ? ')' : ']', depth);
        if (c == '{') return parse_dictionary(depth);
        if (ascii::is_alpha(c)) return parse_word();
        const auto result = std::from_chars(p_, end_, value.number);
        if (result.ec == std::errc()) value.kind = PythonLiteral::integer, p_ = result.ptr;
        return value;
    }

  private:
    /// Whether nothing but blanks is left; passes over them.
    bool at_end() {
        while (p_ != end_ && ascii::is_space(*p_)) ++p_;
        return p_ == end_;
    }

    bool take(char c) {
        if (at_end() || *p_ != c) return false;
        ++p_;
        return true;
    }

    PythonLiteral parse_string() {
        PythonLiteral value;
        const char quote = *p_++;
        while (p_ != end_ && *p_ != quote) {
            if (*p_ == '\\' && p_ + 1 != end_) ++p_;
            value.text += *p_++;
        }
        if (p_ == end_) return {};
        ++p_;
        value.kind = PythonLiteral::string;
        return value;
    }

    PythonLiteral parse_word() {
        const char* first = p_;
        while (p_ != end_ && ascii::is_alnum(*p_)) ++p_;
        const std::string_view word(first, size_t(p_ - first));
        PythonLiteral value;
        if (word != "True" && word != "False") return value;
        value.kind = PythonLiteral::integer;
        value.number = word == "True";
        return value;
    }

    PythonLiteral parse_list(char close, int depth) {
        PythonLiteral value;
        ++p_;
        while (!take(close)) {
            value.items.push_back(parse(depth + 1));
            if (value.items.back().kind == PythonLiteral::none) return {};
            if (!take(',') && (at_end() || *p_ != close)) return {};
        }
        value.kind = PythonLiteral::list;
        return value;
    }

    PythonLiteral parse_dictionary(int depth) {
        PythonLiteral value;
        ++p_;
        while (!take('}')) {
            PythonLiteral key = parse(depth + 1);
            if (key.kind != PythonLiteral::string || !take(':')) return {};
            value.entries.push_back({std::move(key.text), parse(depth + 1)});
            if (value.entries.back().value.kind == PythonLiteral::none) return {};
            if (!take(',') && (at_end() || *p_ != '}')) return {};
        }
        value.kind = PythonLiteral::dictionary;
        return value;
    }

    const char* p_;
    const char* end_;
};

}  // namespace

const PythonLiteral* PythonLiteral::find(std::string_view key) const {
    for (const auto& [name, value] : entries)
        if (name == key) return &value;
    return nullptr;
}

PythonLiteral parse_python_literal(std::string_view text) {
    return LiteralParser(text).parse();
}

}  // namespace easypbr::io
