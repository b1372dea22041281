#include "core/diagnosis/naming/signatures.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>

#include "core/absent.hpp"
#include "core/diagnosis/effects/support/public_holidays.hpp"

namespace recald::diagnosis {
namespace {

using metering::Utility;
using model::DayType;
using model::DriverHour;

/// Place of its signatures.
std::optional<std::size_t> kind_of(Utility utility) {
  switch (utility) {
    case Utility::electricity:
      return 0;
    case Utility::chilled_water:
      return 1;
    case Utility::heating:
    case Utility::steam:
    case Utility::gas:
      return 2;
    case Utility::water:
      break;
  }
  return std::nullopt;
}

constexpr int kSeasons = 3;
constexpr double kCold_C = 8.0;
constexpr double kHot_C = 20.0;
constexpr int kPairs = 12;  // of hours
constexpr int kGroups = static_cast<int>(model::kDayTypes) * kSeasons * kPairs;
constexpr int kFewestHours = 12;

constexpr std::array<const char*, kSeasons> kSeasonNames{"when cold", "when mild", "when hot"};
constexpr std::array<const char*, model::kDayTypes> kDayNames{"workdays", "Saturdays", "Sundays"};

/// Hours that are alike.
enum RegimeKind { kOccupied, kNight, kFreeDay, kRegimes };
constexpr std::array<const char*, kRegimes> kRegimeNames{"occupied hours", "nights", "free days"};
constexpr std::array<const char*, 12> kMonthNames{"January",   "February", "March",    "April",
                                                  "May",       "June",     "July",     "August",
                                                  "September", "October",  "November", "December"};
constexpr int kFewestRows = 30;

// Outdoor temperature: a broken line whose bends stand here.
constexpr std::array<double, 5> kBends_C{2.0, 8.0, 14.0, 19.0, 25.0};
constexpr std::array<const char*, 10> kSlopeNames{"with humidity",
                                                  "with dryness in the cold",
                                                  "with wind in the cold",
                                                  "with wind in the heat",
                                                  "with sun in the cold",
                                                  "with sun in the heat",
                                                  "with warmth of the day before",
                                                  "year by year",
                                                  "spring against autumn",
                                                  "summer against winter"};
constexpr int kCoefficients =
    2 + static_cast<int>(kBends_C.size()) + static_cast<int>(kSlopeNames.size());
constexpr int kOfTime = 3;  ///< The last ones.
constexpr int kFirstSlope = 2 + static_cast<int>(kBends_C.size());

constexpr int kBlocks = 12;
constexpr int kWarmths = 13;
constexpr double kCoolest_C = -8.0;
constexpr double kWarmth_K = 3.0;

int season_of(double day_C) { return day_C < kCold_C ? 0 : day_C > kHot_C ? 2 : 1; }

bool is_in(RegimeKind kind, const DriverHour& hour, const model::SetPoints& set) {
  switch (kind) {
    case kOccupied:
      return hour.day == DayType::workday && hour.local_hour >= set.occupied_from_hour + 2 &&
             hour.local_hour < set.occupied_to_hour - 2;
    case kNight:
      return hour.local_hour >= 1 && hour.local_hour < 5;
    case kFreeDay:
      return hour.day != DayType::workday && hour.local_hour >= 9 && hour.local_hour < 17;
    case kRegimes:
      break;
  }
  return false;
}

struct Means {
  double sum = 0.0;
  int count = 0;
  void add(double value) {
    sum += value;
    ++count;
  }
  [[nodiscard]] double mean() const { return count > 0 ? sum / count : kAbsent; }
};

/// The hours of a regime on one day.
struct RegimeDay {
  Means dry_bulb_C;
  Means humidity;  ///< g/kg
  Means wind;      ///< m/s
  Means sun;       ///< W/m2
  const DriverHour* first;
};

/// What a day's power is regressed on. @param before_C  Mean of the day before; NaN: not in the
/// record.
Eigen::RowVectorXd regressors(const RegimeDay& row, double before_C, int days) {
  const double t = row.dry_bulb_C.mean();
  const double w = row.humidity.mean();
  const double v = row.wind.mean();
  const double sun = row.sun.mean() / 300.0;
  const double warmer_K = std::isfinite(before_C) ? before_C - t : 0.0;
  const double angle = 2.0 * std::numbers::pi * row.first->day_of_year / 365.25;
  Eigen::RowVectorXd x(kCoefficients);
  Eigen::Index k = 0;
  x[k++] = 1.0;
  x[k++] = t / 10.0;
  for (const double bend_C : kBends_C) x[k++] = std::max(t - bend_C, 0.0) / 10.0;
  x[k++] = t > 10.0 ? std::max(w - 8.0, 0.0) / 5.0 : 0.0;
  x[k++] = t < 15.0 ? std::max(5.0 - w, 0.0) / 5.0 : 0.0;
  x[k++] = v * std::max(20.0 - t, 0.0) / 60.0;
  x[k++] = v * std::max(t - 20.0, 0.0) / 30.0;
  x[k++] = t < 14.0 ? sun : 0.0;
  x[k++] = t >= 14.0 ? sun : 0.0;
  x[k++] = warmer_K / 10.0;
  x[k++] = (row.first->day_index - 0.5 * days) / 365.25;
  x[k++] = std::sin(angle);
  x[k++] = -std::cos(angle);
  return x;
}

}  // namespace

std::string_view to_string(SignatureMeter meter) {
  switch (meter) {
    case SignatureMeter::electricity:
      return "electricity";
    case SignatureMeter::cooling:
      return "cooling";
    case SignatureMeter::heat:
      break;
  }
  return "heat";
}

namespace {

std::string two_digits(int hour) { return (hour < 10 ? "0" : "") + std::to_string(hour); }

std::vector<std::string> make_names() {
  std::vector<std::string> names;
  for (const char* day : kDayNames) {
    for (const char* season : kSeasonNames) {
      for (int pair = 0; pair < kPairs; ++pair) {
        names.push_back(std::string(day) + ", " + season + ", " + two_digits(2 * pair) + " to " +
                        two_digits(2 * pair + 2) + " h");
      }
    }
  }
  for (const char* regime : kRegimeNames) {
    const std::string of = std::string(regime) + ", ";
    for (const char* slope : kSlopeNames) names.push_back(of + slope);
    for (int bin = 0; bin < kWarmths; ++bin) {
      names.push_back(of + "about " +
                      std::to_string(static_cast<int>(kCoolest_C + kWarmth_K * bin)) +
                      " degC outdoors");
    }
    for (int block = 0; block < kBlocks; ++block) {
      names.push_back(of + "twelfth " + std::to_string(block + 1) + " of the record");
    }
    for (const char* month : kMonthNames) names.push_back(of + month);
    for (const char* day : {"Mondays", "Tuesdays", "Wednesdays", "Thursdays", "Fridays"}) {
      names.push_back(of + day);
    }
    names.push_back(of + "holidays");
    for (const char* calendar : kHolidayCalendars) {
      names.push_back(of + "workdays that are public holidays in " + calendar);
    }
  }
  for (const char* what : {"mornings of workdays", "evenings of workdays", "mornings of free days",
                           "evenings of free days"}) {
    names.push_back(std::string("dark against light, ") + what);
  }
  return names;
}

}  // namespace

const std::vector<std::string>& signature_names() {
  static const std::vector<std::string> names = make_names();
  return names;
}

namespace {

constexpr int kCalendars = static_cast<int>(kHolidayCalendars.size());
constexpr int kOfRegime =
    static_cast<int>(kSlopeNames.size()) + kWarmths + kBlocks + 12 + 5 + 1 + kCalendars;
constexpr int kDarkKinds = 4;
constexpr int kDarkFrom = kGroups + kRegimes * kOfRegime;  ///< Place of the first.

/// Rows of a regime by what they have in common.
struct RowGroups {
  std::vector<int> block;     ///< Twelfth of the record.
  std::vector<int> weekday;   ///< 0…4 Monday to Friday of a working day; else -1.
  std::vector<int> month;     ///< 0…11
  std::vector<int> free_day;  ///< 0: a holiday from Monday to Friday; else -1.
  /// By calendar. 0: a working day at the site that is a public holiday there; else -1.
  std::array<std::vector<int>, kCalendars> public_day;
  std::vector<int> warmth;  ///< Bin of outdoor temperature.
};

/// Weights of the signatures of a regime, put one below the other in the order of their names.
class Rows {
 public:
  explicit Rows(Eigen::Index columns) : weights_(kOfRegime, columns) {}

  void put(const Eigen::MatrixXd& block) {
    weights_.middleRows(next_, block.rows()) = block;
    next_ += block.rows();
  }
  [[nodiscard]] Eigen::MatrixXd complete() && {
    assert(next_ == weights_.rows());
    return std::move(weights_);
  }

 private:
  Eigen::MatrixXd weights_;
  Eigen::Index next_ = 0;
};

/// (groups x rows) that averages each group; NaN for those of fewer than four rows.
Eigen::MatrixXd averaging(const std::vector<int>& group_of, int groups) {
  constexpr int kFewest = 4;
  Eigen::MatrixXd average = Eigen::MatrixXd::Zero(groups, std::ssize(group_of));
  std::vector<int> count(static_cast<std::size_t>(groups));
  for (std::size_t r = 0; r < group_of.size(); ++r) {
    if (group_of[r] < 0) continue;
    ++count[static_cast<std::size_t>(group_of[r])];
    average(group_of[r], static_cast<Eigen::Index>(r)) = 1.0;
  }
  for (int g = 0; g < groups; ++g) {
    const int of = count[static_cast<std::size_t>(g)];
    average.row(g) *= of < kFewest ? kAbsent : 1.0 / of;
  }
  return average;
}

/// What the signatures of a regime are of its rows, in power. Slopes are told per standard
/// deviation of what they are of: one against next to nothing, such as sun at night, must not be
/// large. Blocks, months and days are asked for what the weather does not explain; blocks keep
/// trend and season too, which are what they are asked for.
Eigen::MatrixXd signatures_of_rows(const Eigen::MatrixXd& design, const Eigen::MatrixXd& solve,
                                   const RowGroups& rows) {
  Rows of_rows(design.rows());
  const auto unexplained = [&](const Eigen::MatrixXd& average, Eigen::Index coefficients) {
    return (average - (average * design.leftCols(coefficients)) * solve.topRows(coefficients))
        .eval();
  };
  const Eigen::MatrixXd of_slopes = design.rightCols(kCoefficients - kFirstSlope);
  const Eigen::RowVectorXd mean = of_slopes.colwise().mean();
  const Eigen::VectorXd deviation =
      (of_slopes.rowwise() - mean).array().square().colwise().mean().sqrt();
  of_rows.put(deviation.asDiagonal() * solve.bottomRows(kCoefficients - kFirstSlope));
  of_rows.put(averaging(rows.warmth, kWarmths));
  of_rows.put(unexplained(averaging(rows.block, kBlocks), kCoefficients - kOfTime));
  of_rows.put(unexplained(averaging(rows.month, 12), kCoefficients));
  of_rows.put(unexplained(averaging(rows.weekday, 5), kCoefficients));
  of_rows.put(unexplained(averaging(rows.free_day, 1), kCoefficients));
  for (const auto& days : rows.public_day) {
    of_rows.put(unexplained(averaging(days, 1), kCoefficients));
  }
  return std::move(of_rows).complete();
}

/// (signatures x rows) weights whose products with rows of power are the level at which each
/// signature of a regime is: of slopes, where there is something of what they are of.
Eigen::MatrixXd levels_of_rows(const Eigen::MatrixXd& design, const RowGroups& rows) {
  Rows of_rows(design.rows());
  const Eigen::ArrayXXd there =
      design.rightCols(kCoefficients - kFirstSlope).cwiseAbs().array() + 1e-9;
  of_rows.put((there.rowwise() / there.colwise().sum()).matrix().transpose());
  of_rows.put(averaging(rows.warmth, kWarmths));
  of_rows.put(averaging(rows.block, kBlocks));
  of_rows.put(averaging(rows.month, 12));
  of_rows.put(averaging(rows.weekday, 5));
  of_rows.put(averaging(rows.free_day, 1));
  for (const auto& days : rows.public_day) of_rows.put(averaging(days, 1));
  return std::move(of_rows).complete();
}

}  // namespace

SignatureReader::SignatureReader(const SiteProblem& site) : site_(&site) {
  const auto& hours = site.drivers->hours;
  std::vector<Means> warmth(static_cast<std::size_t>(hours.back().day_index) + 1);
  for (const DriverHour& hour : hours) {
    warmth[static_cast<std::size_t>(hour.day_index)].add(hour.dry_bulb_C);
  }
  hours_before_.assign(warmth.size() + 1, 0);
  for (const DriverHour& hour : hours) {
    ++hours_before_[static_cast<std::size_t>(hour.day_index) + 1];
  }
  for (std::size_t d = 1; d < hours_before_.size(); ++d) hours_before_[d] += hours_before_[d - 1];
  for (const Means& day : warmth) day_C_.push_back(day.mean());
  std::vector<double> means_kW;
  for (Eigen::Index g = 0; g < site.measured_kW.cols(); ++g) {
    Means meter;
    for (const double kW : site.measured_kW.col(g)) {
      if (std::isfinite(kW)) meter.add(kW);
    }
    means_kW.push_back(meter.count > 0 ? meter.mean() : 0.0);
  }
  const double all_kW = std::accumulate(means_kW.begin(), means_kW.end(), 0.0);
  // What a model gets wrong of a meter that counts next to nothing says nothing of the building.
  constexpr double kNextToNothing = 0.02;
  // Nor must a small meter look as if it changed by many times itself.
  constexpr double kLeastShare = 0.05;
  for (std::size_t g = site.meters.size(); g-- > 0;) {
    if (means_kW[g] < kNextToNothing * all_kW) continue;
    const auto kind = kind_of(site.meters[g].utility);
    if (!kind) continue;
    meters_[*kind] = make_meter(static_cast<int>(g), kLeastShare * all_kW);
    if (static_cast<Eigen::Index>(g) == profile_meter(site)) make_cells(meters_[*kind]);
  }
}

bool SignatureReader::reads(int meter) const {
  return std::ranges::any_of(meters_, [&](const Meter& own) { return own.column == meter; });
}

SignatureReader::Meter SignatureReader::make_meter(int column, double least_kW) const {
  const auto& hours = site_->drivers->hours;
  Meter meter{.column = column};
  Means all;
  std::array<Means, kGroups> groups{};
  for (std::size_t i = 0; i < hours.size(); ++i) {
    const double kW = site_->measured_kW(static_cast<Eigen::Index>(i), column);
    if (!std::isfinite(kW)) {
      meter.group.push_back(-1);
      continue;
    }
    all.add(kW);
    const double day_C = day_C_[static_cast<std::size_t>(hours[i].day_index)];
    const int group = (static_cast<int>(hours[i].day) * kSeasons + season_of(day_C)) * kPairs +
                      hours[i].local_hour / 2;
    meter.group.push_back(group);
    groups[static_cast<std::size_t>(group)].add(kW);
  }
  meter.mean_kW = std::max({all.count > 0 ? all.mean() : 0.0, least_kW, 1e-9});
  for (const Means& of : groups) {
    const double per_kWh = 1.0 / (of.count * unit_at(meter, of.mean()));
    meter.per_group_kWh.push_back(of.count < kFewestHours ? kAbsent : per_kWh);
  }
  for (int kind = 0; kind < kRegimes; ++kind) meter.regimes.push_back(make_regime(meter, kind));
  make_darkness(meter);
  return meter;
}

double SignatureReader::unit_at(const Meter& meter, double level_kW) {
  constexpr double kShareOfMean = 0.25;
  return kShareOfMean * meter.mean_kW + std::abs(level_kW);
}

SignatureReader::Regime SignatureReader::make_regime(const Meter& meter, int kind) const {
  const auto& hours = site_->drivers->hours;
  Regime regime;
  regime.row_of_hour.assign(hours.size(), -1);
  std::vector<RegimeDay> rows;
  std::vector<Means> measured_kW;
  int last_day = -1;
  for (std::size_t i = 0; i < hours.size(); ++i) {
    if (meter.group[i] < 0 ||
        !is_in(static_cast<RegimeKind>(kind), hours[i], site_->nominal.set_points)) {
      continue;
    }
    if (hours[i].day_index != last_day) {
      rows.push_back({.first = &hours[i]});
      measured_kW.emplace_back();
      last_day = hours[i].day_index;
    }
    regime.row_of_hour[i] = static_cast<int>(rows.size()) - 1;
    measured_kW.back().add(site_->measured_kW(static_cast<Eigen::Index>(i), meter.column));
    rows.back().dry_bulb_C.add(hours[i].dry_bulb_C);
    rows.back().humidity.add(1000.0 * hours[i].humidity_ratio);
    rows.back().wind.add(hours[i].wind_m_s);
    rows.back().sun.add(hours[i].global_horizontal_W_m2);
  }
  const auto n = static_cast<Eigen::Index>(rows.size());
  if (n < kFewestRows) {
    regime.row_of_hour.assign(hours.size(), -1);
    return regime;
  }
  const int days = hours.back().day_index + 1;
  Eigen::MatrixXd design(n, kCoefficients);
  RowGroups groups;
  for (Eigen::Index r = 0; r < n; ++r) {
    const RegimeDay& row = rows[static_cast<std::size_t>(r)];
    const DriverHour& first = *row.first;
    regime.per_hour.push_back(1.0 / row.dry_bulb_C.count);
    const double before_C = day_C_[static_cast<std::size_t>(std::max(first.day_index - 1, 0))];
    design.row(r) = regressors(row, before_C, days);
    groups.block.push_back(std::min(first.day_index * kBlocks / days, kBlocks - 1));
    const bool is_workday = first.day == DayType::workday;
    const bool is_weekday = first.weekday >= 1 && first.weekday <= 5;
    groups.weekday.push_back(is_workday ? static_cast<int>(first.weekday) - 1 : -1);
    groups.month.push_back(static_cast<int>(static_cast<unsigned>(first.date.month())) - 1);
    groups.free_day.push_back(is_weekday && !is_workday ? 0 : -1);
    for (std::size_t c = 0; c < groups.public_day.size(); ++c) {
      const bool is_public = is_workday && public_holidays(c).contains(first.date);
      groups.public_day[c].push_back(is_public ? 0 : -1);
    }
    const auto bin =
        static_cast<int>(std::floor((row.dry_bulb_C.mean() - kCoolest_C) / kWarmth_K + 0.5));
    groups.warmth.push_back(std::clamp(bin, 0, kWarmths - 1));
  }
  constexpr double kRidge = 1e-3;
  Eigen::MatrixXd normal = design.transpose() * design;
  for (Eigen::Index k = 1; k < kCoefficients; ++k) {
    const double mean = design.col(k).mean();
    const double variance = design.col(k).array().square().mean() - mean * mean;
    normal(k, k) += static_cast<double>(n) * (kRidge * variance + 1e-9);
  }
  const Eigen::MatrixXd solve = normal.ldlt().solve(design.transpose());
  Eigen::VectorXd rows_kW(n);
  for (Eigen::Index r = 0; r < n; ++r) rows_kW[r] = measured_kW[static_cast<std::size_t>(r)].mean();
  const Eigen::VectorXd unit_kW =
      (levels_of_rows(design, groups) * rows_kW).unaryExpr([&](double kW) {
        return unit_at(meter, kW);
      });
  regime.of_rows = unit_kW.cwiseInverse().asDiagonal() * signatures_of_rows(design, solve, groups);
  return regime;
}

/// Within each hour of the clock: what is more when it is dark.
void SignatureReader::make_darkness(Meter& meter) const {
  const auto& hours = site_->drivers->hours;
  constexpr int kFewest = 15;
  std::array<std::array<std::array<int, 2>, 24>, 2> count{};
  const auto at = [&](std::size_t i) -> std::array<int, 2>& {
    const auto day = hours[i].day == DayType::workday ? 0U : 1U;
    return count[day][static_cast<std::size_t>(hours[i].local_hour)];
  };
  const auto is_dark = [&](std::size_t i) { return hours[i].sine_of_sun_altitude < 0.0 ? 1U : 0U; };
  for (std::size_t i = 0; i < hours.size(); ++i) {
    if (meter.group[i] >= 0) ++at(i)[is_dark(i)];
  }
  // Kinds: mornings and evenings of workdays, then of free days.
  const auto kind_of = [](std::size_t day, int hour) {
    const int half = hour >= 5 && hour < 9 ? 0 : hour >= 16 && hour < 22 ? 1 : -1;
    return half < 0 ? -1 : 2 * static_cast<int>(day) + half;
  };
  std::array<int, kDarkKinds> compared{};
  for (std::size_t day = 0; day < 2; ++day) {
    for (int hour = 0; hour < 24; ++hour) {
      const auto& of = count[day][static_cast<std::size_t>(hour)];
      const int kind = kind_of(day, hour);
      if (kind >= 0 && of[0] >= kFewest && of[1] >= kFewest) {
        ++compared[static_cast<std::size_t>(kind)];
      }
    }
  }
  for (const int of : compared) meter.no_darkness.push_back(of > 0 ? 0.0 : kAbsent);
  meter.darkness.assign(hours.size(), 0.0);
  meter.dark_kind.assign(hours.size(), -1);
  for (std::size_t i = 0; i < hours.size(); ++i) {
    if (meter.group[i] < 0) continue;
    const auto& of = at(i);
    const int kind = kind_of(hours[i].day == DayType::workday ? 0U : 1U, hours[i].local_hour);
    if (kind < 0 || of[0] < kFewest || of[1] < kFewest) continue;
    const double sign = is_dark(i) == 1 ? 1.0 : -1.0;
    meter.dark_kind[i] = kind;
    meter.darkness[i] = sign / (of[is_dark(i)] * compared[static_cast<std::size_t>(kind)]);
  }
  std::array<double, kDarkKinds> level_kW{};  // half of it in the dark, half in the light
  for (std::size_t i = 0; i < hours.size(); ++i) {
    if (meter.dark_kind[i] < 0) continue;
    level_kW[static_cast<std::size_t>(meter.dark_kind[i])] +=
        0.5 * std::abs(meter.darkness[i]) *
        site_->measured_kW(static_cast<Eigen::Index>(i), meter.column);
  }
  for (std::size_t i = 0; i < hours.size(); ++i) {
    if (meter.dark_kind[i] < 0) continue;
    meter.darkness[i] /= unit_at(meter, level_kW[static_cast<std::size_t>(meter.dark_kind[i])]);
  }
}

void SignatureReader::make_cells(Meter& meter) const {
  constexpr int kCells = static_cast<int>(model::kDayTypes) * 24;
  const auto& hours = site_->drivers->hours;
  std::vector<int> cell(hours.size(), -1);
  std::vector<int> count(kCells);
  for (std::size_t i = 0; i < hours.size(); ++i) {
    if (meter.group[i] < 0) continue;
    cell[i] = static_cast<int>(hours[i].day) * 24 + hours[i].local_hour;
    ++count[static_cast<std::size_t>(cell[i])];
  }
  Eigen::MatrixXd of_cells = Eigen::MatrixXd::Zero(std::ssize(signature_names()), kCells);
  std::vector<double> kW(hours.size());
  for (int c = 0; c < kCells; ++c) {
    const int of = count[static_cast<std::size_t>(c)];
    if (of == 0) continue;
    for (std::size_t i = 0; i < hours.size(); ++i) kW[i] = cell[i] == c ? 1.0 / of : 0.0;
    add_power(meter, kW.data(), 0, hours.size(), of_cells.col(c).data());
  }
  meter.cell = std::move(cell);
  meter.of_cells = std::move(of_cells);
}

void SignatureReader::add(const Meter& meter, const double* kW, std::size_t from, std::size_t to,
                          double* values) const {
  add_power(meter, kW, from, to, values);
  if (meter.cell.empty()) return;
  Eigen::VectorXd sums_kWh = Eigen::VectorXd::Zero(meter.of_cells.cols());
  for (std::size_t i = from; i < to; ++i) {
    if (meter.cell[i] >= 0) sums_kWh[meter.cell[i]] += kW[i];
  }
  Eigen::Map<Eigen::VectorXd>(values, meter.of_cells.rows()) -= meter.of_cells * sums_kWh;
}

void SignatureReader::add_power(const Meter& meter, const double* kW, std::size_t from,
                                std::size_t to, double* values) const {
  std::array<double, kGroups> sums{};
  for (std::size_t i = from; i < to; ++i) {
    if (meter.group[i] >= 0) sums[static_cast<std::size_t>(meter.group[i])] += kW[i];
  }
  for (std::size_t g = 0; g < kGroups; ++g) values[g] += sums[g] * meter.per_group_kWh[g];
  for (std::size_t kind = 0; kind < kRegimes; ++kind) {
    const Regime& regime = meter.regimes[kind];
    Eigen::Map<Eigen::VectorXd> into(values + kGroups + kind * kOfRegime, kOfRegime);
    if (regime.per_hour.empty()) {
      into.setConstant(kAbsent);
      continue;
    }
    // Rows are in order of days: those of a few days are together.
    Eigen::Index first = regime.of_rows.cols();
    Eigen::Index last = -1;
    Eigen::VectorXd rows = Eigen::VectorXd::Zero(first);
    for (std::size_t i = from; i < to; ++i) {
      const int row = regime.row_of_hour[i];
      if (row < 0) continue;
      rows[row] += kW[i] * regime.per_hour[static_cast<std::size_t>(row)];
      first = std::min<Eigen::Index>(first, row);
      last = row;
    }
    if (last < 0) {
      into += 0.0 * regime.of_rows.col(0);  // NaN where there is no such signature
      continue;
    }
    const Eigen::Index count = last - first + 1;
    into += regime.of_rows.middleCols(first, count) * rows.segment(first, count);
  }
  double* const dark = values + kDarkFrom;
  for (std::size_t k = 0; k < kDarkKinds; ++k) dark[k] += meter.no_darkness[k];
  for (std::size_t i = from; i < to; ++i) {
    if (meter.dark_kind[i] >= 0) dark[meter.dark_kind[i]] += meter.darkness[i] * kW[i];
  }
}

Eigen::MatrixXd SignatureReader::read(const Eigen::Ref<const Eigen::ArrayXXd>& hours_kW) const {
  const auto count = static_cast<Eigen::Index>(signature_names().size());
  Eigen::MatrixXd values = Eigen::MatrixXd::Constant(count, kSignatureMeters, kAbsent);
  for (std::size_t m = 0; m < kSignatureMeters; ++m) {
    const Meter& meter = meters_[m];
    if (meter.column < 0) continue;
    double* const into = values.col(static_cast<Eigen::Index>(m)).data();
    const double* const kW = hours_kW.col(meter.column).data();
    std::fill_n(into, count, 0.0);
    add(meter, kW, 0, meter.group.size(), into);
  }
  return values;
}

SpanReader::SpanReader(const SignatureReader& reader, const Eigen::ArrayXXd& base_kW)
    : reader_(&reader), base_kW_(&base_kW) {}

void SpanReader::take(const Eigen::Ref<const Eigen::ArrayXXd>& other_kW) {
  more_kW_ = other_kW - *base_kW_;
}

Eigen::MatrixXd SpanReader::change(int from_day, int to_day) const {
  const auto count = static_cast<Eigen::Index>(signature_names().size());
  const auto last = static_cast<int>(reader_->hours_before_.size()) - 1;
  const auto hour_of = [&](int day) {
    return static_cast<std::size_t>(
        reader_->hours_before_[static_cast<std::size_t>(std::clamp(day, 0, last))]);
  };
  const std::size_t from = hour_of(from_day);
  const std::size_t to = std::max(hour_of(to_day), from);
  Eigen::MatrixXd values = Eigen::MatrixXd::Constant(count, kSignatureMeters, kAbsent);
  for (std::size_t m = 0; m < kSignatureMeters; ++m) {
    const auto& meter = reader_->meters_[m];
    if (meter.column < 0) continue;
    auto into = values.col(static_cast<Eigen::Index>(m));
    into.setZero();
    reader_->add(meter, more_kW_.col(meter.column).data(), from, to, into.data());
  }
  return values;
}

}  // namespace recald::diagnosis
