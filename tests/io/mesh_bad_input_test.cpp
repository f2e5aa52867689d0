#include <chrono>
#include <string>
#include <vector>

#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "easypbr/io/mesh/mesh_io.h"
#include "io/bytes.h"
#include "io/las_builder.h"
#include "io/npy_builder.h"
#include "io/ply_builder.h"
#include "io/temporary_folder.h"

namespace easypbr::mesh_bad_input_test {

namespace {

struct BadFile {
    std::string name, content, message;
};

const std::string ply_head = "ply\nformat ascii 1.0\n";
const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
const std::string faces = "property list uchar int vertex_indices\n";
const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

std::string binary_ply(const std::string& counts) {
    return "ply\nformat binary_little_endian 1.0\n" + counts + "end_header\n" + std::string(36, '\0');
}

std::string stl(uint32_t facets, size_t bytes) {
    std::string text(bytes, '\0');
    std::memcpy(text.data() + 80, &facets, 4);
    return text;
}

/// Two points x y z of float32, and a header that may lie about them.
std::string pcd(const std::string& data, const std::string& body, const std::string& points = "2",
                const std::string& types = "F F F", const std::string& sizes = "4 4 4") {
    return "VERSION 0.7\nFIELDS x y z\nSIZE " + sizes + "\nTYPE " + types + "\nCOUNT 1 1 1\nPOINTS " +
           points + "\nDATA " + data + "\n" + body;
}

/// What stands before compressed data, and the data.
std::string lzf(uint32_t compressed, uint32_t full, const std::string& data) {
    std::string text(8, '\0');
    std::memcpy(text.data(), &compressed, 4);
    std::memcpy(text.data() + 4, &full, 4);
    return text + data;
}

/// Four thousand rows, and one that is none: not among those that are looked at before reading.
std::string late_word() {
    std::string text;
    for (int i = 0; i < 4000; ++i) text += "1 2 3\n";
    text += "1 two 3\n";
    for (int i = 0; i < 3000; ++i) text += "1 2 3\n";
    return text;
}

std::string npy_of(const std::string& descr, const std::string& shape, size_t bytes) {
    return npy(descr, shape, std::string(bytes, '\0'));
}

std::string las_with(size_t place, const std::string& bytes) {
    std::string text = LasBuilder().text();
    return text.replace(place, bytes.size(), bytes);
}

/// An archive with bytes of its end or of an entry changed.
std::string damaged_npz(size_t back, char byte) {
    std::string text = npz({{"V.npy", npy_of("'<f4'", "(3, 3)", 36)}});
    text[text.size() - back] = byte;
    return text;
}

const std::vector<BadFile> bad_files{
    {"empty.ply", "", "empty"},
    {"magic.ply", "obj\n", "'ply' expected"},
    {"header.ply", ply_head + "element vertex 3\n", "end_header"},
    {"keyword.ply", ply_head + "elephant vertex 3\nend_header\n", "elephant"},
    {"format.ply", "ply\nformat binary_middle_endian 1.0\nend_header\n", "binary_middle_endian"},
    {"noformat.ply", "ply\nelement vertex 1\n" + xyz + "end_header\n0 0 0\n", "format"},
    {"type.ply", ply_head + "element vertex 1\nproperty quad x\nend_header\n", "quad"},
    {"count.ply", ply_head + "element vertex -1\n" + xyz + "end_header\n", "-1"},
    {"noxyz.ply", ply_head + "element vertex 1\nproperty float x\nend_header\n0\n", "x, y, z"},
    {"novertices.ply", ply_head + "element face 0\n" + faces + "end_header\n", "no vertices"},
    {"zero.ply", ply_head + "element vertex 0\n" + xyz + "end_header\n", "no vertices"},
    {"short.ply", ply_head + "element vertex 2\n" + xyz + "end_header\n0 0 0\n", "2 rows"},
    {"cut.ply", ply_head + "element vertex 2\n" + xyz + "end_header\n0 0 0\n1 1\n", "cut.ply:9"},
    {"word.ply", ply_head + "element vertex 1\n" + xyz + "end_header\n0 zero 0\n", "'zero'"},
    {"lying.ply", ply_head + "element vertex 2000000000\n" + xyz + "end_header\n0 0 0\n", "2000000000"},
    {"nan.ply",
     ply_head + "element vertex 1\n" + xyz + "element face 1\n" + faces + "end_header\n0 nan 0\n3 0 0 0\n",
     "vertex 0"},
    {"inf.ply",
     ply_head + "element vertex 2\n" + xyz + "element face 1\n" + faces +
         "end_header\n0 0 0\n1e99 0 0\n3 0 0 1\n",
     "vertex 1"},
    {"nancloud.ply", ply_head + "element vertex 2\n" + xyz + "end_header\n0 nan 0\n1e99 0 0\n",
     "no point of 2"},
    {"range.ply",
     ply_head + "element vertex 3\n" + xyz + "element face 1\n" + faces +
         "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n",
     "index 3"},
    {"negative.ply",
     ply_head + "element vertex 1\n" + xyz + "element face 1\n" + faces + "end_header\n0 0 0\n3 0 0 -1\n",
     "index -1"},
    {"longlist.ply",
     ply_head + "element vertex 1\n" + xyz + "element face 1\n" + faces + "end_header\n0 0 0\n2000000000 0\n",
     "2000000000"},
    {"realindex.ply",
     ply_head + "element vertex 1\n" + xyz +
         "element face 1\nproperty list uchar float vertex_indices\nend_header\n0 0 0\n3 0 0 0\n",
     "list of integers"},
    {"bincut.ply", binary_ply("element vertex 4\n" + xyz), "4 rows"},
    {"binlying.ply", binary_ply("element vertex 2147483647\n" + xyz), "2147483647"},
    {"binfaces.ply", binary_ply("element vertex 3\n" + xyz + "element face 1\n" + faces), "1 rows"},
    {"empty.obj", "", "empty"},
    {"nothing.obj", "# nothing\n", "no vertices"},
    {"short.obj", "v 0 0 0\nv 1 2\n", "short.obj:2"},
    {"zero.obj", square + "f 0 1 2\n", "index 0"},
    {"range.obj", square + "f 1 2 5\n", "index 5, expected 1 to 4"},
    {"before.obj", square + "f -5 1 2\n", "a face"},
    {"uv.obj", square + "vt 0 0\nf 1/1 2/2 3/1\n", "texture coordinates"},
    {"normal.obj", square + "vn 0 0 1\nf 1//1 2//-2 3//1\n", "normals"},
    {"word.obj", square + "f 1 2 x\n", "word.obj:5"},
    {"corner.obj", square + "f 1/a 2/2 3\n", "'a'"},
    {"nan.obj", "v 0 0 nan\n", "vertex 0"},
    {"line.obj", square + "l 1", "'l'"},
    {"huge.obj", square + "f 1 2 99999999999999999999\n", "a face"},
    {"empty.stl", "", "empty"},
    {"tiny.stl", "abc", "truncated"},
    {"lying.stl", stl(4000000000u, 200), "truncated"},
    {"none.stl", stl(0, 84), "no facets"},
    {"text.stl", "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nendloop\nendfacet\n",
     "2 vertices"},
    {"number.stl", "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0\n", "number.stl:4"},
    {"cut.stl", "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\n",
     "inside a facet"},
    {"nan.stl",
     "solid\nfacet normal 0 0 1\nouter loop\nvertex nan 0 0\nvertex 1 0 0\nvertex 1 1 0\nendloop\nendfacet\n",
     "vertex"},
    {"empty.off", "", "empty"},
    {"kind.off", "4OFF\n1 0 0\n0 0 0 0\n", "4OFF"},
    {"binary.off", "OFF BINARY\n", "binary"},
    {"counts.off", "OFF\n1\n", "header"},
    {"short.off", "OFF\n2 0 0\n0 0 0\n", "2 rows"},
    {"lying.off", "OFF\n2000000000 0 0\n0 0 0\n", "2000000000"},
    {"range.off", "OFF\n1 1 0\n0 0 0\n3 0 0 1\n", "index 1"},
    {"color.off", "COFF\n1 0 0\n0 0 0\n", "colours"},
    {"empty.pcd", "", "empty"},
    {"nodata.pcd", "VERSION 0.7\nFIELDS x y z\n", "'DATA'"},
    {"form.pcd", pcd("binary_squashed", ""), "binary_squashed"},
    {"keyword.pcd", "ELEPHANTS 3\n", "ELEPHANTS"},
    {"fields.pcd", "VERSION 0.7\nPOINTS 0\nDATA ascii\n", "FIELDS"},
    {"sizes.pcd", "FIELDS x y z\nSIZE 4 4\nTYPE F F F\nPOINTS 1\nDATA ascii\n1 2 3\n", "SIZE has 2 entries"},
    {"nothing.pcd", "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 0 0 0\nPOINTS 2\nDATA ascii\n1\n2\n",
     "no positions"},
    {"nothing_binary.pcd",
     "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 0 0 0\nPOINTS 2\nDATA binary\n12345678", "no positions"},
    {"type.pcd", pcd("ascii", "1 2 3\n", "1", "F F Q"), "'Q'"},
    {"width.pcd", pcd("ascii", "1 2 3\n", "1", "F F F", "4 4 3"), "'3'"},
    {"contradiction.pcd", "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 3\nHEIGHT 2\nPOINTS 5\nDATA ascii\n",
     "WIDTH 3 x HEIGHT 2"},
    {"uncounted.pcd", "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nDATA ascii\n1 2 3\n", "POINTS"},
    {"negative.pcd", pcd("ascii", "", "-2"), "'-2'"},
    {"manyvalues.pcd",
     "FIELDS x y z h\nSIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 2000000000\nPOINTS 1\nDATA binary\n", "values"},
    {"zero.pcd", pcd("binary", "", "0"), "no points"},
    {"noxyz.pcd", "FIELDS u v\nSIZE 4 4\nTYPE F F\nPOINTS 1\nDATA ascii\n1 2\n", "x, y, z"},
    {"lying.pcd", pcd("ascii", "1 2 3\n", "2000000000"), "2000000000 points expected"},
    {"word.pcd", pcd("ascii", "1 2 3\n4 five 6\n"), "word.pcd:9"},
    {"cut.pcd", pcd("ascii", "1 2 3\n4 5\n"), "the line's end"},
    {"bincut.pcd", pcd("binary", std::string(23, '\0')), "truncated"},
    {"binlying.pcd", pcd("binary", std::string(24, '\0'), "2147483647"), "truncated"},
    {"nan.pcd", pcd("ascii", "nan nan nan\n1 inf 2\n"), "no point of 2"},
    {"lzfhead.pcd", pcd("binary_compressed", "1234"), "sizes"},
    {"lzfcut.pcd", pcd("binary_compressed", lzf(100, 24, "123")), "truncated"},
    {"lzfsize.pcd", pcd("binary_compressed", lzf(3, 25, "123")), "2 points of 12 bytes"},
    {"lzfbomb.pcd", pcd("binary_compressed", lzf(3, 1'200'000'000, "123"), "100000000"), "compressed"},
    {"lzfdamaged.pcd", pcd("binary_compressed", lzf(3, 24, "\x02zz")), "damaged"},
    {"empty.xyz", "", "empty"},
    {"blank.xyz", "\n\n  \n", "no points"},
    {"comments.xyz", "# nothing\n# x y z\n", "no points"},
    {"words.xyz", "once upon a time\n", "found once, upon"},
    {"two.xyz", "1 2\n3 4\n", "x, y, z"},
    {"short.xyz", "1 2 3\n4 5\n", "short.xyz:2"},
    {"word.xyz", "1 2 3\n4 5 six\n", "no positions"},
    {"lateword.xyz", late_word(), "lateword.xyz:4001"},
    {"comma.csv", "x;y;z\n1,5;2,5;3,5\n", "comma.csv:2"},
    {"names.csv", "x,y,z,heat\n1,2,3\n", "4 columns expected"},
    {"nopos.csv", "red,green,blue\n1,2,3\n", "found red, green, blue"},
    {"nan.csv", "x,y,z\nnan,1,2\n,,\n", "no point of 2"},
    {"lying.pts", "3\n1 2 3\n4 5 6\n", "3 points expected"},
    {"huge.pts", "99999999999\n1 2 3\n", "99999999999"},
    {"binary.xyz", std::string("\x7f\x45\x4c\x46\0\1\2\3", 8), "binary.xyz:1"},
    {"empty.npy", "", "empty"},
    {"magic.npy", "hello, world", "NumPy's mark"},
    {"cut.npy", npy_of("'<f4'", "(3, 3)", 36).substr(0, 40), "truncated"},
    {"short.npy", npy_of("'<f4'", "(3, 3)", 35), "truncated"},
    {"lying.npy", npy_of("'<f4'", "(4611686018427387905, 3)", 36), "truncated"},
    {"dict.npy", npy("'<f4', 'descr'", "(3, 3)", ""), "descr"},
    {"objects.npy", npy_of("'|O'", "(3, 3)", 72), "Python objects"},
    {"complex.npy", npy_of("'<c8'", "(3, 3)", 72), "numbers"},
    {"words.npy", npy_of("'<U4'", "(3, 3)", 144), "numbers"},
    {"nested.npy", npy_of("[('a', [('x', '<f4')])]", "(3,)", 12), "type"},
    {"orders.npy", npy_of("[('x', '<f4'), ('y', '>f4'), ('z', '<f4')]", "(3,)", 36), "byte orders"},
    {"flat.npy", npy_of("'<f4'", "(9,)", 36), "n x 3"},
    {"two.npy", npy_of("'<f4'", "(3, 2)", 24), "(3, 2)"},
    {"none.npy", npy_of("'<f4'", "(0, 3)", 0), "no points"},
    {"fields.npy", npy_of("[('a', '<f4'), ('b', '<f4')]", "(3,)", 24), "found a, b"},
    {"void.npy", npy_of("[('a', '|V0')]", "(1000000000000,)", 0), "numbers"},
    {"long.npy", npy_of("'|V18446744073709551615'", "(3,)", 36), "is too long"},
    {"longer.npy", npy_of("'|V18446744073709551616'", "(3,)", 36), "is not understood"},
    {"wide.npy", npy_of("'<U4611686018427387904'", "(3,)", 36), "is too long"},
    {"twice.npy",
     npy_of("[('x', '<f4'), ('y', '<f4'), ('z', '<f4'), ('w', '|V9223372036854775808', (2,))]", "(3,)", 36),
     "is too long"},
    {"side.npy", npy_of("'<f4'", "(0, 9223372036854775807)", 0), "more than 10000 values in a row"},
    {"empty.npz", "", "empty"},
    {"text.npz", "hello", "no ZIP archive"},
    {"noarray.npz", npz({{"readme.txt", "hello"}}), "no array of positions"},
    {"entry.npz", npz({{"V.npy", "hello"}}), "NumPy's mark"},
    {"checksum.npz", damaged_npz(150, 1), "checksum"},
    {"count.npz", damaged_npz(12, 9), "directory"},
    {"place.npz", damaged_npz(4, 9), "a header is cut off"},
    {"rows.npz", npz({{"V.npy", npy_of("'<f4'", "(3, 3)", 36)}, {"C.npy", npy_of("'|u1'", "(2, 3)", 6)}}),
     "array 'C': expected 3 rows of 3 numbers, one for each point, got shape (2, 3)"},
    {"cols.npz", npz({{"V.npy", npy_of("'<f4'", "(3, 3)", 36)}, {"N.npy", npy_of("'<f4'", "(3, 2)", 24)}}),
     "array 'N'"},
    {"range.npz",
     npz({{"V.npy", npy_of("'<f4'", "(3, 3)", 36)},
          {"F.npy", npy("'<i4'", "(1, 3)", Bytes().add_all({0, 1, 3}).str())}}),
     "index 3"},
    {"real.npz", npz({{"V.npy", npy_of("'<f4'", "(3, 3)", 36)}, {"F.npy", npy_of("'<f4'", "(1, 3)", 12)}}),
     "array 'F': expected integers"},
    {"offset.npz",
     npz({{"V.npy", npy_of("'<f4'", "(3, 3)", 36)}, {"offset.npy", npy_of("'<f8'", "(2,)", 16)}}),
     "array 'offset'"},
    {"empty.bin", "", "empty"},
    {"size.bin", std::string(33, '\0'), "not a multiple of 16"},
    {"nan.bin", std::string(32, '\xff'), "no point of 2"},
    {"empty.las", "", "empty"},
    {"magic.las", std::string(400, 'x'), "LASF"},
    {"cut.las", LasBuilder().text().substr(0, 100), "truncated"},
    {"version.las", las_with(25, "\x05"), "LAS 1.5"},
    {"format.las", las_with(104, "\x0b"), "point format 11"},
    {"record.las", las_with(105, "\x13"), "take 20 bytes, the file says 19"},
    {"body.las", las_with(96, "\xff\xff\xff\x7f"), "points begin at byte"},
    {"scale.las", las_with(131, std::string(8, '\0')), "scale"},
    {"nanoffset.las", las_with(155, std::string(8, '\xff')), "finite"},
    {"lying.las", las_with(107, "\xff\xff\xff\x7f"), "truncated: 2147483647 points"},
    {"many.las", las_with(107, "\xff\xff\xff\xff"), "4294967295 points"},
    {"none.las", las_with(107, std::string(4, '\0')), "no points"},
    {"unknown.xyzzy", "hello", "xyzzy"},
    {"unknown.plyy", "hello", "did you mean 'ply'"},
    {"noextension", "hello", "expected one of"},
};

}  // namespace

TEST(BadMeshes, AreRefusedWithTheReason) {
    const TemporaryFolder folder;
    for (const BadFile& file : bad_files) {
        write_file(folder / file.name, file.content);
        try {
            io::load_mesh(folder / file.name);
            ADD_FAILURE() << file.name << " was read";
        } catch (const FormatError& error) {
            const std::string message = error.what();
            EXPECT_NE(message.find(file.message), std::string::npos) << file.name << ": " << message;
            EXPECT_NE(message.find(file.name), std::string::npos) << "the file is not named: " << message;
        }
    }
}

// The array is left out with a warning, as others that cannot be read.
TEST(BadMeshes, EmptyArraysHaveNoMoreColumnsThanOthers) {
    const TemporaryFolder folder;
    write_file(folder / "side.npz", npz({{"V.npy", npy_of("'<f4'", "(3, 3)", 36)},
                                         {"F.npy", npy_of("'<i4'", "(0, 9223372036854775807)", 0)}}));
    EXPECT_EQ(io::load_mesh(folder / "side.npz").F().rows(), 0);
}

// Quadratic time would take minutes.
TEST(BadMeshes, ManyPropertiesTakeLinearTime) {
    const TemporaryFolder folder;
    std::string same = ply_head + "element vertex 1\n" + xyz, different = same, values = "end_header\n0 0 0";
    std::string of_faces = ply_head + "element vertex 3\n" + xyz + "element face 1\n" + faces;
    for (int i = 0; i < 50'000; ++i) {
        same += "property float a\n";
        different += "property float a" + std::to_string(i) + "\n";
        of_faces += "property float a" + std::to_string(i) + "\n";
        values += " 1";
    }
    const std::string row = values.substr(values.find(" 1"));
    write_file(folder / "same.ply", same + values + "\n");
    write_file(folder / "different.ply", different + values + "\n");
    write_file(folder / "faces.ply", of_faces + "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2" + row + "\n");
    for (const char* name : {"same.ply", "different.ply", "faces.ply"}) {
        const auto start = std::chrono::steady_clock::now();
        EXPECT_EQ(io::load_mesh(folder / name).snapshot()->scalars.size(), 50'000u) << name;
        const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
        EXPECT_LT(seconds.count(), 5) << name;
    }
}

TEST(BadMeshes, MissingFilesAndFoldersAreFileErrors) {
    const TemporaryFolder folder;
    fs::create_directory(folder / "folder.obj");
    for (const char* name : {"gone.ply", "gone.obj", "gone.stl", "gone.off", "gone.pcd", "gone.npz",
                             "gone.las", "gone.bin", "gone.csv", "folder.obj"})
        EXPECT_THROW(io::load_mesh(folder / name), FileError) << name;
}

TEST(BadMeshes, TruncatedAnywhereTheyLoadOrThrow) {
    PlyBuilder ply("binary_big_endian");
    ply.header("element vertex 3\n" + xyz + "element face 2\n" + faces + "property uchar f").end_header();
    for (int i = 0; i < 9; ++i) ply.value("float", i % 4);
    for (int i = 0; i < 2; ++i)
        ply.value("uchar", 3 + i)
            .values("int", {0, 1, 2})
            .values("int", std::vector<int>(size_t(i), 0))
            .value("uchar", 1);
    const TemporaryFolder folder;
    for (size_t size = 0; size < ply.text().size(); ++size) {
        write_file(folder / "cut.ply", ply.text().substr(0, size));
        EXPECT_THROW(io::load_mesh(folder / "cut.ply"), FormatError) << size << " bytes";
    }
    write_file(folder / "whole.ply", ply.text());
    EXPECT_EQ(io::load_mesh(folder / "whole.ply").F().rows(), 3);
}

}  // namespace easypbr::mesh_bad_input_test
