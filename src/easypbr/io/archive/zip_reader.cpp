#include "easypbr/io/archive/zip_reader.h"

#include <fmt/format.h>
#include <zlib.h>

#include <cstring>

#include "easypbr/core/memory_budget.h"
#include "easypbr/core/parallel.h"
#include "easypbr/io/archive/deflate.h"

namespace easypbr::io {
namespace {

constexpr uint32_t in_zip64_16 = 0xffff, in_zip64_32 = 0xffffffff;  ///< the number stands elsewhere

/// A place of the directory.
struct Record {
    std::string name;
    uint64_t compressed = 0, size = 0, header = 0;
    uint32_t checksum = 0;
    uint16_t method = 0, flags = 0;
};

class ZipReader {
  public:
    explicit ZipReader(const Source& source) : source_(source), bytes_(source.bytes) {}

    std::vector<ZipEntry> read(std::string_view ending) {
        std::vector<Record> records = read_directory();
        std::erase_if(records, [&](const Record& record) { return !record.name.ends_with(ending); });
        for (const Record& record : records)
            if (record.method != 0)
                charge_memory(record.size, fmt::format("'{}'", record.name.substr(0, 100)));
        std::vector<ZipEntry> entries(records.size());
        parallel_for(records.size(), 1, [&](size_t i) { entries[i] = read_entry(records[i]); });
        return entries;
    }

  private:
    template <class T>
    T at(uint64_t place) const {
        if (place > bytes_.size() || bytes_.size() - place < sizeof(T)) fail_damaged("a header is cut off");
        T value;
        std::memcpy(&value, bytes_.data() + place, sizeof value);
        return value;
    }

    /// The directory's end, which a comment of up to 64 KB may follow.
    uint64_t find_end() const {
        constexpr size_t size = 22, longest_comment = 65535;
        for (size_t back = size; back <= std::min(bytes_.size(), size + longest_comment); ++back)
            if (bytes_.substr(bytes_.size() - back).starts_with("PK\x05\x06")) return bytes_.size() - back;
        fail(source_, "no ZIP archive, or its end is missing");
    }

    std::vector<Record> read_directory() const {
        const uint64_t end = find_end();
        uint64_t count = at<uint16_t>(end + 10), place = at<uint32_t>(end + 16);
        constexpr uint64_t locator_size = 20;
        if ((count == in_zip64_16 || place == in_zip64_32) && end >= locator_size &&
            at<uint32_t>(end - locator_size) == 0x07064b50) {
            const uint64_t end64 = at<uint64_t>(end - locator_size + 8);
            if (at<uint32_t>(end64) != 0x06064b50) fail_damaged("the directory's ZIP64 end is missing");
            count = at<uint64_t>(end64 + 32);
            place = at<uint64_t>(end64 + 48);
        }
        constexpr uint64_t smallest_record = 46;
        if (count > bytes_.size() / smallest_record) fail_damaged("the directory is cut off");
        std::vector<Record> records;
        for (uint64_t i = 0; i < count; ++i) records.push_back(read_record(place));
        return records;
    }

    Record read_record(uint64_t& place) const {
        if (at<uint32_t>(place) != 0x02014b50) fail_damaged("a directory entry is missing");
        Record record;
        record.flags = at<uint16_t>(place + 8);
        record.method = at<uint16_t>(place + 10);
        record.checksum = at<uint32_t>(place + 16);
        record.compressed = at<uint32_t>(place + 20);
        record.size = at<uint32_t>(place + 24);
        record.header = at<uint32_t>(place + 42);
        const uint64_t name_size = at<uint16_t>(place + 28), extra_size = at<uint16_t>(place + 30);
        const uint64_t name = place + 46, extra = name + name_size;
        if (extra + extra_size > bytes_.size()) fail_damaged("a name is cut off");
        record.name = bytes_.substr(name, name_size);
        read_zip64(extra, extra + extra_size, record);
        place = extra + extra_size + at<uint16_t>(place + 32);
        return record;
    }

    /// Numbers that did not fit 32 bits stand in an extra field, in this order.
    void read_zip64(uint64_t place, uint64_t end, Record& record) const {
        while (place + 4 <= end) {
            const uint16_t id = at<uint16_t>(place), size = at<uint16_t>(place + 2);
            uint64_t next = place + 4;
            place = next + size;
            if (id != 1) continue;
            for (uint64_t* number : {&record.size, &record.compressed, &record.header})
                if (*number == in_zip64_32 && next + 8 <= place) *number = at<uint64_t>(next), next += 8;
        }
    }

    ZipEntry read_entry(const Record& record) const {
        const auto refuse = [&](std::string_view why) {
            fail(source_, fmt::format("'{}' in the archive {}", record.name.substr(0, 100), why));
        };
        if (record.flags & 1) refuse("is encrypted");
        if (record.method != 0 && record.method != 8) refuse("is compressed by another method than Deflate");
        if (at<uint32_t>(record.header) != 0x04034b50) refuse("has no header");
        const uint64_t data =
            record.header + 30 + at<uint16_t>(record.header + 26) + at<uint16_t>(record.header + 28);
        if (data > bytes_.size() || record.compressed > bytes_.size() - data) refuse("is truncated");
        const std::string_view packed = bytes_.substr(data, record.compressed);
        ZipEntry entry{record.name, packed, nullptr};
        if (record.method == 8) {
            if (record.size / best_deflate_ratio > record.compressed)
                refuse("is damaged: its size cannot be");
            entry = inflated(record, packed);
        }
        if (entry.bytes.size() != record.size || checksum(entry.bytes) != record.checksum)
            refuse("is damaged: its size or checksum is another");
        return entry;
    }

    ZipEntry inflated(const Record& record, std::string_view packed) const {
        const std::shared_ptr<char[]> out(new char[record.size + 1]);
        const Inflated inflated = inflate_into(packed, DeflateForm::bare, {out.get(), record.size + 1});
        const size_t written = inflated.ended ? inflated.written : 0;
        return {record.name, {out.get(), written}, out};
    }

    static uint32_t checksum(std::string_view bytes) {
        return uint32_t(crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
    }

    [[noreturn]] void fail_damaged(std::string_view why) const {
        fail(source_, fmt::format("the archive is damaged: {}", why));
    }

    const Source& source_;
    const std::string_view bytes_;
};

}  // namespace

std::vector<ZipEntry> read_zip(const Source& source, std::string_view ending) {
    return ZipReader(source).read(ending);
}

}  // namespace easypbr::io
