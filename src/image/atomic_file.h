#pragma once
#include <initializer_list>
#include <span>
#include <string>

namespace turbid {

/// Replaces `path` by these bytes in one step: they are written beside it (`path.part`), brought to the disk, and
/// renamed. Whoever reads `path`, even after the process or the machine died half-way, finds the old file or the new
/// one. Symbolic links are followed; what is not a regular file (a device, a pipe) is written to directly. Throws
/// FileError.
void write_file_atomically(const std::string& path, std::span<const char> bytes);
/// The same from several pieces, one after the other.
void write_file_atomically(const std::string& path, std::initializer_list<std::span<const char>> pieces);

/// Throws FileError when `path` could not be replaced: no such folder, no permission, a folder of that name. Called
/// before hours of work, leaves nothing behind.
void check_writable(const std::string& path);

/// The whole content of a file; FileError when it cannot be read.
std::string read_file(const std::string& path);

}  // namespace turbid
