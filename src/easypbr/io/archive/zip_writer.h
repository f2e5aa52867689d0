// ZIP archives of stored entries, with ZIP64 where sizes ask for it.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace easypbr::io {

class ZipWriter {
  public:
    void add(const std::string& name, std::string_view bytes);

    /// The archive. Nothing can be added afterwards.
    std::string finish();

  private:
    struct Record {
        std::string name;
        uint64_t size, place;
        uint32_t checksum;
    };

    std::string bytes_;
    std::vector<Record> records_;
};

}  // namespace easypbr::io
