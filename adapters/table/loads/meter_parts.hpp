/// Loads that stand in several rows or columns: tariffs that take turns, phases, registers.
#pragma once

#include <span>
#include <vector>

#include "adapters/csv/reading_intake.hpp"
#include "adapters/table/table_shape.hpp"

namespace recald::table {

/// Reads each row or column of a meter's lists as a part of its own, and adds up their readings.
///
/// Where most intervals have a value of every part, an interval without one of them has none.
/// Otherwise the parts take turns, as the registers of two tariffs do: an interval has the values
/// that are there, but none where a part is missing that has a value before and after it. Readings
/// of such meters are kept until the end.
class MeterParts {
 public:
  explicit MeterParts(std::span<const TableMeter> meters);

  /// To be read in the place of the meters.
  [[nodiscard]] std::span<const TableMeter> parts() const { return parts_; }

  /// Takes the parts' readings. @param outer  For the meters' readings; outlives the result.
  [[nodiscard]] csv::ReadingsSink sink(const csv::ReadingsSink& outer);

  /// Hands out the sums.
  /// @param report  Of the parts, from the intake.
  /// @return the meters' report; or not_enough_data: a part has no row; invalid_value: parts of one
  ///         meter have different intervals.
  [[nodiscard]] Result<csv::ReadingsReport> finish(csv::ReadingsReport report);

 private:
  struct KeptReading {
    metering::Instant start;
    double mean_kW;
    bool is_estimate;
  };
  struct Part {
    std::size_t meter;
    csv::MeterInFile shown{};
    std::vector<KeptReading> readings{};  ///< Only of a meter with several parts.
  };

  [[nodiscard]] std::span<const Part> parts_of(std::size_t meter) const;
  [[nodiscard]] Result<void> require_one_grid(std::size_t meter) const;
  void hand_out(std::size_t meter, csv::MeterReport& report) const;
  [[nodiscard]] csv::MeterReport joined_report(std::size_t meter,
                                               std::span<csv::MeterReport> parts) const;

  std::vector<TableMeter> meters_;
  std::vector<TableMeter> parts_;
  std::vector<Part> kept_;          ///< As many as parts.
  std::vector<std::size_t> first_;  ///< First part of each meter, and the end of the last.
  const csv::ReadingsSink* outer_ = nullptr;
};

/// "Day", or 'Day' and 'Night': the rows or columns of a meter, for messages.
[[nodiscard]] std::string part_words(const TableMeter& part);

}  // namespace recald::table
