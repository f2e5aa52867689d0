#include "easypbr/io/mesh/obj/obj_chunk.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "easypbr/io/source/text_scanner.h"
#include "easypbr/scene/offset.h"

namespace easypbr::io {
namespace {

class ChunkParser {
  public:
    ChunkParser(const Source& source, std::string_view text, const Vec3d& offset)
        : source_(source), offset_(offset), p_(text.data()), end_(text.data() + text.size()) {}

    ObjChunk parse() {
        while (p_ != end_) {
            parse_line();
            p_ = next_line(p_, end_);
        }
        return std::move(chunk_);
    }

  private:
    /// Passes over blanks and over line ends that a backslash continues.
    void skip() {
        for (;;) {
            p_ = skip_blanks(p_, end_);
            if (p_ == end_ || *p_ != '\\') return;
            const char* after = skip_blanks(p_ + 1, end_);
            if (after == end_ || *after != '\n') return;
            p_ = after + 1;
        }
    }

    bool at_line_end() const { return p_ == end_ || *p_ == '\n' || *p_ == '#'; }

    void parse_line() {
        skip();
        if (at_line_end()) return;
        const char* line = p_;
        const std::string_view keyword = read_word(p_, end_);
        if (keyword == "v")
            return offset_.isZero(0) ? parse_position<float>(line) : parse_position<double>(line);
        if (keyword == "f") return parse_face(line);
        if (keyword == "vt") return parse_numbers(line, 1, 2, chunk_.uv);
        if (keyword == "vn") return parse_numbers(line, 3, 3, chunk_.normals);
        if (keyword == "l") return parse_line_element(line);
        if (keyword == "usemtl")
            chunk_.materials.emplace_back(uint32_t(chunk_.face_sizes.size()), read_rest(p_, end_));
        if (keyword == "mtllib") chunk_.libraries.emplace_back(read_rest(p_, end_));
        skip_continued_lines();
    }

    void skip_continued_lines() {
        for (;;) {
            const char* end = line_end(p_, end_);
            const char* last = end;
            while (last != p_ && is_blank(last[-1])) --last;
            const bool continued = last != p_ && last[-1] == '\\' && end != end_;
            p_ = end;
            if (!continued) return;
            ++p_;
        }
    }

    template <class Number>
    size_t read_numbers(Number* values, size_t most) {
        size_t count = 0;
        for (skip(); count < most && read_number(p_, end_, values[count]); skip()) ++count;
        return count;
    }

    /// x y z, or x y z w, or x y z r g b with perhaps more behind.
    template <class Number>
    void parse_position(const char* line) {
        std::array<Number, 6> value;
        const size_t count = read_numbers(value.data(), value.size());
        if (count < 3)
            fail_at_line(source_, line, fmt::format("'v' has {} numbers, expected at least 3", count));
        for (size_t i = 0; i < 3; ++i)
            chunk_.positions.push_back(float(value[i] - Number(offset_[Eigen::Index(i)])));
        if (count < 6 && chunk_.colors.empty()) return;
        chunk_.colors.resize(chunk_.positions.size() - 3, no_color);
        for (size_t i = 3; i < 6; ++i) chunk_.colors.push_back(count == 6 ? float(value[i]) : no_color);
    }

    /// At least `least` numbers; those up to `width` that are missing are 0.
    void parse_numbers(const char* line, size_t least, size_t width, std::vector<float>& out) {
        std::array<float, 3> value{0, 0, 0};
        const size_t count = read_numbers(value.data(), width);
        if (count < least)
            fail_at_line(source_, line, fmt::format("{} numbers found, expected at least {}", count, least));
        out.insert(out.end(), value.begin(), value.begin() + ptrdiff_t(width));
    }

    void parse_face(const char* line) {
        uint32_t size = 0;
        for (skip(); !at_line_end(); skip()) {
            parse_corner(line);
            ++size;
        }
        chunk_.face_sizes.push_back(size);
    }

    bool at_corner_end() const { return at_line_end() || is_blank(*p_) || *p_ == '\\'; }

    /// v, v/t, v//n or v/t/n; what is left out behind a slash is not there.
    void parse_corner(const char* line) {
        add_index(line, obj_position, chunk_.corners[obj_position]);
        const size_t corner = chunk_.corners[obj_position].values.size() - 1;
        if (p_ == end_ || *p_ != '/') return fill_missing(corner + 1);
        ++p_;
        if (!at_corner_end() && *p_ != '/') add_attribute(line, obj_uv, corner);
        if (p_ != end_ && *p_ == '/') {
            ++p_;
            if (!at_corner_end()) add_attribute(line, obj_normal, corner);
        }
        if (!at_corner_end()) fail_corner(line);
        fill_missing(corner + 1);
    }

    void add_attribute(const char* line, ObjIndex kind, size_t corner) {
        ObjIndices& indices = chunk_.corners[kind];
        indices.values.resize(corner, no_index);
        add_index(line, kind, indices);
    }

    /// A kind that some corner has is there for all of them.
    void fill_missing(size_t count) {
        for (const ObjIndex kind : {obj_uv, obj_normal}) {
            auto& values = chunk_.corners[kind].values;
            if (!values.empty() && values.size() != count) values.resize(count, no_index);
        }
    }

    void add_index(const char* line, ObjIndex kind, ObjIndices& out) {
        int32_t index = 0;
        if (!read_integer(p_, end_, index)) fail_corner(line);
        if (index == 0) fail_at_line(source_, line, "index 0 found; indices count from 1, or back from -1");
        if (index < 0) {
            out.relative.push_back(uint32_t(out.values.size()));
            index += int32_t(chunk_.vertex_count(kind)) + 1;
        }
        out.values.push_back(index - 1);
    }

    [[noreturn]] void fail_corner(const char* line) const {
        const char* p = p_;
        fail_at_line(source_, line,
                     fmt::format("an index expected, found '{}'", read_word(p, end_).substr(0, 40)));
    }

    /// One that is broken is left out, as those of VTK, which has no blanks between corners with texture
    /// coordinates: "l 1/12/23/3". At the end of the file it may have been cut off.
    void parse_line_element(const char* line) {
        const size_t values = chunk_.edges.values.size(), relative = chunk_.edges.relative.size();
        size_t count = 0;
        bool is_whole = true;
        LineCorners corners;
        for (skip(); is_whole && !at_line_end(); skip(), ++count) {
            if (count > 1) repeat_last_edge_end();
            is_whole = parse_line_corner(line, corners);
        }
        if (is_whole && count > 1) return;
        skip_continued_lines();
        if (p_ == source_.end())
            fail_at_line(source_, line, "'l' needs at least 2 vertices, each v, v/t, v//n or v/t/n");
        chunk_.edges.values.resize(values);
        chunk_.edges.relative.resize(relative);
        if (chunk_.broken_line_count++ == 0) chunk_.first_broken_line = line;
    }

    /// What the corners of an 'l' so far have in common.
    struct LineCorners {
        int fewest_slashes = 2;
        bool some_have_all = false;  ///< v/t/n
    };

    /// v, v/t, v//n or v/t/n. Of a corner the position counts; false: it is none. Beside others with fewer
    /// slashes v/t/n is two corners of VTK without a blank.
    bool parse_line_corner(const char* line, LineCorners& corners) {
        const char* p = p_;
        int32_t ignored = 0;
        if (!read_integer(p, end_, ignored)) return false;
        add_index(line, obj_position, chunk_.edges);
        int slashes = 0;
        bool has_uv = false;
        for (; slashes < 2 && p_ != end_ && *p_ == '/'; ++slashes) {
            ++p_;
            const bool has_index = read_integer(p_, end_, ignored);
            has_uv = has_uv || (has_index && slashes == 0);
        }
        corners.fewest_slashes = std::min(corners.fewest_slashes, slashes);
        corners.some_have_all = corners.some_have_all || (has_uv && slashes == 2);
        return at_corner_end() && !(corners.some_have_all && corners.fewest_slashes < 2);
    }

    void repeat_last_edge_end() {
        ObjIndices& edges = chunk_.edges;
        const uint32_t last = uint32_t(edges.values.size() - 1);
        if (!edges.relative.empty() && edges.relative.back() == last) edges.relative.push_back(last + 1);
        edges.values.push_back(edges.values.back());
    }

    const Source& source_;
    const Vec3d offset_;
    const char* p_;
    const char* end_;
    ObjChunk chunk_;
};

}  // namespace

ObjChunk parse_obj_chunk(const Source& source, std::string_view text, const Vec3d& offset) {
    return ChunkParser(source, text, offset).parse();
}

Vec3d choose_obj_offset(const Source& source) {
    constexpr size_t lines_per_place = 64;
    std::vector<Vec3d> samples;
    const char* end = source.end();
    for (size_t i = 0; i < offset_sample_count; ++i) {
        const char* p = source.begin() + source.bytes.size() / offset_sample_count * i;
        if (i > 0) p = next_line(p, end);
        for (size_t line = 0; line < lines_per_place && p != end; ++line, p = next_line(p, end)) {
            if (read_word(p, end) != "v") continue;
            Vec3d position = Vec3d::Constant(std::numeric_limits<double>::quiet_NaN());
            for (double& value : position) read_number(p, end, value);
            samples.push_back(position);
            break;
        }
    }
    return offset_of_samples(std::move(samples));
}

}  // namespace easypbr::io
