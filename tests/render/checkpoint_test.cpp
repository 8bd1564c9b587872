#include "render/checkpoint.h"

#include <gtest/gtest.h>

#include <fstream>

#include "core/error.h"
#include "image/atomic_file.h"
#include "testing/temporary_folder.h"
#include "toy_task.h"

namespace turbid {
namespace {

using testing::TemporaryFolder;

Film some_film() {
  testing::ToyTask toy{{9, 7}};
  Film film(toy.size, testing::kLayers);
  toy.render_pass({3, 0, 5}, film, StopFlag());
  return film;
}

void write_bytes(const std::string& path, const std::string& bytes) { std::ofstream(path, std::ios::binary) << bytes; }

std::string reading_error(const std::string& path) {
  try {
    read_checkpoint(path);
  } catch (const FileError& error) {
    return error.what();
  }
  return {};
}

TEST(Checkpoint, KeepsEveryBit) {
  const TemporaryFolder folder;
  const Film film = some_film();
  write_checkpoint(folder.file("a.ckpt"), 0x123456789abcdef0, 12.5, film);
  const Checkpoint back = read_checkpoint(folder.file("a.ckpt"));
  EXPECT_EQ(back.fingerprint, 0x123456789abcdef0u);
  EXPECT_EQ(back.seconds, 12.5);
  EXPECT_TRUE(testing::same_bits(film, back.film));
  EXPECT_EQ(back.film.layer_names(), testing::kLayers);
  EXPECT_GT(back.film.layers(5)[1], 0);
  EXPECT_TRUE(looks_like_checkpoint(folder.file("a.ckpt")));
}

TEST(Checkpoint, NoticesEveryFlippedBitAndEveryLength) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.ckpt");
  write_checkpoint(path, 1, 2, some_film());
  const std::string good = read_file(path);
  for (size_t place = 0; place < good.size(); place += place < 64 ? 1 : 37) {
    std::string bad = good;
    bad[place] = static_cast<char>(bad[place] ^ 4);
    write_bytes(path, bad);
    EXPECT_NE(reading_error(path), "") << place;
  }
  for (const size_t length : {size_t{0}, size_t{11}, size_t{50}, good.size() - 8, good.size() - 1}) {
    write_bytes(path, good.substr(0, length));
    EXPECT_NE(reading_error(path), "") << length;
  }
  write_bytes(path, good + "x");
  EXPECT_EQ(reading_error(path), path + ": is a damaged checkpoint (its checksum does not fit)");
}

TEST(Checkpoint, TellsForeignFilesAndVersionsApart) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.ckpt");
  write_bytes(path, std::string(200, 'x'));
  EXPECT_EQ(reading_error(path), path + ": is not a checkpoint of turbid");
  EXPECT_FALSE(looks_like_checkpoint(path));
  write_checkpoint(path, 1, 2, some_film());
  std::string bytes = read_file(path);
  bytes[12] = 9;
  write_bytes(path, bytes);
  EXPECT_EQ(reading_error(path), path + ": is a checkpoint of format 9, this program reads format 2");
  EXPECT_TRUE(looks_like_checkpoint(path));
}

}  // namespace
}  // namespace turbid
