/// The file of `recald ecm --measure`: measures whose savings are asked for.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "adapters/toml/toml_reader.hpp"
#include "core/savings/measure.hpp"
#include "daemon/site/config/site_config.hpp"

namespace recald::daemon {

/// Reads and checks measures against the site's model.
/// @pre the site has a model of its building
/// @return the measures, in order; or every problem of the file, such as a parameter that nobody
///         knows, targets for a model that recald has built in, or a value that is not possible.
///         Targets in an EnergyPlus model are looked up when it is run.
[[nodiscard]] tl::expected<std::vector<savings::Measure>, Problems> load_measures(
    const std::filesystem::path& file, const SiteConfig& site);

/// The same of a text; `name` is what messages call it.
[[nodiscard]] tl::expected<std::vector<savings::Measure>, Problems> parse_measures(
    std::string_view text, const std::string& name, const SiteConfig& site);

}  // namespace recald::daemon
