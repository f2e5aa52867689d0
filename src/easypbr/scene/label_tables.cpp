// Names and colours as the data sets' authors publish them.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <span>

#include "easypbr/core/error.h"
#include "easypbr/core/suggest.h"
#include "easypbr/scene/label_map.h"

namespace easypbr {
namespace {

struct Entry {
    int32_t label;
    const char* name;
    Rgb8 color;
};

/// https://github.com/PRBonn/semantic-kitti-api, config/semantic-kitti.yaml (there blue first).
constexpr Entry semantic_kitti_classes[] = {
    {0, "unlabeled", {0, 0, 0}},
    {1, "outlier", {255, 0, 0}},
    {10, "car", {100, 150, 245}},
    {11, "bicycle", {100, 230, 245}},
    {13, "bus", {100, 80, 250}},
    {15, "motorcycle", {30, 60, 150}},
    {16, "on-rails", {0, 0, 255}},
    {18, "truck", {80, 30, 180}},
    {20, "other-vehicle", {0, 0, 255}},
    {30, "person", {255, 30, 30}},
    {31, "bicyclist", {255, 40, 200}},
    {32, "motorcyclist", {150, 30, 90}},
    {40, "road", {255, 0, 255}},
    {44, "parking", {255, 150, 255}},
    {48, "sidewalk", {75, 0, 75}},
    {49, "other-ground", {175, 0, 75}},
    {50, "building", {255, 200, 0}},
    {51, "fence", {255, 120, 50}},
    {52, "other-structure", {255, 150, 0}},
    {60, "lane-marking", {150, 255, 170}},
    {70, "vegetation", {0, 175, 0}},
    {71, "trunk", {135, 60, 0}},
    {72, "terrain", {150, 240, 80}},
    {80, "pole", {255, 240, 150}},
    {81, "traffic-sign", {255, 0, 0}},
    {99, "other-object", {50, 255, 255}},
    {252, "moving-car", {100, 150, 245}},
    {253, "moving-bicyclist", {255, 40, 200}},
    {254, "moving-person", {255, 30, 30}},
    {255, "moving-motorcyclist", {150, 30, 90}},
    {256, "moving-on-rails", {0, 0, 255}},
    {257, "moving-bus", {100, 80, 250}},
    {258, "moving-truck", {80, 30, 180}},
    {259, "moving-other-vehicle", {0, 0, 255}},
};
/// "learning_map_inv" there: the file's label of labels 0 to 19 of networks.
constexpr int32_t semantic_kitti_train[] = {0,  10, 11, 15, 18, 20, 30, 31, 32, 40,
                                            44, 48, 49, 50, 51, 70, 71, 72, 80, 81};

/// https://github.com/mcordts/cityscapesScripts, cityscapesscripts/helpers/labels.py.
constexpr Entry cityscapes_classes[] = {
    {-1, "license plate", {0, 0, 142}},
    {0, "unlabeled", {0, 0, 0}},
    {1, "ego vehicle", {0, 0, 0}},
    {2, "rectification border", {0, 0, 0}},
    {3, "out of roi", {0, 0, 0}},
    {4, "static", {0, 0, 0}},
    {5, "dynamic", {111, 74, 0}},
    {6, "ground", {81, 0, 81}},
    {7, "road", {128, 64, 128}},
    {8, "sidewalk", {244, 35, 232}},
    {9, "parking", {250, 170, 160}},
    {10, "rail track", {230, 150, 140}},
    {11, "building", {70, 70, 70}},
    {12, "wall", {102, 102, 156}},
    {13, "fence", {190, 153, 153}},
    {14, "guard rail", {180, 165, 180}},
    {15, "bridge", {150, 100, 100}},
    {16, "tunnel", {150, 120, 90}},
    {17, "pole", {153, 153, 153}},
    {18, "polegroup", {153, 153, 153}},
    {19, "traffic light", {250, 170, 30}},
    {20, "traffic sign", {220, 220, 0}},
    {21, "vegetation", {107, 142, 35}},
    {22, "terrain", {152, 251, 152}},
    {23, "sky", {70, 130, 180}},
    {24, "person", {220, 20, 60}},
    {25, "rider", {255, 0, 0}},
    {26, "car", {0, 0, 142}},
    {27, "truck", {0, 0, 70}},
    {28, "bus", {0, 60, 100}},
    {29, "caravan", {0, 0, 90}},
    {30, "trailer", {0, 0, 110}},
    {31, "train", {0, 80, 100}},
    {32, "motorcycle", {0, 0, 230}},
    {33, "bicycle", {119, 11, 32}},
};
/// The ids of "trainId" 0 to 18 there; 255 is ignored.
constexpr int32_t cityscapes_train[] = {7,  8,  11, 12, 13, 17, 19, 20, 21, 22,
                                        23, 24, 25, 26, 27, 28, 31, 32, 33};

/// https://github.com/ScanNet/ScanNet, BenchmarkScripts/util.py; names of NYU's 40 classes (Gupta et al.
/// 2013).
constexpr Entry scannet_classes[] = {
    {0, "unannotated", {0, 0, 0}},
    {1, "wall", {174, 199, 232}},
    {2, "floor", {152, 223, 138}},
    {3, "cabinet", {31, 119, 180}},
    {4, "bed", {255, 187, 120}},
    {5, "chair", {188, 189, 34}},
    {6, "sofa", {140, 86, 75}},
    {7, "table", {255, 152, 150}},
    {8, "door", {214, 39, 40}},
    {9, "window", {197, 176, 213}},
    {10, "bookshelf", {148, 103, 189}},
    {11, "picture", {196, 156, 148}},
    {12, "counter", {23, 190, 207}},
    {13, "blinds", {178, 76, 76}},
    {14, "desk", {247, 182, 210}},
    {15, "shelves", {66, 188, 102}},
    {16, "curtain", {219, 219, 141}},
    {17, "dresser", {140, 57, 197}},
    {18, "pillow", {202, 185, 52}},
    {19, "mirror", {51, 176, 203}},
    {20, "floor mat", {200, 54, 131}},
    {21, "clothes", {92, 193, 61}},
    {22, "ceiling", {78, 71, 183}},
    {23, "books", {172, 114, 82}},
    {24, "refrigerator", {255, 127, 14}},
    {25, "television", {91, 163, 138}},
    {26, "paper", {153, 98, 156}},
    {27, "towel", {140, 153, 101}},
    {28, "shower curtain", {158, 218, 229}},
    {29, "box", {100, 125, 154}},
    {30, "whiteboard", {178, 127, 135}},
    {31, "person", {120, 185, 128}},
    {32, "night stand", {146, 111, 194}},
    {33, "toilet", {44, 160, 44}},
    {34, "sink", {112, 128, 144}},
    {35, "lamp", {96, 207, 209}},
    {36, "bathtub", {227, 119, 194}},
    {37, "bag", {213, 92, 176}},
    {38, "otherstructure", {94, 106, 211}},
    {39, "otherfurniture", {82, 84, 163}},
    {40, "otherprop", {100, 85, 144}},
};
/// "VALID_CLASS_IDS" of the benchmark, in their order.
constexpr int32_t scannet_train[] = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 14, 16, 24, 28, 33, 34, 36, 39};

/// ASPRS, "LAS Specification 1.4 - R15", table 17; it names no colours: these are ours.
constexpr Entry asprs_classes[] = {
    {0, "never classified", {128, 128, 128}},
    {1, "unclassified", {170, 170, 170}},
    {2, "ground", {161, 110, 60}},
    {3, "low vegetation", {170, 220, 110}},
    {4, "medium vegetation", {90, 180, 70}},
    {5, "high vegetation", {20, 120, 45}},
    {6, "building", {215, 70, 50}},
    {7, "low point (noise)", {255, 0, 255}},
    {8, "model key-point", {255, 255, 255}},
    {9, "water", {40, 110, 220}},
    {10, "rail", {90, 90, 160}},
    {11, "road surface", {90, 90, 95}},
    {12, "overlap", {230, 220, 180}},
    {13, "wire - guard", {255, 230, 90}},
    {14, "wire - conductor", {255, 190, 0}},
    {15, "transmission tower", {255, 130, 0}},
    {16, "wire-structure connector", {200, 110, 40}},
    {17, "bridge deck", {180, 150, 200}},
    {18, "high noise", {190, 0, 190}},
    {19, "overhead structure", {130, 100, 220}},
    {20, "ignored ground", {120, 85, 50}},
    {21, "snow", {235, 245, 255}},
    {22, "temporal exclusion", {60, 60, 60}},
};

/// What networks are told to ignore.
constexpr int32_t ignored = 255;

std::vector<LabelClass> classes_of(std::span<const Entry> entries) {
    std::vector<LabelClass> classes;
    for (const Entry& entry : entries) classes.push_back({entry.label, entry.name, entry.color});
    return classes;
}

/// Some of the classes, as labels 0, 1, 2, ...
std::vector<LabelClass> renumbered(std::span<const Entry> entries, std::span<const int32_t> labels) {
    std::vector<LabelClass> classes;
    for (const int32_t label : labels) {
        const Entry& entry = *std::ranges::find(entries, label, &Entry::label);
        classes.push_back({int32_t(classes.size()), entry.name, entry.color});
    }
    return classes;
}

std::vector<LabelClass> with_ignored(std::vector<LabelClass> classes, const std::string& name) {
    classes.push_back({ignored, name, {0, 0, 0}});
    return classes;
}

using Maps = std::vector<std::pair<std::string, std::shared_ptr<const LabelMap>>>;

const Maps& built_in_maps() {
    static const Maps maps = [] {
        Maps all;
        const auto add = [&](const std::string& name, std::vector<LabelClass> classes, int32_t unlabelled) {
            all.emplace_back(name, std::make_shared<const LabelMap>(name, std::move(classes), unlabelled));
        };
        add("semantic_kitti", classes_of(semantic_kitti_classes), 0);
        add("semantic_kitti_train", renumbered(semantic_kitti_classes, semantic_kitti_train), 0);
        add("cityscapes", classes_of(cityscapes_classes), 0);
        add("cityscapes_train", with_ignored(renumbered(cityscapes_classes, cityscapes_train), "unlabeled"),
            ignored);
        add("scannet", classes_of(scannet_classes), 0);
        add("scannet_train", with_ignored(renumbered(scannet_classes, scannet_train), "unannotated"),
            ignored);
        // Labels from 64 on are the user's.
        all.emplace_back("asprs", std::make_shared<const LabelMap>("asprs", classes_of(asprs_classes),
                                                                   std::nullopt, UnknownLabels::unlabelled));
        return all;
    }();
    return maps;
}

}  // namespace

const std::vector<std::string>& built_in_label_map_names() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> result;
        for (const auto& [name, map] : built_in_maps()) result.push_back(name);
        return result;
    }();
    return names;
}

std::shared_ptr<const LabelMap> built_in_label_map(const std::string& name) {
    for (const auto& [known, map] : built_in_maps())
        if (known == name) return map;
    const auto& names = built_in_label_map_names();
    throw NameError(fmt::format("there is no label map '{}'{}: expected {}", name, did_you_mean(name, names),
                                fmt::join(names, ", ")));
}

}  // namespace easypbr
