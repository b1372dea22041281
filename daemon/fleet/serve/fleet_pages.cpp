#include "daemon/fleet/serve/fleet_pages.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "adapters/record/schema.hpp"
#include "adapters/views/frame/format.hpp"
#include "adapters/views/frame/html.hpp"
#include "daemon/fleet/serve/job_json.hpp"
#include "daemon/fleet/serve/portfolio.hpp"
#include "daemon/gateway/serve/api/parameters.hpp"
#include "daemon/gateway/serve/api/prometheus_text.hpp"
#include "daemon/gateway/serve/api/result_response.hpp"
#include "daemon/gateway/serve/pages/page_frame.hpp"
#include "daemon/gateway/serve/pages/page_script.hpp"
#include "daemon/gateway/serve/pages/page_style.hpp"

namespace recald::daemon {
namespace {

using http::Method;
using http::Request;
using http::Response;
using views::Cell;
using views::Html;
using views::Table;
using Json = nlohmann::ordered_json;

constexpr std::size_t kRowsShown = 500;
constexpr int kFleetJobsShown = 100;
constexpr int kAuditShown = 200;
constexpr std::array<std::string_view, 6> kStates{"alarm", "named", "silent",
                                                  "late",  "ahead", "trouble"};

constexpr std::array kFleetPages{PageLink{"/", "Sites"}, PageLink{"/rerun", "Run again"},
                                 PageLink{"/audit", "Audit"}};
constexpr std::array kFleetPrograms{PageLink{"/api/v1/portfolio", "portfolio"},
                                    PageLink{"/api/v1/jobs", "jobs"},
                                    PageLink{"/metrics", "metrics"}};

Response page(const FleetServed& served, const std::string& title, const Html& main) {
  return framed_page({.title = title,
                      .heading = "Fleet",
                      .pages = kFleetPages,
                      .as_of = metering::to_string(served.now()) + "; times are in UTC",
                      .for_programs = kFleetPrograms},
                     main);
}

/// The record is away: a retry may work.
Response unavailable(const Error& error) { return refusal(error).value(); }

std::string money_text(const std::optional<double>& money, const std::string& currency) {
  return money ? fmt::format("{} {}", views::number_text(std::round(*money)), currency) : "–";
}

/// "Town hall (north)"
std::string site_words(const record::SiteDescription& site) {
  return site.name.empty() ? site.id : fmt::format("{} ({})", site.name, site.id);
}

std::string site_address(const std::string& id) { return "/sites/" + id; }

std::string result_address(const std::string& site, JobKind kind, metering::Month month,
                           std::string_view file) {
  return fmt::format("/results/{}/{}/{}/{}", site, metering::to_string(month), name_of(kind), file);
}

Checked<PortfolioFilter> filter_of(const Request& request) {
  TRY(has_only(request, {"use", "climate", "state", "month"}));
  PortfolioFilter filter{.use = text_of(request, "use").value_or(""),
                         .climate = text_of(request, "climate").value_or(""),
                         .state = text_of(request, "state").value_or("")};
  if (!filter.state.empty() && std::ranges::find(kStates, filter.state) == kStates.end()) {
    return refusal(
        400, "invalid",
        fmt::format("'state' is '{}'; write one of {}", filter.state, fmt::join(kStates, ", ")),
        "state");
  }
  return filter;
}

// --- the first page

void write_select(Html& html, const char* name, const std::string& label,
                  const std::vector<std::string>& values, const std::string& chosen) {
  html.markup("<label>").text(label).markup(fmt::format(" <select name=\"{}\">", name));
  html.markup("<option value=\"\">all</option>");
  for (const std::string& value : values) {
    if (value.empty()) continue;
    html.markup(fmt::format("<option value=\"{}\"{}>", views::escape(value),
                            value == chosen ? " selected" : ""))
        .text(value)
        .markup("</option>");
  }
  html.markup("</select></label> ");
}

void write_filter(Html& html, const Portfolio& all, const PortfolioFilter& filter,
                  const char* action) {
  std::vector<std::string> uses;
  std::vector<std::string> climates;
  for (const PortfolioGroup& group : all.groups) {
    uses.push_back(group.use);
    climates.push_back(group.climate);
  }
  for (auto* const list : {&uses, &climates}) {
    std::ranges::sort(*list);
    list->erase(std::ranges::unique(*list).begin(), list->end());
  }
  html.markup(fmt::format("<form class=\"filter\" action=\"{}\" method=\"get\">", action));
  write_select(html, "use", "Use", uses, filter.use);
  write_select(html, "climate", "Climate", climates, filter.climate);
  write_select(html, "state", "State", {kStates.begin(), kStates.end()}, filter.state);
  html.markup("<button>Show</button></form>");
}

std::string named_text(const PortfolioRow& row) {
  if (row.named.empty()) return "–";
  const NamedEffect& first = row.named.front();
  return fmt::format("{} ({}{})", first.title, views::probability_text(first.probability),
                     row.named.size() > 1 ? fmt::format("; {} more", row.named.size() - 1) : "");
}

Cell state_cell(const PortfolioRow& row) {
  if (row.feed == Feed::silent) return {"✖ silent", "bad"};
  if (row.feed == Feed::ahead) return {"✖ its clock is ahead", "bad"};
  if (row.troubled) {
    const bool is_aside = row.troubled->state == record::FleetJobState::set_aside;
    return {is_aside ? "✖ job set aside" : "▲ job failed", is_aside ? "bad" : "warn"};
  }
  if (row.feed == Feed::late) return {"▲ no readings for a day", "warn"};
  if (!row.month) return {"waits for its first month", "muted"};
  if (!row.is_accepted) return {"▲ not converged", "warn"};
  return {fmt::format("✔ {}", views::month_text(*row.month)), "good"};
}

void write_sites(Html& html, const std::vector<const PortfolioRow*>& rows) {
  Table table{"Sites, the most urgent first"};
  table.with_labels().columns({"Site", "Use", "Calibration", "Explained least", "Gap a month",
                               "What has changed", "Likely cause"});
  for (const PortfolioRow* row : rows) {
    const record::SiteDescription& site = row->site.site;
    const std::string gap = row->worst_cvrmse ? fmt::format("{}, {}", row->worst_meter,
                                                            views::percent_text(*row->worst_cvrmse))
                                              : "–";
    table.row({{.text = site_words(site), .address = site_address(site.id)},
               {site.use.empty() ? "–" : site.use},
               state_cell(*row),
               {gap},
               {money_text(row->gap_money_month, site.currency), "number"},
               {row->alarms.empty() ? "–" : row->alarms.front()},
               {named_text(*row)}});
  }
  table.write(html);
}

std::string quartiles_text(const std::optional<PortfolioGroup::Quartiles>& quartiles,
                           double factor) {
  if (!quartiles) return "–";
  return fmt::format("{} ({} to {})", views::number_text(factor * quartiles->q50),
                     views::number_text(factor * quartiles->q25),
                     views::number_text(factor * quartiles->q75));
}

void write_groups(Html& html, const std::vector<PortfolioGroup>& groups) {
  if (groups.empty()) return;
  Table table{"By use and climate: the median, and half of the sites"};
  table.with_labels().columns({"Use", "Climate", "Sites", "Energy, kWh/m² a year",
                               "Explained least, CV(RMSE) %", "With changes", "With a cause"});
  for (const PortfolioGroup& group : groups) {
    table.row({{group.use.empty() ? "not said" : group.use},
               {group.climate.empty() ? "not said" : group.climate},
               {views::count_text(group.sites), "number"},
               {quartiles_text(group.energy_kWh_m2_year, 1.0), "number"},
               {quartiles_text(group.worst_cvrmse, 100.0), "number"},
               {views::count_text(group.with_alarms), "number"},
               {views::count_text(group.with_names), "number"}});
  }
  table.write(html);
}

/// Places in degrees, north up; a mark for each site, larger where there is something to see.
void write_map(Html& html, const std::vector<const PortfolioRow*>& rows) {
  double west = 180.0, east = -180.0, south = 90.0, north = -90.0;
  int count = 0;
  for (const PortfolioRow* row : rows) {
    const record::SiteDescription& site = row->site.site;
    if (!site.latitude_deg || !site.longitude_deg) continue;
    ++count;
    west = std::min(west, *site.longitude_deg);
    east = std::max(east, *site.longitude_deg);
    south = std::min(south, *site.latitude_deg);
    north = std::max(north, *site.latitude_deg);
  }
  if (count < 2) return;
  constexpr double kWidth = 640.0;
  constexpr double kMargin = 16.0;
  const double squeeze = std::cos(0.5 * (south + north) * M_PI / 180.0);
  const double span = std::max({(east - west) * squeeze, north - south, 0.01});
  const double scale = (kWidth - 2.0 * kMargin) / span;
  const double height = 2.0 * kMargin + (north - south) * scale;
  html.markup(
      fmt::format("<figure><svg class=\"chart\" viewBox=\"0 0 {:.0f} {:.0f}\" role=\"group\" "
                  "aria-label=\"Where the sites are\">",
                  kWidth, height));
  for (const PortfolioRow* row : rows) {
    const record::SiteDescription& site = row->site.site;
    if (!site.latitude_deg || !site.longitude_deg) continue;
    const Cell state = state_cell(*row);
    const std::string words = site.id + ": " + state.text;
    html.markup(
        fmt::format("<a href=\"{}\" aria-label=\"{}\"><circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\" "
                    "class=\"{}\" "
                    "fill=\"currentColor\"><title>{}</title></circle></a>",
                    views::escape(site_address(site.id)), views::escape(words),
                    kMargin + (*site.longitude_deg - west) * squeeze * scale,
                    kMargin + (north - *site.latitude_deg) * scale, row->urgency() > 0 ? 7 : 4,
                    state.css_class, views::escape(words)));
  }
  html.markup("</svg></figure>");
}

/// "1,000 sites: 3 silent, 1 late, 0 with a wrong clock, 2 with a job that failed, 12 with changes,
/// 4 with a likely cause."
std::string summary_text(const std::vector<const PortfolioRow*>& rows) {
  int silent = 0, late = 0, ahead = 0, troubled = 0, changed = 0, named = 0;
  for (const PortfolioRow* row : rows) {
    silent += row->feed == Feed::silent ? 1 : 0;
    late += row->feed == Feed::late ? 1 : 0;
    ahead += row->feed == Feed::ahead ? 1 : 0;
    troubled += row->troubled ? 1 : 0;
    changed += row->alarms.empty() ? 0 : 1;
    named += row->named.empty() ? 0 : 1;
  }
  return fmt::format(
      "{} sites: {} silent, {} late, {} with a wrong clock, {} with a job that failed, {} with "
      "changes, {} with a likely cause.",
      views::count_text(static_cast<double>(rows.size())), silent, late, ahead, troubled, changed,
      named);
}

/// "Metered beyond what the models explain: 12,300 EUR a month; the likely causes: 4,100 EUR." By
/// currency, for what cannot be added.
void write_money(Html& html, const std::vector<const PortfolioRow*>& rows) {
  struct Sums {
    double gap = 0.0, named = 0.0;
  };
  std::map<std::string, Sums> by_currency;
  for (const PortfolioRow* row : rows) {
    Sums sums{.gap = row->gap_money_month.value_or(0.0)};
    bool is_known = row->gap_money_month.has_value();
    for (const NamedEffect& one : row->named) {
      sums.named += one.money_month.value_or(0.0);
      is_known = is_known || one.money_month;
    }
    if (!is_known) continue;
    Sums& all = by_currency[row->site.site.currency];
    all.gap += sums.gap;
    all.named += sums.named;
  }
  for (const auto& [currency, sums] : by_currency) {
    html.element("p",
                 fmt::format("Metered beyond what the models explain: {} a month; the likely "
                             "causes: {} a month.",
                             money_text(sums.gap, currency), money_text(sums.named, currency)));
  }
}

Response sites_page(const FleetServed& served, const Request& request) {
  const auto filter = filter_of(request);
  if (!filter) return filter.error();
  const auto portfolio = read_portfolio(served.record, served.now());
  if (!portfolio) return unavailable(portfolio.error());
  std::vector<const PortfolioRow*> rows;
  for (const PortfolioRow& row : portfolio->rows) {
    if (fits(row, *filter)) rows.push_back(&row);
  }
  Html html;
  html.element("h1", "Sites");
  write_filter(html, *portfolio, *filter, "/");
  html.element("p", summary_text(rows));
  write_money(html, rows);
  const std::size_t found = rows.size();
  write_map(html, rows);
  if (rows.size() > kRowsShown) {
    rows.resize(kRowsShown);
    html.element("p",
                 fmt::format("The first {} of {} are shown; choose a use, a climate or a "
                             "state to see others.",
                             kRowsShown, found),
                 "muted");
  }
  write_sites(html, rows);
  write_groups(html, portfolio->groups);
  html.element("p",
               "The gap is what was metered beyond what the calibrated model explains, at the "
               "site's tariff outside its periods. It is no saving by itself.",
               "muted");
  return page(served, "Sites", html);
}

// --- one site

void write_results(Html& html, const std::vector<record::FleetResultRow>& results) {
  Table table{"Newest results"};
  table.with_labels().columns({"Result", "Month", "By", "What it says", "Pages"});
  for (const record::FleetResultRow& one : results) {
    for (const std::string& file : one.files) {
      if (!file.ends_with(".html")) continue;
      table.row({{std::string{name_of(one.kind)}},
                 {metering::to_string(one.month)},
                 {one.from},
                 {one.message.empty() ? "–" : one.message},
                 {.text = file, .address = result_address(one.site, one.kind, one.month, file)}});
    }
  }
  table.write(html);
}

Cell job_state_cell(const record::FleetJob& job) {
  switch (job.state) {
    case record::FleetJobState::done:
      return {"✔ done", "good"};
    case record::FleetJobState::failed:
      return {"▲ failed", "warn"};
    case record::FleetJobState::set_aside:
      return {"✖ set aside", "bad"};
    case record::FleetJobState::waiting:
    case record::FleetJobState::running:
      break;
  }
  return {std::string{name_of(job.state)}};
}

void write_jobs(Html& html, const std::string& caption, const std::vector<record::FleetJob>& jobs) {
  Table table{caption};
  table.with_labels().columns({"Job", "Site", "Month", "State", "Tries", "Why"});
  for (const record::FleetJob& job : jobs) {
    table.row({{fmt::format("{} {}", name_of(job.kind), job.number)},
               {.text = job.site, .address = site_address(job.site)},
               {metering::to_string(job.month)},
               job_state_cell(job),
               {views::count_text(job.tries), "number"},
               {job.reason.empty() ? "–" : job.reason}});
  }
  table.write(html);
}

Response site_page(const FleetServed& served, const std::string& id) {
  const auto portfolio = read_portfolio(served.record, served.now(), id);
  if (!portfolio) return unavailable(portfolio.error());
  if (id.empty() || portfolio->rows.empty()) {
    return http::error_response(404, "not_found", fmt::format("there is no site '{}'", id));
  }
  const PortfolioRow& row = portfolio->rows.front();
  std::vector<record::FleetResultRow> results;
  for (const JobKind kind : {JobKind::calibration, JobKind::diagnosis}) {
    auto newest = record::newest_results(served.record, kind, id);
    if (!newest) return unavailable(newest.error());
    std::ranges::move(*newest, std::back_inserter(results));
  }
  const auto jobs = record::jobs(served.record, id, kFleetJobsShown);
  if (!jobs) return unavailable(jobs.error());
  Html html;
  html.element("h1", site_words(row.site.site));
  const Cell state = state_cell(row);
  html.element("p", state.text, state.css_class);
  html.element("p", fmt::format("Last heard {}; newest interval {}; version {} of its site file.",
                                row.site.heard ? metering::to_string(*row.site.heard) : "never",
                                row.site.newest ? metering::to_string(*row.site.newest) : "none",
                                row.site.version.number));
  for (const std::string& alarm : row.alarms) html.element("p", "▲ " + alarm, "warn");
  for (const NamedEffect& named : row.named) {
    html.element("p", fmt::format("Likely cause: {} ({}), {} a month", named.title,
                                  views::probability_text(named.probability),
                                  money_text(named.money_month, row.site.site.currency)));
  }
  write_results(html, results);
  write_jobs(html, "Jobs, newest first", *jobs);
  return page(served, id, html);
}

/// @param rest  "ID/MONTH/KIND/FILE"
Response result_file(const FleetServed& served, const std::string& rest) {
  const auto not_found = [] {
    return http::error_response(404, "not_found", "there is no such result");
  };
  std::array<std::string, 4> parts;
  std::size_t begin = 0;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const std::size_t end = i + 1 < parts.size() ? rest.find('/', begin) : rest.size();
    if (end == std::string::npos) return not_found();
    parts[i] = rest.substr(begin, end - begin);
    begin = end + 1;
  }
  const auto& [site, month_word, kind_word, name] = parts;
  const auto month = metering::parse_month(month_word);
  const bool is_diagnosis = kind_word == name_of(JobKind::diagnosis);
  const bool is_known = is_diagnosis || kind_word == name_of(JobKind::calibration);
  if (!month || !is_known || !is_result_name(name)) return not_found();
  auto bytes = record::result_file(
      served.record, site, is_diagnosis ? JobKind::diagnosis : JobKind::calibration, *month, name);
  if (!bytes) {
    return bytes.error().code == ErrorCode::not_found ? not_found() : unavailable(bytes.error());
  }
  return result_response(name, std::move(*bytes));
}

// --- again

Result<std::vector<record::FleetJob>> jobs_that_fit(const FleetServed& served,
                                                    const PortfolioFilter& filter,
                                                    std::optional<metering::Month> month) {
  const auto portfolio = TRY(read_portfolio(served.record, served.now()));
  record::RerunWhat what{.month = month};
  for (const PortfolioRow& row : portfolio.rows) {
    if (fits(row, filter)) what.sites.push_back(row.site.site.id);
  }
  if (what.sites.empty()) return std::vector<record::FleetJob>{};  // none would mean all
  return record::would_rerun(served.record, what);
}

Response rerun_page(const FleetServed& served, const Request& request) {
  const auto filter = filter_of(request);
  if (!filter) return filter.error();
  const auto month = month_of(request, "month");
  if (!month) return month.error();
  const auto portfolio = read_portfolio(served.record, served.now());
  if (!portfolio) return unavailable(portfolio.error());
  Html html;
  html.element("h1", "Run again");
  write_filter(html, *portfolio, *filter, "/rerun");
  const auto jobs = jobs_that_fit(served, *filter, *month);
  if (!jobs) return unavailable(jobs.error());
  if (jobs->empty()) {
    html.element("p", "No job of these sites can run again.", "muted");
    return page(served, "Run again", html);
  }
  Json body = {{"use", filter->use},
               {"climate", filter->climate},
               {"state", filter->state},
               {"month", *month ? Json(metering::to_string(**month)) : Json("")},
               {"jobs", Json::array()}};
  for (const record::FleetJob& job : *jobs) body["jobs"].push_back(job.number);
  html.markup(fmt::format("<p><button type=\"button\" data-post=\"/api/v1/rerun\" "
                          "data-body=\"{}\">",
                          views::escape(body.dump())))
      .text(fmt::format("Run these {} jobs again", jobs->size()))
      .markup("</button></p><p id=\"said\" role=\"status\"></p>");
  write_jobs(html, "What would run, with the present site files", *jobs);
  return page(served, "Run again", html);
}

/// {"jobs": [NUMBER, …], "use", "climate", "state", "month"}: of the jobs that the page with this
/// filter lists, those with these numbers.
Response post_rerun(const FleetServed& served, const Request& request) {
  const Json body = Json::parse(request.body, nullptr, /*allow_exceptions=*/false);
  const auto refuse = [](const char* field, const char* words) {
    return http::error_response(400, "invalid", words, field);
  };
  const auto list = body.is_object() ? body.find("jobs") : body.end();
  if (!body.is_object() || list == body.end() || !list->is_array() ||
      !std::ranges::all_of(*list, [](const Json& one) { return one.is_number_integer(); })) {
    return refuse("jobs", "write {\"jobs\": [NUMBER, …]}");
  }
  Request asked;
  for (const char* key : {"use", "climate", "state", "month"}) {
    const auto value = body.find(key);
    if (value == body.end()) continue;
    if (!value->is_string()) return refuse(key, "a filter is a text");
    if (*value != "") asked.query[key] = value->get<std::string>();
  }
  const auto filter = filter_of(asked);
  if (!filter) return filter.error();
  const auto month = month_of(asked, "month");
  if (!month) return month.error();
  const auto all = jobs_that_fit(served, *filter, *month);
  if (!all) return unavailable(all.error());
  const std::set<std::int64_t> numbers{list->begin(), list->end()};
  std::vector<record::FleetJob> chosen;
  std::ranges::copy_if(*all, std::back_inserter(chosen),
                       [&](const record::FleetJob& job) { return numbers.contains(job.number); });
  const auto count = record::rerun(served.record, chosen, served.who);
  if (!count) return unavailable(count.error());
  return http::json_response(
      Json{{"rerun", *count}, {"left_out", numbers.size() - chosen.size()}}.dump());
}

Response audit_page(const FleetServed& served) {
  const auto entries = record::audited(served.record, kAuditShown);
  if (!entries) return unavailable(entries.error());
  Table table{"What was done, newest first"};
  table.with_labels().columns({"When", "Who", "As", "What", "To", ""});
  for (const record::AuditEntry& entry : *entries) {
    table.row({{metering::to_string(entry.time)},
               {entry.who},
               {entry.role},
               {entry.action},
               {entry.subject},
               {entry.text}});
  }
  Html html;
  html.element("h1", "Audit");
  table.write(html);
  return page(served, "Audit", html);
}

// --- for programs

template <class T>
Json or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json row_json(const PortfolioRow& row) {
  Json named = Json::array();
  for (const NamedEffect& one : row.named) {
    named.push_back({{"title", one.title},
                     {"probability", one.probability},
                     {"money_month", or_null(one.money_month)}});
  }
  return {{"id", row.site.site.id},
          {"name", row.site.site.name},
          {"use", row.site.site.use},
          {"climate", row.site.site.climate},
          {"currency", row.site.site.currency},
          {"feed", name_of(row.feed)},
          {"month", row.month ? Json(metering::to_string(*row.month)) : Json(nullptr)},
          {"accepted", row.is_accepted},
          {"worst_meter", row.worst_meter},
          {"worst_cvrmse", or_null(row.worst_cvrmse)},
          {"gap_money_month", or_null(row.gap_money_month)},
          {"energy_kWh_m2_year", or_null(row.energy_kWh_m2_year)},
          {"alarms", row.alarms},
          {"named", named},
          {"trouble", row.troubled ? Json(row.troubled->reason) : Json(nullptr)}};
}

Response get_portfolio(const FleetServed& served, const Request& request) {
  const auto filter = filter_of(request);
  if (!filter) return filter.error();
  const auto portfolio = read_portfolio(served.record, served.now());
  if (!portfolio) return unavailable(portfolio.error());
  Json json = {{"sites", Json::array()}};
  for (const PortfolioRow& row : portfolio->rows) {
    if (fits(row, *filter)) json["sites"].push_back(row_json(row));
  }
  return http::json_response(json.dump());
}

Response get_jobs(const FleetServed& served, const Request& request) {
  if (auto known = has_only(request, {"site", "limit"}); !known) return known.error();
  const auto limit = limit_of(request);
  if (!limit) return limit.error();
  const auto jobs = record::jobs(served.record, text_of(request, "site").value_or(""), *limit);
  if (!jobs) return unavailable(jobs.error());
  Json json = {{"jobs", Json::array()}};
  for (const record::FleetJob& job : *jobs) {
    json["jobs"].push_back(fleet_job_json(job));
  }
  return http::json_response(json.dump());
}

Response metrics(const FleetServed& served) {
  const auto portfolio = read_portfolio(served.record, served.now());
  if (!portfolio) return unavailable(portfolio.error());
  const auto counts = record::job_counts(served.record);
  if (!counts) return unavailable(counts.error());
  PrometheusText text;
  text.begin("recald_fleet_sites", "gauge", "Registered sites, by status.");
  text.sample(static_cast<double>(portfolio->rows.size()), {{"state", "all"}});
  for (const std::string_view state : kStates) {
    const auto count = std::ranges::count_if(portfolio->rows, [&](const PortfolioRow& row) {
      return fits(row, {.state = std::string{state}});
    });
    text.sample(static_cast<double>(count), {{"state", state}});
  }
  text.begin("recald_fleet_jobs", "gauge", "Jobs, by state.");
  for (const auto& [state, count] : *counts) {
    text.sample(static_cast<double>(count), {{"state", name_of(state)}});
  }
  return {.content_type = "text/plain; version=0.0.4; charset=utf-8", .body = text.str()};
}

Response readiness(const FleetServed& served) {
  if (auto checked = record::check_schema(served.record); !checked) {
    return unavailable(checked.error());
  }
  return http::json_response(R"({"ready":true})");
}

/// What follows a prefix of the path; nothing for another path.
std::optional<std::string> after(const std::string& path, std::string_view prefix) {
  if (!path.starts_with(prefix)) return {};
  return path.substr(prefix.size());
}

}  // namespace

Response answer_fleet(const FleetServed& served, const Request& request) {
  if (request.method == Method::post) {
    if (request.path == "/api/v1/rerun") return post_rerun(served, request);
    return http::error_response(404, "not_found", "this address takes no POST requests");
  }
  if (request.method != Method::get && request.method != Method::head) {
    return http::error_response(405, "method_not_allowed", "this address takes GET and HEAD only");
  }
  const std::string& path = request.path;
  if (path == "/") return sites_page(served, request);
  if (path == "/rerun") return rerun_page(served, request);
  if (path == "/audit") return audit_page(served);
  if (path == "/api/v1/portfolio") return get_portfolio(served, request);
  if (path == "/api/v1/jobs") return get_jobs(served, request);
  if (path == "/metrics") return metrics(served);
  if (path == "/healthz") return http::json_response(R"({"ok":true})");
  if (path == "/readyz") return readiness(served);
  if (path == "/favicon.ico") return {.status = 204};
  if (path == "/style.css") {
    return {.content_type = "text/css; charset=utf-8", .body = std::string{kPageStyle}};
  }
  if (path == "/page.js") {
    return {.content_type = "text/javascript; charset=utf-8", .body = std::string{kPageScript}};
  }
  if (const auto id = after(path, "/sites/")) return site_page(served, *id);
  if (const auto rest = after(path, "/results/")) return result_file(served, *rest);
  return http::error_response(404, "not_found", fmt::format("there is no page '{}'", path));
}

}  // namespace recald::daemon
