#include "easypbr/io/mesh/las/las_header.h"

#include <fmt/format.h>

#include <cstring>

namespace easypbr::io {
namespace {

constexpr std::array<size_t, 11> standard_sizes{20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};
constexpr uint8_t compressed_bits = 0xc0;

class LasHeaderParser {
  public:
    explicit LasHeaderParser(const Source& source) : source_(source), bytes_(source.bytes) {}

    LasHeader parse() {
        constexpr size_t smallest = 227;
        if (!bytes_.starts_with("LASF")) fail(source_, "no LAS file: it does not begin with 'LASF'");
        if (bytes_.size() < smallest) fail(source_, "truncated within the header");
        const int major = at<uint8_t>(24);
        header_.minor_version = at<uint8_t>(25);
        if (major != 1 || header_.minor_version > 4)
            fail(source_, fmt::format("LAS {}.{} is not read, 1.0 to 1.4 are", major, header_.minor_version));
        parse_format();
        parse_transform();
        count_points();
        parse_records();
        return std::move(header_);
    }

  private:
    template <class T>
    T at(size_t place) const {
        if (place > bytes_.size() || bytes_.size() - place < sizeof(T))
            fail(source_, "truncated within the header");
        T value;
        std::memcpy(&value, bytes_.data() + place, sizeof value);
        return value;
    }

    std::string text(size_t place, size_t size) const {
        std::string_view field = bytes_.substr(std::min(place, bytes_.size()), size);
        return std::string(field.substr(0, std::min(field.find('\0'), field.size())));
    }

    void parse_format() {
        const uint8_t format = at<uint8_t>(104);
        header_.compressed = format & compressed_bits;
        header_.format = format & ~compressed_bits;
        header_.record_size = at<uint16_t>(105);
        header_.body = at<uint32_t>(96);
        if (size_t(header_.format) >= standard_sizes.size())
            fail(source_, fmt::format("point format {} is not read, 0 to 10 are", header_.format));
        if (header_.record_size < standard_sizes[size_t(header_.format)])
            fail(source_, fmt::format("points of format {} take {} bytes, the file says {}", header_.format,
                                      standard_sizes[size_t(header_.format)], header_.record_size));
        if (header_.body > bytes_.size())
            fail(source_, fmt::format("truncated: points begin at byte {}, the file has {}", header_.body,
                                      bytes_.size()));
    }

    void parse_transform() {
        for (size_t axis = 0; axis < 3; ++axis) {
            header_.scale[Eigen::Index(axis)] = at<double>(131 + 8 * axis);
            header_.offset[Eigen::Index(axis)] = at<double>(155 + 8 * axis);
        }
        if (!header_.scale.allFinite() || !header_.offset.allFinite() || (header_.scale.array() == 0).any())
            fail(source_,
                 fmt::format("scale ({}, {}, {}) and offset ({}, {}, {}): finite numbers and no scale of 0 "
                             "expected",
                             header_.scale[0], header_.scale[1], header_.scale[2], header_.offset[0],
                             header_.offset[1], header_.offset[2]));
    }

    void count_points() {
        header_.points = at<uint32_t>(107);
        if (header_.minor_version >= 4 && at<uint16_t>(94) >= 255) header_.points = at<uint64_t>(247);
        if (header_.points > INT32_MAX)
            fail(source_,
                 fmt::format("{} points are more than the {} that are read", header_.points, INT32_MAX));
    }

    /// Variable length records between the header and the points.
    void parse_records() {
        constexpr size_t head = 54;
        size_t place = at<uint16_t>(94);
        const uint32_t count = at<uint32_t>(100);
        size_t extra_place = 0, extra_size = 0;
        for (uint32_t i = 0; i < count && place + head <= header_.body; ++i) {
            const std::string user = text(place + 2, 16);
            const uint16_t id = at<uint16_t>(place + 18), size = at<uint16_t>(place + 20);
            place += head;
            if (size > header_.body - place) fail(source_, "a record of the header reaches into the points");
            if (user == "laszip encoded" && id == 22204) header_.laszip = bytes_.substr(place, size);
            if (user == "LASF_Spec" && id == 4) extra_place = place, extra_size = size;
            place += size;
        }
        parse_extra_bytes(extra_place, extra_size);
    }

    /// Descriptions of what follows the standard fields of a point.
    void parse_extra_bytes(size_t place, size_t size) {
        constexpr size_t entry = 192;
        size_t left = header_.record_size - standard_sizes[size_t(header_.format)];
        for (size_t end = place + size; place + entry <= end && left > 0; place += entry)
            add_extra(place, left);
        for (; left > 0; --left) header_.extra.push_back({"_", ScalarType::uint8, {}, 1, 0});
    }

    void add_extra(size_t place, size_t& left) {
        static constexpr ScalarType types[] = {ScalarType::uint8,  ScalarType::int8,   ScalarType::uint16,
                                               ScalarType::int16,  ScalarType::uint32, ScalarType::int32,
                                               ScalarType::uint64, ScalarType::int64,  ScalarType::float32,
                                               ScalarType::float64};
        constexpr size_t type_count = std::size(types);
        const uint8_t type = at<uint8_t>(place + 2), options = at<uint8_t>(place + 3);
        if (type == 0 || type > 3 * type_count) {
            // Without a type the options say how many bytes it takes.
            for (size_t i = 0; i < (type ? 0 : options) && left > 0; ++i, --left)
                header_.extra.push_back({"_", ScalarType::uint8, {}, 1, 0});
            return;
        }
        const ScalarType scalar = types[(type - 1) % type_count];
        const size_t values = 1 + (type - 1) / type_count;
        const std::string name = text(place + 4, 32);
        for (size_t i = 0; i < values && left >= size_of(scalar); ++i, left -= size_of(scalar)) {
            Property property{values == 1 ? name : fmt::format("{}_{}", name, i), scalar, {}, 1, 0};
            if (options & 8) property.scale = at<double>(place + 112 + 8 * i);
            if (options & 16) property.shift = at<double>(place + 136 + 8 * i);
            if (options & 1) property.missing = no_data(place + 40 + 8 * i, scalar);
            property.is_extra = true;
            header_.extra.push_back(std::move(property));
        }
    }

    /// It is stored as the largest type of its kind.
    double no_data(size_t place, ScalarType type) const {
        if (!is_integer(type)) return at<double>(place);
        const bool is_unsigned = type == ScalarType::uint8 || type == ScalarType::uint16 ||
                                 type == ScalarType::uint32 || type == ScalarType::uint64;
        return is_unsigned ? double(at<uint64_t>(place)) : double(at<int64_t>(place));
    }

    const Source& source_;
    const std::string_view bytes_;
    LasHeader header_;
};

}  // namespace

LasHeader parse_las_header(const Source& source) {
    if (source.bytes.empty()) fail(source, "the file is empty");
    return LasHeaderParser(source).parse();
}

std::vector<Property> las_fields(const LasHeader& header) {
    std::vector<Property> fields;
    const auto add = [&](const char* name, ScalarType type, double scale = 1, double shift = 0) {
        fields.push_back({name, type, {}, scale, shift});
    };
    const auto skip = [&](size_t bytes) {
        for (size_t i = 0; i < bytes; ++i) add("_", ScalarType::uint8);
    };
    const bool is_new = header.has_new_layout();
    const char* const axes[] = {"x", "y", "z"};
    for (Eigen::Index axis = 0; axis < 3; ++axis)
        add(axes[axis], ScalarType::int32, header.scale[axis], header.offset[axis]);
    add("intensity", ScalarType::uint16);
    add("return_number", ScalarType::uint8);
    if (is_new) skip(1);
    add("classification", ScalarType::uint8);
    if (!is_new) add("scan_angle", ScalarType::int8);
    add("user_data", ScalarType::uint8);
    constexpr double degrees_per_step = 0.006;
    if (is_new) add("scan_angle", ScalarType::int16, degrees_per_step);
    add("point_source_id", ScalarType::uint16);
    const int format = header.format;
    if (format == 1 || format >= 3) add("gps_time", ScalarType::float64);
    if (format == 2 || format == 3 || format == 5 || format == 7 || format == 8 || format == 10)
        for (const char* name : {"red", "green", "blue"}) add(name, ScalarType::uint16);
    if (format == 8 || format == 10) add("near_infrared", ScalarType::uint16);
    constexpr size_t wave_packet = 29;
    if (format == 4 || format == 5 || format >= 9) skip(wave_packet);
    return fields;
}

}  // namespace easypbr::io
