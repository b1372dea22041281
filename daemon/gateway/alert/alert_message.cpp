#include "daemon/gateway/alert/alert_message.hpp"

#include <fmt/format.h>

#include <array>
#include <cctype>
#include <nlohmann/json.hpp>

#include "core/display/id_words.hpp"
#include "daemon/site/config/service/alert_kinds.hpp"

namespace recald::daemon {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kShownMax = 50;  // in the text; the JSON has all

std::string_view title_of(const StoreEvent& event) {
  const AlertKind* const known = find_alert_kind(event.kind);
  return known == nullptr ? std::string_view{event.kind} : known->title;
}

/// A title begins with an article: "A meter is silent".
std::string inside_sentence(std::string_view title) {
  std::string words{title};
  words.front() = static_cast<char>(std::tolower(static_cast<unsigned char>(words.front())));
  return words;
}

/// Where a person reads on; empty: the site file does not say where the pages are.
std::string page_of_event(const SiteConfig& site, const StoreEvent& event) {
  if (site.alerts.pages.empty()) return "";
  const bool is_of_model = event.kind == "drift_alarm" || event.kind == "cause_named" ||
                           event.kind.starts_with("calibration_") ||
                           event.kind.starts_with("diagnosis_");
  if (is_of_model) return site.alerts.pages + "/model";
  const bool is_of_meter = site.meter_index(event.subject) || site.find_sensor(event.subject);
  return site.alerts.pages + (is_of_meter ? "/meters/" + event.subject : "/events");
}

std::string time_words(const metering::LocalCalendar& calendar, metering::Instant t) {
  const metering::LocalTime local = calendar.local_time(t);
  return fmt::format("{} {:02}:{:02}", metering::to_string(local.date), local.minute_of_day / 60,
                     local.minute_of_day % 60);
}

std::string site_words(const SiteConfig& site) { return site.name.empty() ? site.id : site.name; }

std::string id_of(const SiteConfig& site, const StoreEvent& event) {
  return fmt::format("{}-{}-{}{}{}", site.id, event.time.time_since_epoch().count(), event.kind,
                     event.subject.empty() ? "" : "-", event.subject);
}

Json json_of(const SiteConfig& site, const StoreEvent& event) {
  constexpr std::array kSeverities{"info", "warning", "error"};
  return {{"id", id_of(site, event)},
          {"kind", event.kind},
          {"title", title_of(event)},
          {"severity", kSeverities.at(static_cast<std::size_t>(event.severity))},
          {"subject", event.subject},
          {"time", metering::to_string(event.time)},
          {"text", event.text},
          {"page", page_of_event(site, event)}};
}

std::string document_of(const SiteConfig& site, const std::string& subject, Json alerts) {
  const Json document = {{"text", subject},
                         {"site", site.id},
                         {"site_name", site_words(site)},
                         {"alerts", std::move(alerts)}};
  return document.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

AlertMessage alert_message(const SiteConfig& site, const metering::LocalCalendar& calendar,
                           std::span<const StoreEvent> events, metering::Instant now) {
  const StoreEvent& last = events.back();
  const std::string of_which = last.subject.empty() ? "" : fmt::format(" ({})", last.subject);
  AlertMessage message{
      .id = fmt::format("{}-{}", id_of(site, last), events.size()),
      .subject = events.size() == 1 ? fmt::format("{}: {}{}", site_words(site),
                                                  inside_sentence(title_of(last)), of_which)
                                    : fmt::format("{}: {} alerts", site_words(site), events.size()),
      .text = {},
      .document = {},
      .time = now};
  Json alerts = Json::array();
  for (std::size_t i = 0; i < events.size(); ++i) {
    const StoreEvent& event = events[i];
    alerts.push_back(json_of(site, event));
    if (i >= kShownMax) continue;
    message.text += fmt::format("{}\n{}\n{}\n", title_of(event), time_words(calendar, event.time),
                                display::capitalised(event.text));
    if (const std::string page = page_of_event(site, event); !page.empty()) {
      message.text += page + "\n";
    }
    message.text += "\n";
  }
  if (events.size() > kShownMax) {
    message.text += fmt::format("And {} more.\n\n", events.size() - kShownMax);
  }
  message.text += fmt::format(
      "Times are in {}. [alerts] in the site file says who is notified of what.\n", site.timezone);
  message.document = document_of(site, message.subject, std::move(alerts));
  return message;
}

AlertMessage trial_message(const SiteConfig& site, metering::Instant now) {
  const std::string subject = site_words(site) + ": a trial";
  return {.id = fmt::format("{}-trial-{}", site.id, now.time_since_epoch().count()),
          .subject = subject,
          .text = "Alerts of recald arrive here. Nothing has happened.\n",
          .document = document_of(site, subject, Json::array()),
          .time = now};
}

}  // namespace recald::daemon
