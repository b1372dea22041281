/// The page of savings: what measures would save, or what has been saved since a date.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "adapters/views/drift/drift_page.hpp"
#include "adapters/views/frame/report_data.hpp"

namespace recald::views {

/// A number with its 90 % interval, in the unit shown.
struct SavedAmount {
  std::string what;  ///< "Chilled water"; "Money"
  std::string unit;  ///< "kWh a year"
  double q05;
  double q50;
  double q95;
  std::optional<double> share;  ///< Of what is used without; the median.
  double probability;           ///< That it saves at all.
};

/// One measure, or one meter since a date.
struct SavingCard {
  std::string title;
  std::string sentence;
  std::string caption;  ///< Of its table.
  std::vector<SavedAmount> amounts;
  std::vector<std::string> notes;
};

struct SavingsData {
  std::string title;
  SiteLine site;
  std::string generated_at;
  std::string headline;
  std::vector<SavingCard> cards;
  std::vector<ForecastSeries> months;  ///< Meters since a date beside what was expected.
  std::vector<std::string> months_before;
  std::vector<std::string> months_after;
  std::vector<std::string> not_known;  ///< Sentences.
  std::vector<Notice> notices;
  Provenance provenance;
};

/// Renders the page under the rules of `render_report`.
[[nodiscard]] std::string render_savings(const SavingsData& data);

}  // namespace recald::views
