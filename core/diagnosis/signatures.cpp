#include "core/diagnosis/signatures.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <span>

#include "core/absent.hpp"

namespace recald::diagnosis {
namespace {

using metering::Utility;
using model::DayType;
using model::DriverHour;

constexpr int kSeasons = 3;
constexpr double kCold_C = 8.0;
constexpr double kHot_C = 20.0;
constexpr int kPairs = 12;  // of hours
constexpr int kGroups = static_cast<int>(model::kDayTypes) * kSeasons * kPairs;
constexpr int kFewestHours = 12;

constexpr std::array<const char*, kSeasons> kSeasonNames{"cold", "mild", "hot"};
constexpr std::array<const char*, model::kDayTypes> kDayNames{"workday", "Saturday", "Sunday"};

/// Hours that are alike.
enum RegimeKind { kOccupied, kNight, kFreeDay, kRegimes };
constexpr std::array<const char*, kRegimes> kRegimeNames{"occupied", "night", "free day"};
constexpr int kFewestRows = 30;

// Outdoor temperature: a broken line whose bends stand here.
constexpr std::array<double, 5> kBends_C{2.0, 8.0, 14.0, 19.0, 25.0};
constexpr std::array<const char*, 10> kSlopeNames{"per humidity",
                                                  "per dryness in the cold",
                                                  "per wind in the cold",
                                                  "per wind in the heat",
                                                  "per sun in the cold",
                                                  "per sun in the heat",
                                                  "per warmth of the day before",
                                                  "per year",
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
  [[nodiscard]] double mean(int fewest = 1) const {
    return count >= fewest ? sum / count : kAbsent;
  }
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

constexpr int kFewestDays = 8;

double median_of(std::vector<double>& values) {
  if (values.size() < kFewestDays) return kAbsent;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// When the day's load begins or ends.
struct Edge {
  double at_h;
  double outdoor_C;  ///< In the morning.
  bool monday;
  bool summer_time;
  int third;  ///< Of the record.
};

template <class Wanted>
double median_where(const std::vector<Edge>& edges, Wanted wanted) {
  std::vector<double> chosen;
  for (const Edge& edge : edges) {
    if (wanted(edge)) chosen.push_back(edge.at_h);
  }
  return median_of(chosen);
}

/// Half way from the night's load to the one at noon; absent for a day that hardly has a noon.
/// @param kW  (24)
double half_load(const double* kW) {
  const double night = (kW[1] + kW[2] + kW[3]) / 3.0;
  const double noon = (kW[11] + kW[12] + kW[13]) / 3.0;
  constexpr double kLeastRise = 0.15;
  return noon - night > kLeastRise * std::abs(noon) ? 0.5 * (night + noon) : kAbsent;
}

/// Where the line through the middles of two hours passes the half load.
double crossing_h(const double* kW, int hour, double half) {
  return hour + 0.5 + (half - kW[hour]) / (kW[hour + 1] - kW[hour]);
}

double start_of_day(const double* kW) {
  const double half = half_load(kW);
  for (int hour = 3; hour < 13; ++hour) {
    if (kW[hour] < half && kW[hour + 1] >= half) return crossing_h(kW, hour, half);
  }
  return kAbsent;
}

double stop_of_day(const double* kW) {
  const double half = half_load(kW);
  for (int hour = 22; hour >= 12; --hour) {
    if (kW[hour] >= half && kW[hour + 1] < half) return crossing_h(kW, hour, half);
  }
  return kAbsent;
}

}  // namespace

/// Values one after the other, in the order of their names.
class SignatureReader::Sheet {
 public:
  explicit Sheet(std::span<double> values) : left_(values) {}
  void put(double value) {
    assert(!left_.empty());
    left_.front() = value;
    left_ = left_.subspan(1);
  }
  [[nodiscard]] bool is_full() const { return left_.empty(); }

 private:
  std::span<double> left_;
};

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
      names.push_back(of + std::to_string(static_cast<int>(kCoolest_C + kWarmth_K * bin)) + " C");
    }
    for (int block = 0; block < kBlocks; ++block) {
      names.push_back(of + "twelfth " + std::to_string(block + 1) + " of the record");
    }
    for (int month = 0; month < 12; ++month) {
      names.push_back(of + "month " + std::to_string(month + 1));
    }
    for (const char* day : {"Monday", "Tuesday", "Wednesday", "Thursday", "Friday"}) {
      names.push_back(of + day);
    }
    names.push_back(of + "holiday");
  }
  for (const char* edge : {"start", "stop"}) {
    const std::string of = std::string(edge) + " of the day, ";
    for (const char* what :
         {"usual", "spread", "per cold", "per heat", "Monday", "Saturdays that have one",
          "Sundays that have one", "after the clock change", "late in the record"}) {
      names.push_back(of + what);
    }
  }
  for (const char* what :
       {"workday mornings", "workday evenings", "free day mornings", "free day evenings"}) {
    names.push_back(std::string("dark against light, ") + what);
  }
  return names;
}

}  // namespace

const std::vector<std::string>& signature_names() {
  static const std::vector<std::string> names = make_names();
  return names;
}

SignatureReader::SignatureReader(const SiteProblem& site) : site_(&site) {
  const auto& hours = site.drivers->hours;
  std::vector<Means> warmth(static_cast<std::size_t>(hours.back().day_index) + 1);
  for (const DriverHour& hour : hours) {
    warmth[static_cast<std::size_t>(hour.day_index)].add(hour.dry_bulb_C);
  }
  for (const Means& day : warmth) day_C_.push_back(day.mean());
  for (std::size_t i = 0; i + 24 <= hours.size(); ++i) {
    // Days of 23 or 25 hours have no edges.
    if (hours[i].local_hour != 0 || hours[i + 23].day_index != hours[i].day_index ||
        hours[i + 23].local_hour != 23) {
      continue;
    }
    first_hour_.push_back(static_cast<int>(i));
    double sum_C = 0.0;
    for (std::size_t h = 5; h < 8; ++h) sum_C += hours[i + h].dry_bulb_C;
    morning_C_.push_back(sum_C / 3.0);
  }
  for (std::size_t g = site.meters.size(); g-- > 0;) {
    const int column = static_cast<int>(g);
    switch (site.meters[g].utility) {
      case Utility::electricity:
        meters_[0] = make_meter(column);
        break;
      case Utility::chilled_water:
        meters_[1] = make_meter(column);
        break;
      case Utility::heating:
      case Utility::steam:
      case Utility::gas:
        meters_[2] = make_meter(column);
        break;
      case Utility::water:
        break;
    }
  }
}

SignatureReader::Meter SignatureReader::make_meter(int column) const {
  const auto& hours = site_->drivers->hours;
  Meter meter{.column = column};
  Means all;
  for (std::size_t i = 0; i < hours.size(); ++i) {
    const double kW = site_->measured_kW(static_cast<Eigen::Index>(i), column);
    if (!std::isfinite(kW)) {
      meter.group.push_back(-1);
      continue;
    }
    all.add(kW);
    const double day_C = day_C_[static_cast<std::size_t>(hours[i].day_index)];
    meter.group.push_back((static_cast<int>(hours[i].day) * kSeasons + season_of(day_C)) * kPairs +
                          hours[i].local_hour / 2);
  }
  meter.mean_kW = std::max(all.mean(1), 1e-9);
  for (int kind = 0; kind < kRegimes; ++kind) meter.regimes.push_back(make_regime(meter, kind));
  return meter;
}

SignatureReader::Regime SignatureReader::make_regime(const Meter& meter, int kind) const {
  const auto& hours = site_->drivers->hours;
  Regime regime;
  regime.row_of_hour.assign(hours.size(), -1);
  std::vector<RegimeDay> rows;
  int last_day = -1;
  for (std::size_t i = 0; i < hours.size(); ++i) {
    if (meter.group[i] < 0 ||
        !is_in(static_cast<RegimeKind>(kind), hours[i], site_->nominal.set_points)) {
      continue;
    }
    if (hours[i].day_index != last_day) {
      rows.push_back({.first = &hours[i]});
      last_day = hours[i].day_index;
    }
    regime.row_of_hour[i] = static_cast<int>(rows.size()) - 1;
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
  regime.design.resize(n, kCoefficients);
  for (Eigen::Index r = 0; r < n; ++r) {
    const RegimeDay& row = rows[static_cast<std::size_t>(r)];
    const DriverHour& first = *row.first;
    regime.per_hour.push_back(1.0 / row.dry_bulb_C.count);
    const double before_C = day_C_[static_cast<std::size_t>(std::max(first.day_index - 1, 0))];
    regime.design.row(r) = regressors(row, before_C, days);
    regime.block.push_back(std::min(first.day_index * kBlocks / days, kBlocks - 1));
    const bool is_workday = first.day == DayType::workday;
    const bool is_weekday = first.weekday >= 1 && first.weekday <= 5;
    regime.weekday.push_back(is_workday ? static_cast<int>(first.weekday) - 1 : -1);
    regime.month.push_back(static_cast<int>(static_cast<unsigned>(first.date.month())) - 1);
    regime.free_day.push_back(is_weekday && !is_workday);
    const auto bin =
        static_cast<int>(std::floor((row.dry_bulb_C.mean() - kCoolest_C) / kWarmth_K + 0.5));
    regime.warmth.push_back(std::clamp(bin, 0, kWarmths - 1));
  }
  constexpr double kRidge = 1e-3;
  Eigen::MatrixXd normal = regime.design.transpose() * regime.design;
  for (Eigen::Index k = 1; k < kCoefficients; ++k) {
    const double mean = regime.design.col(k).mean();
    const double variance = regime.design.col(k).array().square().mean() - mean * mean;
    normal(k, k) += static_cast<double>(n) * (kRidge * variance + 1e-9);
  }
  regime.solve = normal.ldlt().solve(regime.design.transpose());
  return regime;
}

void SignatureReader::read_means(const Meter& meter, const double* kW, Sheet& sheet) const {
  std::array<Means, kGroups> groups;
  for (std::size_t i = 0; i < meter.group.size(); ++i) {
    if (meter.group[i] >= 0) groups[static_cast<std::size_t>(meter.group[i])].add(kW[i]);
  }
  for (const Means& group : groups) sheet.put(group.mean(kFewestHours) / meter.mean_kW);
}

void SignatureReader::read_regime(const Regime& regime, const double* kW, double mean_kW,
                                  Sheet& sheet) const {
  const Eigen::Index n = regime.design.rows();
  Eigen::VectorXd rows = Eigen::VectorXd::Zero(n);
  for (std::size_t i = 0; i < regime.row_of_hour.size(); ++i) {
    const int row = regime.row_of_hour[i];
    if (row >= 0) rows[row] += kW[i] * regime.per_hour[static_cast<std::size_t>(row)];
  }
  rows /= mean_kW;
  const bool is_there = n > 0;
  Eigen::VectorXd coefficients = Eigen::VectorXd::Constant(kCoefficients, kAbsent);
  Eigen::VectorXd residual = rows;
  if (is_there) {
    coefficients = regime.solve * rows;
    residual -= regime.design * coefficients;
  }
  for (Eigen::Index k = kFirstSlope; k < kCoefficients; ++k) sheet.put(coefficients[k]);
  std::array<Means, kWarmths> warmths;
  std::array<Means, kBlocks> blocks;
  std::array<Means, 12> months;
  std::array<Means, 5> weekdays;
  Means holidays;
  for (Eigen::Index r = 0; r < n; ++r) {
    const auto row = static_cast<std::size_t>(r);
    warmths[static_cast<std::size_t>(regime.warmth[row])].add(rows[r]);
    // What the weather does not explain, with trend and season: they are what is asked for.
    const double in_time = regime.design.row(r).tail(kOfTime).dot(coefficients.tail(kOfTime));
    blocks[static_cast<std::size_t>(regime.block[row])].add(residual[r] + in_time);
    months[static_cast<std::size_t>(regime.month[row])].add(residual[r]);
    const int weekday = regime.weekday[row];
    if (weekday >= 0) weekdays[static_cast<std::size_t>(weekday)].add(residual[r]);
    if (regime.free_day[row]) holidays.add(residual[r]);
  }
  for (const Means& bin : warmths) sheet.put(bin.mean(4));
  for (const Means& block : blocks) sheet.put(block.mean(4));
  for (const Means& month : months) sheet.put(month.mean(4));
  for (const Means& weekday : weekdays) sheet.put(weekday.mean(4));
  sheet.put(holidays.mean(4));
}

void SignatureReader::read_edges(const Meter& meter, const double* kW, Sheet& sheet) const {
  const auto& hours = site_->drivers->hours;
  for (const bool starts : {true, false}) {
    std::vector<Edge> edges;
    Means saturdays, sundays;
    for (std::size_t d = 0; d < first_hour_.size(); ++d) {
      const auto first = static_cast<std::size_t>(first_hour_[d]);
      const bool is_measured = std::all_of(meter.group.begin() + first_hour_[d],
                                           meter.group.begin() + first_hour_[d] + 24,
                                           [](int group) { return group >= 0; });
      if (!is_measured) continue;
      const double at = starts ? start_of_day(kW + first) : stop_of_day(kW + first);
      const DriverHour& hour = hours[first];
      const double has_one = std::isfinite(at) ? 1.0 : 0.0;
      if (hour.day == DayType::saturday) saturdays.add(has_one);
      if (hour.day == DayType::sunday_or_holiday) sundays.add(has_one);
      if (hour.day != DayType::workday || !std::isfinite(at)) continue;
      edges.push_back({.at_h = at,
                       .outdoor_C = morning_C_[d],
                       .monday = hour.weekday == 1,
                       .summer_time = hour.daylight_saving,
                       .third = static_cast<int>(3 * d / first_hour_.size())});
    }
    const double usual = median_where(edges, [](const Edge&) { return true; });
    std::vector<double> off_h;
    for (const Edge& edge : edges) off_h.push_back(std::abs(edge.at_h - usual));
    const auto between = [&](double from_C, double to_C) {
      return median_where(edges, [&](const Edge& edge) {
        return edge.outdoor_C >= from_C && edge.outdoor_C < to_C;
      });
    };
    const double mild = between(8.0, 17.0);
    sheet.put(usual);
    sheet.put(median_of(off_h));
    sheet.put(between(-90.0, 4.0) - mild);
    sheet.put(between(20.0, 90.0) - mild);
    sheet.put(median_where(edges, [](const Edge& edge) { return edge.monday; }) - usual);
    sheet.put(saturdays.mean(kFewestDays));
    sheet.put(sundays.mean(kFewestDays));
    sheet.put(median_where(edges, [](const Edge& edge) { return edge.summer_time; }) -
              median_where(edges, [](const Edge& edge) { return !edge.summer_time; }));
    sheet.put(median_where(edges, [](const Edge& edge) { return edge.third == 2; }) -
              median_where(edges, [](const Edge& edge) { return edge.third == 0; }));
  }
}

void SignatureReader::read_darkness(const Meter& meter, const double* kW, Sheet& sheet) const {
  const auto& hours = site_->drivers->hours;
  // Within each hour of the clock: what is more when it is dark.
  std::array<std::array<std::array<Means, 2>, 24>, 2> means;
  for (std::size_t i = 0; i < hours.size(); ++i) {
    if (meter.group[i] < 0) continue;
    const bool is_dark = hours[i].sine_of_sun_altitude < 0.0;
    const auto day = hours[i].day == DayType::workday ? 0U : 1U;
    means[day][static_cast<std::size_t>(hours[i].local_hour)][is_dark ? 1 : 0].add(kW[i]);
  }
  for (const auto& of_day : means) {
    for (const auto& [from, to] : {std::pair{5U, 9U}, std::pair{16U, 22U}}) {
      Means more;
      for (std::size_t h = from; h < to; ++h) {
        constexpr int kFewest = 15;
        if (of_day[h][0].count < kFewest || of_day[h][1].count < kFewest) continue;
        more.add(of_day[h][1].mean() - of_day[h][0].mean());
      }
      sheet.put(more.mean() / meter.mean_kW);
    }
  }
}

Eigen::MatrixXd SignatureReader::read(const Eigen::Ref<const Eigen::ArrayXXd>& hours_kW) const {
  const auto count = static_cast<Eigen::Index>(signature_names().size());
  Eigen::MatrixXd values = Eigen::MatrixXd::Constant(count, kSignatureMeters, kAbsent);
  for (std::size_t m = 0; m < kSignatureMeters; ++m) {
    const Meter& meter = meters_[m];
    if (meter.column < 0) continue;
    Sheet sheet({values.col(static_cast<Eigen::Index>(m)).data(), static_cast<std::size_t>(count)});
    const double* kW = hours_kW.col(meter.column).data();
    read_means(meter, kW, sheet);
    for (const Regime& regime : meter.regimes) read_regime(regime, kW, meter.mean_kW, sheet);
    read_edges(meter, kW, sheet);
    read_darkness(meter, kW, sheet);
    assert(sheet.is_full());
  }
  return values;
}

}  // namespace recald::diagnosis
