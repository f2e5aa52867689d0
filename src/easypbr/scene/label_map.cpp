#include "easypbr/scene/label_map.h"

#include <fmt/format.h>

#include <algorithm>

#include "easypbr/core/error.h"
#include "easypbr/core/hash.h"
#include "easypbr/scene/label_colors.h"

namespace easypbr {
namespace {

/// Labels up to here above the first are looked up in a table.
constexpr int64_t longest_table = 1 << 16;

bool by_label(const LabelClass& a, const LabelClass& b) {
    return a.label < b.label;
}

void require_distinct(const std::string& name, const std::vector<LabelClass>& sorted) {
    for (size_t i = 1; i < sorted.size(); ++i)
        if (sorted[i].label == sorted[i - 1].label)
            throw ArgumentError(fmt::format("label map '{}': label {} occurs twice, as '{}' and '{}'", name,
                                            sorted[i].label, sorted[i - 1].name, sorted[i].name));
}

}  // namespace

LabelMap::LabelMap(std::string name, std::vector<LabelClass> classes, std::optional<int32_t> unlabelled,
                   UnknownLabels unknown)
    : name_(std::move(name)),
      classes_(std::move(classes)),
      unlabelled_(unlabelled),
      unknown_(unknown),
      revision_(next_revision()) {
    if (classes_.empty())
        throw ArgumentError(fmt::format("label map '{}': expected classes, got none", name_));
    std::stable_sort(classes_.begin(), classes_.end(), by_label);
    require_distinct(name_, classes_);
    const int64_t first = classes_.front().label;
    const int64_t span = int64_t(classes_.back().label) - first + 1;
    table_.assign(size_t(std::min(span, longest_table)), -1);
    for (size_t i = 0; i < classes_.size(); ++i)
        if (const int64_t at = classes_[i].label - first; at < longest_table) table_[size_t(at)] = int32_t(i);
    if (!unlabelled_) return;
    const LabelClass* none = find(*unlabelled_);
    if (!none)
        throw ArgumentError(fmt::format("label map '{}': the unlabelled class {} is not among the {}", name_,
                                        *unlabelled_, range_text()));
    unlabelled_color_ = none->color;
}

LabelMap LabelMap::generated(const std::vector<std::string>& names, std::string name) {
    const GeneratedColors colors(int32_t(names.size()));
    std::vector<LabelClass> classes;
    for (const std::string& own : names) {
        const int32_t label = int32_t(classes.size());
        classes.push_back({label, own, colors.color_of(label)});
    }
    return LabelMap(std::move(name), std::move(classes));
}

int32_t LabelMap::search(int32_t label) const {
    const auto found =
        std::lower_bound(classes_.begin(), classes_.end(), LabelClass{label, {}, {}}, by_label);
    return found != classes_.end() && found->label == label ? int32_t(found - classes_.begin()) : -1;
}

std::string LabelMap::range_text() const {
    return fmt::format("{} labels from {} to {}", classes_.size(), classes_.front().label,
                       classes_.back().label);
}

}  // namespace easypbr
