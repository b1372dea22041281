#include "adapters/record/figure_json.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "adapters/record/values.hpp"

namespace recald::record {
namespace {

using metering::Instant;
using metering::MonthlyFigure;
using nlohmann::json;

json number_or_null(double value) { return std::isfinite(value) ? json(value) : json(); }

double number_or_nan(const json& value) {
  return value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
}

}  // namespace

std::string figure_json(const MonthlyFigure& figure) {
  json peak;
  if (figure.peak) {
    peak = {{"kW", number_or_null(figure.peak->kW)},
            {"start", figure.peak->start.time_since_epoch().count()},
            {"could_be_exceeded", figure.peak->could_be_exceeded}};
  }
  return json{{"month", metering::to_string(figure.month)},
              {"daily_average_kWh", number_or_null(figure.daily_average_kWh)},
              {"daily_average_variance_kWh2", number_or_null(figure.daily_average_variance_kWh2)},
              {"peak", std::move(peak)},
              {"peak_window_s", figure.peak_window.count()},
              {"coverage", number_or_null(figure.coverage)},
              {"filled_share", number_or_null(figure.filled_share)},
              {"slots_by_validity", figure.slots_by_validity},
              {"slots", figure.slots},
              {"usable", figure.usable},
              {"unusable_because", text_of(figure.unusable_because)},
              {"reasons", static_cast<std::uint32_t>(figure.reasons)},
              {"revision", figure.revision}}
      .dump(-1, ' ', false, json::error_handler_t::replace);
}

Result<MonthlyFigure> parse_figure(std::string_view text) {
  try {
    const json read = json::parse(text);
    const auto month = metering::parse_month(read.at("month").get<std::string>());
    if (!month) return tl::unexpected(month.error());
    MonthlyFigure figure{
        .month = *month,
        .daily_average_kWh = number_or_nan(read.at("daily_average_kWh")),
        .daily_average_variance_kWh2 = number_or_nan(read.at("daily_average_variance_kWh2")),
        .peak = {},
        .peak_window = std::chrono::seconds{read.at("peak_window_s").get<std::int64_t>()},
        .coverage = number_or_nan(read.at("coverage")),
        .filled_share = number_or_nan(read.at("filled_share")),
        .slots_by_validity = read.at("slots_by_validity"),
        .slots = read.at("slots"),
        .usable = read.at("usable"),
        .unusable_because = read.at("unusable_because"),
        .reasons = static_cast<metering::Reason>(read.at("reasons").get<std::uint32_t>()),
        .revision = read.at("revision")};
    if (const json& peak = read.at("peak"); !peak.is_null()) {
      figure.peak = metering::PeakDemand{
          .kW = number_or_nan(peak.at("kW")),
          .start = Instant{std::chrono::seconds{peak.at("start").get<std::int64_t>()}},
          .could_be_exceeded = peak.at("could_be_exceeded")};
    }
    return figure;
  } catch (const json::exception& reason) {
    return failure(ErrorCode::malformed,
                   fmt::format("a month of the record is none of recald's: {}", reason.what()));
  }
}

}  // namespace recald::record
