// The plain data where Mesh is only declared: nothing here may include scene/mesh.h.
#include "easypbr/scene/mesh_data.h"

#include <gtest/gtest.h>

#include <type_traits>
#include <utility>
#include <vector>

#include "easypbr/core/error.h"

namespace easypbr::mesh_data_test {

namespace {

template <class T>
concept Complete = requires {
    sizeof(T);
};
static_assert(!Complete<Mesh>);
static_assert(std::is_aggregate_v<MeshData>);

MeshData triangle() {
    MeshData data;
    data.name = "triangle";
    data.V = Array3f::Dense{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    data.F = Array3i::Dense{{0, 1, 2}};
    return data;
}

TEST(MeshData, IsCopiedMovedAndDestroyedWithoutItsHandle) {
    std::vector<MeshData> many{triangle(), {}};
    many[1] = many[0];
    EXPECT_EQ(many[1].V.data(), many[0].V.data());
    const MeshData moved = std::move(many[0]);
    many.clear();
    EXPECT_EQ(moved.name, "triangle");
    EXPECT_EQ(moved.V(1, 0), 1);
}

TEST(MeshData, IsValidatedWithoutItsHandle) {
    MeshData data = triangle();
    EXPECT_NO_THROW(validate(data));
    data.F = Array3i::Dense{{0, 1, 3}};
    EXPECT_THROW(validate(data), ArgumentError);
}

}  // namespace

}  // namespace easypbr::mesh_data_test
