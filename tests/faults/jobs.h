// What the library is asked to do while the system fails.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace easypbr::faults {

/// Which allocations the libraries that do a job survive without. nlohmann's JSON allocates in destructors,
/// which must not throw; libwebp 1.2 frees what it could not allocate; tinyexr asserts that zlib has its
/// memory.
enum class Memory { any_may_fail, large_may_fail, none_may_fail };

struct Job {
    std::string name;
    /// Does it; files are written to the folder, which is empty before. What it returns is the same each
    /// time. Throws what the library throws.
    std::function<std::string(const std::filesystem::path& folder)> run;
    Memory memory = Memory::any_may_fail;
};

/// Reading of every format from the kept files of tests/fuzz/seeds.
const std::vector<Job>& reading_jobs();
/// Writing of every format.
const std::vector<Job>& writing_jobs();
/// Geometry, settings, and a picture that the CPU draws.
const std::vector<Job>& computing_jobs();

}  // namespace easypbr::faults
