/// Faults of the file system, of whoever changes a file in this process: recald itself, the
/// standard library, SQLite. Linked into a test program, its functions stand before those of the C
/// library.
#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace recald::testing {

struct FileChange {
  std::string_view call;  ///< As the C library names it.
  std::string path;       ///< Of the file or folder, before the call.
  std::string to;         ///< Its name after a rename.
};

/// Asked before each call that changes a file or a name. 0: it is made; another errno: it fails
/// with that. Absent: all are made. Whoever ends the process here leaves the disk as before the
/// call.
extern std::function<int(const FileChange&)> before_file_change;

/// The n-th change fails, or that and all after it, until the value ends.
class FailingChanges {
 public:
  FailingChanges(int nth, int error, bool lasting);
  ~FailingChanges();
  FailingChanges(const FailingChanges&) = delete;
  FailingChanges& operator=(const FailingChanges&) = delete;

  /// Whether there were so many.
  [[nodiscard]] bool has_failed() const { return has_failed_; }

 private:
  int seen_ = 0;
  bool has_failed_ = false;
};

/// The process ends before the n-th change.
void end_process_before_change(int nth, int exit_code);

}  // namespace recald::testing
