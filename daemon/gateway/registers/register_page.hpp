/// The map of the registers for people and programs, made from its table.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "daemon/gateway/registers/alarm_codes.hpp"
#include "daemon/site/config/site_config.hpp"

namespace recald::daemon {

/// What an alarm's code stands for.
[[nodiscard]] std::string words_of(AlarmCode code);

/// registers.md: the map of any site.
[[nodiscard]] std::string register_page();

/// The registers of this site, one a line: address,registers,type,meter,name,unit,meaning
[[nodiscard]] std::string registers_csv(const SiteConfig& site);

/// The same, with what codes stand for.
[[nodiscard]] nlohmann::ordered_json registers_json(const SiteConfig& site);

/// The same as columns for a console.
[[nodiscard]] std::string registers_text(const SiteConfig& site);

}  // namespace recald::daemon
