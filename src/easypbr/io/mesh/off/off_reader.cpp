#include <fmt/format.h>

#include <algorithm>

#include "easypbr/io/mesh/mesh_readers.h"
#include "easypbr/io/source/text_scanner.h"
#include "easypbr/io/tables/attributes.h"
#include "easypbr/io/tables/element_table.h"
#include "easypbr/scene/color_range.h"

namespace easypbr::io {
namespace {

/// The first line, [ST][C][N]OFF, and the counts (Geomview's manual, "OFF Files").
struct OffHeader {
    bool has_uv = false, has_color = false, has_normal = false;
    size_t vertices = 0, faces = 0;
    const char* body = nullptr;
};

class OffHeaderParser {
  public:
    explicit OffHeaderParser(const Source& source)
        : source_(source), p_(source.begin()), end_(source.end()) {}

    OffHeader parse() {
        std::string_view word = next_word();
        parse_keyword(word);
        header_.vertices = read_count("vertices");
        header_.faces = read_count("faces");
        header_.body = next_line(p_, end_);
        return header_;
    }

  private:
    /// The next word of this or a later line; comments are passed over.
    std::string_view next_word() {
        for (;;) {
            p_ = skip_blanks(p_, end_);
            if (p_ == end_) fail(source_, "the file ends inside its header");
            if (*p_ != '\n' && *p_ != '#') return read_word(p_, end_);
            p_ = next_line(p_, end_);
        }
    }

    void parse_keyword(std::string_view word) {
        const std::string_view whole = word;
        const auto take = [&](std::string_view prefix) {
            const bool found = word.starts_with(prefix);
            if (found) word.remove_prefix(prefix.size());
            return found;
        };
        header_.has_uv = take("ST");
        header_.has_color = take("C");
        header_.has_normal = take("N");
        if (word != "OFF")
            fail_at_line(source_, p_,
                         fmt::format("[ST][C][N]OFF expected, found '{}'; other kinds of OFF are not read",
                                     whole.substr(0, 40)));
    }

    size_t read_count(std::string_view what) {
        const std::string_view word = next_word();
        if (word == "BINARY") fail_at_line(source_, p_, "binary OFF is not read");
        const char* p = word.data();
        int32_t count = 0;
        if (!read_integer(p, word.data() + word.size(), count) || count < 0 || p != word.data() + word.size())
            fail_at_line(source_, p_,
                         fmt::format("the number of {} expected, found '{}'", what, word.substr(0, 40)));
        return size_t(count);
    }

    const Source& source_;
    const char* p_;
    const char* end_;
    OffHeader header_;
};

/// Words in the first row at or after `p`.
size_t words_in_row(const char* p, const char* end) {
    while (p != end) {
        size_t words = 0;
        for (std::string_view word = read_word(p, end); !word.empty() && word[0] != '#';
             word = read_word(p, end))
            ++words;
        if (words) return words;
        p = next_line(p, end);
    }
    return 0;
}

class OffReader {
  public:
    explicit OffReader(const Source& source) : source_(source), header_(OffHeaderParser(source).parse()) {}

    MeshData read() {
        if (header_.vertices == 0) fail(source_, "no vertices");
        describe_vertices();
        elements_[1] = {"face", header_.faces, {{"vertex_indices", ScalarType::int32, ScalarType::int32}}};
        check_text_rows(source_, header_.body, elements_);
        std::vector<ElementPlan> plans = plan();
        read_text_elements(source_, TextRows(source_, header_.body, {.comment = '#'}), plans);
        return make_mesh();
    }

  private:
    /// The number of words tells whether colours have three or four parts, and whether a plain OFF has
    /// colours at all.
    void describe_vertices() {
        const size_t words = words_in_row(header_.body, source_.end());
        const size_t others = 3 + (header_.has_normal ? 3 : 0) + (header_.has_uv ? 2 : 0);
        const size_t left = words > others ? words - others : 0;
        if (header_.has_color && left < 3)
            fail_at_line(source_, header_.body,
                         fmt::format("{} numbers per vertex are too few for colours", words));
        color_parts_ = header_.has_color || left == 3 || left == 4 ? std::min<size_t>(left, 4) : 0;
        const size_t numbers = others + color_parts_;
        elements_[0] = {"vertex", header_.vertices,
                        std::vector<Property>(numbers, {"vertex", ScalarType::float32, {}})};
    }

    std::vector<ElementPlan> plan() {
        std::vector<ElementPlan> plans{{&elements_[0], std::vector<Column>(elements_[0].properties.size())},
                                       {&elements_[1], std::vector<Column>(1)}};
        size_t next = 0;
        const auto take = [&](auto& matrix, size_t width) {
            if (width == 0) return;
            matrix.resize(Eigen::Index(header_.vertices), Eigen::Index(width));
            for (size_t i = 0; i < width; ++i) {
                plans[0].columns[next].floats = matrix.data() + i;
                plans[0].columns[next++].stride = width;
            }
        };
        take(V_, 3);
        take(N_, header_.has_normal ? 3 : 0);
        take(C_, color_parts_);
        take(UV_, header_.has_uv ? 2 : 0);
        plans[1].columns[0].indices = &faces_;
        return plans;
    }

    MeshData make_mesh() {
        check_positions(source_, V_);
        check_indices(source_, {faces_.values.data(), faces_.value_count()}, header_.vertices, "a face");
        tidy_normals(N_);
        normalize_colors(C_);
        tidy_colors(C_);
        tidy_uv(UV_);
        MeshData mesh;
        mesh.V = std::move(V_);
        if (N_.size()) mesh.N = std::move(N_);
        if (C_.size()) mesh.C = std::move(C_);
        if (UV_.size()) mesh.UV = std::move(UV_);
        triangulate(std::move(faces_), mesh);
        return mesh;
    }

    const Source& source_;
    const OffHeader header_;
    size_t color_parts_ = 0;
    std::vector<Element> elements_{2};
    Array3f::Dense V_, N_;
    ArrayXf::Dense C_;
    Array2f::Dense UV_;
    Polygons faces_;
};

}  // namespace

MeshData read_off(const Source& source) {
    if (source.bytes.empty()) fail(source, "the file is empty");
    return OffReader(source).read();
}

}  // namespace easypbr::io
