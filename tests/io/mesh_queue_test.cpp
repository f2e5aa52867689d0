#include "easypbr/io/mesh/mesh_queue.h"

#include <gtest/gtest.h>

#include "easypbr/core/error.h"
#include "easypbr/geometry/primitives.h"
#include "temporary_folder.h"

namespace easypbr::io::mesh_queue_test {
namespace {

// Files of different sizes come in their order, and an error at its own place only.
TEST(MeshQueue, KeepsTheOrderAndPlacesErrors) {
    const TemporaryFolder folder;
    std::vector<std::filesystem::path> paths;
    for (int i = 0; i < 12; ++i) {
        paths.push_back(folder.path() / fmt::format("{}.ply", i));
        if (i != 5) make_sphere(1, 8 + (i * 7) % 5 * 20).save(paths.back());
    }
    MeshQueue queue(paths, 3, 4);
    for (int i = 0; i < 12; ++i) {
        if (i == 5) {
            EXPECT_THROW(queue.next(), FileError);
            continue;
        }
        const auto mesh = queue.next();
        ASSERT_TRUE(mesh);
        EXPECT_EQ(mesh->F().rows(), Mesh(paths[size_t(i)]).F().rows()) << i;
    }
    EXPECT_FALSE(queue.next());
    EXPECT_FALSE(queue.next());
}

// Destroyed while threads wait for room or read.
TEST(MeshQueue, CanBeLeftEarly) {
    const TemporaryFolder folder;
    make_sphere().save(folder.path() / "a.ply");
    MeshQueue queue(std::vector<std::filesystem::path>(50, folder.path() / "a.ply"), 2, 2);
    EXPECT_TRUE(queue.next());
}

TEST(MeshQueue, RefusesNoWorkers) {
    EXPECT_THROW(MeshQueue({}, 0, 1), ArgumentError);
    EXPECT_THROW(MeshQueue({}, 1, 0), ArgumentError);
    EXPECT_FALSE(MeshQueue({}, 1, 1).next());
}

}  // namespace
}  // namespace easypbr::io::mesh_queue_test
