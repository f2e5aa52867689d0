// NPY and NPZ files for tests, made without the library.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "io/bytes.h"

inline std::string npy(const std::string& descr, const std::string& shape, const std::string& data,
                       bool fortran = false, int version = 1) {
    std::string header = "{'descr': " + descr + ", 'fortran_order': " + (fortran ? "True" : "False") +
                         ", 'shape': " + shape + ", }";
    while ((header.size() + (version == 1 ? 11 : 13)) % 64) header += ' ';
    header += '\n';
    Bytes bytes;
    bytes.text("\x93NUMPY").add(char(version)).add('\0');
    if (version == 1)
        bytes.add(uint16_t(header.size()));
    else
        bytes.add(uint32_t(header.size()));
    return bytes.text(header).text(data).str();
}

inline uint32_t crc32_of(const std::string& bytes) {
    uint32_t crc = ~0u;
    for (const char c : bytes) {
        crc ^= uint8_t(c);
        for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0);
    }
    return ~crc;
}

/// Stored entries.
inline std::string npz(const std::vector<std::pair<std::string, std::string>>& entries) {
    Bytes file, directory;
    for (const auto& [name, data] : entries) {
        const auto place = uint32_t(file.size());
        const auto size = uint32_t(data.size()), crc = crc32_of(data);
        file.add(0x04034b50u)
            .add<uint16_t>(20)
            .add(uint32_t(0))
            .add(uint32_t(0))
            .add(crc)
            .add(size)
            .add(size);
        file.add(uint16_t(name.size())).add<uint16_t>(0).text(name).text(data);
        directory.add(0x02014b50u)
            .add(uint32_t(20))
            .add(uint32_t(0))
            .add(uint32_t(0))
            .add(crc)
            .add(size)
            .add(size);
        directory.add(uint16_t(name.size())).add(uint64_t(0)).add(uint32_t(0)).add(place).text(name);
    }
    const auto begin = uint32_t(file.size()), size = uint32_t(directory.size());
    const auto count = uint16_t(entries.size());
    file.text(directory.str()).add(0x06054b50u).add(uint32_t(0)).add(count).add(count).add(size).add(begin);
    return file.add<uint16_t>(0).str();
}
