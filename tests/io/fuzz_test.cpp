// Mutated files: each must load as a valid mesh or throw easypbr::Error. EASYPBR_FUZZ_COUNT sets the number
// per file.
#include <cstdlib>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "easypbr/core/error.h"
#include "easypbr/io/archive/deflate.h"
#include "easypbr/io/mesh/mesh_io.h"
#include "easypbr/io/mesh/mesh_readers.h"
#include "easypbr/io/mesh/obj/mtl_reader.h"
#include "io/bytes.h"
#include "io/las_builder.h"
#include "io/npy_builder.h"
#include "io/ply_builder.h"

namespace easypbr::fuzz_test {

namespace {

int fuzz_count() {
    const char* count = std::getenv("EASYPBR_FUZZ_COUNT");
    return count ? std::atoi(count) : 200;
}

/// One to four changes: a byte, a run of bytes, a number replaced by an extreme one, a piece cut out, doubled
/// or the end lost.
std::string mutate(std::string text, std::mt19937& random) {
    static const std::vector<std::string> extremes{"-1",   "0",   "4294967295", "2147483648",
                                                   "1e39", "nan", "-",          "99999999999999999999",
                                                   "\\\n", "#",   "/",          ""};
    const int changes = 1 + int(random() % 4);
    for (int i = 0; i < changes && !text.empty(); ++i) {
        const size_t place = random() % text.size(),
                     length = std::min<size_t>(random() % 16, text.size() - place);
        switch (random() % 6) {
            case 0:
                text[place] = char(random());
                break;
            case 1:
                text[place] = char(text[place] ^ (1 << random() % 8));
                break;
            case 2:
                text.replace(place, length, extremes[random() % extremes.size()]);
                break;
            case 3:
                text.erase(place, length);
                break;
            case 4:
                text.insert(place, text.substr(random() % text.size(), length));
                break;
            default:
                text.resize(place);
                break;
        }
    }
    return text;
}

void fuzz(const std::string& text, const std::function<void(const io::Source&)>& read) {
    std::mt19937 random(12345);
    int loaded = 0, refused = 0;
    ASSERT_NO_THROW(read(io::Source(std::string_view(text), "/nowhere/fuzz")));
    for (int i = 0; i < fuzz_count(); ++i) {
        const std::string mutated = mutate(text, random);
        try {
            read(io::Source(std::string_view(mutated), "/nowhere/fuzz"));
            ++loaded;
        } catch (const Error&) {
            ++refused;
        } catch (const std::exception& error) {
            ADD_FAILURE() << "mutation " << i << ": " << error.what();
        }
    }
    EXPECT_GT(refused, 0);
    EXPECT_GT(loaded, 0);
}

std::string ply_file(const std::string& format) {
    PlyBuilder ply(format);
    ply.header("comment TextureFile gone.png\nelement camera 1\nproperty list int float k\nelement vertex 5");
    ply.header("property float x\nproperty double y\nproperty short z\nproperty float nx\nproperty float ny");
    ply.header(
        "property float nz\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nproperty int "
        "label");
    ply.header("element face 3\nproperty list uchar int vertex_indices\nproperty list uchar float texcoord");
    ply.header(
        "element tristrips 1\nproperty list int int vertex_indices\nelement edge 1\nproperty int vertex1");
    ply.header("property int vertex2").end_header();
    ply.value("int", 1).value("float", 2).end_row();
    for (int i = 0; i < 5; ++i) {
        ply.value("float", i).value("double", i % 2).value("short", 10).values("float", {0, 0, 1});
        ply.values("uchar", {1, 2, 3}).value("int", i).end_row();
    }
    ply.value("uchar", 3)
        .values("int", {0, 1, 2})
        .value("uchar", 6)
        .values("float", {0, 0, 1, 0, 0, 1})
        .end_row();
    ply.value("uchar", 4)
        .values("int", {0, 1, 2, 3})
        .value("uchar", 8)
        .values("float", {0, 0, 1, 0, 1, 1, 0, 0})
        .end_row();
    ply.value("uchar", 3).values("int", {2, 3, 4}).value("uchar", 0).end_row();
    ply.values("int", {6, 0, 1, 2, -1, 3, 4}).end_row();
    ply.values("int", {0, 4}).end_row();
    return ply.text();
}

void read_valid_ply(const io::Source& source) {
    validate(io::read_ply(source));
}

}  // namespace

TEST(Fuzz, PlyAscii) {
    fuzz(ply_file("ascii"), read_valid_ply);
}
TEST(Fuzz, PlyLittleEndian) {
    fuzz(ply_file("binary_little_endian"), read_valid_ply);
}
TEST(Fuzz, PlyBigEndian) {
    fuzz(ply_file("binary_big_endian"), read_valid_ply);
}

TEST(Fuzz, PlyTriangles) {
    PlyBuilder ply("binary_little_endian");
    ply.header("element vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 4");
    ply.header("property list uchar int vertex_indices").end_header();
    ply.values("float", {0, 0, 0, 1, 0, 0, 0, 1, 0});
    for (int i = 0; i < 4; ++i) ply.value("uchar", 3).values("int", {0, 1, 2});
    fuzz(ply.text(), read_valid_ply);
}

namespace {

/// A header for nine points; `body` makes what follows it.
std::string pcd_file(const std::string& data, const std::string& body) {
    return "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z rgb label heat\nSIZE 4 4 8 4 2 4\nTYPE F F F F U F\n"
           "COUNT 1 1 1 1 1 2\nWIDTH 9\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 9\nDATA " +
           data + "\n" + body;
}

/// Nine times 30 bytes of numbers that are finite, whatever they are read as.
std::string pcd_numbers() {
    std::string bytes(270, '\0');
    for (size_t i = 0; i < bytes.size(); ++i) bytes[i] = char(i % 4 == 3 ? 0x3f : i);
    return bytes;
}

void read_valid_pcd(const io::Source& source) {
    validate(io::read_pcd(source));
}

}  // namespace

TEST(Fuzz, PcdAscii) {
    std::string body;
    for (int i = 0; i < 9; ++i) body += fmt::format("{} {}.5 -{} 1671168 {} 0.5 nan\n", i, i, i, i * 7);
    fuzz(pcd_file("ascii", body), read_valid_pcd);
}

TEST(Fuzz, PcdBinary) {
    fuzz(pcd_file("binary", pcd_numbers()), read_valid_pcd);
}

TEST(Fuzz, PcdCompressed) {
    const std::string numbers = pcd_numbers();
    std::string data;
    // The first 238 bytes as literals, the last 32 as a match of 4 bytes before.
    for (size_t i = 0; i < 238; i += 17) data += char(16) + numbers.substr(i, 17);
    data += std::string("\xe0\x17\x03", 3);
    const uint32_t sizes[] = {uint32_t(data.size()), 270};
    std::string body(8, '\0');
    std::memcpy(body.data(), sizes, 8);
    fuzz(pcd_file("binary_compressed", body + data), read_valid_pcd);
}

namespace {

void read_valid_xyz(const io::Source& source) {
    validate(io::read_xyz(source));
}

/// A structured array of 20 points.
std::string npy_file() {
    std::string data;
    for (int i = 0; i < 20 * 21; ++i) data += char(i % 4 == 3 ? 0x3f : i);
    return npy("[('xyz', '<f4', (3,)), ('rgb', '|u1', (3,)), ('', '|V2'), ('label', '<i4')]", "(20,)", data);
}

}  // namespace

TEST(Fuzz, Xyz) {
    std::string text = "# x y z red green blue heat\n";
    for (int i = 0; i < 20; ++i) text += fmt::format("{} {}.5 -{}e1 {} 7 8 nan\n", i, i * i, i, i * 12);
    fuzz(text, read_valid_xyz);
}

TEST(Fuzz, CsvWithoutNames) {
    std::string text;
    for (int i = 0; i < 20; ++i) text += fmt::format("{}, {}.5,,{},7,8\n", i, i * i, i * 12);
    for (int i = 0; i < 20; ++i) text += fmt::format("{}, {}.5,1,{},7,8\n", i, i * i, i * 12);
    fuzz(text, read_valid_xyz);
}

TEST(Fuzz, Npy) {
    fuzz(npy_file(), [](const io::Source& source) { validate(io::read_npy(source)); });
}

TEST(Fuzz, NpyInColumns) {
    std::string data;
    for (int i = 0; i < 20 * 7; ++i) data += Bytes().add(float(i)).str();
    fuzz(npy("'<f4'", "(20, 7)", data, true),
         [](const io::Source& source) { validate(io::read_npy(source)); });
}

TEST(Fuzz, Npz) {
    // Checksums would refuse nearly every mutation within the arrays: the arrays are mutated before they are
    // packed.
    const std::string faces =
        npy("'<i8'", "(2, 4)", Bytes().add_all<int64_t>({0, 1, 2, 3, 4, 5, 6, 7}).str());
    fuzz(npy_file() + faces, [](const io::Source& source) {
        const std::string text(source.bytes);
        const size_t half = std::min(text.size(), npy_file().size());
        const std::string archive = npz({{"V.npy", text.substr(0, half)}, {"F.npy", text.substr(half)}});
        validate(io::read_npz(io::Source(std::string_view(archive), source.path)));
    });
}

TEST(Fuzz, Zip) {
    fuzz(npz({{"V.npy", npy_file()}, {"readme.txt", "hello"}}),
         [](const io::Source& source) { validate(io::read_npz(source)); });
}

TEST(Fuzz, Kitti) {
    std::string data;
    for (int i = 0; i < 20 * 4; ++i) data += Bytes().add(float(i)).str();
    fuzz(data, [](const io::Source& source) { validate(io::read_kitti(source)); });
}

TEST(Fuzz, Splat) {
    std::string data;
    for (int i = 0; i < 20 * 8; ++i) data += Bytes().add(float(i)).str();
    fuzz(data, [](const io::Source& source) { validate(io::read_splat(source)); });
}

TEST(Fuzz, Spz) {
    Bytes bytes;
    bytes.add_all<uint32_t>({0x5053474e, 3, 9}).add_all<uint8_t>({1, 12, 0, 0});
    for (int i = 0; i < 9 * 29; ++i) bytes.add(uint8_t(i));
    // Mutated before it is packed: the packing notices most of what is done to it.
    fuzz(bytes.str(), [](const io::Source& source) {
        const std::string packed = io::gzip(source.bytes);
        validate(io::read_spz(io::Source(std::string_view(packed), source.path)));
    });
    fuzz(io::gzip(bytes.str()), [](const io::Source& source) { validate(io::read_spz(source)); });
}

TEST(Fuzz, PackedPly) {
    PlyBuilder ply("binary_little_endian");
    ply.header("element chunk 1");
    for (const char* name : {"min_x", "min_y", "min_z", "max_x", "max_y", "max_z", "min_scale_x",
                             "min_scale_y", "min_scale_z", "max_scale_x", "max_scale_y", "max_scale_z"})
        ply.header(fmt::format("property float {}", name));
    ply.header("element vertex 5");
    for (const char* name : {"position", "rotation", "scale", "color"})
        ply.header(fmt::format("property uint packed_{}", name));
    ply.header("element sh 5");
    for (int i = 0; i < 9; ++i) ply.header(fmt::format("property uchar f_rest_{}", i));
    ply.end_header();
    for (int i = 0; i < 12; ++i) ply.value("float", i);
    for (int i = 0; i < 20; ++i) ply.value("uint", i * 1000003);
    for (int i = 0; i < 45; ++i) ply.value("uchar", i);
    fuzz(ply.text(), read_valid_ply);
}

TEST(Fuzz, Las) {
    LasBuilder las{.minor_version = 4, .format = 7, .points = 5};
    las.extra_record = las_extra(4, "height", 0.01, 100) + las_extra(21, "wave");
    las.extra_bytes = std::string(5, '\1');
    fuzz(las.text(), [](const io::Source& source) { validate(io::read_las(source)); });
    fuzz(LasBuilder{.format = 3}.text(), [](const io::Source& source) { validate(io::read_las(source)); });
}

TEST(Fuzz, Obj) {
    fuzz(
        "mtllib gone.mtl\nv 0 0 0 1 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 1\nvn 0 0 1\nusemtl a\nf "
        "1/1/1 2/2/1 3/1/1 4/2/1\n"
        "usemtl b\nf -1//-1 -2//-1 \\\n -3//-1\nf 1 2 3\nl 1 2 -1\n",
        [](const io::Source& source) { validate(io::read_obj(source, {})); });
}

TEST(Fuzz, Mtl) {
    fuzz(
        "newmtl a\nKd 0.1 0.2 0.3\nKe 1 1 1\nNs 30\nPr 0.5\nPm 1\nd -halo 0.5\nTr 0.5\nillum 2\nmap_Kd -s 1 "
        "2 -o 0 0 0 -clamp on gone.png\n"
        "norm -bm 0.5 gone.png\nnewmtl b\nmap_Ks gone.png\n",
        [](const io::Source& source) {
            io::TextureLoader textures(source.path);
            // Every mutation is read; what is not understood is left out, so one that is refused is made
            // here.
            if (io::read_mtl(source, textures).empty()) throw FormatError("no material");
        });
}

TEST(Fuzz, StlBinary) {
    std::string text(84 + 3 * 50, '\0');
    text[80] = 3;
    for (size_t i = 0; i < 27; ++i) {
        const float value = float(i * i % 5);
        std::memcpy(text.data() + 84 + i / 9 * 50 + 12 + i % 9 * 4, &value, 4);
    }
    fuzz(text, [](const io::Source& source) { validate(io::read_stl(source, {})); });
}

TEST(Fuzz, StlText) {
    std::string text = "solid a\n";
    for (int i = 0; i < 3; ++i)
        text += fmt::format(
            "facet normal 0 0 1\n outer loop\n  vertex {0} 0 0\n  vertex 1 0 {0}\n  vertex 0 1 0\n "
            "endloop\nendfacet\n",
            i);
    fuzz(text + "endsolid a\n", [](const io::Source& source) { validate(io::read_stl(source, {})); });
}

TEST(Fuzz, Off) {
    fuzz("COFF # kind\n4 2 0\n0 0 0 255 0 0\n1 0 0 0 255 0\n1 1 0 0 0 255\n0 1 0 9 9 9\n4 0 1 2 3\n3 0 1 2\n",
         [](const io::Source& source) { validate(io::read_off(source)); });
}

}  // namespace easypbr::fuzz_test
