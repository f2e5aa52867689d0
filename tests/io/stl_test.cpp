#include <array>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "easypbr/core/error.h"
#include "easypbr/io/mesh/mesh_io.h"
#include "easypbr/io/mesh/mesh_readers.h"
#include "io/gltf_decoded.h"

namespace easypbr::stl_test {

namespace {

using Triangle = std::array<std::array<float, 3>, 3>;

/// The unit cube, outside faces, with one corner written as -0.
std::vector<Triangle> cube() {
    std::vector<Triangle> triangles;
    const auto quad = [&](std::array<float, 3> a, std::array<float, 3> b, std::array<float, 3> c,
                          std::array<float, 3> d) {
        triangles.push_back({a, b, c});
        triangles.push_back({a, c, d});
    };
    quad({-0.0f, 0, 0}, {0, 1, 0}, {1, 1, 0}, {1, 0, 0});
    quad({0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1});
    quad({0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1});
    quad({0, 1, 0}, {0, 1, 1}, {1, 1, 1}, {1, 1, 0});
    quad({0, 0, 0}, {0, 0, 1}, {0, 1, 1}, {0, 1, 0});
    quad({1, 0, 0}, {1, 1, 0}, {1, 1, 1}, {1, 0, 1});
    return triangles;
}

std::string binary(const std::vector<Triangle>& triangles, const std::string& title) {
    std::string text = title + std::string(80 - title.size(), ' ');
    const auto append = [&](auto value) { text.append(reinterpret_cast<const char*>(&value), sizeof value); };
    append(uint32_t(triangles.size()));
    for (const Triangle& triangle : triangles) {
        for (int k = 0; k < 3; ++k) append(0.0f);
        for (const auto& corner : triangle)
            for (const float x : corner) append(x);
        append(uint16_t(0));
    }
    return text;
}

std::string ascii(const std::vector<Triangle>& triangles) {
    std::string text = "solid cube\n";
    for (const Triangle& triangle : triangles) {
        text += "  facet normal 0 0 0\n    outer loop\n";
        for (const auto& c : triangle) text += fmt::format("      vertex {} {} {}\n", c[0], c[1], c[2]);
        text += "    endloop\n  endfacet\n";
    }
    return text + "endsolid cube\n";
}

MeshData read(const std::string& text, float crease_angle_deg = 30) {
    MeshData mesh = io::read_stl(io::Source(std::string_view(text), "test.stl"), {crease_angle_deg});
    validate(mesh);
    return mesh;
}

/// What is said while a text is read.
std::string warnings_of(const std::string& text) {
    const LogCapture log;
    read(text);
    return log.text;
}

}  // namespace

TEST(Stl, WeldsAndKeepsSharpEdges) {
    for (const std::string& text :
         {binary(cube(), "made by a test"), binary(cube(), "solid not text"), ascii(cube())}) {
        // Eight corners, of which each has three faces at right angles; the two halves of a square share
        // theirs.
        const MeshData sharp = read(text, 30);
        EXPECT_EQ(sharp.F.rows(), 12);
        ASSERT_EQ(sharp.V.rows(), 24);
        for (int f = 0; f < 12; ++f)
            for (int k = 0; k < 3; ++k)
                EXPECT_NEAR(std::abs(sharp.N.row(sharp.F(f, k)).dot(sharp.N.row(sharp.F(f, 0)))), 1, 1e-6)
                    << "a corner's normal is that of its face";
        EXPECT_EQ(Vec3(sharp.N.row(sharp.F(0, 0))), Vec3(0, 0, -1));

        const MeshData smooth = read(text, 91);
        ASSERT_EQ(smooth.V.rows(), 8);
        EXPECT_TRUE(smooth.source_vertex.empty());
        for (int v = 0; v < 8; ++v) {
            // By symmetry the three right angles count the same: the normal is the diagonal.
            const Vec3 outward = (Vec3(smooth.V.row(v)) - Vec3(0.5f, 0.5f, 0.5f)).normalized();
            // The weights are corner angles, which vertex_normals() computes to about 1e-4.
            EXPECT_NEAR((Vec3(smooth.N.row(v)) - outward).norm(), 0, 1e-4);
        }
    }
}

TEST(Stl, JoinsFacesRoundACylinderButNotItsLid) {
    // 24 sides meet at 15 degrees, the lid at 90: one ring of normals for the side, one for the lid.
    constexpr int sides = 24;
    std::vector<Triangle> triangles;
    for (int i = 0; i < sides; ++i) {
        const double a = 2 * pi * i / sides, b = 2 * pi * ((i + 1) % sides) / sides;
        const std::array<float, 3> a0{float(std::cos(a)), 0, float(-std::sin(a))},
            b0{float(std::cos(b)), 0, float(-std::sin(b))};
        const std::array<float, 3> a1{a0[0], 1, a0[2]}, b1{b0[0], 1, b0[2]};
        triangles.push_back({a0, b0, b1});
        triangles.push_back({a0, b1, a1});
        triangles.push_back({a1, b1, {0, 1, 0}});
    }
    EXPECT_EQ(read(binary(triangles, ""), 30).V.rows(), sides * 3 + 1);
    // At 10 degrees every side has corners of its own.
    EXPECT_EQ(read(binary(triangles, ""), 10).V.rows(), sides * 5 + 1);
}

TEST(Stl, ReadsManyTextFacets) {
    // About 1.6 MB: more than one piece. Facets stand apart along x, so that none share a vertex.
    std::vector<Triangle> triangles;
    for (int i = 0; i < 12000; ++i)
        triangles.push_back({{{i * 2.f, 0, 0}, {i * 2.f + 1, 0, 0}, {i * 2.f, 1, 0}}});
    const std::string text = ascii(triangles);
    ASSERT_GT(text.size(), 1'200'000u);
    const MeshData mesh = read(text);
    ASSERT_EQ(mesh.F.rows(), 12000);
    ASSERT_EQ(mesh.V.rows(), 36000);
    for (int i = 0; i < 12000; ++i) ASSERT_EQ(mesh.V(mesh.F(i, 1), 0), i * 2.f + 1);
}

// A cut anywhere before the last line leaves a facet without its end.
TEST(Stl, RefusesTextThatIsCutOff) {
    const std::string text = ascii(cube());
    EXPECT_EQ(warnings_of(text), "");
    const std::string whole = text.substr(0, text.find("endsolid"));
    EXPECT_EQ(read(whole).F.rows(), 12);
    EXPECT_NE(warnings_of(whole).find("'endsolid' is missing"), std::string::npos);
    const size_t last = text.rfind("  facet");
    for (size_t end = last + 7; end + 3 < whole.size(); ++end)
        EXPECT_THROW(read(text.substr(0, end)), FormatError) << text.substr(last, end - last);
    EXPECT_THROW(read("solid a\nfacet normal 0 0 1\n" + text.substr(text.find('\n') + 1)), FormatError)
        << "a facet inside another";
    EXPECT_EQ(warnings_of(text + "\n \r\n"), "");
    EXPECT_EQ(warnings_of(text + text), "") << "several solids";
}

TEST(Stl, ReadsBinaryFilesBeforeOtherBytesWhateverTheirHeader) {
    const LogCapture log;
    for (const std::string title : {"solid cube", "made by a test"}) {
        EXPECT_EQ(read(binary(cube(), title) + "\n").F.rows(), 12) << title;
        EXPECT_EQ(read(binary(cube(), title) + std::string(100, 'x')).F.rows(), 12) << title;
        const std::string whole = binary(cube(), title);
        try {
            read(whole.substr(0, whole.size() - 60));
            FAIL() << title;
        } catch (const FormatError& error) {
            EXPECT_NE(std::string(error.what()).find("truncated: 12 facets"), std::string::npos);
        }
    }
    EXPECT_EQ(log.text, "");
}

// The last byte of a facet has bit 15 of its attributes.
TEST(Stl, NamesColorsOfFacets) {
    std::string viscam = binary(cube(), "made by a test");
    EXPECT_EQ(warnings_of(viscam), "");
    viscam[84 + 50 * 7 + 49] = '\x80';
    EXPECT_NE(warnings_of(viscam).find("colours of facets are left out"), std::string::npos);
    EXPECT_NE(warnings_of(binary(cube(), "COLOR=abcd")).find("colours of facets"), std::string::npos);
}

}  // namespace easypbr::stl_test
