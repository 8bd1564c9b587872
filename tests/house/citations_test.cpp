#include "house/citations.h"

#include <gtest/gtest.h>

#include "house/source_files.h"

namespace turbid::testing {
namespace {

const std::filesystem::path kRoot = TURBID_ROOT;

TEST(Citations, OfTheSourcesAreInTheBibliography) {
  const std::vector<Reference> bibliography = parse_bibliography(read_lines(kRoot / "docs/references.bib"));
  EXPECT_GE(bibliography.size(), 10u);
  size_t count = 0;
  for (const SourceFile& file : source_files(kRoot, {"src", "bench", "experiments"}))
    for (size_t i = 0; i < file.lines.size(); ++i)
      for (const Citation& citation : find_citations(file.lines[i])) {
        ++count;
        EXPECT_TRUE(resolves(citation, bibliography))
            << file.path << ":" << i + 1 << ": '" << citation.text << "' is not in docs/references.bib";
      }
  EXPECT_GE(count, 10u) << "the sources cite more than that: is the search broken?";
}

TEST(Citations, AreFoundAsPeopleWriteThem) {
  const auto texts = [](const std::string& line) {
    std::vector<std::string> found;
    for (const Citation& citation : find_citations(line)) found.push_back(citation.text);
    return found;
  };
  using Texts = std::vector<std::string>;
  EXPECT_EQ(texts("/// a map (Shirley & Chiu 1997); Duff et al. 2017"),
            (Texts{"Shirley & Chiu 1997", "Duff et al. 2017"}));
  EXPECT_EQ(texts("// PCG32 (O'Neill 2014), Křivánek et al. 2014"), (Texts{"O'Neill 2014", "Křivánek et al. 2014"}));
  EXPECT_EQ(texts("// (Heitz & d'Eon 2014)"), (Texts{"Heitz & d'Eon 2014"}));
  EXPECT_EQ(texts("// S3 eq. 41 and NUMERICS 2.3"), (Texts{"S3 eq. 41", "NUMERICS 2.3"}));
  EXPECT_EQ(texts("// 2048 rays in 1999 steps of Vec3 x"), Texts{});
}

TEST(Citations, ThatAreWrongDoNotResolve) {
  const std::vector<Reference> bibliography =
      parse_bibliography({"@article{duff2017,", "  author = {Duff, Tom and Burgess, James},", "  year = {2017},", "}",
                          "@book{S3,", "  author = {van de Hulst, H. C.},", "  year = 1980", "}"});
  const auto all_resolve = [&](const std::string& line) {
    const std::vector<Citation> found = find_citations(line);
    return !found.empty() &&
           std::all_of(found.begin(), found.end(), [&](const Citation& c) { return resolves(c, bibliography); });
  };
  EXPECT_TRUE(all_resolve("Duff et al. 2017"));
  EXPECT_TRUE(all_resolve("Duff & Burgess 2017"));
  EXPECT_TRUE(all_resolve("van de Hulst 1980"));
  EXPECT_TRUE(all_resolve("S3 eq. 1"));
  EXPECT_FALSE(all_resolve("Duff et al. 2018"));
  EXPECT_FALSE(all_resolve("Duff & Hulst 2017"));
  EXPECT_FALSE(all_resolve("Burgess 2017"));
  EXPECT_FALSE(all_resolve("S4 eq. 1"));
}

}  // namespace
}  // namespace turbid::testing
