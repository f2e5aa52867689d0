// LabelMap: what integer labels mean: a name and a colour for each class.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "easypbr/core/color.h"

namespace easypbr {

/// The label of what has none. Negative labels mean that in most data sets.
inline constexpr int32_t no_label = -1;

struct LabelClass {
    int32_t label = 0;
    std::string name;
    Rgb8 color{};
};

/// What becomes of labels of at least 0 that the map does not have.
enum class UnknownLabels {
    refused,     ///< a mesh does not take them: they mean that it is another data set's map
    unlabelled,  ///< they are shown as the unlabelled class
};

/// Immutable. Labels may have gaps, as SemanticKITTI's 0 to 259. Negative labels that
/// the map does not have are shown as the unlabelled class.
class LabelMap {
  public:
    /// `unlabelled` is the label of the class of what has no label; without one it is a grey. Throws
    /// ArgumentError when there is no class, when a label occurs twice or when `unlabelled` is none of them.
    LabelMap(std::string name, std::vector<LabelClass> classes,
             std::optional<int32_t> unlabelled = std::nullopt,
             UnknownLabels unknown = UnknownLabels::refused);

    // Moving copies: there is always a class.
    LabelMap(const LabelMap& other) = default;
    LabelMap& operator=(const LabelMap& other) = default;

    /// Labels 0, 1, 2, ... with these names, in generated colours.
    static LabelMap generated(const std::vector<std::string>& names, std::string name = "generated");

    const std::string& name() const { return name_; }
    /// By rising label.
    const std::vector<LabelClass>& classes() const { return classes_; }
    std::optional<int32_t> unlabelled() const { return unlabelled_; }
    UnknownLabels unknown() const { return unknown_; }

    /// Whether meshes take the label.
    bool accepts(int32_t label) const {
        return label < 0 || unknown_ == UnknownLabels::unlabelled || place(label) >= 0;
    }
    /// The class of a label; null when the map does not have it.
    const LabelClass* find(int32_t label) const {
        const int32_t at = place(label);
        return at < 0 ? nullptr : &classes_[size_t(at)];
    }
    /// The class's colour; the unlabelled one when the map does not have the label.
    Rgb8 color_of(int32_t label) const {
        const int32_t at = place(label);
        return at < 0 ? unlabelled_color_ : classes_[size_t(at)].color;
    }
    Rgb8 unlabelled_color() const { return unlabelled_color_; }

    /// "34 labels from -1 to 33".
    std::string range_text() const;
    /// Unique for every map that is made; copies keep it.
    uint64_t revision() const { return revision_; }

  private:
    /// Place in classes_, or -1. Labels near the first one are looked up in a table, others are searched.
    int32_t place(int32_t label) const {
        const int64_t at = int64_t(label) - classes_.front().label;
        if (at >= 0 && at < int64_t(table_.size())) return table_[size_t(at)];
        return search(label);
    }
    int32_t search(int32_t label) const;

    std::string name_;
    std::vector<LabelClass> classes_;
    std::optional<int32_t> unlabelled_;
    UnknownLabels unknown_;
    Rgb8 unlabelled_color_{128, 128, 128};
    std::vector<int32_t> table_;
    uint64_t revision_;
};

/// The label maps of public data sets, by the labels that their files have, and with "_train" by those that
/// networks are trained with and predict: semantic_kitti (Behley et al. 2019), cityscapes (Cordts et al.
/// 2016), scannet (Dai et al. 2017: the 40 classes of NYU; the 20 of the benchmark).
/// And asprs, the classes of LAS files, which shows other labels as unlabelled.
const std::vector<std::string>& built_in_label_map_names();

/// Throws NameError with the nearest name.
std::shared_ptr<const LabelMap> built_in_label_map(const std::string& name);

}  // namespace easypbr
