// Points of few emissive triangles, as paths look for them.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "easypbr/native/shaders.h"
#include "easypbr/render/raytrace/path_batch.h"

namespace easypbr::emitters_test {
namespace {

using render::PathVectors;

/// A square of half width a at z = 1 that faces the origin, and a triangle behind the places, which faces
/// away from them and belongs to a closed mesh.
native::FewEmitters emitters(float a) {
    native::FewEmitters e;
    e.count = 3;
    const auto set = [&](int k, const std::array<Vec3, 3>& corners, float light) {
        const Vec3 edge1 = corners[1] - corners[0], edge2 = corners[2] - corners[0],
                   normal = edge1.cross(edge2), centre = (corners[0] + corners[1] + corners[2]) / 3;
        for (int c = 0; c < 3; ++c) {
            e.corner[c][k] = corners[0][c];
            e.edge1[c][k] = edge1[c];
            e.edge2[c][k] = edge2[c];
            e.centre[c][k] = centre[c];
            e.normal[c][k] = normal.normalized()[c];
            e.least[c][k] = -1e30f;
            e.most[c][k] = 1e30f;
        }
        e.area[k] = normal.norm() / 2;
        e.light[k] = light * e.area[k];
    };
    set(0, {Vec3(-a, -a, 1), Vec3(a, a, 1), Vec3(a, -a, 1)}, 1);
    set(1, {Vec3(-a, -a, 1), Vec3(-a, a, 1), Vec3(a, a, 1)}, 3);
    set(2, {Vec3(-1, 0, -2), Vec3(0, 1, -2), Vec3(1, 0, -2)}, 9);
    for (int c = 0; c < 3; ++c) e.least[c][2] = e.most[c][2] = -2;
    return e;
}

/// All of what the kernels make of a grid of points at the origin.
struct Found {
    explicit Found(size_t side)
        : count(side * side),
          from(count),
          points(count),
          direction(count),
          chosen(count),
          u(count),
          v(count),
          distance(count),
          cosine(count),
          density(count),
          chances(count) {
        for (size_t i = 0; i < count; ++i)
            points.set(i, Vec2(float(i % side) + 0.5f, float(i / side) + 0.5f) / float(side));
    }

    void find(const native::FewEmitters& e) {
        native::EmitterPlaces places{{}, points.component(0), points.component(1)};
        from.read_by(places.from);
        native::EmitterPoints to{chosen.data(),   u.data(),      v.data(),      {},
                                 distance.data(), cosine.data(), density.data()};
        direction.written_by(to.direction);
        native::sample_emitters(e, places, int(count), to);
        native::chances_of_emitters(e, places.from, chosen.data(), int(count), chances.data());
    }
    std::vector<float> numbers() const {
        std::vector<float> all;
        for (const auto* values : {&u, &v, &distance, &cosine, &density, &chances})
            all.insert(all.end(), values->begin(), values->end());
        for (int c = 0; c < 3; ++c)
            all.insert(all.end(), direction.component(c), direction.component(c) + count);
        return all;
    }

    size_t count;
    PathVectors<3> from;
    PathVectors<2> points;
    PathVectors<3> direction;
    std::vector<int32_t> chosen;
    std::vector<float> u, v, distance, cosine, density, chances;
};

// The mean of the inverse density is the solid angle of what is seen: of a square of half width a at a
// distance of 1, 4 asin(a^2 / (1 + a^2)). 0.003: points of a grid.
TEST(FewEmitters, FillTheSolidAngle) {
    for (const float a : {0.1f, 1.0f, 3.0f}) {
        Found found(64);
        found.find(emitters(a));
        double sum = 0;
        for (size_t i = 0; i < found.count; ++i) {
            ASSERT_NE(found.chosen[i], 2) << "it is hidden by its own mesh";
            ASSERT_GT(found.density[i], 0);
            sum += 1 / double(found.density[i]);
        }
        const double seen = 4 * std::asin(a * a / (1 + a * a));
        EXPECT_NEAR(sum / double(found.count) / seen, 1, 0.003) << a;
    }
}

// Places and densities agree with each other. 1e-5: single precision.
TEST(FewEmitters, AgreeWithTheirChances) {
    const native::FewEmitters e = emitters(1);
    Found found(32);
    found.find(e);
    for (size_t i = 0; i < found.count; ++i) {
        const auto k = size_t(found.chosen[i]);
        const float d = found.distance[i];
        EXPECT_NEAR(found.direction.at(i).norm(), 1, 1e-5);
        EXPECT_NEAR(found.density[i] * found.cosine[i] / (d * d) / found.chances[i], 1, 1e-5);
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(found.direction.at(i)[c] * d,
                        e.corner[c][k] + found.u[i] * e.edge1[c][k] + found.v[i] * e.edge2[c][k], 1e-5);
    }
}

TEST(FewEmitters, AreTheSameOnAllInstructionSets) {
    const std::string before(native::instruction_set());
    std::vector<float> first;
    for (const std::string_view name : native::instruction_sets()) {
        native::use_instruction_set(name);
        Found found(16);
        found.find(emitters(0.7f));
        const std::vector<float> numbers = found.numbers();
        if (first.empty()) first = numbers;
        EXPECT_EQ(std::memcmp(first.data(), numbers.data(), first.size() * sizeof(float)), 0) << name;
    }
    native::use_instruction_set(before);
}

}  // namespace
}  // namespace easypbr::emitters_test
