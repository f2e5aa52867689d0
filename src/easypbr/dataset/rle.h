// Run-length encoding of masks as COCO has it (cocoapi, maskApi.c).
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace easypbr::dataset {

/// Lengths of runs of 0 and 1 in turn, beginning with 0, column by column. `mask` is row by row.
std::vector<uint32_t> rle_counts(std::span<const uint8_t> mask, int width, int height);
/// The counts as COCO's string.
std::string rle_string(std::span<const uint32_t> counts);
/// The inverse. Throws FormatError for what is no such string.
std::vector<uint32_t> rle_parse(const std::string& text);
/// The mask, row by row. Throws FormatError when the counts are not those of width x height pixels.
std::vector<uint8_t> rle_mask(std::span<const uint32_t> counts, int width, int height);

}  // namespace easypbr::dataset
