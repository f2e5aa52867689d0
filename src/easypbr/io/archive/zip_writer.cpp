#include "easypbr/io/archive/zip_writer.h"

#include <zlib.h>

#include <algorithm>
#include <cstring>

namespace easypbr::io {
namespace {

constexpr uint16_t zip_version = 45;  ///< the first with ZIP64
constexpr uint32_t elsewhere = 0xffffffff;

template <class... Numbers>
void append(std::string& out, Numbers... numbers) {
    const auto append_one = [&](auto number) {
        out.append(reinterpret_cast<const char*>(&number), sizeof number);
    };
    (append_one(numbers), ...);
}

/// No time, no date: the same content gives the same bytes. The date 0 is none; this is 1 January 1980.
constexpr uint16_t no_time = 0, first_date = 33;

/// Names are UTF-8 (general purpose bit 11); those of ASCII are the same without it.
uint16_t flags_of(const std::string& name) {
    const bool is_ascii =
        std::ranges::all_of(name, [](char c) { return static_cast<unsigned char>(c) < 128; });
    return is_ascii ? 0 : 1 << 11;
}

constexpr uint16_t none16 = 0;
constexpr uint32_t none32 = 0;

}  // namespace

void ZipWriter::add(const std::string& name, std::string_view bytes) {
    const Record record{name, bytes.size(), bytes_.size(),
                        uint32_t(crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()))};
    // The sizes stand in the extra field, whatever they are.
    append(bytes_, uint32_t(0x04034b50), zip_version, flags_of(name), none16, no_time, first_date,
           record.checksum, elsewhere, elsewhere, uint16_t(name.size()), uint16_t(20));
    bytes_ += name;
    append(bytes_, uint16_t(1), uint16_t(16), record.size, record.size);
    bytes_ += bytes;
    records_.push_back(record);
}

std::string ZipWriter::finish() {
    const uint64_t begin = bytes_.size();
    for (const Record& record : records_) {
        append(bytes_, uint32_t(0x02014b50), zip_version, zip_version, flags_of(record.name), none16, no_time,
               first_date, record.checksum, elsewhere, elsewhere, uint16_t(record.name.size()), uint16_t(28),
               none16, none16, none16, none32, elsewhere);
        bytes_ += record.name;
        append(bytes_, uint16_t(1), uint16_t(24), record.size, record.size, record.place);
    }
    const uint64_t end = bytes_.size(), count = records_.size();
    append(bytes_, uint32_t(0x06064b50), uint64_t(44), zip_version, zip_version, none32, none32, count, count,
           end - begin, begin);
    append(bytes_, uint32_t(0x07064b50), none32, end, uint32_t(1));
    append(bytes_, uint32_t(0x06054b50), none16, none16, uint16_t(0xffff), uint16_t(0xffff), elsewhere,
           elsewhere, none16);
    return std::move(bytes_);
}

}  // namespace easypbr::io
