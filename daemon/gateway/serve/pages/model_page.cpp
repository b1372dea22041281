#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "adapters/csv/fields.hpp"
#include "adapters/models/model_store.hpp"
#include "adapters/views/frame/format.hpp"
#include "daemon/gateway/serve/pages/page_frame.hpp"
#include "daemon/gateway/serve/pages/pages.hpp"

namespace recald::daemon {
namespace {

using views::Cell;
using views::Html;
using views::Table;

Cell version_state_cell(const diagnosis::ModelVersion& version, const std::string& active) {
  if (version.version == active) return {"✔ in force", "good"};
  return {std::string{name_of(version.status)}};
}

/// A time of a version's file.
std::string made_text(const Served& served, const std::string& created_at) {
  if (created_at.empty()) return "–";
  const auto at = csv::parse_timestamp(created_at);
  return at ? site_time_text(served.calendar, *at) : created_at;
}

/// A button that posts to the API. @param path  "model"
void write_button(Html& html, std::string_view path, const nlohmann::json& body,
                  std::string_view text) {
  html.markup(fmt::format("<button type=\"button\" data-post=\"/api/v1/{}\" data-body=\"{}\">",
                          path, views::escape(body.dump())))
      .text(text)
      .markup("</button> ");
}

/// Versions that may be put in force, and the way back.
void write_changes(Html& html, const models::VersionList& list) {
  html.markup("<p>");
  for (const diagnosis::ModelVersion& version : list.versions) {
    if (version.version == list.active || version.effects.empty()) continue;
    write_button(html, "model", {{"activate", version.version}},
                 fmt::format("Put {} in force", diagnosis::short_version(version.version)));
  }
  if (list.active != diagnosis::kBaseVersion) {
    write_button(html, "model", {{"revert", nullptr}}, "Go back by one version");
  }
  html.markup("</p>");
}

/// Jobs that may be requested now.
void write_requests(Html& html, const Served& served, const Result<models::VersionList>& list) {
  if (!served.ask_job) return;
  html.markup("<p>");
  write_button(html, "calibrations", nlohmann::json::object(), "Calibrate now");
  // A diagnosis simulates the building's hours, and starts from the drawings.
  const bool can_be_diagnosed =
      served.site.building.has_value() && list && list->active == diagnosis::kBaseVersion;
  if (can_be_diagnosed) {
    write_button(html, "diagnoses", nlohmann::json::object(), "Look for missing effects");
  }
  html.markup("</p>");
}

/// What diagnoses have added to the model, or would.
void write_versions(Html& html, const Served& served, const Result<models::VersionList>& list) {
  if (!list) {
    html.element("p", "✖ The versions of the model cannot be read: " + list.error().message, "bad");
    return;
  }
  for (const std::string& sentence : list->damaged) html.element("p", "✖ " + sentence, "bad");
  if (list->versions.size() < 2) return;  // the drawings alone
  Table table{"Versions of the model"};
  table.with_labels().columns({"Version", "State", "What it adds to the drawings", "Made"});
  for (const diagnosis::ModelVersion& version : list->versions) {
    std::string added;
    for (const diagnosis::AddedEffect& effect : version.effects) {
      added += fmt::format("{}{} ({})", added.empty() ? "" : ", ", effect.title,
                           views::probability_text(effect.probability));
    }
    table.row({{diagnosis::short_version(version.version)},
               version_state_cell(version, list->active),
               {added.empty() ? "nothing" : added},
               {made_text(served, version.created_at)}});
  }
  table.write(html);
  write_changes(html, *list);
}

}  // namespace

http::Response model_page(const Served& served) {
  constexpr int kShown = 50;
  views::Html html;
  html.element("h1", "Model");
  if (!served.site.model) {
    html.element(
        "p",
        "The site file has no [building] and no model, so nothing is calibrated. Meters and "
        "months are kept all the same.",
        "muted");
    return page_of(served, PageKind::model, "Model", html);
  }
  const auto in_use = served.store.last_accepted(JobKind::calibration);
  if (!in_use) {
    html.element("p", "✖ The calibrations cannot be read: " + in_use.error().message, "bad");
  } else if (!*in_use) {
    html.element("p", "No calibration is in use yet.", "muted");
  } else {
    const StoredJob& job = **in_use;
    html.markup("<p>✔ ").text(fmt::format("Calibration {} is in use", job.number));
    if (job.ended) {
      html.text(fmt::format(", made {} ago", age_text(served.now() - *job.ended)));
    }
    html.text(": ").link(file_address(job, "report.html"), "its report");
    if (job.result.drift) {
      html.text(", ").link(file_address(job, "drift.html"),
                           "what months since the first year show");
    }
    html.markup(".</p>");
  }
  write_job_now(html, served);
  const auto versions = models::ModelStore{served.site.versions_beside(), served.site.id}.list();
  write_requests(html, served, versions);
  html.markup(
      "<p id=\"said\" role=\"status\"></p><noscript><p class=\"muted\">The buttons need "
      "JavaScript. Without it, recald model apply and recald model revert change the "
      "version.</p></noscript>");
  write_versions(html, served, versions);
  write_alarms(html, served);
  write_jobs(html, served, JobKind::calibration, "Calibrations, the newest first", kShown);
  write_jobs(html, served, JobKind::diagnosis, "Diagnoses, the newest first", kShown);
  return page_of(served, PageKind::model, "Model", html);
}

}  // namespace recald::daemon
