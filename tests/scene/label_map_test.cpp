#include "easypbr/scene/label_map.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <limits>
#include <utility>

#include "easypbr/core/error.h"
#include "refusal.h"

namespace easypbr::label_map_test {

TEST(LabelMap, FindsLabelsWithGaps) {
    constexpr int32_t lowest = std::numeric_limits<int32_t>::min(),
                      highest = std::numeric_limits<int32_t>::max();
    // Labels within the table, beyond it, and so far apart that their difference does not fit in 32 bits.
    const LabelMap map("sparse", {{259, "c", {3, 0, 0}},
                                  {highest, "e", {5, 0, 0}},
                                  {0, "b", {2, 0, 0}},
                                  {lowest, "a", {1, 0, 0}},
                                  {1000000, "d", {4, 0, 0}}});
    for (const auto& [label, name] : std::vector<std::pair<int32_t, std::string>>{
             {lowest, "a"}, {0, "b"}, {259, "c"}, {1000000, "d"}, {highest, "e"}}) {
        ASSERT_TRUE(map.find(label)) << label;
        EXPECT_EQ(map.find(label)->name, name);
        EXPECT_EQ(map.color_of(label), (Rgb8{uint8_t(name[0] - 'a' + 1), 0, 0}));
    }
    for (const int32_t label : {lowest + 1, -1, 1, 258, 260, 999999, 1000001, highest - 1}) {
        EXPECT_FALSE(map.find(label)) << label;
        EXPECT_EQ(map.color_of(label), map.unlabelled_color());
        EXPECT_EQ(map.accepts(label), label < 0);
    }
}

TEST(LabelMap, ShowsWhatIsUnknownAsUnlabelled) {
    const std::vector<LabelClass> classes{{0, "none", {9, 8, 7}}, {4, "car", {1, 2, 3}}};
    const LabelMap map("cars", classes, 0, UnknownLabels::unlabelled);
    EXPECT_TRUE(map.accepts(17));
    EXPECT_EQ(map.color_of(17), (Rgb8{9, 8, 7}));
    EXPECT_EQ(map.color_of(-3), (Rgb8{9, 8, 7}));
    EXPECT_EQ(LabelMap("cars", classes).color_of(17), (Rgb8{128, 128, 128}));
}

TEST(LabelMap, IsThereAfterItWasMovedFrom) {
    LabelMap map = LabelMap::generated({"a", "b"});
    const LabelMap taken = std::move(map);
    EXPECT_EQ(map.classes().size(), 2u);
    EXPECT_TRUE(map.accepts(1));
    EXPECT_EQ(map.range_text(), taken.range_text());
}

TEST(LabelMap, SaysWhatIsWrong) {
    EXPECT_EQ(refusal([] { LabelMap("cars", {}); }), "label map 'cars': expected classes, got none");
    EXPECT_EQ(refusal([] {
                  LabelMap("cars", {{1, "a", {}}, {0, "b", {}}, {1, "c", {}}});
              }),
              "label map 'cars': label 1 occurs twice, as 'a' and 'c'");
    EXPECT_EQ(refusal([] {
                  LabelMap("cars", {{1, "a", {}}, {3, "b", {}}}, 2);
              }),
              "label map 'cars': the unlabelled class 2 is not among the 2 labels from 1 to 3");
}

// Some entries as their authors publish them; sizes: 34 labels, 19 + unlabelled; 35 with the licence plate,
// 19 + ignored; 40 + unannotated, 20 + ignored.
TEST(LabelMap, HasTheTablesOfPublicDataSets) {
    const auto entry = [](const std::string& map, int32_t label) {
        const LabelClass* c = built_in_label_map(map)->find(label);
        return c ? fmt::format("{} {},{},{}", c->name, c->color[0], c->color[1], c->color[2]) : "none";
    };
    const auto size = [](const std::string& map) { return built_in_label_map(map)->classes().size(); };
    EXPECT_EQ(size("semantic_kitti"), 34u);
    EXPECT_EQ(entry("semantic_kitti", 10), "car 100,150,245");
    EXPECT_EQ(entry("semantic_kitti", 40), "road 255,0,255");
    EXPECT_EQ(entry("semantic_kitti", 259), "moving-other-vehicle 0,0,255");
    EXPECT_EQ(entry("semantic_kitti", 12), "none");
    EXPECT_EQ(size("semantic_kitti_train"), 20u);
    EXPECT_EQ(entry("semantic_kitti_train", 1), "car 100,150,245");
    EXPECT_EQ(entry("semantic_kitti_train", 19), "traffic-sign 255,0,0");
    EXPECT_EQ(size("cityscapes"), 35u);
    EXPECT_EQ(entry("cityscapes", 7), "road 128,64,128");
    EXPECT_EQ(entry("cityscapes", -1), "license plate 0,0,142");
    EXPECT_EQ(size("cityscapes_train"), 20u);
    EXPECT_EQ(entry("cityscapes_train", 18), "bicycle 119,11,32");
    EXPECT_EQ(built_in_label_map("cityscapes_train")->unlabelled(), 255);
    EXPECT_EQ(size("scannet"), 41u);
    EXPECT_EQ(entry("scannet", 39), "otherfurniture 82,84,163");
    EXPECT_EQ(size("scannet_train"), 21u);
    EXPECT_EQ(entry("scannet_train", 13), "curtain 219,219,141");
    EXPECT_EQ(entry("scannet_train", 19), "otherfurniture 82,84,163");
    EXPECT_THROW(built_in_label_map("kitti"), NameError);
}

TEST(LabelMap, GeneratesColoursForNames) {
    const LabelMap map = LabelMap::generated({"road", "car"});
    EXPECT_EQ(map.find(1)->name, "car");
    EXPECT_EQ(map.color_of(1), (Rgb8{156, 210, 21}));
}

}  // namespace easypbr::label_map_test
