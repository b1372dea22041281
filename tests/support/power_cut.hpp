/// What a power cut leaves of a folder: file_faults tells of each change, and the disk may keep any
/// part of what was not synced.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/random/rng.hpp"
#include "tests/support/file_faults.hpp"

namespace recald::testing {

/// Of a file, any sectors written since its last sync may be there or not. Names that came, went or
/// changed since their folder was synced are there up to some moment, as a journal of a file system
/// keeps them. Files written without a sync are no different from others.
class PowerCut {
 public:
  /// @param folder  All that is in it now is safe, also in the folders below.
  explicit PowerCut(std::filesystem::path folder);

  /// To be told of each change before it is made.
  void watch(const FileChange& change);

  /// The folder as the power going now may leave it. `to` is made empty first.
  void write_image(Rng& rng, const std::filesystem::path& to) const;

 private:
  struct File {
    std::string durable;  ///< Its contents as of the last sync.
    std::string path;     ///< Where its contents of now are; empty: nowhere.
  };
  using Names = std::map<std::string, std::shared_ptr<File>>;
  struct NameChange {
    std::string from;  ///< Empty: the file is new.
    std::string to;    ///< Empty: the file goes.
    std::shared_ptr<File> file;
  };

  void change_name(const std::string& from, const std::string& to);
  void sync(const std::string& path);
  static void apply(const NameChange& change, Names& names);

  std::filesystem::path folder_;
  Names now_;
  Names durable_;
  std::vector<NameChange> pending_;  ///< From durable_ to now_.
};

}  // namespace recald::testing
