// What is written; how it is drawn stands in annotation_drawing.cpp.
#include "easypbr/app/annotation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <set>

#include "easypbr/core/interrupt.h"
#include "easypbr/core/parallel.h"
#include "easypbr/scene/draw_style.h"
#include "easypbr/scene/label_colors.h"
#include "easypbr/scene/resolve.h"

namespace easypbr::app {
namespace {

constexpr size_t grain = 1 << 16;

std::set<int32_t> labels_in(const Array1i& labels) {
    const size_t count = size_t(labels.rows());
    std::vector<std::set<int32_t>> parts((count + grain - 1) / grain);
    parallel_chunks(count, grain, [&](size_t begin, size_t end) {
        std::set<int32_t>& part = parts[begin / grain];
        for (size_t i = begin; i < end; ++i) {
            const int32_t label = labels(Eigen::Index(i));
            if (i == begin || label != labels(Eigen::Index(i - 1))) part.insert(label);
        }
    });
    std::set<int32_t> all;
    for (std::set<int32_t>& part : parts) all.merge(part);
    return all;
}

LegendEntry unlabelled_entry(const LabelMap& map) {
    const LabelClass* own = map.unlabelled() ? map.find(*map.unlabelled()) : nullptr;
    return {own ? own->name : "unlabelled", map.unlabelled_color()};
}

std::vector<LegendEntry> entries_of(const std::set<int32_t>& labels, const LabelMap* map) {
    std::vector<LegendEntry> entries;
    std::set<std::pair<std::string, Rgb8>> known;
    const auto add = [&](LegendEntry entry) {
        check_interrupt(known.size());
        if (known.emplace(entry.name, entry.color).second) entries.push_back(std::move(entry));
    };
    const GeneratedColors generated(map || labels.empty() ? 0 : *labels.rbegin());
    for (const int32_t label : labels) {
        if (!map)
            add({label < 0 ? "unlabelled" : std::to_string(label), generated.color_of(label)});
        else if (const LabelClass* own = map->find(label))
            add({own->name.empty() ? std::to_string(label) : own->name, own->color});
        else
            add(unlabelled_entry(*map));
    }
    return entries;
}

/// Infinite values lie beyond any range.
void count_infinite(const Array1f& values, ValueRange& range) {
    constexpr float infinite = std::numeric_limits<float>::infinity();
    if ((values.array() == infinite).any()) range.data_max = infinite;
    if ((values.array() == -infinite).any()) range.data_min = -infinite;
}

/// The objects' names; those of equal names have a number behind them that makes no other object's name.
std::vector<std::string> distinct_names(const std::vector<SceneSnapshot::Object>& objects) {
    std::map<std::string, int> uses;
    for (const SceneSnapshot::Object& object : objects) ++uses[object.name];
    std::map<std::string, int> numbers;
    std::vector<std::string> names;
    for (const SceneSnapshot::Object& object : objects) {
        std::string name = object.name;
        if (uses.at(name) > 1) {
            do name = fmt::format("{} {}", object.name, ++numbers[object.name]);
            while (uses.contains(name));
        }
        names.push_back(std::move(name));
    }
    return names;
}

/// Gathers what the objects of a scene have in common.
class Collector {
  public:
    Collector(const SceneSnapshot& scene, const InferredSettings& settings) : settings_(settings) {
        const Vec3d up = parse_up(settings.camera.up);
        if (settings.annotation.colorbar) names_ = distinct_names(scene.objects);
        for (size_t i = 0; i < scene.objects.size(); ++i) {
            const SceneSnapshot::Object& object = scene.objects[i];
            const DrawStyle style = resolve_style(*object.mesh, settings.style);
            if (!style.visible || object.mesh->V.empty()) continue;
            add(i, *object.mesh,
                plan_colors(*object.mesh, settings.style, style.mode, object.T_world_mesh, up, scene.origin));
        }
    }

    std::vector<Legend> legends() const {
        std::vector<Legend> result;
        for (const auto& [map, labels] : labels_)
            result.push_back({settings_.annotation.title, entries_of(labels, map)});
        return result;
    }

    std::vector<ColorBar> bars() const {
        std::map<std::string, int> uses;
        for (const Shared& shared : bars_) ++uses[shared.bar.title];
        std::vector<ColorBar> result;
        for (const Shared& shared : bars_) {
            result.push_back(shared.bar);
            if (uses[shared.bar.title] > 1) result.back().title += shared.whose();
        }
        return result;
    }

  private:
    /// A bar of one object or several.
    struct Shared {
        ColorBar bar;
        std::string first;  ///< the first object's name
        int others = 0;

        std::string whose() const {
            return others ? fmt::format(" ({} + {} more)", first, others) : fmt::format(" ({})", first);
        }
    };

    /// `object`: its place in the scene.
    void add(size_t object, const MeshData& mesh, const ColorPlan& plan) {
        if (plan.by == ColorBy::label && settings_.annotation.legend) add_labels(mesh);
        const bool has_values =
            plan.by == ColorBy::scalar || plan.by == ColorBy::height || plan.by == ColorBy::intensity;
        if (has_values && settings_.annotation.colorbar) add_bar(names_[object], mesh, plan);
    }

    void add_labels(const MeshData& mesh) {
        const LabelMap* const map = mesh.label_map.get();
        auto known = std::ranges::find(labels_, map, &std::pair<const LabelMap*, std::set<int32_t>>::first);
        if (known == labels_.end()) known = labels_.insert(known, {map, {}});
        known->second.merge(labels_in(mesh.L));
    }

    void add_bar(const std::string& object, const MeshData& mesh, const ColorPlan& plan) {
        const Array1f values = plan_values(mesh, plan);
        ColorBar bar;
        bar.title = settings_.annotation.title.empty() ? title_of(plan) : settings_.annotation.title;
        bar.range = plan_range(values, plan);
        count_infinite(values, bar.range);
        bar.table = plan_table(plan);
        if (values.array().isNaN().any()) bar.nan_color = opaque(to_rgb8(plan.nan_color));
        const auto same = [&](const Shared& other) {
            const bool differ =
                other.bar.nan_color && bar.nan_color && *other.bar.nan_color != *bar.nan_color;
            return !differ && other.bar.title == bar.title && other.bar.range.min == bar.range.min &&
                   other.bar.range.max == bar.range.max && other.bar.range.scale == bar.range.scale &&
                   other.bar.range.base == bar.range.base && other.bar.range.parts == bar.range.parts &&
                   other.bar.table == bar.table;
        };
        const auto known = std::ranges::find_if(bars_, same);
        if (known == bars_.end())
            bars_.push_back({bar, object});
        else
            join(*known, bar);
    }

    static void join(Shared& shared, const ColorBar& other) {
        ColorBar& bar = shared.bar;
        bar.range.data_min = std::min(bar.range.data_min, other.range.data_min);
        bar.range.data_max = std::max(bar.range.data_max, other.range.data_max);
        if (!bar.nan_color) bar.nan_color = other.nan_color;
        ++shared.others;
    }

    static std::string title_of(const ColorPlan& plan) {
        return plan.by == ColorBy::scalar ? plan.scalar : plan.by == ColorBy::height ? "height" : "intensity";
    }

    const InferredSettings& settings_;
    std::vector<std::string> names_;                                     ///< of the objects, for bars
    std::vector<std::pair<const LabelMap*, std::set<int32_t>>> labels_;  ///< in the order of the scene
    std::vector<Shared> bars_;
};

/// The least of 1, 2, 5 times a power of ten that is at least this.
double round_step(double least) {
    const double power = std::pow(10.0, std::floor(std::log10(least)));
    for (const double factor : {1.0, 2.0, 5.0})
        if (factor * power >= least * (1 - 1e-9)) return factor * power;
    return 10 * power;
}

/// Digits after the point that tell multiples of a step apart.
int digits_of(double step) {
    return std::max(0, int(-std::floor(std::log10(step) + 1e-9)));
}

/// A number without the zeros at its end: 1.5e6 is "15" and 6.
struct Decimal {
    bool negative = false;
    std::string digits;  ///< none: 0
    int exponent = 0;    ///< of the first digit
};

/// So many steps, which are 1, 2 or 5 times a power of ten.
Decimal decimal_of(double count, double step) {
    const int power = int(std::floor(std::log10(step) + 1e-9));
    const long long units = std::llround(count) * std::llround(step / std::pow(10.0, power));
    Decimal decimal{units < 0, std::to_string(std::abs(units)), power};
    decimal.exponent += int(decimal.digits.size()) - 1;
    decimal.digits.erase(decimal.digits.find_last_not_of('0') + 1);
    return decimal;
}

/// With so many digits in all: "5e6", "5.0e6".
std::string scientific_text(const Decimal& decimal, size_t digits) {
    if (decimal.digits.empty()) return "0";
    std::string text = decimal.digits + std::string(digits - decimal.digits.size(), '0');
    if (digits > 1) text.insert(1, ".");
    return fmt::format("{}{}e{}", decimal.negative ? "\u2212" : "", text, decimal.exponent);
}

/// With so many digits after the point.
std::string fixed_text(double value, int digits) {
    std::string text = fmt::format("{:.{}f}", value, digits);
    if (text.starts_with('-')) text.replace(0, 1, "\u2212");
    return text;
}

/// All ticks have one format: as many digits after the point as the tick that needs the most.
std::vector<Tick> ticks_at(const std::vector<double>& counts, double step, double magnitude) {
    const bool scientific = magnitude >= 1e6 || magnitude < 1e-3;
    size_t digits = 1;
    for (const double count : counts) digits = std::max(digits, decimal_of(count, step).digits.size());
    std::vector<Tick> ticks;
    for (const double count : counts) {
        const double value = count == 0 ? 0 : count * step;  // no negative zero
        ticks.push_back({value, scientific ? scientific_text(decimal_of(count, step), digits)
                                           : fixed_text(value, digits_of(step))});
    }
    return ticks;
}

}  // namespace

std::vector<Tick> ticks_of(double min, double max, int most) {
    most = std::max(1, most);
    double step = round_step((max - min) / most);
    const auto first = [&] { return std::ceil(min / step - 1e-6); };
    const auto last = [&] { return std::floor(max / step + 1e-6); };
    const auto count = [&] { return last() - first() + 1; };
    while (count() > most) step = round_step(step * 1.5);
    // Too few: of the next finer distance the outermost, where all are too many.
    while (count() < std::min(2, most)) step = round_step(step * 0.4);
    const double magnitude = std::max(std::abs(min), std::abs(max));
    std::vector<double> counts;
    if (count() <= most)
        for (double k = first(); k <= last(); ++k) counts.push_back(k);
    else
        counts = most == 1 ? std::vector{last()} : std::vector{first(), last()};
    return ticks_at(counts, step, magnitude);
}

namespace {

/// 1, 2 or 5 times a power of ten.
struct LogTick {
    int factor, exponent;
    double value() const { return factor * std::pow(10.0, exponent); }
};

/// All within the range, the least first. The ends are as float32 holds them.
std::vector<LogTick> log_ticks(double min, double max) {
    constexpr double rounding = 1e-6;
    std::vector<LogTick> ticks;
    const int first = int(std::floor(std::log10(min))), last = int(std::ceil(std::log10(max)));
    for (int exponent = first; exponent <= last; ++exponent)
        for (const int factor : {1, 2, 5})
            if (const LogTick tick{factor, exponent};
                tick.value() >= min * (1 - rounding) && tick.value() <= max * (1 + rounding))
                ticks.push_back(tick);
    return ticks;
}

std::vector<LogTick> powers_of_ten(const std::vector<LogTick>& ticks) {
    std::vector<LogTick> powers;
    std::ranges::copy_if(ticks, std::back_inserter(powers), [](const LogTick& t) { return t.factor == 1; });
    return powers;
}

/// Every n-th, with the last, so that there are no more than `most`.
std::vector<LogTick> thinned(const std::vector<LogTick>& ticks, size_t most) {
    const size_t stride = std::max<size_t>(1, (ticks.size() + most - 1) / most);
    std::vector<LogTick> kept;
    for (size_t from_last = 0; from_last < ticks.size(); from_last += stride)
        kept.push_back(ticks[ticks.size() - 1 - from_last]);
    std::ranges::reverse(kept);
    return kept;
}

std::vector<Tick> ticks_with_text(const std::vector<LogTick>& log_ticks) {
    const bool plain = log_ticks.front().exponent >= -3 && log_ticks.back().exponent < 6;
    std::vector<Tick> ticks;
    for (const LogTick& tick : log_ticks)
        ticks.push_back({tick.value(), plain ? fixed_text(tick.value(), std::max(0, -tick.exponent))
                                             : fmt::format("{}e{}", tick.factor, tick.exponent)});
    return ticks;
}

/// Whether ticks of a linear scale lie far enough from each other on a logarithmic bar, too, which has room
/// for `most`.
bool has_room(const std::vector<Tick>& ticks, const ValueRange& range, int most) {
    for (size_t i = 1; i < ticks.size(); ++i)
        // Not a number where a tick is 0, just below the range.
        if (!(place_of(ticks[i], range) - place_of(ticks[i - 1], range) >= 1.0 / (most + 1))) return false;
    return true;
}

}  // namespace

double place_of(const Tick& tick, const ValueRange& range) {
    return place_on_scale(tick.value - range.base, range);
}

std::vector<Tick> ticks_of(const ValueRange& range, int most) {
    most = std::max(1, most);
    const std::vector<Tick> linear = ticks_of(range.true_min(), range.true_max(), most);
    if (range.scale == ColorScale::linear) return linear;
    constexpr size_t enough = 3;  // of 1, 2 and 5, before other ticks are looked for
    const std::vector<LogTick> fine = log_ticks(range.true_min(), range.true_max()),
                               powers = powers_of_ten(fine);
    if (fine.size() >= enough && fine.size() <= size_t(most)) return ticks_with_text(fine);
    if (linear.size() > 1 && has_room(linear, range, most)) return linear;
    if (powers.size() > 1) return ticks_with_text(thinned(powers, size_t(most)));
    if (fine.size() > 1) return ticks_with_text(thinned(fine, size_t(most)));
    return linear.size() > 1 ? std::vector{linear.front(), linear.back()} : linear;
}

Annotation annotation_of(const SceneSnapshot& scene, const InferredSettings& settings) {
    if (!settings.annotation.legend && !settings.annotation.colorbar) return {};
    const Collector found(scene, settings);
    return {found.legends(), found.bars()};
}

}  // namespace easypbr::app
