/// Which site a design of experiments was run for, so that a meta-model of it never speaks for a
/// site whose model has other effects.
///
///     DIR/site.json   {"site": path of the site file from DIR, "effects": [parameter names]}
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "adapters/doe/design_folder.hpp"
#include "core/diagnosis/model_version.hpp"
#include "core/result.hpp"

namespace recald::daemon {

/// Writes site.json into the folder of a design of this site.
/// @param effects  Of the version in force, which the design varies.
[[nodiscard]] Result<void> note_site(const std::filesystem::path& folder,
                                     const std::filesystem::path& site_file,
                                     const std::vector<diagnosis::AddedEffect>& effects);

/// What a calibration on a design must know of its site.
struct DesignOrigin {
  /// Parameters of effects that these months must not teach again: they are held, and what they
  /// could move counts as error.
  std::vector<std::string> held;
  std::vector<std::string> notes;        ///< In words.
  std::filesystem::path site_file = {};  ///< Empty: another program's design.
};

/// Nothing for a design without site.json: it is another program's.
/// @return the above; or
///         unsupported  an effect of the version in force is not in the design, or the design
///                      varies one that is no longer in force;
///         malformed    site.json is damaged; or what `active_effects` finds.
[[nodiscard]] Result<DesignOrigin> check_origin(const doe::DesignFolder& design);

}  // namespace recald::daemon
