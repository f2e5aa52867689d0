// The embedded font, as coverage of pixels.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace easypbr::app {

/// Called for every pixel that text touches, with the part of it that is covered, 0 to 1.
using Coverage = std::function<void(int x, int y, float coverage)>;

/// The embedded font's file (TrueType).
std::span<const std::byte> font_file();

/// The characters of a text that the font lacks, in UTF-8, each once.
std::vector<std::string> missing_characters(std::string_view text);

/// DejaVu Sans in one size. Text is UTF-8; what the font lacks is a box.
class Font {
  public:
    /// `em` is the size of the font in pixels.
    explicit Font(float em);

    /// Height of capital letters, in pixels.
    float cap_height() const { return cap_height_; }
    float width(std::string_view text) const;

    /// Text that begins at `x` with its baseline at the pixel border `baseline`. Glyphs begin at whole
    /// pixels' thirds, so that their distances are even.
    void draw(std::string_view text, float x, int baseline, const Coverage& cover) const;

  private:
    /// Calls visit(glyph, x) for each of the text's glyphs and returns where the text ends.
    template <class Visit>
    float lay_out(std::string_view text, float x, Visit&& visit) const;

    float scale_, cap_height_;
};

}  // namespace easypbr::app
