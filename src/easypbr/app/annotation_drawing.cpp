#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "easypbr/app/annotation.h"
#include "easypbr/app/font.h"
#include "easypbr/scene/settings.h"

namespace easypbr::app {
namespace {

// Lengths in units of the text's size.
constexpr float margin = 0.8f, padding = 0.6f, gap = 0.6f;
constexpr float row_height = 1.4f, swatch_size = 0.95f, swatch_gap = 0.5f, column_gap = 1.2f;
constexpr float bar_width = 1.1f, longest_bar = 14, tick_length = 0.35f, tick_width = 0.07f, tick_gap = 0.3f,
                arrow_height = 0.7f;
/// Part of the picture that an automatic camera leaves to annotations, at most.
constexpr double largest_strip = 1.0 / 3;
/// Small text: 11 pixels from the top of its capitals to the end of its descenders, which are 0.965 of its
/// size.
constexpr float small_text = 11.4f;
/// Nothing is readable below.
constexpr float smallest_text = 7;
/// Part of the size asked for that text keeps at least where it is made smaller for the strip.
constexpr float kept_size = 2.0f / 3;

const Rgb8 dark_ink{16, 16, 16}, light_ink{245, 245, 245}, dark_panel{0, 0, 0}, light_panel{255, 255, 255};
/// How much of what is behind is covered.
constexpr float panel_alpha = 0.75f;

constexpr std::string_view ellipsis = "\u2026";

bool is_within_character(char byte) {
    return (uint8_t(byte) & 0xc0) == 0x80;  // UTF-8
}

/// Bytes of the longest beginning that two texts share, in whole characters.
size_t shared_beginning(const std::string& a, const std::string& b) {
    size_t end = size_t(std::ranges::mismatch(a, b).in1 - a.begin());
    while (end > 0 && end < a.size() && is_within_character(a[end])) --end;
    return end;
}

/// How much room text of one size takes.
class TextMetrics {
  public:
    explicit TextMetrics(float em) : em_(em), font_(em) {}

    /// Whole pixels of a length in units of the text's size.
    int px(float length) const { return int(std::lround(length * em_)); }
    int width(const std::string& text) const { return int(std::ceil(font_.width(text))); }
    const Font& font() const { return font_; }

    /// The text, or the longest beginning that is no wider than the room together with an ellipsis; nothing
    /// if not even that fits.
    std::string shortened(const std::string& text, int room) const {
        return width(text) <= room ? text : cut(text, ellipsis, room);
    }

    /// The same beside others. Where the beginning does not tell it apart from some of them, what it shares
    /// with these is left out instead, as far as need be.
    std::string shortened_beside(std::span<const std::string> others, const std::string& text,
                                 int room) const {
        const std::string plain = shortened(text, room);
        if (plain == text) return text;
        const size_t kept = plain.size() - std::min(plain.size(), ellipsis.size());
        size_t shared = text.size();
        for (const std::string& other : others) {
            const size_t same = shared_beginning(text, other);
            if (same >= kept) shared = std::min(shared, same);
        }
        if (shared == 0 || shared == text.size()) return plain;
        const std::string end = fmt::format("{}{}", ellipsis, text.substr(shared));
        if (width(end) <= room) return cut(text.substr(0, shared), end, room);
        const std::string middle = cut(end, ellipsis, room);
        return middle.size() > 2 * ellipsis.size() ? middle : plain;
    }

  private:
    /// The longest beginning of a text that is no wider than the room together with what follows it; nothing
    /// if not even that fits.
    std::string cut(const std::string& text, std::string_view after, int room) const {
        std::string fits;
        for (size_t end = 0; end <= text.size(); ++end) {
            if (end < text.size() && is_within_character(text[end])) continue;
            std::string next = text.substr(0, end).append(after);
            if (width(next) > room) break;
            fits = std::move(next);
        }
        return fits;
    }

    float em_;
    Font font_;
};

/// Writes on a canvas in one size and colour.
class Pen : public TextMetrics {
  public:
    Pen(Canvas& canvas, const TextMetrics& metrics) : TextMetrics(metrics), canvas_(canvas) {}

    Canvas& canvas() { return canvas_; }
    void set_ink(const Rgb8& ink) { ink_ = ink; }
    const Rgb8& ink() const { return ink_; }

    /// Text whose capitals are centred on the row from `y` on, `height` pixels high.
    void write(const std::string& text, int x, int y, int height) {
        const int baseline = y + int(std::lround((float(height) + font().cap_height()) / 2));
        font().draw(text, float(x), baseline,
                    [&](int px, int py, float coverage) { canvas_.blend(px, py, ink_, coverage); });
    }

  private:
    Canvas& canvas_;
    Rgb8 ink_{};
};

/// Something of known size that is drawn at a place.
struct Block {
    int width = 0, height = 0;
    bool is_whole = true;  ///< nothing is left out or shortened
    std::function<void(Pen&, int x, int y)> draw;
};

enum class Titles {
    whole,  ///< a shortened one leaves its block incomplete
    cut     ///< to their block's part of the strip
};

/// What a block may take.
struct Room {
    int x, y;
    int title;  ///< width
    Titles titles;
    std::span<const std::string> all_titles;  ///< of all blocks
};

Block titled(const TextMetrics& metrics, const std::string& text, const Room& room, Block block) {
    if (text.empty()) return block;
    const std::string title =
        metrics.shortened_beside(room.all_titles, text, std::max(room.title, block.width));
    const int row = metrics.px(row_height);
    const bool is_whole = block.is_whole && (room.titles == Titles::cut || title == text);
    return {std::max(block.width, metrics.width(title)), block.height + row, is_whole,
            [title, row, inner = block.draw](Pen& p, int x, int y) {
                p.write(title, x, y, row);
                inner(p, x, y + row);
            }};
}

/// Columns of swatches with names, which are shortened where one column would be too wide. Of entries that
/// cannot fit no name is measured.
class LegendLayout {
  public:
    LegendLayout(const TextMetrics& metrics, const Legend& legend, int room_x, int room_y)
        : row_(metrics.px(row_height)),
          swatch_(metrics.px(swatch_size)),
          text_x_(swatch_ + metrics.px(swatch_gap)),
          column_gap_(metrics.px(column_gap)) {
        const int title = legend.title.empty() ? 0 : row_;
        const size_t most_rows = size_t(std::max(1, (room_y - title) / row_));
        const size_t most_columns = size_t(std::max(1, (room_x + column_gap_) / (text_x_ + column_gap_)));
        const size_t count = legend.entries.size();
        const size_t needed = std::max<size_t>(1, (count + most_rows - 1) / most_rows);
        take(metrics, legend, std::min(count, most_rows * most_columns), room_x - text_x_);
        if (needed <= most_columns) {
            place((count + needed - 1) / needed);
            if (needed == 1 || width() <= room_x) return;
        }
        // They do not fit: the last row says so.
        is_whole_ = false;
        for (size_t columns = std::min(needed - 1, most_columns);; --columns) {
            shown_.resize(columns * most_rows - 1);
            rest_ = metrics.shortened(fmt::format("+ {} more", count - shown_.size()), room_x);
            rest_width_ = metrics.width(rest_);
            place(most_rows);
            if (columns == 1 || width() <= room_x) return;
        }
    }

    int width() const { return x_.back() - column_gap_; }
    int height() const { return int(rows_) * row_; }
    bool is_whole() const { return is_whole_; }

    void draw(Pen& pen, int x, int y) const {
        for (size_t i = 0; i < shown_.size(); ++i) {
            const int at_x = x + x_[i / rows_], at_y = y + int(i % rows_) * row_;
            pen.canvas().fill({at_x, at_y + (row_ - swatch_) / 2, swatch_, swatch_}, shown_[i].color);
            pen.write(shown_[i].name, at_x + text_x_, at_y, row_);
        }
        if (!rest_.empty()) pen.write(rest_, x + x_[x_.size() - 2], y + int(rows_ - 1) * row_, row_);
    }

  private:
    struct Shown : LegendEntry {
        int width;  ///< of the name
    };

    void take(const TextMetrics& metrics, const Legend& legend, size_t count, int room) {
        for (const LegendEntry& entry : std::span(legend.entries).first(count)) {
            const std::string name = metrics.shortened(entry.name, room);
            is_whole_ &= name == entry.name;
            shown_.push_back({{name, entry.color}, metrics.width(name)});
        }
    }

    /// Columns of some rows: where each begins, and where the next one would.
    void place(size_t rows) {
        rows_ = std::max<size_t>(1, rows);
        const size_t count = shown_.size() + (rest_.empty() ? 0 : 1);
        x_ = {0};
        for (size_t first = 0; first < count || x_.size() == 1; first += rows_) {
            int widest = first + rows_ >= count ? rest_width_ : 0;
            for (size_t i = first; i < std::min(shown_.size(), first + rows_); ++i)
                widest = std::max(widest, text_x_ + shown_[i].width);
            x_.push_back(x_.back() + widest + column_gap_);
        }
    }

    int row_, swatch_, text_x_, column_gap_, rest_width_ = 0;
    size_t rows_ = 1;
    bool is_whole_ = true;
    std::vector<Shown> shown_;
    std::string rest_;
    std::vector<int> x_;
};

Block legend_block(const TextMetrics& metrics, const Legend& legend, const Room& room) {
    const LegendLayout layout(metrics, legend, room.x, room.y);
    return titled(metrics, legend.title, room,
                  {layout.width(), layout.height(), layout.is_whole(),
                   [layout](Pen& p, int x, int y) { layout.draw(p, x, y); }});
}

Rgb8 rgb(const Rgba8& color) {
    return {color[0], color[1], color[2]};
}

/// A triangle that points away from the bar's end: values go on beyond it.
void draw_arrow(Pen& pen, int x, int y, int width, int height, const Rgb8& color, bool up) {
    for (int row = 0; row < height; ++row) {
        const int from_tip = up ? row : height - 1 - row;
        const int half = std::max(1, width * (from_tip + 1) / (2 * height));
        pen.canvas().fill({x + width / 2 - half, y + row, 2 * half, 1}, color);
    }
}

/// The bar with its ticks, the largest value on top.
struct BarLayout {
    int bar = 0, height = 0, arrow = 0, top = 0, tick = 0, text_x = 0;
    std::vector<Tick> ticks;
};

int tick_row(const BarLayout& layout, const ValueRange& range, const Tick& tick) {
    const double t = place_of(tick, range);
    const int row = int(std::lround((1 - t) * layout.height - 0.5));
    return layout.top + std::clamp(row, 0, layout.height - 1);
}

void draw_bar(Pen& pen, const ColorBar& bar, const BarLayout& layout, int x, int y) {
    for (int row = 0; row < layout.height; ++row) {
        const float t = (float(layout.height - 1 - row) + 0.5f) / float(layout.height);
        const Rgba8& color =
            bar.table[size_t(std::min(bar.range.parts - 1, int(t * float(bar.range.parts))))];
        pen.canvas().fill({x, y + layout.top + row, layout.bar, 1}, rgb(color));
    }
    if (bar.range.clips_above()) draw_arrow(pen, x, y, layout.bar, layout.arrow, rgb(bar.table[255]), true);
    if (bar.range.clips_below())
        draw_arrow(pen, x, y + layout.top + layout.height, layout.bar, layout.arrow, rgb(bar.table[0]),
                   false);
    const int row_pixels = pen.px(row_height);
    for (const Tick& tick : layout.ticks) {
        const int at = y + tick_row(layout, bar.range, tick);
        pen.canvas().fill({x + layout.bar, at, layout.tick, std::max(1, pen.px(tick_width))}, pen.ink());
        pen.write(tick.text, x + layout.text_x, at - row_pixels / 2, row_pixels);
    }
}

/// Rows of a bar that two ticks take.
constexpr int least_rows = 2;

/// Height of a picture in which all of a bar fits, in units of the text's size.
float least_height(const ColorBar& bar) {
    // The ends take half a row each, or an arrow, which is as long.
    const int rows = least_rows + 1 + (bar.title.empty() ? 0 : 1) + (bar.nan_color ? 1 : 0);
    return 2 * (margin + padding) + float(rows) * row_height;
}

/// What does not fit above or below the bar is left out: its title, then the swatch of missing values.
ColorBar fitting(ColorBar bar, int room_y, int row) {
    const auto fits = [&] {
        const int others = 1 + (bar.title.empty() ? 0 : 1) + (bar.nan_color ? 1 : 0);
        return room_y >= (others + 1) * row;
    };
    if (!fits()) bar.title.clear();
    if (!fits()) bar.nan_color.reset();
    return bar;
}

std::vector<Tick> ticks_within(const ValueRange& range, int height, int row) {
    std::vector<Tick> ticks = ticks_of(range, std::max(2, height / (2 * row)));
    if (height < least_rows * row && ticks.size() > 1) ticks.erase(ticks.begin(), ticks.end() - 1);
    return ticks;
}

Block bar_block(const TextMetrics& metrics, const ColorBar& given, const Room& room) {
    const int row = metrics.px(row_height), half_row = row / 2;
    const ColorBar bar = fitting(given, room.y, row);
    BarLayout layout;
    layout.bar = metrics.px(bar_width);
    layout.arrow = metrics.px(arrow_height);
    layout.tick = metrics.px(tick_length);
    layout.text_x = layout.bar + layout.tick + metrics.px(tick_gap);
    // The texts of the ends reach beyond the bar by half a row.
    layout.top = bar.range.clips_above() ? std::max(layout.arrow, half_row) : half_row;
    const int below = bar.range.clips_below() ? std::max(layout.arrow, half_row) : half_row;
    const int others = layout.top + below + (bar.nan_color ? row : 0) + (bar.title.empty() ? 0 : row);
    layout.height = std::max(2, std::min(metrics.px(longest_bar), room.y - others));
    layout.ticks = ticks_within(bar.range, layout.height, row);
    int widest = 0;
    for (const Tick& tick : layout.ticks) widest = std::max(widest, metrics.width(tick.text));
    const std::string missing = "no value";
    const int nan_y = layout.top + layout.height + below, swatch = metrics.px(swatch_size);
    if (bar.nan_color) widest = std::max(widest, metrics.width(missing));
    const auto draw = [=](Pen& p, int x, int y) {
        // An arrow stands right above its bar.
        const int arrow_y = layout.top - layout.arrow;
        BarLayout placed = layout;
        placed.top = layout.arrow;
        draw_bar(p, bar, placed, x, y + arrow_y);
        if (!bar.nan_color) return;
        p.canvas().fill({x + (layout.bar - swatch) / 2, y + nan_y + (row - swatch) / 2, swatch, swatch},
                        rgb(*bar.nan_color));
        p.write(missing, x + layout.text_x, y + nan_y, row);
    };
    const bool is_whole = bar.title == given.title && bar.nan_color == given.nan_color;
    return titled(metrics, bar.title, room,
                  {layout.text_x + widest, nan_y + (bar.nan_color ? row : 0), is_whole, draw});
}

bool at_right(Corner corner) {
    return corner == Corner::top_right || corner == Corner::bottom_right;
}
bool at_bottom(Corner corner) {
    return corner == Corner::bottom_left || corner == Corner::bottom_right;
}

/// A panel that text stands out from, dark on dark and light on light pictures, and the block on it.
void draw_block(Pen& pen, const Block& block, const PixelRect& panel) {
    const bool dark = pen.canvas().brightness(panel) < 0.5f;
    pen.canvas().fill(panel, dark ? dark_panel : light_panel, panel_alpha);
    pen.set_ink(dark ? light_ink : dark_ink);
    block.draw(pen, panel.x + pen.px(padding), panel.y + pen.px(padding));
}

/// The blocks of an annotation on their panels, next to each other from the corner of a picture inwards. What
/// the picture has no room for is left out.
class AnnotationLayout {
  public:
    AnnotationLayout(const Annotation& annotation, Corner corner, Vec2i picture, float em, Titles titles)
        : metrics_(em),
          corner_(corner),
          picture_(picture),
          titles_(titles),
          count_(int(annotation.legends.size() + annotation.bars.size())),
          used_(border()) {
        for (const Legend& legend : annotation.legends) all_titles_.push_back(legend.title);
        for (const ColorBar& bar : annotation.bars) all_titles_.push_back(bar.title);
        for (const Legend& legend : annotation.legends) place(legend_block(metrics_, legend, room()));
        for (const ColorBar& bar : annotation.bars) place(bar_block(metrics_, bar, room()));
    }

    int left_out() const { return count_ - int(panels_.size()); }
    /// Whether all of it is shown, in a strip that an automatic camera leaves free.
    bool fits() const { return is_whole_ && left_out() == 0 && strip() != Insets(); }

    Insets strip() const {
        const double across = double(used_) / picture_.x(),
                     along = double(border() + tallest_ + metrics_.px(gap)) / picture_.y();
        Insets insets;
        if (panels_.empty() || std::min(across, along) > largest_strip) return insets;
        if (across <= along)
            (at_right(corner_) ? insets.right : insets.left) = across;
        else
            (at_bottom(corner_) ? insets.bottom : insets.top) = along;
        return insets;
    }

    void draw(Canvas& canvas) const {
        Pen pen(canvas, metrics_);
        for (const auto& [block, panel] : panels_) draw_block(pen, block, panel);
    }

  private:
    int border() const { return metrics_.px(margin); }
    int pad() const { return metrics_.px(padding); }

    Room room() const {
        const int x = picture_.x() - used_ - border() - 2 * pad();
        const int y = picture_.y() - 2 * (border() + pad());
        const int share = int((largest_strip * picture_.x() - border()) / count_);
        return {x, y, titles_ == Titles::cut ? share - metrics_.px(gap) - 2 * pad() : x, titles_,
                all_titles_};
    }

    void place(const Block& block) {
        const int width = block.width + 2 * pad(), height = block.height + 2 * pad();
        const int x = at_right(corner_) ? picture_.x() - used_ - width : used_;
        const int y = at_bottom(corner_) ? picture_.y() - border() - height : border();
        if (x < 0 || y < 0 || x + width > picture_.x() || y + height > picture_.y()) return;
        panels_.push_back({block, {x, y, width, height}});
        used_ += width + metrics_.px(gap);
        tallest_ = std::max(tallest_, height);
        is_whole_ &= block.is_whole;
    }

    struct Panel {
        Block block;
        PixelRect rect;
    };
    TextMetrics metrics_;
    Corner corner_;
    Vec2i picture_;
    Titles titles_;
    int count_;        ///< of blocks that are asked for
    int used_;         ///< of the picture's width, from the corner inwards
    int tallest_ = 0;  ///< panel's height
    bool is_whole_ = true;
    std::vector<std::string> all_titles_;
    std::vector<Panel> panels_;
};

/// Sizes to try for a layout that fits the strip: small text is made larger first, then what is asked for
/// smaller.
std::vector<float> strip_sizes(float asked, float most) {
    std::vector<float> sizes;
    for (float em = std::min(small_text, most); em > asked; em -= 1) sizes.push_back(em);
    for (float em = asked; em >= std::max(smallest_text, kept_size * asked); em -= 1) sizes.push_back(em);
    return sizes;
}

/// Text as large as asked for, or as small as a bar needs to fit into the height. The first that fits the
/// strip, if need be with shortened titles, else the largest from which nothing is left out.
AnnotationLayout laid_out(const Annotation& annotation, const BasicAnnotationSettings<Inferred>& settings,
                          Vec2i picture) {
    const float height = float(picture.y());
    float most = height;
    for (const ColorBar& bar : annotation.bars) most = std::min(most, height / least_height(bar));
    const float given = settings.text_size * float(picture.minCoeff());
    const float asked = std::max(smallest_text, std::min(given, most));
    const auto with = [&](float em, Titles titles) {
        return AnnotationLayout(annotation, settings.corner, picture, em, titles);
    };
    const std::vector<float> sizes = strip_sizes(asked, most);
    for (const Titles titles : {Titles::whole, Titles::cut}) {
        if (!with(sizes.back(), titles).fits()) continue;  // Larger ones take more room.
        for (const float em : sizes)
            if (AnnotationLayout layout = with(em, titles); layout.fits()) return layout;
    }
    for (float em = asked; em > smallest_text; em -= 1)
        if (AnnotationLayout layout = with(em, Titles::cut); layout.left_out() == 0) return layout;
    return with(smallest_text, Titles::cut);
}

}  // namespace

Insets annotation_strip(const Annotation& annotation, const BasicAnnotationSettings<Inferred>& settings,
                        Vec2i size) {
    return annotation.empty() ? Insets{} : laid_out(annotation, settings, size).strip();
}

int annotations_left_out(const Annotation& annotation, const BasicAnnotationSettings<Inferred>& settings,
                         Vec2i size) {
    return annotation.empty() ? 0 : laid_out(annotation, settings, size).left_out();
}

void draw_annotation(const Annotation& annotation, const BasicAnnotationSettings<Inferred>& settings,
                     Image& picture) {
    if (annotation.empty()) return;
    Canvas canvas(picture);
    laid_out(annotation, settings, {picture.width(), picture.height()}).draw(canvas);
}

}  // namespace easypbr::app
