#include "easypbr/scene/object_key.h"

#include <gtest/gtest.h>

#include <set>

#include "easypbr/scene/mesh.h"

namespace easypbr::object_key_test {
namespace {

using Partners = std::vector<std::optional<size_t>>;

constexpr auto none = std::nullopt;

// A root and three children that share a name.
const std::vector<ObjectKey> family = {
    {"r", "r", 1}, {"r", "r/ball", 2}, {"r", "r/ball", 3}, {"r", "r/ball", 4}};

TEST(ObjectPartners, AreTheSameNodes) {
    EXPECT_EQ(partners(family, family), (Partners{0, 1, 2, 3}));
    const std::vector<ObjectKey> without_first = {family[0], family[2], family[3]};
    EXPECT_EQ(partners(without_first, family), (Partners{0, 2, 3}));
    EXPECT_EQ(partners(family, without_first), (Partners{0, none, 1, 2}));
    const std::vector<ObjectKey> turned = {family[0], family[3], family[1], family[2]};
    EXPECT_EQ(partners(turned, family), (Partners{0, 3, 1, 2}));
    EXPECT_EQ(partners({}, family), Partners{});
    EXPECT_EQ(partners(family, {}), (Partners{none, none, none, none}));
}

TEST(ObjectPartners, KeepTheirNodesUnderOtherNames) {
    // Renamed, hung elsewhere, shown under another name, and two that changed their names.
    EXPECT_EQ(partners({{"r", "r/a/ball", 2}, {"r", "r/b", 3}}, family), (Partners{1, 2}));
    EXPECT_EQ(partners({{"s", "s", 2}}, family), Partners{1});
    EXPECT_EQ(partners({{"a", "a", 1}, {"b", "b", 2}}, {{"a", "a", 2}, {"b", "b", 1}}), (Partners{1, 0}));
}

TEST(ObjectPartners, OfReplacedNodesAreThoseOfTheName) {
    // All, as by a program that makes its meshes anew; the second one, whose successor comes last.
    EXPECT_EQ(
        partners({{"r", "r", 11}, {"r", "r/ball", 12}, {"r", "r/ball", 13}, {"r", "r/ball", 14}}, family),
        (Partners{0, 1, 2, 3}));
    EXPECT_EQ(partners({family[0], family[1], family[3], {"r", "r/ball", 9}}, family),
              (Partners{0, 1, 3, 2}));
    // One more than there were, and what has the name of another root's child.
    EXPECT_EQ(partners({family[0], family[1], family[2], family[3], {"r", "r/ball", 9}}, family),
              (Partners{0, 1, 2, 3, none}));
    EXPECT_EQ(partners({{"r/ball", "r/ball", 9}}, family), Partners{none});
}

TEST(ObjectPartners, OfANodeThatIsShownTwiceAreThoseOfTheName) {
    const std::vector<ObjectKey> both = {{"a", "a", 1}, {"b", "b", 1}};
    EXPECT_EQ(partners(both, both), (Partners{0, 1}));
    EXPECT_EQ(partners({both[1]}, both), Partners{1});
    EXPECT_EQ(partners(both, {both[1]}), (Partners{none, 0}));
    // Under two parents, one of which is hidden.
    const std::vector<ObjectKey> shared = {{"r", "r/a/x", 1}, {"r", "r/b/x", 1}};
    EXPECT_EQ(partners({shared[1]}, shared), Partners{1});
}

// Memory of what is gone is used again: an address would be the same sooner or later.
TEST(MeshIdentity, IsNeverThatOfAMeshThatIsGone) {
    std::set<uint64_t> seen;
    for (int i = 0; i < 100; ++i) {
        const Mesh mesh;
        EXPECT_TRUE(seen.insert(mesh.identity()).second);
        EXPECT_EQ(Mesh(mesh).identity(), mesh.identity());
        EXPECT_NE(mesh.clone().identity(), mesh.identity());
    }
}

}  // namespace
}  // namespace easypbr::object_key_test
