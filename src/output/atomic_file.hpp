#pragma once
#include <string>

/// Files appear under their final name only when they are whole: they are written beside it, forced
/// to disk and renamed. None of these functions is collective; call them on rank 0.
namespace lockstep {

/// The name under which `path` is written until it is complete.
std::string part_name(const std::string& path);

/// Creates part_name(path) for writing, instead of one that a killed run has left. Returns its
/// descriptor; or -1, and `failure` says why. A link or anything else that is no plain file stays
/// untouched, and so does what it points to.
int open_part(const std::string& path, std::string& failure);

/// Replaces the file `path` by `text`. Throws OutputError (and leaves the old file untouched) if
/// the disk is full or the folder is not writable.
void write_file_atomically(const std::string& path, const std::string& text);

/// Forces the closed file part_name(path) to disk and renames it to `path`. Throws OutputError,
/// after removing the part, if either fails.
void commit_part(const std::string& path);

/// Removes part_name(path) if it exists; never throws.
void discard_part(const std::string& path) noexcept;

/// Appends `text` to the file descriptor. Returns 0, or the errno of the write that failed.
int write_fully(int descriptor, const std::string& text);
/// Writes bytes to this place of the file; the result is as that of write_fully.
int write_fully_at(int descriptor, const char* bytes, std::size_t size, long long offset);

/// The whole content of a plain file; throws OutputError if it is none or cannot be read.
std::string read_whole_file(const std::string& path);

}  // namespace lockstep
