#include "easypbr/gl/watched_program.h"

#include <system_error>

#include "easypbr/gl/context.h"

namespace easypbr::gl {

WatchedProgram::WatchedProgram(std::string vertex, std::string fragment, ShaderTexts texts)
    : vertex_(std::move(vertex)), fragment_(std::move(fragment)), texts_(std::move(texts)) {
    note_files();
}

void WatchedProgram::note_files() {
    files_.clear();
    for (const std::string& name : {vertex_, fragment_}) {
        if (texts_.contains(name)) continue;
        for (std::filesystem::path& file : shader_files(name)) files_.push_back(std::move(file));
    }
    revision_ = revision();
}

uint64_t WatchedProgram::revision() const {
    uint64_t sum = 1;
    for (const std::filesystem::path& file : files_) {
        std::error_code gone;  // A file that is being replaced may be missing for a moment.
        const auto time = std::filesystem::last_write_time(file, gone);
        if (gone) return revision_;
        sum = (sum ^ uint64_t(time.time_since_epoch().count())) * 0x100000001b3;  // as FNV-1a does
    }
    return sum;
}

const Program& WatchedProgram::get(const std::vector<std::string>& defines) {
    if (revision() != revision_) {
        programs_.clear();
        note_files();
    }
    const std::shared_ptr<DeletionQueue>& context = Context::current().deletions();
    if (context_.lock() != context) programs_.clear();
    context_ = context;
    Program& program = programs_[defines];
    if (!program) program = Program(vertex_, fragment_, defines, texts_);
    return program;
}

}  // namespace easypbr::gl
