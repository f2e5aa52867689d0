#include "easypbr/io/mesh/cloud_reader.h"

#include <fmt/format.h>

#include <optional>

#include "easypbr/scene/offset.h"

namespace easypbr::io {
namespace {

/// Where a field stands among the tables.
struct FieldPlace {
    size_t table;
    PropertyPlace property;
};

/// The plans of tables and the arrays that they fill.
class CloudPlan {
  public:
    explicit CloudPlan(const Source& source) : source_(source) {}

    void add(const std::vector<Element>& elements) {
        plans_.emplace_back();
        for (const Element& element : elements)
            plans_.back().push_back({&element, std::vector<Column>(element.properties.size())});
        for (size_t e = 0; e < elements.size(); ++e) {
            if (!count_) count_ = elements[e].count;
            if (elements[e].count != *count_)
                fail(source_, fmt::format("as many rows in all tables expected, found {} and {}", *count_,
                                          elements[e].count));
            for (size_t i = 0; i < elements[e].properties.size(); ++i) {
                fields_.push_back({elements[e].properties[i], &plans_.back()[e].columns[i]});
                places_.push_back({plans_.size() - 1, {e, i}});
            }
        }
    }

    /// Makes room for what was added.
    void make_arrays() {
        const size_t count = count_.value_or(0);
        if (count > INT32_MAX)
            fail(source_, fmt::format("{} points are more than the {} that are read", count, INT32_MAX));
        arrays_.emplace(fields_, count);
        // Rows may have no field at all.
        if (!arrays_->position() && (count > 0 || !fields_.empty())) fail_without_position();
        if (count == 0) fail(source_, "no points");
    }

    /// The table that has the positions, and their places in it.
    size_t position_table() const { return place_of(0).table; }
    std::array<PropertyPlace, 3> position() const {
        return {place_of(0).property, place_of(1).property, place_of(2).property};
    }

    void recentre(std::vector<Vec3d> samples) { arrays_->recentre(std::move(samples)); }
    void recentre_positions() { arrays_->recentre_positions(); }
    std::vector<ElementPlan>& plans(size_t table) { return plans_[table]; }

    MeshData mesh() {
        MeshData result;
        arrays_->move_into(result, source_);
        return result;
    }

  private:
    const FieldPlace& place_of(size_t axis) const { return places_[(*arrays_->position())[axis]]; }

    [[noreturn]] void fail_without_position() const {
        std::string names;
        for (const VertexField& field : fields_)
            if (names.size() < 200) names += (names.empty() ? "" : ", ") + field.property.name.substr(0, 40);
        fail(source_,
             fmt::format("no positions: fields x, y, z expected, found {}", names.empty() ? "none" : names));
    }

    const Source& source_;
    std::optional<size_t> count_;
    std::vector<std::vector<ElementPlan>> plans_;  ///< of each table
    std::vector<VertexField> fields_;
    std::vector<FieldPlace> places_;  ///< of each field
    std::optional<VertexArrays> arrays_;
};

/// Nothing is allocated for rows that cannot be there.
void check_size(const Source& source, const BinaryTable& table) {
    size_t left = size_t(table.source.end() - table.body);
    for (const Element& element : table.elements) {
        const size_t row = smallest_row(element);
        if (row && element.count > left / row)
            fail(source, fmt::format("truncated: {} points take {} bytes each, but {} bytes are left",
                                     element.count, row, left));
        left -= element.count * row;
    }
}

}  // namespace

MeshData read_binary_cloud(const Source& source, const std::vector<BinaryTable>& tables) {
    CloudPlan cloud(source);
    for (const BinaryTable& table : tables) {
        check_size(source, table);
        cloud.add(table.elements);
    }
    cloud.make_arrays();
    const BinaryTable& first = tables[cloud.position_table()];
    cloud.recentre(
        sample_binary_positions(first.source, first.body, first.endian, first.elements, cloud.position()));
    for (size_t i = 0; i < tables.size(); ++i)
        read_binary_elements(tables[i].source, tables[i].body, tables[i].endian, cloud.plans(i));
    return cloud.mesh();
}

struct CloudStream::State {
    State(const Source& given_source, std::vector<Element> given)
        : source(given_source), elements(std::move(given)), cloud(source) {
        cloud.add(elements);
        cloud.make_arrays();
    }

    const Source& source;
    const std::vector<Element> elements;
    CloudPlan cloud;
    Misfits misfits;
    size_t element = 0, row = 0;  ///< what comes next
};

CloudStream::CloudStream(const Source& source, std::vector<Element> elements)
    : state_(std::make_unique<State>(source, std::move(elements))) {}

CloudStream::~CloudStream() = default;

bool CloudStream::can_read(const std::vector<Element>& elements) {
    constexpr size_t largest_row = 4096;
    for (const Element& element : elements) {
        if (smallest_row(element) > largest_row) return false;
        for (const Property& property : element.properties) {
            const bool exact = size_of(property.type) < 4 || property.type == ScalarType::float32;
            if (is_position_field(property.name) && !exact) return false;
        }
    }
    return true;
}

size_t CloudStream::push(const char* data, size_t size) {
    size_t used = 0;
    while (state_->element < state_->elements.size()) {
        const Element& element = state_->elements[state_->element];
        const size_t stride = smallest_row(element);
        const size_t rows = std::min(element.count - state_->row, (size - used) / stride);
        read_binary_rows(state_->cloud.plans(0)[state_->element], data + used, std::endian::little,
                         state_->row, rows, state_->misfits);
        used += rows * stride;
        state_->row += rows;
        if (state_->row < element.count) break;
        ++state_->element;
        state_->row = 0;
    }
    return used;
}

MeshData CloudStream::finish() {
    state_->misfits.warn(state_->source);
    state_->cloud.recentre_positions();
    return state_->cloud.mesh();
}

MeshData read_text_cloud(const Source& source, const TextRows& rows, const Element& element) {
    if (element.count > rows.count())
        fail_at_line(source, source.end(),
                     fmt::format("truncated: {} points expected, but the file ends after {}", element.count,
                                 rows.count()));
    const std::vector<Element> elements{element};
    CloudPlan cloud(source);
    cloud.add(elements);
    cloud.make_arrays();
    cloud.recentre(sample_text_positions(rows, elements, cloud.position()));
    read_text_elements(source, rows, cloud.plans(0));
    return cloud.mesh();
}

}  // namespace easypbr::io
