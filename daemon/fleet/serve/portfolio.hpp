/// A fleet as people look at it: which buildings are worst, what is known of why, what it costs.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "adapters/record/jobs.hpp"
#include "adapters/record/sites.hpp"
#include "core/metering/civil_time.hpp"
#include "core/result.hpp"

namespace recald::daemon {

/// What a site's newest results say of one thing that is wrong.
struct NamedEffect {
  std::string title;
  double probability = 0.0;
  std::optional<double> money_month;  ///< In the site's currency.
};

/// What reaches the record from a site's gateway.
enum class Feed : std::uint8_t {
  current,
  silent,  ///< Nothing for a day.
  late,    ///< It is heard, but its newest reading is over a day old: meters, a clock, or a long
           ///< queue.
  ahead,   ///< Its newest reading is from the future: its clock is wrong.
};
[[nodiscard]] std::string_view name_of(Feed feed);

/// One building.
struct PortfolioRow {
  record::RecordedSite site;
  Feed feed = Feed::current;
  std::optional<metering::Month> month;  ///< Of the newest calibration; absent: there is none.
  bool is_accepted = false;              ///< That calibration passed its checks.
  /// The output that the calibrated model explains least, by CV(RMSE) of the fitted months.
  std::string worst_meter;
  std::optional<double> worst_cvrmse;
  std::optional<double> gap_money_month;     ///< Metered beyond modelled, all outputs.
  std::optional<double> energy_kWh_m2_year;  ///< All outputs in kWh, as measured, by floor area.
  std::vector<std::string> alarms;           ///< Sentences: what has changed.
  std::vector<NamedEffect> named;            ///< The likeliest first.
  std::optional<record::FleetJob> troubled;  ///< The newest job that failed or was set aside.
  bool has_calibration_page = false;
  bool has_diagnosis_page = false;

  /// From 0, all is well, upwards: what to look at first.
  [[nodiscard]] int urgency() const;
};

/// Buildings of one use in one climate.
struct PortfolioGroup {
  std::string use, climate;  ///< Empty: not said.
  int sites = 0;
  int with_alarms = 0;
  int with_names = 0;
  /// Quartiles over the sites that have one; absent below three.
  struct Quartiles {
    double q25, q50, q75;
  };
  std::optional<Quartiles> energy_kWh_m2_year;
  std::optional<Quartiles> worst_cvrmse;
};

struct Portfolio {
  std::vector<PortfolioRow> rows;      ///< The most urgent first, then by what the gap costs.
  std::vector<PortfolioGroup> groups;  ///< By use, then climate.
};

/// Which sites somebody wants to see; empty: all.
struct PortfolioFilter {
  std::string use, climate;
  std::string state;  ///< "alarm", "named", "silent", "late", "ahead", "trouble"
};
[[nodiscard]] bool fits(const PortfolioRow& row, const PortfolioFilter& filter);

/// Puts together what the record has.
/// @param troubled  As record::troubled_jobs.
[[nodiscard]] Portfolio portfolio_of(std::vector<record::RecordedSite> sites,
                                     const std::vector<record::FleetResultRow>& calibrations,
                                     const std::vector<record::FleetResultRow>& diagnoses,
                                     const std::vector<record::FleetJob>& troubled,
                                     metering::Instant now);

/// The same, read. @param site  Empty: all. @return io_failed: the record is away.
[[nodiscard]] Result<Portfolio> read_portfolio(postgres::Connection& record, metering::Instant now,
                                               const std::string& site = {});

}  // namespace recald::daemon
