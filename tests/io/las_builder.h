// LAS files for tests, of every version and point format, made without the library.
#pragma once

#include <array>
#include <string>

#include "io/bytes.h"

/// A file of points on a line: point i lies at scale * (X + i, Y - i, Z + 2 i) + offset.
struct LasBuilder {
    int minor_version = 2;
    int format = 0;
    int points = 3;
    double scale = 0.001;
    std::array<double, 3> offset{691'000, 5'335'000, 500};
    std::array<int32_t, 3> first{125, 250, 20'500};
    std::string extra_record{};  ///< description of extra bytes, 192 bytes each
    std::string extra_bytes{};   ///< behind each point
    uint16_t full_color = 0xff00;

    static constexpr std::array<uint16_t, 11> sizes{20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};

    bool is_new() const { return format >= 6; }
    uint16_t record_size() const { return uint16_t(sizes[size_t(format)] + extra_bytes.size()); }

    std::string record(int i) const {
        Bytes r;
        r.add(int32_t(first[0] + i)).add(int32_t(first[1] - i)).add(int32_t(first[2] + 2 * i));
        r.add(uint16_t(1000 + i));
        // Return 1 + i of 3; class 2 + i, in old formats with the flag of a synthetic point.
        if (is_new())
            r.add(uint8_t((1 + i) | 3 << 4))
                .add(uint8_t(0))
                .add(uint8_t(2 + i))
                .add(uint8_t(0))
                .add(int16_t(1000 * i));
        else
            r.add(uint8_t((1 + i) | 3 << 3)).add(uint8_t((2 + i) | 32)).add(int8_t(6 * i)).add(uint8_t(0));
        r.add(uint16_t(77));
        if (format == 1 || format >= 3) r.add(300'000'000.5 + i);
        if (format == 2 || format == 3 || format == 5 || format == 7 || format == 8 || format == 10)
            r.add_all<uint16_t>({full_color, uint16_t(full_color / 2), 0});
        if (format == 8 || format == 10) r.add(uint16_t(500 + i));
        while (r.size() < sizes[size_t(format)]) r.add('\x5a');
        return r.text(extra_bytes).str();
    }

    /// A variable length record with its head.
    static std::string variable_record(const std::string& user, uint16_t id, const std::string& content) {
        std::string padded = user;
        padded.resize(16, '\0');
        return Bytes()
            .add(uint16_t(0))
            .text(padded)
            .add(id)
            .add(uint16_t(content.size()))
            .text(std::string(32, '\0'))
            .text(content)
            .str();
    }

    size_t header_size() const { return minor_version >= 4 ? 375 : minor_version == 3 ? 235 : 227; }

    std::string header(size_t records, size_t record_count) const {
        Bytes h;
        h.text("LASF")
            .text(std::string(20, '\0'))
            .add(uint8_t(1))
            .add(uint8_t(minor_version))
            .text(std::string(68, '\0'));
        h.add(uint16_t(header_size())).add(uint32_t(header_size() + records)).add(uint32_t(record_count));
        h.add(uint8_t(format))
            .add(record_size())
            .add(uint32_t(minor_version >= 4 ? 0 : points))
            .text(std::string(20, '\0'));
        h.add_all({scale, scale, scale})
            .add_all({offset[0], offset[1], offset[2]})
            .text(std::string(48, '\0'));
        if (minor_version >= 3) h.add(uint64_t(0));
        if (minor_version >= 4)
            h.add(uint64_t(0)).add(uint32_t(0)).add(uint64_t(points)).text(std::string(120, '\0'));
        return h.str();
    }

    std::string text() const {
        std::string records;
        if (!extra_record.empty()) records = variable_record("LASF_Spec", 4, extra_record);
        std::string file = header(records.size(), extra_record.empty() ? 0 : 1) + records;
        for (int i = 0; i < points; ++i) file += record(i);
        return file;
    }
};

/// A description of an extra value (LAS 1.4, table 24). `no_data`: 8 bytes, or none.
inline std::string las_extra(uint8_t type, const std::string& name, double scale = 0, double shift = 0,
                             std::string no_data = {}) {
    std::string padded = name;
    padded.resize(32, '\0');
    const uint8_t options = uint8_t((no_data.empty() ? 0 : 1) | (scale != 0 ? 8 : 0) | (shift != 0 ? 16 : 0));
    no_data.resize(72, '\0');
    Bytes b;
    b.add(uint16_t(0)).add(type).add(options).text(padded).text(std::string(4, '\0')).text(no_data);
    b.add_all({scale, 0.0, 0.0}).add_all({shift, 0.0, 0.0}).text(std::string(32, '\0'));
    return b.str();
}
