/// The versions of a site's model on disk, beside the site file.
///
///     SITE.models/<version>.json   see version_file.hpp; written whole, never removed
///     SITE.models/active           the version in force; absent: the drawings
///     SITE.models/history.jsonl    one line an activation or a revert, oldest first
///
/// `active` is written last, so that a crash leaves the model as it was: the history may then speak
/// of a change that did not happen, and the same command makes it happen.
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
  std::vector<std::string> damaged;  ///< A sentence a file that cannot be read.
};

class ModelStore {
 public:
  /// Touches nothing yet: a site whose model was never changed has no folder.
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

  /// Writes a version under the name its content gives it. One that is there already stays as it
  /// is, status included.
  /// @return the version as it stands, or what `named_by_content` refuses; not_found when its
  ///         parent is unknown; io_failed.
  [[nodiscard]] Result<diagnosis::ModelVersion> save(diagnosis::ModelVersion version) const;

  /// Puts a version in force and marks it accepted.
  /// @param at  Time for the history, ISO 8601.
  /// @return the version, or as `load`; invalid_value when it is in force already.
  [[nodiscard]] Result<diagnosis::ModelVersion> activate(std::string_view version,
                                                         const std::string& at) const;

  /// Goes back to the parent of the version in force, or to `target` where one is given. All that
  /// is left on the way there is marked reverted. With a `target` this is also the way out of
  /// damage.
  /// @return the version now in force, or as `load`; invalid_value when nothing was ever added,
  ///         `target` is in force already, or was proposed and never accepted.
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
