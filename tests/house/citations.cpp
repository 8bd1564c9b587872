#include "house/citations.h"

#include <algorithm>
#include <regex>

namespace turbid::testing {
namespace {

// A family name: begins with a capital letter (or one outside ASCII) and goes on with letters, hyphens and apostrophes;
// d' may stand before it.
const std::string kName = R"re(((?:d')?(?:[A-Z]|[^\x01-\x7f])(?:[A-Za-z'-]|[^\x01-\x7f])+))re";

std::vector<std::string> family_names(const std::string& authors) {
  static const std::regex separator(R"( and )");
  std::vector<std::string> names;
  for (std::sregex_token_iterator it(authors.begin(), authors.end(), separator, -1), end; it != end; ++it) {
    const std::string author = *it;
    std::string family = author.substr(0, author.find(','));
    family = family.substr(family.find_last_of(' ') + 1);  // van de Hulst: Hulst
    std::erase_if(family, [](char c) { return c == '{' || c == '}'; });
    names.push_back(family);
  }
  return names;
}

}  // namespace

std::vector<Citation> find_citations(const std::string& line) {
  static const std::regex by_author("\\b" + kName + "(?: et al\\.| (?:&|and) " + kName + ")? ((?:19|20)[0-9]{2})\\b");
  static const std::regex by_key(
      R"(\b(S[0-9]+|NUMERICS) (?:(?:eq\.|sect\.|Fig\.|Table|Algorithm|App\.) )?[A-Z]?[0-9]+(?:\.[0-9]+)*)");
  std::vector<Citation> found;
  for (std::sregex_iterator it(line.begin(), line.end(), by_author), end; it != end; ++it) {
    const std::smatch& match = *it;
    Citation citation{match.str(0), {match.str(1)}, match.str(3)};
    if (match[2].matched) citation.authors.push_back(match.str(2));
    found.push_back(citation);
  }
  for (std::sregex_iterator it(line.begin(), line.end(), by_key), end; it != end; ++it)
    found.push_back({it->str(0), {}, it->str(1)});
  return found;
}

std::vector<Reference> parse_bibliography(const std::vector<std::string>& lines) {
  static const std::regex entry(R"(^\s*@\w+\{\s*([^,\s]+)\s*,)");
  static const std::regex field(R"re(^\s*(author|year)\s*=\s*[{"]?(.*?)[}"]?,?\s*$)re");
  std::vector<Reference> references;
  for (const std::string& line : lines) {
    std::smatch match;
    if (std::regex_search(line, match, entry)) {
      references.push_back({match.str(1), "", {}});
    } else if (!references.empty() && std::regex_search(line, match, field)) {
      if (match.str(1) == "year")
        references.back().year = match.str(2);
      else
        references.back().authors = family_names(match.str(2));
    }
  }
  return references;
}

bool resolves(const Citation& citation, const std::vector<Reference>& bibliography) {
  return std::any_of(bibliography.begin(), bibliography.end(), [&](const Reference& reference) {
    if (citation.authors.empty()) return reference.key == citation.year_or_key;
    return reference.year == citation.year_or_key && reference.authors.size() >= citation.authors.size() &&
           std::equal(citation.authors.begin(), citation.authors.end(), reference.authors.begin());
  });
}

}  // namespace turbid::testing
