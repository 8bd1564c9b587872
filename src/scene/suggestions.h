#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace turbid {

/// Fewest insertions, deletions, replacements and swaps of neighbours that turn one word into the other (optimal string
/// alignment distance), ignoring the case of letters.
size_t edit_distance(std::string_view a, std::string_view b);

/// The candidate nearest to `word` when it is near enough to be meant (a third of the longer word, at least 1 edit), or
/// empty.
std::string nearest_name(std::string_view word, std::span<const std::string> candidates);

/// ", did you mean 'x'?" for the nearest candidate; without one "" or, for a short list, " (expected one of: a, b, c)".
std::string suggestion(std::string_view word, std::span<const std::string> candidates);

}  // namespace turbid
