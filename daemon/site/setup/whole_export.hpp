/// An export that is read to its end, the way that its rows show.
#pragma once

#include <vector>

#include "daemon/site/setup/export_survey.hpp"

namespace recald::daemon {

/// What the readings of one meter show, as they pass.
struct MeterWatch {
  RegisterEvidence as_register;  ///< Of its rows.
  bool is_rate = false;
  std::uint64_t values = 0;
  double sum_kW = 0.0;
  double first = 0.0;
  std::uint64_t zeros = 0;
  std::uint64_t negatives = 0;
  std::uint64_t frozen = 0;
  int run = 0;
  double last = 0.0;

  void take(const metering::Reading& reading);
};

/// What reading the whole file showed.
struct WholeFile {
  csv::ReadingsReport report;
  table::ClockFacts clock;
  std::vector<MeterWatch> watches;
};

/// Reads it with the meters that it has; their samples are taken anew.
[[nodiscard]] Result<WholeFile> read_whole(SurveyedExport& survey,
                                           const metering::LocalCalendar& calendar);

/// Reads it the way that its rows show: rows told apart, flags, registers, steps, its clock.
[[nodiscard]] Result<WholeFile> read_as_it_shows(SurveyedExport& survey,
                                                 const metering::LocalCalendar& calendar,
                                                 const SurveyHints& hints);

}  // namespace recald::daemon
