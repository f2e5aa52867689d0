#include "easypbr/io/mesh/gltf/gltf_accessor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <type_traits>

#include "easypbr/core/memory_budget.h"
#include "easypbr/core/parallel.h"
#include "easypbr/io/mesh/gltf/component_type.h"

namespace easypbr::io {
namespace {

constexpr size_t accessor_grain = 1 << 15;
constexpr size_t uint32_type = 5125;  ///< the only one that float32 does not have all values of
/// Rows of an accessor that names no buffer: nothing in the file bears its size out.
constexpr size_t most_rows_without_data = size_t(1) << 24;

size_t size_of_component(size_t type) {
    switch (type) {
        case 5120:
        case 5121:
            return 1;
        case 5122:
        case 5123:
            return 2;
        case 5125:
        case 5126:
            return 4;
        default:
            return 0;
    }
}

template <class T>
T load(const std::byte* from) {
    T value;
    std::memcpy(&value, from, sizeof(T));
    return value;
}

template <class Real, class T>
Real as_real(T value, bool normalized) {
    if constexpr (std::is_floating_point_v<T>) return Real(value);
    if (!normalized) return Real(value);
    return std::max(Real(double(value) / double(std::numeric_limits<T>::max())), Real(-1));
}

int components_of(const std::string& type) {
    if (type == "SCALAR") return 1;
    if (type == "MAT4") return 16;
    if (type.size() == 4 && type.starts_with("VEC") && type[3] >= '2' && type[3] <= '4') return type[3] - '0';
    return 0;
}

/// Where the rows of a part of a buffer view lie.
struct Rows {
    const std::byte* data = nullptr;
    size_t stride = 0;
};

class Accessor {
  public:
    Accessor(GltfDocument& document, size_t index)
        : document_(document), index_(index), json_(document.item("accessors", index)) {
        const GltfRows form = gltf_rows(document, index);
        count = form.count;
        type = form.component_type;
        components = form.components;
        normalized = form.normalized;
        const size_t row_bytes = size_t(components) * size_of_component(type);
        if (const auto view = document.optional_integer(json_, "bufferView"))
            rows =
                rows_of(*view, document.optional_integer(json_, "byteOffset").value_or(0), count, row_bytes);
        else if (const auto* given = document.provided(index))
            use_rows(*given, row_bytes);
        else if (count > most_rows_without_data)
            fail(fmt::format("has {} rows and no data", count));
    }

    [[noreturn]] void fail(const std::string& what) const {
        document_.fail(fmt::format("accessors[{}] {}", index_, what));
    }

    /// Accounts for the values of so many rows, of so many bytes each.
    void charge(size_t row_count, size_t bytes) const {
        charge_memory(uint64_t(row_count) * uint64_t(components) * bytes,
                      fmt::format("accessors[{}]", index_));
    }

    const Json* sparse() const { return member(json_, "sparse"); }

    Rows rows_of(size_t view, size_t offset, size_t row_count, size_t row_bytes) const {
        const auto bytes = document_.buffer_view(view);
        const size_t given =
            document_.optional_integer(document_.item("bufferViews", view), "byteStride").value_or(0);
        const size_t stride = given ? given : row_bytes;
        if (stride < row_bytes)
            fail(fmt::format("has a stride of {} bytes for rows of {}", stride, row_bytes));
        const bool inside = offset <= bytes.size() && row_bytes <= bytes.size() - offset &&
                            row_count - 1 <= (bytes.size() - offset - row_bytes) / stride;
        if (!inside)
            fail(fmt::format(
                "ends behind bufferViews[{}]: {} rows of {} bytes from byte {} on, {} bytes apart, in {}",
                view, row_count, row_bytes, offset, stride, bytes.size()));
        return {bytes.data() + offset, stride};
    }

    /// Of compressed data, which hold what they hold: exporters write the count of before.
    void use_rows(const std::vector<std::byte>& bytes, size_t row_bytes) {
        count = bytes.size() / row_bytes;
        rows = {bytes.data(), row_bytes};
        if (count == 0) fail("has no rows in its compressed data");
    }

    std::vector<uint32_t> sparse_rows(const Json& sparse, size_t sparse_count) const {
        const Json* indices = member(sparse, "indices");
        if (!indices) fail("is sparse without indices");
        const size_t index_type = document_.integer(*indices, "componentType");
        if (index_type != 5121 && index_type != 5123 && index_type != 5125)
            fail(fmt::format("has sparse indices of componentType {}", index_type));
        const Rows where = rows_of(document_.integer(*indices, "bufferView"),
                                   document_.optional_integer(*indices, "byteOffset").value_or(0),
                                   sparse_count, size_of_component(index_type));
        std::vector<uint32_t> out(sparse_count);
        with_component(index_type, [&]<class T>(T) {
            if constexpr (std::is_unsigned_v<T>)
                for (size_t i = 0; i < sparse_count; ++i)
                    out[i] = uint32_t(load<T>(where.data + i * where.stride));
        });
        for (const uint32_t row : out)
            if (row >= count) fail(fmt::format("replaces row {} of {}", row, count));
        return out;
    }

    size_t count = 0, type = 0;
    int components = 0;
    bool normalized = false;
    Rows rows;

  private:
    GltfDocument& document_;
    size_t index_;
    const Json& json_;
};

template <class Real>
using DenseRows = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

template <class Real>
void fill_row(const Accessor& accessor, const std::byte* from, Real* to) {
    with_component(accessor.type, [&]<class T>(T) {
        for (int c = 0; c < accessor.components; ++c)
            to[c] = as_real<Real>(load<T>(from + size_t(c) * sizeof(T)), accessor.normalized);
    });
}

/// The place of a row among those that are read; nothing where it is none of them.
std::optional<size_t> place_among(size_t row, const std::vector<int32_t>* rows) {
    if (!rows) return row;
    const auto found = std::ranges::lower_bound(*rows, int32_t(row));
    if (found == rows->end() || size_t(*found) != row) return std::nullopt;
    return size_t(found - rows->begin());
}

template <class Real>
void apply_sparse(GltfDocument& document, const Accessor& accessor, const std::vector<int32_t>* rows,
                  DenseRows<Real>& out) {
    const Json& sparse = *accessor.sparse();
    const size_t count = document.integer(sparse, "count");
    const Json* values = member(sparse, "values");
    if (count < 1 || count > accessor.count || !values) accessor.fail("has a damaged sparse part");
    const std::vector<uint32_t> where = accessor.sparse_rows(sparse, count);
    const Rows from = accessor.rows_of(document.integer(*values, "bufferView"),
                                       document.optional_integer(*values, "byteOffset").value_or(0), count,
                                       size_t(accessor.components) * size_of_component(accessor.type));
    for (size_t i = 0; i < count; ++i)
        if (const auto place = place_among(where[i], rows))
            fill_row(accessor, from.data + i * from.stride, out.row(Eigen::Index(*place)).data());
}

/// The rows, or those that are named.
template <class Real>
DenseRows<Real> read_rows(GltfDocument& document, const Accessor& accessor,
                          const std::vector<int32_t>* rows) {
    if (rows && !rows->empty() && size_t(rows->back()) >= accessor.count)
        accessor.fail(fmt::format("has no row {}", rows->back()));
    const size_t count = rows ? rows->size() : accessor.count;
    accessor.charge(count, sizeof(Real));
    DenseRows<Real> out(Eigen::Index(count), accessor.components);
    if (!accessor.rows.data)
        out.setZero();
    else
        with_component(accessor.type, [&]<class T>(T) {
            parallel_for(count, accessor_grain, [&](size_t i) {
                const size_t row = rows ? size_t((*rows)[i]) : i;
                const std::byte* from = accessor.rows.data + row * accessor.rows.stride;
                Real* to = out.data() + i * size_t(accessor.components);
                for (int c = 0; c < accessor.components; ++c)
                    to[c] = as_real<Real>(load<T>(from + size_t(c) * sizeof(T)), accessor.normalized);
            });
        });
    if (accessor.sparse()) apply_sparse(document, accessor, rows, out);
    return out;
}

}  // namespace

GltfRows gltf_rows(const GltfDocument& document, size_t index) {
    const auto fail = [&](const std::string& what) {
        document.fail(fmt::format("accessors[{}] {}", index, what));
    };
    const Json& json = document.item("accessors", index);
    const GltfRows rows{.count = document.integer(json, "count"),
                        .component_type = document.integer(json, "componentType"),
                        .components = components_of(document.text(json, "type")),
                        .normalized = document.boolean(json, "normalized", false)};
    if (!size_of_component(rows.component_type))
        fail(fmt::format("has unknown componentType {}", rows.component_type));
    if (!rows.components) fail("must be SCALAR, VEC2, VEC3, VEC4 or MAT4");
    if (rows.count < 1 || rows.count > size_t(std::numeric_limits<int32_t>::max()))
        fail(fmt::format("has a count of {}", rows.count));
    return rows;
}

ArrayXf::Dense read_floats(GltfDocument& document, size_t index, int least, int most,
                           const std::vector<int32_t>* rows) {
    const Accessor accessor(document, index);
    if (accessor.components < least || accessor.components > most)
        accessor.fail(fmt::format("has {} components, expected {} to {}", accessor.components, least, most));
    return read_rows<float>(document, accessor, rows);
}

std::vector<RoundingCounts> gltf_rounding(GltfDocument& document, size_t index,
                                          const std::vector<int32_t>* rows) {
    const Accessor accessor(document, index);
    if (accessor.type != uint32_type) return {};
    const DenseRows<double> values = read_rows<double>(document, accessor, rows);
    std::vector<RoundingCounts> counts;
    for (Eigen::Index column = 0; column < values.cols(); ++column) {
        const Eigen::VectorXd one = values.col(column);
        counts.push_back(rounding_of({one.data(), size_t(one.size())}));
    }
    return counts;
}

std::vector<uint32_t> read_indices(GltfDocument& document, size_t index) {
    const Accessor accessor(document, index);
    const bool is_unsigned = accessor.type == 5121 || accessor.type == 5123 || accessor.type == 5125;
    if (accessor.components != 1 || !is_unsigned)
        accessor.fail("must be a scalar of an unsigned integer type");
    if (accessor.sparse() || !accessor.rows.data) accessor.fail("holds indices without plain data");
    accessor.charge(accessor.count, sizeof(uint32_t));
    std::vector<uint32_t> out(accessor.count);
    with_component(accessor.type, [&]<class T>(T) {
        if constexpr (std::is_unsigned_v<T>)
            parallel_for(out.size(), accessor_grain, [&](size_t i) {
                out[i] = uint32_t(load<T>(accessor.rows.data + i * accessor.rows.stride));
            });
    });
    return out;
}

}  // namespace easypbr::io
