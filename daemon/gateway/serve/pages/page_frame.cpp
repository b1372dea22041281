#include "daemon/gateway/serve/pages/page_frame.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdlib>

#include "adapters/views/frame/assets.hpp"
#include "adapters/views/frame/format.hpp"
#include "adapters/views/frame/zoomable_chart.hpp"
#include "core/display/id_words.hpp"
#include "daemon/gateway/serve/pages/page_script.hpp"
#include "daemon/gateway/serve/pages/page_style.hpp"
#include "daemon/gateway/serve/pages/pages.hpp"
#include "daemon/version.hpp"

namespace recald::daemon {
namespace {

using metering::Instant;
using views::Cell;
using views::Html;
using views::Table;

constexpr std::array kSitePages{PageLink{"/", "Now"}, PageLink{"/months", "Months"},
                                PageLink{"/model", "Model"}, PageLink{"/data", "Data"},
                                PageLink{"/events", "Events"}};
constexpr std::array kSitePrograms{PageLink{"/api/v1/openapi.json", "interface"},
                                   PageLink{"/api/v1/meters", "meters"},
                                   PageLink{"/api/v1/months", "months"},
                                   PageLink{"/api/v1/events", "events"},
                                   PageLink{"/metrics", "metrics"},
                                   PageLink{"/readyz", "readiness"}};

void write_links(Html& html, const char* label, std::span<const PageLink> links,
                 const PageLink* here) {
  html.markup(fmt::format("<nav aria-label=\"{}\">", label));
  for (const PageLink& link : links) {
    html.markup(fmt::format("<a href=\"{}\"{}>{}</a> ", link.address,
                            &link == here ? " aria-current=\"page\"" : "", link.text));
  }
  html.markup("</nav>");
}

/// Pages that renew themselves.
bool shows_progress(PageKind kind) { return kind == PageKind::now || kind == PageKind::model; }

/// For an hour, by the browser.
http::Response kept(http::Response response) {
  response.headers.emplace_back("Cache-Control", "private, max-age=3600");
  return response;
}

/// @param in_use  Number of the calibration in use; 0: none.
Cell job_state_cell(const StoredJob& job, std::int64_t in_use) {
  if (job.state == JobState::done) {
    if (!job.accepted) return {"▲ not accepted", "warn"};
    if (job.kind != JobKind::calibration) return {"✔ done", "good"};
    return job.number == in_use ? Cell{"✔ in use", "good"} : Cell{"✔ accepted", "good"};
  }
  if (job.state == JobState::failed) return {"✖ failed", "bad"};
  return {std::string{recald::name_of(job.state)}};
}

}  // namespace

http::Response framed_page(const PageFrame& frame, const Html& main) {
  Html html;
  html.markup(
      "<!doctype html><html lang=\"en\"><head><meta charset=\"utf-8\">"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">"
      "<link rel=\"stylesheet\" href=\"/style.css\">"
      "<script src=\"/page.js\" defer></script>");
  html.element("title", frame.title + " – recald")
      .markup(frame.is_live ? "</head><body data-live><header>" : "</head><body><header>");
  html.element("p", frame.heading, "site");
  write_links(html, "Pages", frame.pages, frame.here);
  html.markup("</header><main>").markup(main.str()).markup("</main>");
  // Text is escaped, so no other text can look like this.
  if (main.str().find(views::kZoomableMarkup) != std::string::npos) {
    html.markup("<script src=\"/charts.js\" defer></script>");
  }
  html.markup("<footer>");
  html.element("p", fmt::format("As of {}. recald {}.", frame.as_of, kVersion), "muted");
  write_links(html, "For programs", frame.for_programs, nullptr);
  html.markup("</footer></body></html>\n");
  return {.content_type = "text/html; charset=utf-8", .body = html.str()};
}

http::Response page_of(const Served& served, PageKind kind, const std::string& title,
                       const Html& main) {
  const std::string site = served.site.name.empty() ? served.site.id : served.site.name;
  const auto place = static_cast<std::size_t>(kind);
  return framed_page(
      {.title = (title.empty() ? "" : title + " – ") + site,
       .heading = site,
       .pages = kSitePages,
       .here = place < kSitePages.size() ? &kSitePages.at(place) : nullptr,
       .is_live = shows_progress(kind),
       .as_of = fmt::format("{}; times are in {}", site_time_text(served.calendar, served.now()),
                            served.site.timezone),
       .for_programs = kSitePrograms},
      main);
}

http::Response page_style(const Served&) {
  return kept({.content_type = "text/css; charset=utf-8", .body = std::string{kPageStyle}});
}

http::Response page_script(const Served&) {
  return kept({.content_type = "text/javascript; charset=utf-8", .body = std::string{kPageScript}});
}

http::Response charts_script(const Served&) {
  return kept({.content_type = "text/javascript; charset=utf-8",
               .body = std::string{views::assets().charts}});
}

std::string site_time_text(const metering::LocalCalendar& calendar, Instant t) {
  if (t < std::chrono::sys_days{std::chrono::year{1971} / 1 / 1} || t >= metering::kLatestInstant) {
    return metering::to_string(t);  // before the clock was set
  }
  const metering::LocalTime local = calendar.local_time(t);
  const auto offset_minutes =
      std::chrono::duration_cast<std::chrono::minutes>(calendar.utc_offset(t)).count();
  const auto size = std::abs(offset_minutes);
  return fmt::format("{} {:02}:{:02} {}{:02}:{:02}", metering::to_string(local.date),
                     local.minute_of_day / 60, local.minute_of_day % 60,
                     offset_minutes < 0 ? "−" : "+", size / 60, size % 60);
}

std::string age_text(std::chrono::seconds age) {
  const auto s = age.count();
  if (s < 0) return "in the future";
  if (s < 120) return fmt::format("{} s", s);
  if (s < 2 * 3600) return fmt::format("{} min", s / 60);
  if (s < 2 * 86'400) return fmt::format("{} h", s / 3600);
  return fmt::format("{} days", s / 86'400);
}

Cell severity_cell(Severity severity) {
  switch (severity) {
    case Severity::info:
      break;
    case Severity::warning:
      return {"▲ warning", "warn"};
    case Severity::error:
      return {"✖ error", "bad"};
  }
  return {"info"};
}

std::string file_address(const StoredJob& job, std::string_view file) {
  return fmt::format("/jobs/{}/{}", job.number, file);
}

void write_jobs(Html& html, const Served& served, JobKind kind, std::string caption, int limit) {
  const auto jobs = served.store.jobs(kind, limit);
  if (!jobs || jobs->empty()) return;
  const auto last = served.store.last_accepted(JobKind::calibration);
  const std::int64_t in_use = last && *last ? (*last)->number : 0;
  Table table{std::move(caption)};
  table.with_labels().columns({"Number", "State", "Requested", "By", "Message", "Report"});
  for (const StoredJob& job : *jobs) {
    const bool has_report = !job.folder.empty();
    const char* file = kind == JobKind::calibration ? "report.html" : "diagnosis.html";
    table.row({{std::to_string(job.number)},
               job_state_cell(job, in_use),
               {site_time_text(served.calendar, job.asked)},
               {job.asked_by},
               {job.message.empty() ? "–" : job.message},
               {has_report ? "report" : "–", "", has_report ? file_address(job, file) : ""}});
  }
  table.write(html);
}

void write_job_now(Html& html, const Served& served) {
  const auto unfinished = served.store.unfinished_jobs();
  if (!unfinished) return;
  for (const StoredJob& job : *unfinished) {
    if (job.state != JobState::running || !job.started) {
      html.element("p", fmt::format("A {} is waiting.", recald::name_of(job.kind)), "muted");
      continue;
    }
    const auto since = served.now() - *job.started;
    std::string text =
        fmt::format("A {} has been running for {}", recald::name_of(job.kind), age_text(since));
    const auto progress = served.progress ? served.progress() : std::nullopt;
    if (progress && progress->job == job.number) {
      text += fmt::format(": {} ({})", views::percent_text(progress->share, 0), progress->what);
      constexpr double kEnoughToTell = 0.05;
      if (progress->share >= kEnoughToTell) {
        const double left_s =
            static_cast<double>(since.count()) * (1.0 - progress->share) / progress->share;
        text +=
            fmt::format("; about {} left", age_text(std::chrono::seconds{std::llround(left_s)}));
      }
    }
    html.element("p", text + ".");
  }
}

void write_alarms(Html& html, const Served& served) {
  const auto job = served.store.last_accepted(JobKind::calibration);
  if (!job || !*job) return;
  const auto& drift = (*job)->result.drift;
  if (!drift || drift->alarms.empty()) return;
  Table table{"What has changed"};
  table.with_labels().columns({"Since", "What", "Details", "Likeliest causes"});
  for (const DriftAlarm& alarm : drift->alarms) {
    std::string causes;
    for (const AlarmCause& cause : alarm.causes) {
      if (!causes.empty()) causes += "; ";
      causes += fmt::format("{} {}", views::probability_text(cause.probability), cause.words);
    }
    table.row({{alarm.since},
               {display::capitalised(display::output_words(alarm.output))},
               {alarm.sentence},
               {causes.empty() ? "–" : causes}});
  }
  table.write(html);
}

}  // namespace recald::daemon
