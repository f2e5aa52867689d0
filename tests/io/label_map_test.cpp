#include <gtest/gtest.h>

#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "easypbr/io/settings/label_map_io.h"
#include "easypbr/io/settings/label_map_text.h"
#include "easypbr/scene/label_colors.h"
#include "io/temporary_folder.h"

namespace easypbr::label_map_test {

namespace {

LabelMap read(const std::string& name, const std::string& text) {
    const TemporaryFolder folder;
    write_file(folder / name, text);
    return io::load_label_map(folder / name);
}

std::string message_of(const std::string& name, const std::string& text) {
    const TemporaryFolder folder;
    write_file(folder / name, text);
    try {
        io::load_label_map(folder / name);
    } catch (const FormatError& error) {
        std::string message = error.what();
        const std::string path = (folder / name).string();
        return message.replace(message.find(path), path.size(), name);
    }
    return "read";
}

/// "label name r,g,b; ..."
std::string text_of(const LabelMap& map) {
    std::string text;
    for (const LabelClass& c : map.classes())
        text += fmt::format("{} {} {},{},{}; ", c.label, c.name, c.color[0], c.color[1], c.color[2]);
    return text;
}

}  // namespace

TEST(LabelMapFiles, TextComesInManyForms) {
    const std::string expected = "0 none 0,0,0; 7 traffic light 250,170,30; ";
    EXPECT_EQ(text_of(read("a.txt", "# names\n\n7 \"traffic light\" 250 170 30\n0 none 0 0 0\n")), expected);
    EXPECT_EQ(text_of(read("a.txt", "0 none 0 0 0 255\r\n7 traffic light 250 170 30 0\r\n")), expected)
        << "FreeSurfer: alpha last";
    EXPECT_EQ(text_of(read("a.label", "0 0 0 0 0 0 0 \"none\"\n7 250 170 30 1 1 1 \"traffic light\"\n")),
              expected)
        << "ITK-SNAP: colour, alpha, visibility, mesh, name";
    EXPECT_EQ(text_of(read("a.csv", "id,name,red,green,blue\n0,none,0,0,0\n7, traffic light ,250,170,30\n")),
              expected);
    EXPECT_EQ(text_of(read("a.tsv", "7\t250\t170\t30\ttraffic light\n0\t0\t0\t0\tnone")), expected);
}

TEST(LabelMapFiles, NamesAloneGetColours) {
    const LabelMap map = read("classes.txt", "road\nside walk\n");
    EXPECT_EQ(map.name(), "classes");
    const GeneratedColors generated(1);
    EXPECT_EQ(map.find(0)->name, "road");
    EXPECT_EQ(map.find(1)->name, "side walk");
    EXPECT_EQ(map.color_of(1), generated.color_of(1));
    EXPECT_EQ(read("classes.txt", "3 road\n9 car\n").find(9)->name, "car");
}

TEST(LabelMapFiles, YamlIsThatOfSemanticKitti) {
    const LabelMap map =
        read("semantic-kitti.yaml",
             "labels:\n  0 : \"unlabeled\"\n  10: \"car\"\n  259: new\ncolor_map: # bgr\n  0 : [0, 0, 0]\n"
             "  10: [245, 150, 100]\nlearning_map:\n  0 : 0\n");
    EXPECT_EQ(map.name(), "semantic-kitti");
    EXPECT_EQ(map.unlabelled(), 0);
    EXPECT_EQ(map.color_of(10), built_in_label_map("semantic_kitti")->color_of(10));
    EXPECT_EQ(map.color_of(259), GeneratedColors(259).color_of(259));
}

TEST(LabelMapFiles, SurviveWritingAndReading) {
    const TemporaryFolder folder;
    for (const std::string& name : built_in_label_map_names()) {
        const LabelMap& map = *built_in_label_map(name);
        for (const char* file : {"m.json", "m.txt"}) {
            io::save_label_map(map, folder / file);
            const LabelMap back = io::load_label_map(folder / file);
            EXPECT_EQ(text_of(back), text_of(map)) << name << " " << file;
            EXPECT_EQ(back.unlabelled(), map.unlabelled()) << name << " " << file;
        }
        EXPECT_EQ(io::load_label_map(folder / "m.json").name() == "m", false);
    }
    const LabelMap tolerant("t", {{-5, "a", {1, 2, 3}}}, std::nullopt, UnknownLabels::unlabelled);
    io::save_label_map(tolerant, folder / "t.json");
    EXPECT_EQ(io::load_label_map(folder / "t.json").unknown(), UnknownLabels::unlabelled);
    EXPECT_FALSE(io::load_label_map(folder / "t.json").unlabelled());
    EXPECT_THROW(io::save_label_map(tolerant, folder / "t.yaml"), FormatError);
    EXPECT_THROW(io::save_label_map(LabelMap("q", {{0, "a\"b", {}}}), folder / "q.txt"), FormatError);
    EXPECT_THROW(io::save_label_map(tolerant, folder / "no/t.json"), FileError);
}

// A name may be a number, where it is quoted, and need not be UTF-8; quotes alone are no line.
TEST(LabelMapFiles, OddNamesSurviveToo) {
    const LabelMap map = io::parse_label_map("\"\n0 \"17\" 1 2 3\n\"\"\n5 \"a 11111\" 4 5 6\n", "a.txt");
    ASSERT_EQ(map.classes().size(), 2u);
    EXPECT_EQ(map.classes()[0].name, "17");
    EXPECT_EQ(map.classes()[1].name, "a 11111");
    const LabelMap again = io::parse_label_map(io::format_label_map(map, "b.txt"), "b.txt");
    EXPECT_EQ(again.classes()[1].name, "a 11111");
    EXPECT_EQ(again.classes()[0].color, map.classes()[0].color);
    // Between commas quotes say nothing of what is a number.
    EXPECT_EQ(io::parse_label_map("\"3\",\"road\",\"1\",\"2\",\"3\"\n", "c.csv").classes()[0].label, 3);
    const LabelMap latin = io::parse_label_map(
        "1 Stra\xdf"
        "e 1 2 3\n",
        "d.txt");
    EXPECT_EQ(io::parse_label_map(io::format_label_map(latin, "d.json"), "d.json").classes()[0].name,
              "Stra\xef\xbf\xbd"
              "e");
}

TEST(LabelMapFiles, SayWhereTheyAreWrong) {
    EXPECT_EQ(message_of("a.txt", "0 road 1 2 3\nx car 1 2 3\n"),
              "cannot read a label map from a.txt, line 2: expected a label, got 'x'");
    EXPECT_EQ(message_of("a.txt", "0 road 1 2\n"),
              "cannot read a label map from a.txt, line 1: expected 'LABEL NAME R G B', got 2 numbers for "
              "the colour");
    EXPECT_EQ(
        message_of("a.txt", "\n0 road 1 2 256\n"),
        "cannot read a label map from a.txt, line 2: expected a colour of numbers from 0 to 255, got 256");
    EXPECT_EQ(message_of("a.txt", "# nothing\n"), "cannot read a label map from a.txt: it has no classes");
    EXPECT_EQ(message_of("a.txt", "0 a 1 2 3\n0 b 1 2 3\n"),
              "cannot read a label map from a.txt: label map 'a': label 0 occurs twice, as 'a' and 'b'");
    EXPECT_EQ(message_of("a.json", R"({"classes": [{"label": 1.5}]})"),
              "cannot read a label map from a.json: expected a label, a whole number, got 1.5");
    EXPECT_EQ(message_of("a.json", R"({"classes": [{"label": 1, "colour": "red"}]})"),
              "cannot read a label map from a.json: unknown key 'colour' (expected label, name, color)");
    EXPECT_EQ(message_of("a.json", R"({"classes": []})"),
              "cannot read a label map from a.json: label map 'a': expected classes, got none");
    EXPECT_NE(
        message_of("a.json", R"({"classes": [{"label": 1, "color": [1, 2]}]})").find("three whole numbers"),
        std::string::npos);
    EXPECT_NE(message_of("a.json", "{\"classes\": [").find("line 1"), std::string::npos);
    EXPECT_NE(message_of("a.yaml", "labels: [1, 2").find("line"), std::string::npos);
    EXPECT_EQ(message_of("a.yaml", "names: {}"),
              "cannot read a label map from a.yaml: expected 'labels:' with a name for each label");
    EXPECT_THROW(io::load_label_map("/no/such/map.json"), FileError);
}

TEST(LabelMapFiles, AreFoundByNameOrPath) {
    EXPECT_EQ(io::find_label_map("cityscapes"), built_in_label_map("cityscapes"));
    const TemporaryFolder folder;
    write_file(folder / "mine.txt", std::string_view("0 road 1 2 3\n"));
    EXPECT_EQ(io::find_label_map((folder / "mine.txt").string())->name(), "mine");
    EXPECT_THROW(io::find_label_map((folder / "other.txt").string()), FileError);
    try {
        io::find_label_map("cityscape");
        FAIL();
    } catch (const NameError& error) {
        EXPECT_STREQ(
            error.what(),
            "there is no label map 'cityscape' (did you mean 'cityscapes'?): expected semantic_kitti, "
            "semantic_kitti_train, cityscapes, cityscapes_train, scannet, scannet_train, asprs");
    }
}

}  // namespace easypbr::label_map_test
