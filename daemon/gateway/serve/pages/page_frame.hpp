/// What the pages share: the head, the links between them, words for times.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "adapters/views/frame/html.hpp"
#include "daemon/gateway/serve/api/served.hpp"

namespace recald::daemon {

struct PageLink {
  const char* address;
  const char* text;
};

/// What stands around the middle of a page.
struct PageFrame {
  std::string title;    ///< Of the window.
  std::string heading;  ///< Above the links.
  std::span<const PageLink> pages;
  const PageLink* here = nullptr;  ///< That of `pages` which is shown, if any.
  bool is_live = false;            ///< It renews itself.
  std::string as_of;               ///< "2026-03-29 03:15 +02:00; times are in Europe/Berlin"
  std::span<const PageLink> for_programs;
};

[[nodiscard]] http::Response framed_page(const PageFrame& frame, const views::Html& main);

/// In the order of the links to them.
enum class PageKind : std::uint8_t { now, months, model, data, events, other };

/// A page with the site's name above and `main` in the middle.
/// @param title  Of the window: "Months"; empty: the site's name alone.
[[nodiscard]] http::Response page_of(const Served& served, PageKind kind, const std::string& title,
                                     const views::Html& main);

/// "2026-03-29 03:15 +02:00", in the site's local time.
[[nodiscard]] std::string site_time_text(const metering::LocalCalendar& calendar,
                                         metering::Instant t);

/// "40 s", "3 min", "5 h", "2 days"; "in the future" if negative.
[[nodiscard]] std::string age_text(std::chrono::seconds age);

/// A sign beside each word, so that the meaning never depends on colour alone.
[[nodiscard]] views::Cell severity_cell(Severity severity);

/// Where a file of a job is served.
[[nodiscard]] std::string file_address(const StoredJob& job, std::string_view file);

/// The job that runs or waits, and how far it is.
void write_job_now(views::Html& html, const Served& served);

/// The calibrations or diagnoses, newest first; nothing if there are none.
void write_jobs(views::Html& html, const Served& served, JobKind kind, std::string caption,
                int limit);

/// Alarms from the months after the calibration in use; nothing if there are none.
void write_alarms(views::Html& html, const Served& served);

}  // namespace recald::daemon
