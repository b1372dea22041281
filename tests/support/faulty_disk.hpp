/// A disk for SQLite that a test can break: it fails when it is told to, and knows what a power cut
/// at any moment would leave of it.
///
/// Files are real ones, written through SQLite's own file system, so locks and shared memory are
/// too. Nothing is synced to the machine's disk; instead what was written since a file's last sync
/// is remembered apart, and which names the folder is sure to have.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/random/rng.hpp"

namespace recald::testing {

class FaultyDisk {
 public:
  enum class Operation { open, read, write, truncate, sync, remove, share };

  struct Step {
    Operation operation;
    std::string file;  ///< Its name in the folder.
  };

  /// Files by name, as a power cut may leave them.
  using Image = std::map<std::string, std::string>;

  /// @param name  Under which SQLite finds it: Database::Options::vfs. One of a name at a time.
  explicit FaultyDisk(std::string name);
  ~FaultyDisk();
  FaultyDisk(const FaultyDisk&) = delete;
  FaultyDisk& operator=(const FaultyDisk&) = delete;

  /// Asked before each step. 0: it is done; another of SQLite's result codes: it is not, and that
  /// is the answer. Whoever throws or ends the process here leaves the disk as before the step.
  std::function<int(const Step&)> before;

  /// What the disk may hold if the power goes now. Of what was not synced, each write may be there,
  /// not at all or in some of its sectors, whatever the order; a name that came or went since its
  /// folder was synced may be there or not.
  [[nodiscard]] Image after_power_cut(Rng& rng) const;

  [[nodiscard]] const std::string& name() const { return name_; }

 private:
  struct Vfs;
  std::string name_;
  std::unique_ptr<Vfs> vfs_;
};

/// Writes an image's files into a folder, which is made empty first.
void write_image(const FaultyDisk::Image& image, const std::filesystem::path& folder);

}  // namespace recald::testing
