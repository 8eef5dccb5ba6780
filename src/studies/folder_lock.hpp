#pragma once
#include <string>

namespace lockstep {

/// Keeps a folder for one study at a time. The children of a study hold the lock as well, so that a
/// run that outlives its study is noticed.
class FolderLock {
 public:
  /// Waits up to this long for others; then throws OutputError.
  FolderLock(const std::string& folder, double seconds);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_;
};

}  // namespace lockstep
