// What assimp loses of the colours of 3MF files is named: of each object it takes one base material.
#include "easypbr/io/mesh/assimp/colors_of_3mf.h"

#include <gtest/gtest.h>

namespace easypbr::io::colors_of_3mf_test {
namespace {

using Names = std::vector<std::string>;

constexpr const char* materials = R"(<basematerials id="9"><base name="a" displaycolor="#FF0000"/>
<base name="b" displaycolor="#00FF00"/></basematerials>)";
constexpr const char* colors = R"(<m:colorgroup id='8'><m:color color='#FF0000'/></m:colorgroup>)";

/// An object of two triangles with these attributes.
std::string object(const std::string& own, const std::string& first, const std::string& second) {
    return "<object id=\"1\" type=\"model\" " + own +
           "><mesh><triangles><triangle v1=\"0\" v2=\"1\" v3=\"2\" " + first +
           "/><triangle v1=\"0\" v2=\"2\" v3=\"3\" " + second + "/></triangles></mesh></object>";
}

Names left_out(const std::string& resources) {
    return colors_left_out_of_3mf("<?xml version=\"1.0\"?><model><resources>" + resources +
                                  "</resources></model>");
}

}  // namespace

TEST(ColorsOf3mf, OneMaterialOfAnObjectIsReadAndNothingIsNamed) {
    const std::string own = R"(pid="9" pindex="1")";
    EXPECT_EQ(left_out(object("", "", "")), Names());
    EXPECT_EQ(left_out(materials + object(own, "", "")), Names());
    EXPECT_EQ(left_out(materials + object("", R"(pid="9" p1="0")", R"(p1="0" pid="9" p2="0" p3="0")")),
              Names());
    // Colours that no object uses.
    EXPECT_EQ(left_out(colors + object("", "", "")), Names());
}

TEST(ColorsOf3mf, TrianglesThatDifferAreNamed) {
    const Names is_mixed{"materials of single triangles (objects: 1)"};
    const std::string red = R"(pid="9" p1="0")", green = R"(pid="9" p1="1")";
    EXPECT_EQ(left_out(materials + object("", red, green)), is_mixed);
    EXPECT_EQ(left_out(materials + object("", red, "")), is_mixed);
    // A triangle's material takes the place of its object's, an index is in the object's group.
    EXPECT_EQ(left_out(materials + object(R"(pid="9" pindex="1")", red, red)), is_mixed);
    EXPECT_EQ(left_out(materials + object(R"(pid="9" pindex="1")", R"(p1="0")", R"(p1="0")")), is_mixed);
    EXPECT_EQ(left_out(materials + object("", red, red + R"( p2="1")")), is_mixed);
    EXPECT_EQ(left_out(materials + object("", red, green) + object("", green, red)),
              Names{"materials of single triangles (objects: 2)"});
}

TEST(ColorsOf3mf, GroupsThatAreNoBaseMaterialsAreNamedWhereTheyAreUsed) {
    const std::string own = R"(pid='8' pindex='0')";
    EXPECT_EQ(left_out(colors + object(own, "", "")), Names{"colour groups (m:colorgroup)"});
    const std::string texture = R"(<m:texture2dgroup id="7" texid="6"></m:texture2dgroup>)";
    EXPECT_EQ(left_out(texture + object("", R"(pid="7" p1="0" p2="1" p3="2")", "")),
              (Names{"textures (m:texture2dgroup)", "materials of single triangles (objects: 1)"}));
}

TEST(ColorsOf3mf, ObjectsWithoutAMaterialBesideOthersAreNamed) {
    EXPECT_EQ(left_out(materials + object("", "", "") + object(R"(pid="9" pindex="1")", "", "")),
              Names{"the default material of objects without one, which get the file's first (objects: 1)"});
}

TEST(ColorsOf3mf, TextThatIsNoTagIsNone) {
    const std::string mixed = object("", R"(pid="9" p1="0")", R"(pid="9" p1="1")");
    EXPECT_EQ(left_out("<!-- " + mixed + " -->"), Names());
    EXPECT_EQ(left_out("<metadata name=\"a > b\"><![CDATA[" + mixed + "]]></metadata>"), Names());
    for (const char* text :
         {"", "<", "<triangle", "<triangle p1=\"", "<!--", "<a b", "<a b=\"'>", "PK\3\4"}) {
        EXPECT_EQ(colors_left_out_of_3mf(text), Names()) << text;
    }
}

}  // namespace easypbr::io::colors_of_3mf_test
