/// What EnergyPlus says of a run, in `eplusout.err`.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace recald::energyplus {

struct ErrorFile {
  std::vector<std::string> fatal;   ///< A sentence each, its continuation lines joined.
  std::vector<std::string> severe;  ///< The first ones.
  std::size_t severe_count = 0;
  std::size_t warning_count = 0;
  bool is_complete = false;  ///< EnergyPlus came to its end, well or badly.

  /// The first severe error, which is the cause, else the fatal one; empty where there is neither.
  [[nodiscard]] std::string words() const;
};

[[nodiscard]] ErrorFile parse_error_file(std::string_view text);

/// A file that is not there is one without a line.
[[nodiscard]] ErrorFile read_error_file(const std::filesystem::path& file);

}  // namespace recald::energyplus
