// What volumes leave of light that passes them straight, by the faces that a ray meets in any order.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "easypbr/render/raytrace/straight_light.h"

namespace easypbr::straight_light_test {
namespace {

constexpr float endless = std::numeric_limits<float>::infinity();
constexpr float rounding = 1e-5f;

/// An object that absorbs half of the light on a way of 1.
struct Glass {
    Glass() {
        item.object = &object;
        item.material.transmission = 1;
        item.material.thickness = 1;
        item.material.attenuation_distance = 1;
        item.material.attenuation_color = Vec3::Constant(0.5f);
    }
    render::VolumeFace face(float distance, bool is_exit, bool is_closed = true) const {
        return {&item, distance, is_exit, is_closed, 0.5f, Vec3::Constant(0.9f)};
    }

    SceneSnapshot::Object object;
    render::DrawItem item;
};

/// Of a ray as long as `end`, where a unit is 2 long in the world: the way in the volumes, world units.
double way_of(const std::vector<render::VolumeFace>& faces, float end = endless) {
    render::StraightLight light;
    for (const render::VolumeFace& face : faces) light.add(face);
    return -std::log2(double(light.absorbed(end, 2).x()));
}

TEST(StraightLight, CountsTheWayBetweenFaces) {
    const Glass a, b;
    EXPECT_NEAR(way_of({a.face(3, false), a.face(4, true)}), 2, rounding);
    EXPECT_NEAR(way_of({a.face(4, true), a.face(3, false)}), 2, rounding) << "in another order";
    EXPECT_NEAR(way_of({a.face(9, true), a.face(3, false), a.face(8, false), a.face(4, true)}), 4, rounding);
    EXPECT_NEAR(way_of({a.face(3, false), b.face(3.5f, false), b.face(3.75f, true), a.face(4, true)}), 2.5,
                rounding);
    EXPECT_NEAR(way_of({a.face(3, true, false), a.face(4, false, false)}), 2, rounding)
        << "open, faces look inward";
}

TEST(StraightLight, StartsAndEndsInClosedVolumes) {
    const Glass a;
    EXPECT_NEAR(way_of({a.face(3, true)}), 6, rounding);
    EXPECT_NEAR(way_of({a.face(3, false)}, 5), 4, rounding);
    EXPECT_NEAR(way_of({a.face(1, true), a.face(3, false)}, 4), 4, rounding) << "both";
    EXPECT_NEAR(way_of({a.face(1, true), a.face(3, false), a.face(4, true)}), 4, rounding);
}

// A sheet has its thickness of 0.5, which is 1 in the world, and the tint of two faces: one of them is
// counted by whoever adds it.
TEST(StraightLight, SheetsHaveTheirThickness) {
    const Glass a;
    for (const bool is_exit : {false, true})
        EXPECT_NEAR(way_of({a.face(3, is_exit, false)}), 1 - std::log2(0.9), rounding) << is_exit;
}

// A ray along an edge meets both faces.
TEST(StraightLight, EdgesCountOnce) {
    const Glass a;
    render::StraightLight light;
    EXPECT_TRUE(light.add(a.face(3, false)));
    EXPECT_FALSE(light.add(a.face(3.000001f, false)));
    EXPECT_TRUE(light.add(a.face(3.01f, false)));
    EXPECT_TRUE(light.add(a.face(3, true)));
}

// Of more faces than there is room for each stands for half of its thickness.
TEST(StraightLight, OfManyFacesHalfTheThickness) {
    const Glass a;
    std::vector<render::VolumeFace> faces;
    for (int i = 0; i < 40; ++i) faces.push_back(a.face(float(i + 1), i % 2 == 1));
    EXPECT_NEAR(way_of(faces), 40 * 0.5, 1e-4);
}

}  // namespace
}  // namespace easypbr::straight_light_test
