#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "easypbr/core/ascii.h"
#include "easypbr/core/log.h"
#include "easypbr/core/memory_budget.h"
#include "easypbr/core/parallel.h"
#include "easypbr/io/mesh/mesh_readers.h"
#include "easypbr/io/source/text_scanner.h"
#include "easypbr/io/tables/attributes.h"
#include "easypbr/io/tables/element_table.h"
#include "easypbr/io/tables/vertex_arrays.h"
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
        // Files of ModelNet have no blank before the first count: "OFF490 518 0".
        if (word.size() > 3 && word.starts_with("OFF") && ascii::is_digit(word[3]))
            p_ = word.data() + 3;
        else if (word != "OFF")
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
        const TextRows rows(source_, header_.body, {.comment = '#'});
        read_text_elements(source_, rows, plans);
        read_colors_of_faces(rows);
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
        const size_t numbers = elements_[0].properties.size();
        charge_memory(uint64_t(header_.vertices) * numbers * sizeof(float), "its vertices");
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

    /// What stands behind the indices of a face: nothing, a place in a colour map, or three or four numbers.
    static std::vector<float> color_behind_indices(const char* p, const char* end) {
        double corners = 0;
        read_number(p, end, corners);
        for (double i = 0; i < corners; ++i) read_word(p, end);
        std::vector<float> color;
        for (float value = 0; color.size() < 4 && read_number(p, end, value);) color.push_back(value);
        return color;
    }

    /// Whether something stands behind the indices of any face. Samples tell where many have colours.
    bool has_colors_of_faces(const TextRows& rows) const {
        const auto samples = sample_rows(rows, header_.vertices, header_.faces);
        const auto is_colored = [&](const char* row) {
            return color_behind_indices(row, source_.end()).size() > 0;
        };
        if (std::ranges::any_of(samples, is_colored)) return true;
        if (samples.size() == header_.faces) return false;
        std::atomic<bool> any{false};
        parallel_for(rows.chunks.size(), 1, [&](size_t i) {
            size_t row = rows.chunks[i].first_row;
            for_each_row(rows.chunks[i], [&](const char* p) {
                const size_t face = row++ - header_.vertices;
                if (face < header_.faces && !any && is_colored(p)) any = true;
            });
        });
        return any;
    }

    /// Faces may have colours each on its own; those without one are white beside others.
    void read_colors_of_faces(const TextRows& rows) {
        if (!has_colors_of_faces(rows)) return;
        charge_memory(uint64_t(header_.faces) * 4 * sizeof(float), "the colours of its faces");
        ArrayXf::Dense C = ArrayXf::Dense::Constant(Eigen::Index(header_.faces), 4, NAN);
        std::atomic<size_t> mapped{0}, colored{0};
        parallel_for(rows.chunks.size(), 1, [&](size_t i) {
            size_t row = rows.chunks[i].first_row;
            for_each_row(rows.chunks[i], [&](const char* p) {
                const size_t face = row++ - header_.vertices;
                if (face >= header_.faces) return;
                const std::vector<float> color = color_behind_indices(p, rows.chunks[i].end);
                if (color.size() == 1 || color.size() == 2) ++mapped;
                if (color.size() < 3) return;
                ++colored;
                for (size_t k = 0; k < color.size(); ++k) C(Eigen::Index(face), Eigen::Index(k)) = color[k];
            });
        });
        if (mapped > 0)
            log_warning(fmt::format("{}: {} faces have colours of a colour map, which are left out",
                                    source_.path.string(), mapped.load()));
        if (colored == 0) return;
        const bool has_alpha = !C.col(3).array().isNaN().all();
        face_colors_ = has_alpha ? C : ArrayXf::Dense(C.leftCols(3));
    }

    /// Calls use(place) for each row of a chunk.
    template <class Use>
    static void for_each_row(const TextChunk& chunk, Use&& use) {
        for (const char* p = chunk.begin; p != chunk.end; p = next_line(p, chunk.end)) {
            p = skip_blanks(p, chunk.end);
            if (p == chunk.end) return;
            if (*p != '\n' && !begins_comment(p, chunk.end, {.comment = '#'})) use(p);
        }
    }

    void color_faces(MeshData& mesh) {
        if (face_colors_.rows() == 0 || faces_.value_count() == 0) return;
        if (!mesh.C.empty()) {
            warn_of_left_out_values(source_, "the colours", "the vertices have colours of their own");
            return;
        }
        normalize_colors(face_colors_);
        face_colors_ = face_colors_.unaryExpr([](float value) { return std::isnan(value) ? 1.0f : value; });
        tidy_colors(face_colors_);
        color_vertices_by_faces(face_colors_, faces_, mesh);
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
        color_faces(mesh);
        triangulate(std::move(faces_), mesh);
        return mesh;
    }

    const Source& source_;
    const OffHeader header_;
    size_t color_parts_ = 0;
    std::vector<Element> elements_{2};
    Array3f::Dense V_, N_;
    ArrayXf::Dense C_, face_colors_;
    Array2f::Dense UV_;
    Polygons faces_;
};

}  // namespace

MeshData read_off(const Source& source) {
    if (source.bytes.empty()) fail(source, "the file is empty");
    const TextSource text(source);
    return OffReader(text.source()).read();
}

}  // namespace easypbr::io
