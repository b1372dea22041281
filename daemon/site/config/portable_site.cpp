#include "daemon/site/config/portable_site.hpp"

#include <array>
#include <sstream>

#include "adapters/toml/toml_reader.hpp"

namespace recald::daemon {
namespace {

/// Whether a [[meter]] is one whose readings come in while the daemon runs.
bool comes_in(const toml::table& meter) {
  constexpr std::array<std::string_view, 3> kSources{"modbus", "http", "mqtt"};
  const auto source = meter["source"].value_or(std::string_view{});
  return std::ranges::find(kSources, source) != kSources.end();
}

}  // namespace

Result<PortableSite> read_portable_site(const std::filesystem::path& file) {
  const auto root = TRY(read_toml(file, "site file"));
  PortableSite site;
  toml::table kept;
  for (const char* const key : {"site", "bus"}) {
    if (const toml::node* const node = root.get(key)) kept.insert(key, *node);
  }
  toml::array meters;
  if (const toml::array* const all = root.get_as<toml::array>("meter")) {
    for (const toml::node& node : *all) {
      const toml::table* const meter = node.as_table();
      if (meter == nullptr || !comes_in(*meter)) continue;
      meters.push_back(*meter);
      const std::string map = (*meter)["map"].value_or(std::string{});
      if (!map.ends_with(".toml") || site.maps.contains(map)) continue;
      site.maps[map] = TRY(read_register_map(map, file.parent_path()));
    }
  }
  kept.insert("meter", std::move(meters));
  // Meters of a broker need one, but which it is does not matter.
  if (root.contains("mqtt")) kept.insert("mqtt", toml::table{{"url", "mqtt://127.0.0.1"}});
  // The weather file does not either, where sensors measure the rest.
  if (root.contains("weather")) kept.insert("weather", toml::table{{"file", "weather.csv"}});
  std::ostringstream text;
  text << kept;
  site.text = text.str();
  return site;
}

}  // namespace recald::daemon
