/// What an export's owner says of it, and what has to be asked where he does not.
#pragma once

#include <chrono>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "adapters/csv/readings_csv.hpp"
#include "adapters/table/sniff.hpp"
#include "daemon/site/replay/register_evidence.hpp"

namespace recald::daemon {

/// Nothing of this is guessed.
struct SurveyHints {
  table::TableHints table;
  /// "kWh" for the meters whose unit nothing says, or "NAME=kWh" for one.
  std::vector<std::string> units;
  std::optional<csv::Stamps> stamps;
  std::optional<std::chrono::seconds> interval;
  /// What other files of its kind show of registers, by row and column, and of a clock column.
  std::map<std::pair<std::string, std::string>, RegisterVerdict> registers;
  std::optional<table::ClockFormat> clock_format;
  std::string clock;  ///< IANA zone of the stamps; empty: the building's, or as they show.
  std::string clock_because = "as told";
};

/// What no evidence settles.
struct OpenQuestion {
  std::string words;                 ///< A sentence: what, where, and how it looks.
  std::string option;                ///< That answers it: "--unit".
  std::string subject;               ///< Before "=" in its value; empty: none.
  std::vector<std::string> answers;  ///< Likely ones.
};

}  // namespace recald::daemon
