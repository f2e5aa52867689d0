// What editors and old programs make of text files: byte order marks, and lines that end by CR alone.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "easypbr/core/file.h"
#include "easypbr/io/mesh/content_format.h"
#include "easypbr/io/mesh/mesh_io.h"
#include "io/temporary_folder.h"

namespace easypbr::text_files_test {
namespace {

struct TextFile {
    std::string name, text;
    bool ends_lines_by_cr;  ///< may do so: what follows the header is never binary
};

const std::vector<TextFile> triangles{
    {"a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", true},
    {"a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", true},
    {"a.stl",
     "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n"
     "endsolid\n",
     true},
    {"a.ply",
     "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
     "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
     false}};

const std::vector<TextFile> clouds{{"a.xyz", "0 0 0\n1 0 0\n0 1 0\n", true},
                                   {"a.csv", "x,y,z\n0,0,0\n1,0,0\n0,1,0\n", true},
                                   {"a.pcd",
                                    "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH "
                                    "3\nHEIGHT 1\nPOINTS 3\nDATA ascii\n"
                                    "0 0 0\n1 0 0\n0 1 0\n",
                                    false}};

const Array3f::Dense corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};

const std::string mark = "\xef\xbb\xbf";

TEST(TextFiles, ByteOrderMarksAreNoContent) {
    const TemporaryFolder folder;
    for (const auto* files : {&triangles, &clouds})
        for (const TextFile& file : *files) {
            write_file(folder / file.name, mark + file.text);
            const Mesh mesh(folder / file.name);
            EXPECT_EQ(mesh.V(), corners) << file.name;
            EXPECT_EQ(mesh.F().rows(), files == &triangles ? 1 : 0) << file.name;
            EXPECT_EQ(io::format_of_content(mark + file.text), io::format_of_content(file.text));
        }
}

TEST(TextFiles, LinesMayEndByCarriageReturnsAlone) {
    const TemporaryFolder folder;
    for (const auto* files : {&triangles, &clouds})
        for (const TextFile& file : *files) {
            if (!file.ends_lines_by_cr) continue;
            std::string text = file.text;
            std::ranges::replace(text, '\n', '\r');
            write_file(folder / file.name, text);
            const Mesh mesh(folder / file.name);
            EXPECT_EQ(mesh.V(), corners) << file.name;
            EXPECT_EQ(mesh.F().rows(), files == &triangles ? 1 : 0) << file.name;
        }
}

TEST(TextFiles, MaterialsToo) {
    const TemporaryFolder folder;
    write_file(folder / "a.obj", "mtllib a.mtl\nusemtl red\n" + triangles[0].text);
    for (const std::string& text : {mark + "newmtl red\nKd 1 0 0\n", std::string("newmtl red\rKd 1 0 0\r")}) {
        write_file(folder / "a.mtl", text);
        EXPECT_EQ(Mesh(folder / "a.obj").snapshot()->materials.at(0).base_color, Vec3(1, 0, 0));
    }
}

// The bytes of a mark may also be those of a number.
TEST(TextFiles, BinaryFilesKeepAllBytes) {
    const TemporaryFolder folder;
    std::string scan = mark + "\x3f" + std::string(12, '\0');
    write_file(folder / "a.bin", scan);
    EXPECT_EQ(Mesh(folder / "a.bin").V().rows(), 1);
}

}  // namespace
}  // namespace easypbr::text_files_test
