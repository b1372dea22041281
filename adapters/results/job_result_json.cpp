#include "adapters/results/job_result_json.hpp"

#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

namespace recald::results {
namespace {

using Json = nlohmann::ordered_json;

Json daily_json(const std::optional<DailyEvidence>& daily) {
  if (!daily) return nullptr;
  return {{"log_evidence", number(daily->log_evidence)},
          {"log_threshold", number(daily->log_threshold)},
          {"lag_one", number(daily->lag_one)},
          {"month_factor", number(daily->month_factor)}};
}

Json days_json(const std::optional<AlarmedDays>& days) {
  if (!days) return nullptr;
  return {{"raised", days->raised},
          {"since", days->since},
          {"since_earliest", days->since_earliest},
          {"since_latest", days->since_latest},
          {"excess", number(days->excess)}};
}

Json causes_json(const std::vector<AlarmCause>& causes) {
  Json list = Json::array();
  for (const AlarmCause& cause : causes) {
    list.push_back({{"kind", cause.kind},
                    {"subject", cause.subject ? Json(*cause.subject) : Json(nullptr)},
                    {"probability", number(cause.probability)},
                    {"log_evidence", number(cause.log_evidence)},
                    {"mean", number(cause.mean)},
                    {"q05", number(cause.q05)},
                    {"q95", number(cause.q95)},
                    {"words", cause.words}});
  }
  return list;
}

/// The members of an object; absent if they are missing or of another type.
class Reader {
 public:
  explicit Reader(const Json& json) : json_(json) {}

  [[nodiscard]] double number(const char* key) const {
    const Json* value = find(key);
    return value != nullptr && value->is_number() ? value->get<double>() : kAbsent;
  }
  [[nodiscard]] std::string text(const char* key) const {
    const Json* value = find(key);
    return value != nullptr && value->is_string() ? value->get<std::string>() : std::string{};
  }
  [[nodiscard]] bool flag(const char* key) const {
    const Json* value = find(key);
    return value != nullptr && value->is_boolean() && value->get<bool>();
  }
  /// Null: no such object.
  [[nodiscard]] const Json* object(const char* key) const {
    const Json* value = find(key);
    return value != nullptr && value->is_object() ? value : nullptr;
  }
  [[nodiscard]] const Json* array(const char* key) const {
    const Json* value = find(key);
    return value != nullptr && value->is_array() ? value : nullptr;
  }

  /// Applies `read` to each object of an array.
  template <class Read>
  [[nodiscard]] auto list(const char* key, Read read) const {
    std::vector<decltype(read(*this))> all;
    if (const Json* values = array(key)) {
      for (const Json& one : *values) {
        if (one.is_object()) all.push_back(read(Reader{one}));
      }
    }
    return all;
  }

 private:
  [[nodiscard]] const Json* find(const char* key) const {
    const auto found = json_.find(key);
    return found == json_.end() ? nullptr : &*found;
  }

  const Json& json_;
};

OutputDrift read_output(const Reader& from) {
  OutputDrift output{.output = from.text("output"),
                     .month = from.text("month"),
                     .pvalue = from.number("pvalue"),
                     .log_evidence = from.number("log_evidence"),
                     .log_threshold = from.number("log_threshold"),
                     .change_within_year = from.number("change_within_year")};
  if (const Json* daily = from.object("daily")) {
    const Reader days{*daily};
    output.daily = DailyEvidence{days.number("log_evidence"), days.number("log_threshold"),
                                 days.number("lag_one"), days.number("month_factor")};
  }
  return output;
}

AlarmCause read_cause(const Reader& from) {
  AlarmCause cause{.kind = from.text("kind"),
                   .subject = {},
                   .probability = from.number("probability"),
                   .log_evidence = from.number("log_evidence"),
                   .mean = from.number("mean"),
                   .q05 = from.number("q05"),
                   .q95 = from.number("q95"),
                   .words = from.text("words")};
  if (std::string subject = from.text("subject"); !subject.empty()) cause.subject = subject;
  return cause;
}

DriftAlarm read_alarm(const Reader& from) {
  DriftAlarm alarm{.month = from.text("month"),
                   .output = from.text("output"),
                   .direction = from.text("direction"),
                   .evidence = from.number("evidence"),
                   .since = from.text("since"),
                   .since_earliest = from.text("since_earliest"),
                   .since_latest = from.text("since_latest"),
                   .forecasts_are_true = from.flag("forecasts_are_true"),
                   .causes = from.list("causes", read_cause),
                   .explained_until = from.text("explained_until"),
                   .consequence = from.text("consequence"),
                   .sentence = from.text("sentence")};
  if (const Json* days = from.object("days")) {
    const Reader of{*days};
    alarm.days = AlarmedDays{of.text("raised"), of.text("since"), of.text("since_earliest"),
                             of.text("since_latest"), of.number("excess")};
  }
  return alarm;
}

ChangedMeter read_changed_meter(const Reader& from) {
  return {.meter = from.text("meter"),
          .kind = from.text("kind"),
          .since = from.text("since"),
          .seen = from.text("seen"),
          .factor = from.number("factor"),
          .sentence = from.text("sentence")};
}

MonthWeather read_weather(const Reader& from) {
  MonthWeather month{.month = from.text("month"), .known = from.number("known")};
  if (const Json* shares = from.object("from")) {
    for (const auto& [name, share] : shares->items()) {
      if (share.is_number()) month.from[name] = share.get<double>();
    }
  }
  return month;
}

}  // namespace

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json outputs_json(const DriftSummary& drift) {
  Json list = Json::array();
  for (const OutputDrift& one : drift.outputs) {
    list.push_back({{"output", one.output},
                    {"month", one.month.empty() ? Json(nullptr) : Json(one.month)},
                    {"pvalue", number(one.pvalue)},
                    {"log_evidence", number(one.log_evidence)},
                    {"log_threshold", number(one.log_threshold)},
                    {"change_within_year", number(one.change_within_year)},
                    {"daily", daily_json(one.daily)}});
  }
  return list;
}

Json alarms_json(const DriftSummary& drift) {
  Json list = Json::array();
  for (const DriftAlarm& alarm : drift.alarms) {
    list.push_back({{"month", alarm.month},
                    {"output", alarm.output},
                    {"direction", alarm.direction},
                    {"evidence", number(alarm.evidence)},
                    {"since", alarm.since},
                    {"since_earliest", alarm.since_earliest},
                    {"since_latest", alarm.since_latest},
                    {"days", days_json(alarm.days)},
                    {"forecasts_are_true", alarm.forecasts_are_true},
                    {"causes", causes_json(alarm.causes)},
                    {"explained_until", alarm.explained_until},
                    {"consequence", alarm.consequence},
                    {"sentence", alarm.sentence}});
  }
  return list;
}

Json changed_meters_json(const DriftSummary& drift) {
  Json list = Json::array();
  for (const ChangedMeter& change : drift.changed_meters) {
    list.push_back({{"meter", change.meter},
                    {"kind", change.kind},
                    {"since", change.since},
                    {"seen", change.seen},
                    {"factor", number(change.factor)},
                    {"sentence", change.sentence}});
  }
  return list;
}

Json weather_json(const std::vector<MonthWeather>& months) {
  Json list = Json::array();
  for (const MonthWeather& one : months) {
    Json from = Json::object();
    for (const auto& [name, share] : one.from) from[name] = number(share);
    list.push_back({{"month", one.month}, {"known", number(one.known)}, {"from", from}});
  }
  return list;
}

JobResult read_job_result(std::string document) {
  JobResult result{.document = std::move(document), .rhat_max = kAbsent, .drift = {}};
  const Json json = Json::parse(result.document, nullptr, false);
  if (!json.is_object()) return result;
  const Reader from{json};
  for (const char* group : {"parameters", "hyperparameters"}) {
    for (const double rhat :
         from.list(group, [](const Reader& one) { return one.number("rhat"); })) {
      result.rhat_max = std::fmax(result.rhat_max, rhat);
    }
  }
  result.weather = from.list("weather", read_weather);
  if (from.array("drift") == nullptr && from.array("alarms") == nullptr) return result;
  result.drift = DriftSummary{.outputs = from.list("drift", read_output),
                              .alarms = from.list("alarms", read_alarm),
                              .changed_meters = from.list("meter_changes", read_changed_meter)};
  return result;
}

}  // namespace recald::results
