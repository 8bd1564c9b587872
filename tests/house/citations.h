#pragma once
#include <string>
#include <vector>

namespace turbid::testing {

/// A source named in a comment: "Veach 1997", "Duff et al. 2017", "Shirley & Chiu 1997", or by its key: "S1 Table 1",
/// "NUMERICS 2.3".
struct Citation {
  std::string text;                  ///< as written
  std::vector<std::string> authors;  ///< family names, one or two; empty when cited by key
  std::string year_or_key;
};

/// What a bibliography holds about one source.
struct Reference {
  std::string key, year;
  std::vector<std::string> authors;  ///< family names
};

/// The citations in a line of text. Those that are broken over two lines are not seen.
std::vector<Citation> find_citations(const std::string& line);

/// The entries of a BibTeX file whose fields stand on lines of their own, with authors as "Family, Given and ...".
std::vector<Reference> parse_bibliography(const std::vector<std::string>& lines);

/// Does the bibliography hold what is cited?
bool resolves(const Citation& citation, const std::vector<Reference>& bibliography);

}  // namespace turbid::testing
