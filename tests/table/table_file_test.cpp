#include "table/table_file.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "core/error.h"
#include "image/atomic_file.h"
#include "medium/henyey_greenstein.h"
#include "medium/isotropic.h"
#include "table/table_cache.h"
#include "table/tables_for_tests.h"
#include "testing/temporary_folder.h"

namespace turbid::testing {
namespace {

void expect_equal(const ScatteringTable& a, const ScatteringTable& b) {
  EXPECT_EQ(a.shape.grid.radii(), b.shape.grid.radii());
  EXPECT_EQ(a.shape.grid.angles(), b.shape.grid.angles());
  EXPECT_EQ(a.shape.grid.outer(), b.shape.grid.outer());
  EXPECT_EQ(a.shape.bands, b.shape.bands);
  EXPECT_EQ(a.moments, b.moments);
  EXPECT_EQ(a.seed, b.seed);
  EXPECT_EQ(a.deposits, b.deposits);
  for (size_t k = 0; k < kSourceKinds; ++k) {
    EXPECT_EQ(a.kinds[k].density, b.kinds[k].density);
    EXPECT_EQ(a.kinds[k].largest, b.kinds[k].largest);
    EXPECT_EQ(a.kinds[k].ratios, b.kinds[k].ratios);
  }
}

TEST(TableFile, ComesBackAsItWas) {
  for (const float g : {0.0f, 0.7f}) {
    const std::string bytes = encode_table(small_table(g));
    expect_equal(decode_table(bytes, "memory"), small_table(g));
    EXPECT_EQ(encode_table(small_table(g)), bytes);
  }
}

TEST(TableFile, RatiosInEightBits) {
  for (const float largest : {0.1f, 3.0f})
    for (float x = -1; x <= 1; x += 0.01f) {
      const float back = decode_ratio(encode_ratio(x * largest, largest), largest) / largest;
      EXPECT_NEAR(back, x, std::sqrt(std::abs(x)) / 127 + 2e-5f);
    }
  EXPECT_EQ(decode_ratio(encode_ratio(0, 0), 0), 0);
}

TEST(TableFile, DamageIsFound) {
  const std::string bytes = encode_table(small_table(0));
  const auto is_refused = [](const std::string& damaged) {
    try {
      decode_table(damaged, "x.h5");
      return false;
    } catch (const FileError& error) {
      EXPECT_EQ(std::string(error.what()).rfind("x.h5: this is not a usable table of multiple scattering: ", 0), 0u);
      return true;
    }
  };
  EXPECT_TRUE(is_refused(""));
  EXPECT_TRUE(is_refused("not a table"));
  EXPECT_TRUE(is_refused(bytes.substr(0, bytes.size() / 2)));
  // Bits in the data; in the library's own records a few are not used, and their loss changes nothing.
  Rng rng(1);
  int found = 0;
  constexpr int kTries = 60;
  for (int i = 0; i < kTries; ++i) {
    std::string damaged = bytes;
    damaged[rng.next_u32() % damaged.size()] ^= static_cast<char>(1 << rng.next_u32() % 8);
    try {
      expect_equal(decode_table(damaged, "x.h5"), small_table(0));
    } catch (const FileError&) {
      ++found;
    }
  }
  EXPECT_GT(found, kTries / 2);
}

TableRequest request_in(const TemporaryFolder& folder) { return {{1, 2000}, folder.file("tables")}; }

TEST(TableCache, BuildsOnceAndReplacesWhatIsDamaged) {
  const TemporaryFolder folder;
  const TableRequest request = request_in(folder);
  const IsotropicPhase phase;
  const std::string path = table_path(phase, request);
  EXPECT_FALSE(std::filesystem::exists(path));
  const ScatteringTable first = *find_table(phase, request);
  const std::string bytes = read_file(path);
  const auto time = std::filesystem::last_write_time(path);
  expect_equal(*find_table(phase, request), first);
  EXPECT_EQ(std::filesystem::last_write_time(path), time);

  for (const std::string& wrong : {bytes.substr(0, 1000), encode_table(small_table(0.7f)), std::string("x")}) {
    std::ofstream(path, std::ios::binary) << wrong;
    ::testing::internal::CaptureStderr();
    expect_equal(*find_table(phase, request), first);
    EXPECT_NE(::testing::internal::GetCapturedStderr().find("built anew"), std::string::npos);
    EXPECT_EQ(read_file(path), bytes);
  }
}

TEST(TableCache, NamesDependOnWhatTablesDependOn) {
  const TableRequest request{{1, 1000}, "f"};
  const std::string path = table_path(HenyeyGreensteinPhase(0.5f), request);
  EXPECT_EQ(path.rfind("f/g0.500-", 0), 0u) << path;
  EXPECT_EQ(path, table_path(HenyeyGreensteinPhase(0.5f), request));
  EXPECT_NE(path, table_path(HenyeyGreensteinPhase(0.501f), request));
  EXPECT_NE(path, table_path(HenyeyGreensteinPhase(0.5f), {{2, 1000}, "f"}));
  EXPECT_NE(path, table_path(HenyeyGreensteinPhase(0.5f), {{1, 1001}, "f"}));
}

TEST(TableCache, WithoutAFolderTablesAreBuiltAllTheSame) {
  const TemporaryFolder folder;
  std::ofstream(folder.file("file")) << "in the way";
  ::testing::internal::CaptureStderr();
  EXPECT_NE(find_table(IsotropicPhase(), {{1, 2000}, folder.file("file")}), nullptr);
  EXPECT_NE(::testing::internal::GetCapturedStderr().find("could not be kept"), std::string::npos);
}

TEST(TableCache, ProcessesMayWriteAtOnce) {
  const TemporaryFolder folder;
  const std::string bytes = encode_table(small_table(0)), path = folder.file("table.h5");
  std::vector<pid_t> writers;
  for (int i = 0; i < 4; ++i) {
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child > 0) {
      writers.push_back(child);
      continue;
    }
    int wrong = 0;
    try {
      for (int n = 0; n < 20; ++n) {
        write_file_atomically(path, bytes);
        wrong += read_file(path) != bytes;
      }
    } catch (...) {
      wrong = 100;
    }
    ::_exit(wrong);
  }
  for (const pid_t child : writers) {
    int status = -1;
    EXPECT_EQ(::waitpid(child, &status, 0), child);
    EXPECT_EQ(status, 0);
  }
  expect_equal(decode_table(read_file(path), path), small_table(0));
}

}  // namespace
}  // namespace turbid::testing
