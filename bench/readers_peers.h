// Libraries that could take the place of our readers, each where it is installed; empty functions elsewhere.
#pragma once

#include <functional>
#include <string>

namespace peers {

using Reader = std::function<bool(const std::string&)>;

extern const Reader hdr, exr, obj, zip;
bool lzf(const std::string& packed, size_t size);
/// Empty without liblzf.
std::string lzf_pack(const std::string& bytes);

}  // namespace peers
