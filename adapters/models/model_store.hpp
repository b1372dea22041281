/// The versions of a site's model on disk, beside the site file or the store.
///
///     SITE.models/<version>.json   see version_file.hpp; written whole, never removed
///     SITE.models/active           the version in force; absent: the drawings
///     SITE.models/history.jsonl    one line per activation or revert, oldest first
///
/// `active` is written last, so a crash leaves the model unchanged. The history may then mention a
/// change that did not happen; running the same command again makes it.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/diagnosis/model_version.hpp"
#include "core/result.hpp"

namespace recald::models {

struct VersionList {
  std::vector<diagnosis::ModelVersion> versions;  ///< Drawings first, then by time of creation.
  std::string active;
  std::vector<std::string> damaged;  ///< One sentence for each file that cannot be read.
};

class ModelStore {
 public:
  /// Creates nothing: the folder appears with the first version.
  /// @param site_file  Or another file, beside which the folder is (SiteConfig::versions_beside).
  ModelStore(const std::filesystem::path& site_file, std::string site_id);

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }

  /// @return io_failed when the folder or `active` cannot be read.
  [[nodiscard]] Result<VersionList> list() const;

  /// @param version  "drawings", a version, or its first digits, at least four.
  /// @return not_found with the known versions; invalid_value when the digits fit several;
  ///         malformed for a damaged file; io_failed.
  [[nodiscard]] Result<diagnosis::ModelVersion> load(std::string_view version) const;

  /// The version in force. @return as `load`
  [[nodiscard]] Result<diagnosis::ModelVersion> active() const;

  /// Writes a version under the name that its content gives it. A version that is already there
  /// stays unchanged, with its status.
  /// @return the stored version, or what `named_by_content` refuses; not_found when its parent is
  ///         unknown; io_failed.
  [[nodiscard]] Result<diagnosis::ModelVersion> save(diagnosis::ModelVersion version) const;

  /// Puts a version in force and marks it accepted.
  /// @param at  Time for the history, ISO 8601.
  /// @return the version, or as `load`; invalid_value when it is already in force.
  [[nodiscard]] Result<diagnosis::ModelVersion> activate(std::string_view version,
                                                         const std::string& at) const;

  /// Goes back to the parent of the version in force, or to `target` if given. All versions left on
  /// the way are marked reverted. With a `target`, this also works when the version in force is
  /// damaged.
  /// @return the version now in force, or as `load`; invalid_value when nothing was ever added, or
  ///         `target` is already in force or was proposed and never accepted.
  [[nodiscard]] Result<diagnosis::ModelVersion> revert(std::string_view target,
                                                       const std::string& at) const;

 private:
  [[nodiscard]] std::filesystem::path file_of(std::string_view version) const;
  [[nodiscard]] Result<std::vector<std::string>> names() const;
  [[nodiscard]] Result<std::string> full_name(std::string_view version) const;
  [[nodiscard]] Result<std::string> active_name() const;
  [[nodiscard]] Result<void> mark(diagnosis::ModelVersion version,
                                  diagnosis::VersionStatus status) const;
  [[nodiscard]] Result<void> mark_reverted(diagnosis::ModelVersion version,
                                           const diagnosis::ModelVersion& until) const;
  [[nodiscard]] Result<diagnosis::ModelVersion> put_in_force(diagnosis::ModelVersion next,
                                                             std::string_view action,
                                                             const std::string& from,
                                                             const std::string& at) const;

  std::filesystem::path folder_;
  std::string site_id_;
};

}  // namespace recald::models
