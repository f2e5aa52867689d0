#include "easypbr/app/font.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <utility>

#define STB_TRUETYPE_IMPLEMENTATION
#define STBTT_STATIC
#include <stb/stb_truetype.h>

// The font file as it stands in its package; EASYPBR_FONT_FILE is set by CMake.
__asm__(
    ".section .rodata\n"
    ".balign 16\n"
    "easypbr_font_begin:\n"
    ".incbin \"" EASYPBR_FONT_FILE
    "\"\n"
    "easypbr_font_end:\n"
    ".byte 0\n"
    ".previous\n");
extern "C" const unsigned char easypbr_font_begin[] __attribute__((visibility("hidden")));
extern "C" const unsigned char easypbr_font_end[] __attribute__((visibility("hidden")));

namespace easypbr::app {
namespace {

constexpr uint32_t replacement = 0xfffd;

const stbtt_fontinfo& font() {
    static const stbtt_fontinfo info = [] {
        stbtt_fontinfo result;
        stbtt_InitFont(&result, easypbr_font_begin, 0);
        return result;
    }();
    return info;
}

/// The next code point of UTF-8 text; U+FFFD for a byte that is none of it.
uint32_t next_code(std::string_view text, size_t& at) {
    const auto byte = [&](size_t i) { return i < text.size() ? uint8_t(text[i]) : 0u; };
    const uint32_t first = byte(at++);
    if (first < 0x80) return first;
    const int more = first >= 0xf0 && first < 0xf8 ? 3 : first >= 0xe0 ? 2 : first >= 0xc0 ? 1 : 0;
    if (more == 0 || first >= 0xf8) return replacement;
    uint32_t code = first & (0x3fu >> more);
    for (int i = 0; i < more; ++i, ++at) {
        if ((byte(at) & 0xc0) != 0x80) return replacement;
        code = code << 6 | (byte(at) & 0x3f);
    }
    return code;
}

struct FreeBitmap {
    void operator()(unsigned char* bitmap) const { stbtt_FreeBitmap(bitmap, nullptr); }
};

void draw_glyph(int glyph, float scale, float x, int baseline, const Coverage& cover) {
    const int left = int(std::floor(x));
    int width = 0, height = 0, dx = 0, dy = 0;
    const std::unique_ptr<unsigned char, FreeBitmap> bitmap(stbtt_GetGlyphBitmapSubpixel(
        &font(), scale, scale, x - float(left), 0, glyph, &width, &height, &dx, &dy));
    for (int row = 0; row < height; ++row)
        for (int column = 0; column < width; ++column)
            if (const unsigned char value = bitmap.get()[row * width + column])
                cover(left + dx + column, baseline + dy + row, float(value) / 255);
}

}  // namespace

std::span<const std::byte> font_file() {
    return std::as_bytes(std::span(easypbr_font_begin, easypbr_font_end));
}

std::vector<std::string> missing_characters(std::string_view text) {
    std::vector<std::string> missing;
    for (size_t at = 0; at < text.size();) {
        const size_t begin = at;
        const uint32_t code = next_code(text, at);
        if (code < 0x80 || stbtt_FindGlyphIndex(&font(), int(code)) != 0) continue;
        std::string character(text.substr(begin, at - begin));
        if (std::ranges::find(missing, character) == missing.end()) missing.push_back(std::move(character));
    }
    return missing;
}

Font::Font(float em) : scale_(stbtt_ScaleForMappingEmToPixels(&font(), em)) {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    stbtt_GetCodepointBox(&font(), 'H', &x0, &y0, &x1, &y1);
    cap_height_ = float(y1) * scale_;
}

template <class Visit>
float Font::lay_out(std::string_view text, float x, Visit&& visit) const {
    int before = 0;
    for (size_t at = 0; at < text.size();) {
        const int glyph = stbtt_FindGlyphIndex(&font(), int(next_code(text, at)));
        if (before) x += scale_ * float(stbtt_GetGlyphKernAdvance(&font(), before, glyph));
        visit(glyph, x);
        int advance = 0, bearing = 0;
        stbtt_GetGlyphHMetrics(&font(), glyph, &advance, &bearing);
        x += scale_ * float(advance);
        before = glyph;
    }
    return x;
}

float Font::width(std::string_view text) const {
    return lay_out(text, 0, [](int, float) {});
}

void Font::draw(std::string_view text, float x, int baseline, const Coverage& cover) const {
    lay_out(text, x,
            [&](int glyph, float at) { draw_glyph(glyph, scale_, std::round(at * 3) / 3, baseline, cover); });
}

}  // namespace easypbr::app
