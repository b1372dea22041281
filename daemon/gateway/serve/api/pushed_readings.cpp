#include "daemon/gateway/serve/api/pushed_readings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "adapters/csv/fields.hpp"
#include "adapters/ports/interval_store.hpp"
#include "adapters/system/files/sha256.hpp"
#include "core/absent.hpp"
#include "core/metering/months/validation.hpp"
#include "daemon/gateway/ingest/json_depth.hpp"
#include "daemon/gateway/ingest/sent_values.hpp"

namespace recald::daemon {
namespace {

using metering::Instant;
using metering::Reading;
using std::chrono::seconds;

constexpr std::string_view kExample =
    R"({"meter":"chw","unit":"kWh","readings":[{"time":"2026-03-01T00:00:00Z","value":1.5}]})";
constexpr std::array<std::string_view, 6> kKeys{"meter",  "unit",   "stamps",
                                                "reason", "author", "readings"};
constexpr int kDepthMax = 8;  // a valid body has three
/// A sender whose clock was reset must not create months of the year 2000.

tl::unexpected<http::Response> malformed(std::string_view what, std::string_view field) {
  return refusal(400, "malformed", fmt::format("{}; send JSON such as {}", what, kExample), field);
}

/// The text under a key; nothing if it is absent or not text.
std::optional<std::string> text_in(const nlohmann::json& object, const char* key) {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_string()) return {};
  return found->get<std::string>();
}

Checked<const MeterConfig*> pushed_meter(const nlohmann::json& body, const SiteConfig& site) {
  const auto id = text_in(body, "meter");
  if (!id) return malformed("'meter' is needed", "meter");
  const auto meter = meter_of(site, *id);
  if (!meter || (*meter)->source == MeterSource::http) return meter;
  return refusal(409, "not_possible",
                 fmt::format("meter '{}' has source = \"{}\", so its readings cannot be pushed",
                             *id, name_of((*meter)->source)),
                 "meter");
}

/// The meaning of the numbers in a body.
struct PushedUnit {
  metering::UnitConversion power{};                   ///< For a meter.
  const weather::SensorQuantity* quantity = nullptr;  ///< For a weather sensor; else null.
};

Checked<PushedUnit> unit_of(const nlohmann::json& body, const MeterConfig& meter) {
  const auto unit = text_in(body, "unit");
  if (meter.role == MeterRole::weather) {
    if (!unit) return malformed("'unit' is needed, such as degC", "unit");
    if (const auto* const quantity = weather::find_quantity_of_unit(*unit)) {
      return PushedUnit{.quantity = quantity};
    }
    return refusal(400, "invalid_value",
                   fmt::format("unit {} is not one of the weather units; use {}",
                               csv::in_quotes(*unit), weather::quantity_units()),
                   "unit");
  }
  if (!unit) return malformed("'unit' is needed, such as kWh", "unit");
  const auto conversion = metering::find_unit(*unit, meter.meter.utility, meter.units);
  if (!conversion) return refusal(400, "invalid_value", conversion.error().message, "unit");
  if (meter.counter && conversion->is_rate) {
    return refusal(
        400, "invalid_value",
        fmt::format("meter '{}' has a counter, but {} is a power; send what its register "
                    "reads, such as in kWh",
                    meter.meter.id, csv::in_quotes(*unit)),
        "unit");
  }
  return PushedUnit{.power = *conversion};
}

/// Absent if there is no reason.
Checked<std::optional<Correction>> correction_in(const nlohmann::json& body,
                                                 std::string_view bytes) {
  const auto is_text = [&](const char* key) {
    const auto text = text_in(body, key);
    return text && text->find_first_not_of(" \t\r\n") != std::string::npos;
  };
  if (!body.contains("reason")) {
    if (!body.contains("author")) return std::optional<Correction>{};
    return refusal(400, "invalid_value", "'author' needs a 'reason'", "author");
  }
  if (!is_text("reason")) {
    return refusal(400, "invalid_value",
                   "'reason' is empty; say why the stored readings are corrected, so that others "
                   "can understand it later",
                   "reason");
  }
  if (body.contains("author") && !is_text("author")) {
    return refusal(400, "invalid_value", "'author' is empty; say who corrects them", "author");
  }
  for (const auto& [key, bytes_max] : {std::pair{"reason", kReasonMax}, {"author", kAuthorMax}}) {
    const std::size_t size = text_in(body, key).value_or("").size();
    if (size <= bytes_max) continue;
    return refusal(400, "invalid_value",
                   fmt::format("'{}' is {} bytes long; it may be {} at most", key, size, bytes_max),
                   key);
  }
  system::Sha256 hash;
  hash.add(bytes);
  return Correction{.author = text_in(body, "author").value_or("api"),
                    .reason = *text_in(body, "reason"),
                    .sha256 = hash.hex()};
}

/// A register stands at its stamp, and its samples are not intervals that could be corrected.
Checked<void> require_plain_samples(const nlohmann::json& body, const MeterConfig& meter) {
  for (const auto& [key, advice] :
       {std::pair{"stamps", "'time' is when its register was read, so leave out 'stamps'"},
        {"reason", "its intervals are corrected by recald import"}}) {
    if (!body.contains(key)) continue;
    return refusal(400, "invalid_value",
                   fmt::format("meter '{}' has a counter: {}", meter.meter.id, advice), key);
  }
  return {};
}

/// Reads the elements of `readings` one after the other.
class Elements {
 public:
  Elements(const MeterConfig& meter, const metering::ValidationOptions& validation,
           const PushedUnit& unit, bool is_end_stamped, Instant now)
      : meter_(meter),
        validation_(validation),
        unit_(unit),
        is_end_stamped_(is_end_stamped),
        now_(now) {}

  [[nodiscard]] Checked<Reading> read(const nlohmann::json& element, std::size_t index) const {
    const std::string place = fmt::format("readings[{}]", index);
    TRY(check_keys(element, place));
    const auto start = TRY(start_of(element, place + ".time"));
    const auto mean_kW = TRY(mean_of(element, place + ".value"));
    Reading reading{.meter = 0, .start = start, .mean_kW = mean_kW};
    if (std::isnan(mean_kW)) {
      reading.validity = metering::Validity::missing;
      return reading;
    }
    reading.reasons = doubt_of(mean_kW);
    if (reading.reasons != metering::Reason::none) reading.validity = metering::Validity::suspect;
    return reading;
  }

  /// What a register read; NaN where it could not be read.
  [[nodiscard]] Checked<metering::RegisterSample> read_sample(const nlohmann::json& element,
                                                              std::size_t index) const {
    const std::string place = fmt::format("readings[{}]", index);
    TRY(check_keys(element, place));
    const auto time = TRY(time_of(element, place + ".time"));
    const auto number = TRY(number_of(element, place + ".value"));
    return metering::RegisterSample{time, number * unit_.power.factor};
  }

 private:
  [[nodiscard]] static Checked<void> check_keys(const nlohmann::json& element,
                                                const std::string& place) {
    if (!element.is_object()) return malformed(place + " is not an object", place);
    for (const auto& [key, value] : element.items()) {
      if (key == "time" || key == "value") continue;
      return malformed(fmt::format("{} has the unknown key {}", place, csv::in_quotes(key)), place);
    }
    return {};
  }

  [[nodiscard]] metering::Reason doubt_of(double mean) const {
    if (unit_.quantity == nullptr) return metering::doubt_of(mean, meter_.meter, validation_);
    return weather::is_plausible(*unit_.quantity, mean) ? metering::Reason::none
                                                        : metering::Reason::range;
  }

  [[nodiscard]] static Checked<Instant> stamp_of(const nlohmann::json& element,
                                                 const std::string& place) {
    const auto text = text_in(element, "time");
    const auto stamp = text ? csv::parse_timestamp(*text) : Result<Instant>{};
    if (text && stamp) return *stamp;
    return refusal(400, "invalid_value",
                   fmt::format("{} is {}; write a time such as 2026-03-01T00:00:00Z", place,
                               text ? csv::in_quotes(*text) : "not a text"),
                   place);
  }

  [[nodiscard]] Checked<Instant> start_of(const nlohmann::json& element,
                                          const std::string& place) const {
    const auto stamp = TRY(stamp_of(element, place));
    const seconds interval = meter_.meter.interval;
    const Instant start = is_end_stamped_ ? stamp - interval : stamp;
    if ((start.time_since_epoch() - meter_.meter.phase) % interval != seconds{0}) {
      return refusal(400, "invalid_value",
                     fmt::format("{} is {}, which is not a boundary of the meter's {} s intervals",
                                 place, quoted_time(element), interval.count()),
                     place);
    }
    const bool is_instant = meter_.values == weather::RecordedValues::instant;
    TRY(check_age(element, place, start, is_instant ? start : start + interval));
    return start;
  }

  [[nodiscard]] Checked<Instant> time_of(const nlohmann::json& element,
                                         const std::string& place) const {
    const auto stamp = TRY(stamp_of(element, place));
    TRY(check_age(element, place, stamp, stamp));
    return stamp;
  }

  [[nodiscard]] static std::string quoted_time(const nlohmann::json& element) {
    return csv::in_quotes(text_in(element, "time").value_or(""));
  }

  /// @param end  Of the interval; of an instant it is its begin.
  [[nodiscard]] Checked<void> check_age(const nlohmann::json& element, const std::string& place,
                                        Instant begin, Instant end) const {
    if (end > now_ + kClocksDiffer) {
      return refusal(
          400, "invalid_value",
          fmt::format("{} is {}{} after now, {}", place, quoted_time(element),
                      begin == end ? "," : ": that interval ends", metering::to_string(now_)),
          place);
    }
    if (begin < now_ - kSentOldest) {
      return refusal(400, "invalid_value",
                     fmt::format("{} is {}, more than {} days ago; {}", place, quoted_time(element),
                                 kSentOldest.count(),
                                 unit_.quantity == nullptr
                                     ? "use recald import for older readings"
                                     : "older weather belongs in the file named by [weather] file"),
                     place);
    }
    return {};
  }

  [[nodiscard]] Checked<double> mean_of(const nlohmann::json& element,
                                        const std::string& place) const {
    const auto number = TRY(number_of(element, place));
    if (unit_.quantity != nullptr) return number;
    return unit_.power.mean_kW(number, meter_.meter.interval) * meter_.multiplier;
  }

  /// NaN for null.
  [[nodiscard]] static Checked<double> number_of(const nlohmann::json& element,
                                                 const std::string& place) {
    const auto value = element.find("value");
    if (value != element.end() && value->is_null()) {
      return kAbsent;
    }
    if (value == element.end() || !value->is_number()) {
      return refusal(400, "invalid_value",
                     place + " is not a number; write null for an interval without a value", place);
    }
    const double number = value->get<double>();
    if (!(std::abs(number) <= kSentValueMax)) {
      return refusal(400, "invalid_value", place + " is more than any meter counts", place);
    }
    return number;
  }

  const MeterConfig& meter_;
  const metering::ValidationOptions& validation_;
  PushedUnit unit_;
  bool is_end_stamped_;
  Instant now_;
};

}  // namespace

std::string PushedReadings::stored_id() const {
  const std::string& id = meter->meter.id;
  return quantity == nullptr ? id : WeatherChannel{id, quantity}.id();
}

Checked<PushedReadings> parse_pushed(std::string_view body, const SiteConfig& site, Instant now) {
  if (is_nested_deeper(body, kDepthMax)) {
    return malformed(fmt::format("the body has more than {} levels of nesting", kDepthMax), "body");
  }
  const auto json = nlohmann::json::parse(body, nullptr, false);
  if (!json.is_object()) return malformed("the body is not a JSON object", "body");
  for (const auto& [key, value] : json.items()) {
    if (std::ranges::find(kKeys, key) == kKeys.end()) {
      return malformed(fmt::format("{} is not a known key", csv::in_quotes(key)), key);
    }
  }
  const auto meter = TRY(pushed_meter(json, site));
  const auto unit = TRY(unit_of(json, *meter));
  const std::string stamps =
      json.contains("stamps") ? text_in(json, "stamps").value_or("") : "start";
  if (stamps != "start" && stamps != "end") {
    return refusal(400, "invalid_value", R"('stamps' is neither "start" nor "end")", "stamps");
  }
  if (stamps == "end" && meter->values == weather::RecordedValues::instant) {
    return refusal(400, "invalid_value",
                   fmt::format("sensor '{}' has values = \"instant\": 'time' is when a value was "
                               "measured, so leave out 'stamps'",
                               meter->meter.id),
                   "stamps");
  }
  const auto list = json.find("readings");
  if (list == json.end() || !list->is_array() || list->empty()) {
    return malformed("'readings' is needed, with at least one", "readings");
  }
  auto correction = TRY(correction_in(json, body));
  if (meter->counter) TRY(require_plain_samples(json, *meter));
  const Elements elements{*meter, site.closing.closing.validation, unit, stamps == "end", now};
  PushedReadings pushed{.meter = meter,
                        .quantity = unit.quantity,
                        .readings = {},
                        .correction = std::move(correction)};
  for (std::size_t i = 0; meter->counter && i < list->size(); ++i) {
    const auto sample = TRY(elements.read_sample((*list)[i], i));
    if (!std::isnan(sample.value_kWh)) pushed.samples.push_back(sample);
  }
  for (std::size_t i = 0; !meter->counter && i < list->size(); ++i) {
    auto reading = TRY(elements.read((*list)[i], i));
    pushed.readings.push_back(reading);
  }
  return pushed;
}

}  // namespace recald::daemon
