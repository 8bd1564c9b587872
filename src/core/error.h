#pragma once
#include <stdexcept>
#include <string>

namespace turbid {

/// Base of everything that turbid throws on purpose. `main` turns it into a message and the exit code.
class Error : public std::runtime_error {
 public:
  Error(const std::string& message, int exit_code) : std::runtime_error(message), exit_code_(exit_code) {}
  int exit_code() const { return exit_code_; }

 private:
  int exit_code_;
};

/// Wrong words on the command line.
struct UsageError : Error {
  explicit UsageError(const std::string& message) : Error(message, 2) {}
};

/// A place in a text file; line and column count from 1, 0 means unknown.
struct SourceLocation {
  std::string file;
  int line = 0, column = 0;
};

/// What a scene asks for is wrong or not supported. The message of what() is complete: place, offending line with a
/// caret when the file can be read, what was found and what would be right.
class SceneError : public Error {
 public:
  explicit SceneError(const std::string& message) : Error(message, 3), reason_(message) {}
  SceneError(const SourceLocation& where, const std::string& message);

  const SourceLocation& where() const { return where_; }
  /// The message without place and quoted line.
  const std::string& reason() const { return reason_; }

 private:
  SourceLocation where_;
  std::string reason_;
};

/// A file that cannot be read, written or understood.
struct FileError : Error {
  FileError(const std::string& path, const std::string& message) : Error(path + ": " + message, 4) {}
};

}  // namespace turbid
