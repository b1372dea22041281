/// Meters in a file that are not configured: their names and line counts, in one sentence.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace recald::csv {

class OtherMeters {
 public:
  /// Counts one more line of a meter.
  void add(std::string_view name);

  [[nodiscard]] bool empty() const { return lines_ == 0; }
  [[nodiscard]] std::uint64_t lines() const { return lines_; }

  /// "2 meters are not configured, and their lines were left out: water (24), heat (4)"; empty if
  /// there are none.
  [[nodiscard]] std::string words() const;

 private:
  struct Other {
    std::string name;
    std::uint64_t lines;
  };
  std::vector<Other> named_;      ///< The first ones, in order of appearance.
  std::uint64_t lines_ = 0;       ///< Of all meters.
  std::uint64_t more_lines_ = 0;  ///< Of those beyond the named ones.
};

}  // namespace recald::csv
