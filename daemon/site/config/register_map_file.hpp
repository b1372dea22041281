/// Register maps as TOML: one file a kind of meter, shipped with recald or written by a user.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "adapters/modbus/register_map.hpp"
#include "adapters/toml/toml_reader.hpp"
#include "core/result.hpp"

namespace recald::daemon {

/// A reply that the map must decode as stated: the proof that belongs to each shipped map.
struct GoldenReply {
  std::uint16_t address;  ///< As `RegisterField::address`.
  modbus::Words words;
  std::map<std::string, double> values;  ///< Field -> value in its unit.
};

struct RegisterMapFile {
  modbus::RegisterMap map;
  std::vector<GoldenReply> golden;
};

/// Reads and checks a map's text. Every key is documented in adapters/modbus/maps/README.md.
/// @param name  "abb-b23": of the map, and in messages as "abb-b23.toml".
/// @return the map, or every problem found, with its line.
[[nodiscard]] tl::expected<RegisterMapFile, Problems> parse_register_map(std::string_view text,
                                                                         const std::string& name);

/// Names of the maps that come with recald, ascending.
[[nodiscard]] std::vector<std::string_view> shipped_register_maps();

/// A shipped map's text; not_found lists the names there are, the nearest one first.
[[nodiscard]] Result<std::string_view> shipped_register_map(std::string_view name);

/// The map that a site file names: a file beside it if the name ends in ".toml", else a shipped
/// one.
/// @return the map, or every problem; a file that cannot be read is one.
[[nodiscard]] tl::expected<modbus::RegisterMap, Problems> find_register_map(
    const std::string& name, const std::filesystem::path& folder);

/// The text of such a file. @return or a sentence that says where it should be.
[[nodiscard]] Result<std::string> read_register_map(const std::string& name,
                                                    const std::filesystem::path& folder);

/// Texts of register maps, by the names that a site file gives them.
using MapTexts = std::map<std::string, std::string>;

/// The maps of one site file, each read once, however many meters have it.
class RegisterMaps {
 public:
  /// @param folder  Where a map of one's own lies: that of the site file.
  /// @param given   In the place of files, if not null; outlives this.
  explicit RegisterMaps(std::filesystem::path folder, const MapTexts* given = nullptr)
      : folder_(std::move(folder)), given_(given) {}

  /// As find_register_map.
  [[nodiscard]] const tl::expected<modbus::RegisterMap, Problems>& find(const std::string& name);

 private:
  [[nodiscard]] tl::expected<modbus::RegisterMap, Problems> find_anew(
      const std::string& name) const;

  std::filesystem::path folder_;
  const MapTexts* given_;
  std::map<std::string, tl::expected<modbus::RegisterMap, Problems>> read_;
};

}  // namespace recald::daemon
