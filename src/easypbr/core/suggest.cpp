#include "easypbr/core/suggest.h"

#include <algorithm>
#include <numeric>
#include <vector>

namespace easypbr {
namespace {

/// Levenshtein distance: fewest single-letter edits from a to b.
size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), size_t(0));
    for (size_t i = 1; i <= a.size(); ++i) {
        size_t diagonal = row[0];
        row[0] = i;
        for (size_t j = 1; j <= b.size(); ++j) {
            const size_t replaced = diagonal + (a[i - 1] != b[j - 1]);
            diagonal = row[j];
            row[j] = std::min({replaced, row[j] + 1, row[j - 1] + 1});
        }
    }
    return row.back();
}

/// Edits up to which a name is a hint.
size_t most_edits(std::string_view candidate) {
    return std::max<size_t>(1, candidate.size() / 3);
}

/// Edits that the lengths alone ask for.
size_t least_edits(std::string_view a, std::string_view b) {
    return a.size() > b.size() ? a.size() - b.size() : b.size() - a.size();
}

}  // namespace

std::string nearest(std::string_view wrong, std::span<const std::string> candidates) {
    const std::string* best = nullptr;
    size_t best_distance = 0;
    for (const std::string& candidate : candidates) {
        if (least_edits(wrong, candidate) > most_edits(candidate)) continue;
        const size_t distance = edit_distance(wrong, candidate);
        if (!best || distance < best_distance) best = &candidate, best_distance = distance;
    }
    // A name of which no letter is right is no hint.
    if (!best || best_distance > most_edits(*best) || best_distance >= best->size()) return {};
    return *best;
}

std::string did_you_mean(std::string_view wrong, std::span<const std::string> candidates) {
    const std::string name = nearest(wrong, candidates);
    return name.empty() ? name : " (did you mean '" + name + "'?)";
}

}  // namespace easypbr
