#include "daemon/fleet/serve/portfolio.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

namespace recald::daemon {
namespace {

using Json = nlohmann::ordered_json;

constexpr auto kSilentAfter = std::chrono::hours{24};
constexpr auto kLateAfter = std::chrono::hours{24};
constexpr auto kAheadBy = std::chrono::hours{1};  // of an interval that has begun
constexpr std::array<std::string_view, 4> kFeeds{"current", "silent", "late", "ahead"};
constexpr double kDaysPerYear = 365.25;
constexpr double kSureProbability = 0.8;
constexpr std::size_t kQuartilesFrom = 3;

Feed feed_of(const record::RecordedSite& site, metering::Instant now) {
  if (!site.heard || now - *site.heard > kSilentAfter) return Feed::silent;
  if (!site.newest) return Feed::current;
  if (*site.newest - now > kAheadBy) return Feed::ahead;
  return now - *site.newest > kLateAfter ? Feed::late : Feed::current;
}

std::optional<double> number_of(const Json& json, const char* key) {
  const auto found = json.find(key);
  if (found == json.end() || !found->is_number()) return {};
  return found->get<double>();
}

std::string text_of(const Json& json, const char* key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_string() ? found->get<std::string>() : "";
}

Json list_of(const Json& json, const char* key) {
  const auto found = json.is_object() ? json.find(key) : json.end();
  return found != json.end() && found->is_array() ? *found : Json::array();
}

bool has_file(const record::FleetResultRow& result, const char* name) {
  return std::ranges::find(result.files, name) != result.files.end();
}

void add(std::optional<double>& sum, std::optional<double> part) {
  if (part) sum = sum.value_or(0.0) + *part;
}

void add_calibration(const record::FleetResultRow& result, PortfolioRow& row) {
  row.month = result.month;
  row.is_accepted = result.accepted;
  row.has_calibration_page = has_file(result, "report.html");
  const Json summary = Json::parse(result.summary, nullptr, /*allow_exceptions=*/false);
  std::optional<double> kWh_day;
  for (const Json& output : list_of(summary, "outputs")) {
    add(row.gap_money_month, number_of(output, "gap_money_month"));
    if (text_of(output, "unit") == "kWh/day") add(kWh_day, number_of(output, "measured"));
    const auto cvrmse = number_of(output, "cvrmse");
    if (!cvrmse || (row.worst_cvrmse && *row.worst_cvrmse >= *cvrmse)) continue;
    row.worst_cvrmse = cvrmse;
    row.worst_meter = text_of(output, "meter");
  }
  const auto& area = row.site.site.floor_area_m2;
  if (kWh_day && area && *area > 0.0) row.energy_kWh_m2_year = *kWh_day * kDaysPerYear / *area;
  for (const char* key : {"alarms", "meter_changes"}) {
    for (const Json& alarm : list_of(summary, key)) {
      row.alarms.push_back(text_of(alarm, "sentence"));
    }
  }
}

void add_diagnosis(const record::FleetResultRow& result, PortfolioRow& row) {
  row.has_diagnosis_page = has_file(result, "diagnosis.html");
  const Json summary = Json::parse(result.summary, nullptr, /*allow_exceptions=*/false);
  for (const Json& named : list_of(summary, "named")) {
    row.named.push_back({.title = text_of(named, "title"),
                         .probability = number_of(named, "probability").value_or(0.0),
                         .money_month = number_of(named, "money_month")});
  }
  std::ranges::stable_sort(row.named, std::greater{}, &NamedEffect::probability);
}

std::optional<PortfolioGroup::Quartiles> quartiles_of(std::vector<double> values) {
  if (values.size() < kQuartilesFrom) return {};
  std::ranges::sort(values);
  const auto at = [&](double share) {
    const double place = share * static_cast<double>(values.size() - 1);
    const auto below = static_cast<std::size_t>(place);
    const std::size_t above = std::min(below + 1, values.size() - 1);
    return values[below] + (place - static_cast<double>(below)) * (values[above] - values[below]);
  };
  return PortfolioGroup::Quartiles{at(0.25), at(0.5), at(0.75)};
}

std::vector<PortfolioGroup> groups_of(const std::vector<PortfolioRow>& rows) {
  struct Members {
    PortfolioGroup group;
    std::vector<double> energies, gaps;
  };
  std::map<std::pair<std::string, std::string>, Members> all;
  for (const PortfolioRow& row : rows) {
    const record::SiteDescription& site = row.site.site;
    Members& one = all[{site.use, site.climate}];
    one.group.use = site.use;
    one.group.climate = site.climate;
    ++one.group.sites;
    if (!row.alarms.empty()) ++one.group.with_alarms;
    if (!row.named.empty()) ++one.group.with_names;
    if (row.energy_kWh_m2_year) one.energies.push_back(*row.energy_kWh_m2_year);
    if (row.worst_cvrmse) one.gaps.push_back(*row.worst_cvrmse);
  }
  std::vector<PortfolioGroup> groups;
  for (auto& [key, members] : all) {
    members.group.energy_kWh_m2_year = quartiles_of(std::move(members.energies));
    members.group.worst_cvrmse = quartiles_of(std::move(members.gaps));
    groups.push_back(std::move(members.group));
  }
  return groups;
}

}  // namespace

std::string_view name_of(Feed feed) { return kFeeds.at(static_cast<std::size_t>(feed)); }

int PortfolioRow::urgency() const {
  const bool has_no_readings = feed == Feed::silent || feed == Feed::ahead;
  const bool has_sure_name = !named.empty() && named.front().probability >= kSureProbability;
  return (has_no_readings ? 8 : 0) + (troubled || feed == Feed::late ? 4 : 0) +
         (has_sure_name ? 2 : 0) + (alarms.empty() ? 0 : 1);
}

bool fits(const PortfolioRow& row, const PortfolioFilter& filter) {
  const auto is_same = [](const std::string& wanted, const std::string& has) {
    return wanted.empty() || wanted == has;
  };
  if (!is_same(filter.use, row.site.site.use)) return false;
  if (!is_same(filter.climate, row.site.site.climate)) return false;
  if (filter.state == "alarm") return !row.alarms.empty();
  if (filter.state == "named") return !row.named.empty();
  if (const auto feed = std::ranges::find(kFeeds, filter.state); feed != kFeeds.end()) {
    return name_of(row.feed) == *feed;
  }
  if (filter.state == "trouble") return row.troubled.has_value();
  return true;
}

Portfolio portfolio_of(std::vector<record::RecordedSite> sites,
                       const std::vector<record::FleetResultRow>& calibrations,
                       const std::vector<record::FleetResultRow>& diagnoses,
                       const std::vector<record::FleetJob>& troubled, metering::Instant now) {
  Portfolio portfolio;
  std::map<std::string, std::size_t> by_id;
  for (record::RecordedSite& site : sites) {
    by_id[site.site.id] = portfolio.rows.size();
    const Feed feed = feed_of(site, now);
    portfolio.rows.push_back({.site = std::move(site), .feed = feed});
  }
  const auto row_of = [&](const std::string& id) -> PortfolioRow* {
    const auto found = by_id.find(id);
    return found == by_id.end() ? nullptr : &portfolio.rows[found->second];
  };
  for (const record::FleetResultRow& one : calibrations) {
    if (PortfolioRow* const row = row_of(one.site)) add_calibration(one, *row);
  }
  for (const record::FleetResultRow& one : diagnoses) {
    if (PortfolioRow* const row = row_of(one.site)) add_diagnosis(one, *row);
  }
  for (const record::FleetJob& job : troubled) {
    PortfolioRow* const row = row_of(job.site);
    if (row == nullptr) continue;
    if (!row->troubled || row->troubled->number < job.number) row->troubled = job;
  }
  std::ranges::stable_sort(portfolio.rows, [](const PortfolioRow& a, const PortfolioRow& b) {
    if (a.urgency() != b.urgency()) return a.urgency() > b.urgency();
    return a.gap_money_month.value_or(0.0) > b.gap_money_month.value_or(0.0);
  });
  portfolio.groups = groups_of(portfolio.rows);
  return portfolio;
}

Result<Portfolio> read_portfolio(postgres::Connection& record, metering::Instant now,
                                 const std::string& site) {
  auto sites = TRY(record::sites(record));
  if (!site.empty()) {
    std::erase_if(sites, [&](const record::RecordedSite& one) { return one.site.id != site; });
  }
  const auto calibrations = TRY(record::newest_results(record, JobKind::calibration, site));
  const auto diagnoses = TRY(record::newest_results(record, JobKind::diagnosis, site));
  const auto troubled = TRY(record::troubled_jobs(record));
  return portfolio_of(std::move(sites), calibrations, diagnoses, troubled, now);
}

}  // namespace recald::daemon
