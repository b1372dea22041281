/// Which folder may include which: the arrows of the architecture, read off the sources.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

namespace recald::layout {

/// What one file includes of the project, by paths from its root.
using Includes = std::map<std::string, std::set<std::string>>;

/// The sources of core, adapters, daemon and simulators below a checkout's root.
[[nodiscard]] Includes read_includes(const std::string& root);

/// Includes that no folder may have: core <- adapters <- daemon/site <- daemon/gateway <-
/// daemon/commands, the rooms of a wing in one order, simulators apart.
/// @return a sentence each, with both files.
[[nodiscard]] std::vector<std::string> forbidden_arrows(const Includes& includes);

/// Folders that include each other, directly or around a corner; rooms too, with all folders in
/// them.
/// @return the folders or rooms of one circle each, separated by blanks.
[[nodiscard]] std::vector<std::string> circles(const Includes& includes);

/// Folders of more files than a reader takes in: thirty, but for catalogues, which have a file an
/// effect.
[[nodiscard]] std::vector<std::string> crowded(const Includes& includes);

}  // namespace recald::layout
