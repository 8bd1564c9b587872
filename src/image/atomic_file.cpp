#include "image/atomic_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <utility>

#include "core/error.h"

namespace turbid {
namespace {

/// An open file descriptor that closes itself.
class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  int get() const { return fd_; }
  explicit operator bool() const { return fd_ >= 0; }

 private:
  int fd_;
};

[[noreturn]] void fail(const std::string& path, const char* what) {
  throw FileError(path, std::string(what) + ": " + std::strerror(errno));
}

bool is_same_file(int fd, const std::string& path) {
  struct stat opened {
  }, named{};
  return ::fstat(fd, &opened) == 0 && ::stat(path.c_str(), &named) == 0 && opened.st_ino == named.st_ino &&
         opened.st_dev == named.st_dev;
}

/// The file beside `path`, empty and locked. One left behind by a killed process is used again; one that a living
/// process is writing is not, then the process number makes another name.
struct PartFile {
  explicit PartFile(const std::string& path) : name(path + ".part"), fd(open(name)) {
    if (!fd || ::flock(fd.get(), LOCK_EX | LOCK_NB) != 0 || !is_same_file(fd.get(), name)) {
      name = path + "." + std::to_string(::getpid()) + ".part";
      fd = open(name);
    }
    if (!fd || ::ftruncate(fd.get(), 0) != 0) fail(path, "cannot be written");
  }

  std::string name;
  Descriptor fd;

 private:
  static Descriptor open(const std::string& name) {
    return Descriptor(::open(name.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666));
  }
};

void write_all(int fd, std::initializer_list<std::span<const char>> pieces, const std::string& path) {
  for (const std::span<const char> bytes : pieces) {
    for (size_t done = 0; done < bytes.size();) {
      const ssize_t n = ::write(fd, bytes.data() + done, bytes.size() - done);
      if (n < 0 && errno != EINTR) fail(path, "cannot be written");
      if (n > 0) done += static_cast<size_t>(n);
    }
  }
}

/// The file that a chain of symbolic links ends in.
std::string followed(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_symlink(path, error)) return path;
  const auto target = std::filesystem::weakly_canonical(path, error);
  return error ? path : target.string();
}

bool exists_but_is_no_regular_file(const std::string& path) {
  struct stat info {};
  return ::stat(path.c_str(), &info) == 0 && !S_ISREG(info.st_mode);
}

}  // namespace

void write_file_atomically(const std::string& path, std::span<const char> bytes) {
  write_file_atomically(path, {bytes});
}

void write_file_atomically(const std::string& path, std::initializer_list<std::span<const char>> pieces) {
  const std::string target = followed(path);
  if (exists_but_is_no_regular_file(target)) {
    const Descriptor fd(::open(target.c_str(), O_WRONLY | O_CLOEXEC));
    if (!fd) fail(path, "cannot be written");
    return write_all(fd.get(), pieces, path);
  }
  const PartFile part(target);
  try {
    write_all(part.fd.get(), pieces, path);
    struct stat old {};
    if (::stat(target.c_str(), &old) == 0 && ::fchmod(part.fd.get(), old.st_mode & 07777) != 0)
      fail(path, "cannot keep its permissions");
    if (::fsync(part.fd.get()) != 0) fail(path, "cannot be brought to the disk");
    if (::rename(part.name.c_str(), target.c_str()) != 0) fail(path, "cannot be replaced");
  } catch (...) {
    ::unlink(part.name.c_str());
    throw;
  }
  std::string folder = std::filesystem::path(target).parent_path().string();
  if (folder.empty()) folder = ".";
  const Descriptor directory(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (directory) ::fsync(directory.get());
}

void check_writable(const std::string& path) {
  const std::string target = followed(path);
  if (exists_but_is_no_regular_file(target)) {
    const Descriptor fd(::open(target.c_str(), O_WRONLY | O_CLOEXEC | O_NONBLOCK));
    if (!fd) fail(path, "cannot be written");
    return;
  }
  const PartFile part(target);
  ::unlink(part.name.c_str());
}

std::string read_file(const std::string& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) throw FileError(path, "is a folder, not a file");
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) fail(path, "cannot be opened");
  std::string content{std::istreambuf_iterator<char>(file), {}};
  if (file.bad()) fail(path, "cannot be read");
  return content;
}

}  // namespace turbid
