// What a picture's colours mean, written into it: legends of labels, colour bars of values.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "easypbr/app/canvas.h"
#include "easypbr/scene/element_colors.h"
#include "easypbr/scene/resolve.h"
#include "easypbr/scene/settings.h"

namespace easypbr::app {

struct LegendEntry {
    std::string name;
    Rgb8 color{};

    bool operator==(const LegendEntry&) const = default;
};

/// The classes that occur in the data of what is coloured by labels, by rising label.
struct Legend {
    std::string title;
    std::vector<LegendEntry> entries;
};

/// A colormap with the values that it stands for.
struct ColorBar {
    std::string title;
    ValueRange range;
    std::array<Rgba8, 256> table{};
    std::optional<Rgba8> nan_color;  ///< given where values are missing
};

struct Annotation {
    std::vector<Legend> legends;
    std::vector<ColorBar> bars;

    bool empty() const { return legends.empty() && bars.empty(); }
};

/// What the settings ask for of the visible objects: a legend for each label map, a colour bar for each name,
/// range, colormap and colour of missing values. Bars of the same title have the name of their object added,
/// with a number where several objects have it.
Annotation annotation_of(const SceneSnapshot& scene, const InferredSettings& settings);

/// The side of a picture of this size that the annotation takes, beside or above and below, whichever is
/// less. Nothing where that is more than a third.
Insets annotation_strip(const Annotation& annotation, const BasicAnnotationSettings<Inferred>& settings,
                        Vec2i size);

/// Legends and colour bars that a picture of this size has no room for, even in the smallest text.
int annotations_left_out(const Annotation& annotation, const BasicAnnotationSettings<Inferred>& settings,
                         Vec2i size);

/// Draws it from the settings' corner inwards, next to each other. Sizes are parts of the picture's shorter
/// side, but text is at least 11 pixels high where that fits, and up to a third smaller where only that fits
/// into a third of the picture. Longer titles are shortened; of those that begin alike, what they share.
void draw_annotation(const Annotation& annotation, const BasicAnnotationSettings<Inferred>& settings,
                     Image& picture);

struct Tick {
    double value = 0;  ///< the true one (see ValueRange)
    std::string text;  ///< all of a bar in one format, with as many digits as tell them apart
};
/// Multiples of a round distance, 1, 2 or 5 times a power of ten, from `min` to `max` (larger): at most
/// `most` of them, and two at least where `most` is. All of them, or the least and the largest.
std::vector<Tick> ticks_of(double min, double max, int most);
/// Of a logarithmic scale 1, 2 and 5 times powers of ten where `most` is enough for all of them, else powers
/// of ten; those of a linear scale, or two of them, where the range holds hardly any of these.
std::vector<Tick> ticks_of(const ValueRange& range, int most);
/// place_on_scale() of a tick.
double place_of(const Tick& tick, const ValueRange& range);

}  // namespace easypbr::app
