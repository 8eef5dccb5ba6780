#pragma once
#include <memory>
#include <string>

namespace lockstep {

/// Keeps a folder for one program at a time: a study, a run. The children of a program hold the
/// lock as well, so that a run that outlives its study is noticed; the system releases it when the
/// last of them ends, however it does.
class FolderLock {
 public:
  /// Waits up to this long for others; null if one still has the folder. Throws OutputError if the
  /// folder cannot be written to. A file system that knows no locks keeps nobody out. Local.
  static std::unique_ptr<FolderLock> take(const std::string& folder, double seconds);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  explicit FolderLock(int descriptor) : descriptor_(descriptor) {}

  int descriptor_;
};

}  // namespace lockstep
