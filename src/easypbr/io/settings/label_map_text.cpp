#include "easypbr/io/settings/label_map_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "easypbr/core/error.h"
#include "easypbr/io/source/text_scanner.h"

namespace easypbr::io {
namespace {

std::optional<int32_t> whole_number(std::string_view text) {
    int32_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (text.empty() || error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return value;
}

struct Word {
    std::string text;
    bool is_name = false;  ///< never a number: quoted, in a line without commas
};
using Words = std::vector<Word>;

/// One line's words; quotes keep blanks and commas. With a comma outside of quotes the words are what is
/// between commas.
class Splitter {
  public:
    Words split(std::string_view line) {
        words_.clear();
        separators_only_ = !has_comma(line);
        for (const char c : line) take(c);
        finish_word(!separators_only_);
        return std::move(words_);
    }

  private:
    static bool has_comma(std::string_view line) {
        bool quoted = false;
        for (const char c : line) {
            if (c == '"') quoted = !quoted;
            if (c == ',' && !quoted) return true;
        }
        return false;
    }

    void take(char c) {
        if (c == '"') {
            quoted_ = !quoted_;
            is_name_ = separators_only_;
        } else if (!quoted_ && (separators_only_ ? is_blank(c) : c == ',')) {
            finish_word(!separators_only_);
        } else {
            word_ += c;
        }
    }

    void finish_word(bool keep_empty) {
        const size_t first = word_.find_first_not_of(" \t\r"), last = word_.find_last_not_of(" \t\r");
        word_ = first == word_.npos ? "" : word_.substr(first, last - first + 1);
        if (keep_empty || !word_.empty()) words_.push_back({word_, is_name_});
        word_.clear();
        is_name_ = false;
    }

    Words words_;
    std::string word_;
    bool quoted_ = false, is_name_ = false, separators_only_ = true;
};

std::optional<int32_t> number_of(const Word& word) {
    return word.is_name ? std::nullopt : whole_number(word.text);
}

struct Line {
    size_t number;
    Words words;
};

std::vector<Line> lines_of(std::string_view text) {
    std::vector<Line> lines;
    const char *p = text.data(), *const end = p + text.size();
    for (size_t number = 1; p != end; ++number, p = next_line(p, end)) {
        const char* at = p;
        const std::string_view line = read_rest(at, end);
        if (line.empty() || line.starts_with('#') || line.starts_with("//")) continue;
        // Quotes alone are no words.
        if (Words words = Splitter().split(line); !words.empty()) lines.push_back({number, std::move(words)});
    }
    return lines;
}

std::string joined_words(Words::const_iterator first, Words::const_iterator last) {
    std::string text;
    for (; first != last; ++first) text += (text.empty() ? "" : " ") + first->text;
    return text;
}

/// Reads the lines of one file.
class TextReader {
  public:
    explicit TextReader(const std::string& file) : file_(file) {}

    std::vector<ReadClass> read(std::vector<Line> lines) {
        const auto numbered = [](const Line& line) { return number_of(line.words.front()).has_value(); };
        std::vector<ReadClass> classes;
        if (std::ranges::none_of(lines, numbered)) {
            for (const Line& line : lines)
                classes.push_back(
                    {int32_t(classes.size()), joined_words(line.words.begin(), line.words.end()), {}});
            return classes;
        }
        if (!numbered(lines.front())) lines.erase(lines.begin());  // names of columns
        for (const Line& line : lines) classes.push_back(read(line));
        return classes;
    }

  private:
    ReadClass read(const Line& line) const {
        const Words& words = line.words;
        const std::optional<int32_t> label = number_of(words.front());
        if (!label) fail(line, fmt::format("expected a label, got '{}'", words.front().text));
        const auto is_number = [](const Word& word) { return number_of(word).has_value(); };
        const auto begin = words.begin() + 1, end = words.end();
        const auto first_word = std::find_if_not(begin, end, is_number);
        // Colour first, as ITK-SNAP has it, when the name comes last.
        if (first_word - begin >= 3 && first_word != end)
            return {*label, joined_words(first_word, end), color(line, begin)};
        const auto last_word = std::find_if_not(words.rbegin(), words.rend() - 1, is_number).base();
        const std::ptrdiff_t numbers = end - last_word;
        if (numbers == 0) return {*label, joined_words(begin, end), {}};
        if (numbers != 3 && numbers != 4)
            fail(line, fmt::format("expected 'LABEL NAME R G B', got {} numbers for the colour", numbers));
        return {*label, joined_words(begin, last_word), color(line, last_word)};
    }

    Rgb8 color(const Line& line, Words::const_iterator word) const {
        Rgb8 result;
        for (uint8_t& channel : result) {
            const int32_t value = *number_of(*word++);
            if (value < 0 || value > 255)
                fail(line, fmt::format("expected a colour of numbers from 0 to 255, got {}", value));
            channel = uint8_t(value);
        }
        return result;
    }

    [[noreturn]] void fail(const Line& line, const std::string& what) const {
        throw FormatError(
            fmt::format("cannot read a label map from {}, line {}: {}", file_, line.number, what));
    }

    const std::string& file_;
};

}  // namespace

std::vector<ReadClass> parse_label_text(std::string_view text, const std::string& file) {
    const std::vector<Line> lines = lines_of(text);
    if (lines.empty())
        throw FormatError(fmt::format("cannot read a label map from {}: it has no classes", file));
    return TextReader(file).read(lines);
}

std::string to_label_text(const LabelMap& map) {
    std::string text = "# label name red green blue\n";
    for (const LabelClass& own : map.classes()) {
        if (own.name.find_first_of("\"\n") != own.name.npos)
            throw FormatError(fmt::format(
                "cannot write label {} as text: its name holds a quote or a line's end; write JSON",
                own.label));
        text += fmt::format("{} \"{}\" {} {} {}\n", own.label, own.name, own.color[0], own.color[1],
                            own.color[2]);
    }
    return text;
}

}  // namespace easypbr::io
