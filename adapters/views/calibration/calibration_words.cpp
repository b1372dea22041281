#include "adapters/views/calibration/calibration_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "adapters/views/frame/format.hpp"
#include "core/absent.hpp"
#include "core/assessment/fit_metrics.hpp"
#include "core/display/id_words.hpp"
#include "core/text/number_text.hpp"

namespace recald::views {
namespace {

constexpr std::size_t kFitNumbers = 3;
/// A bias that grows by less is the same to whoever reads it.
constexpr double kNoticeableBias = 0.01;
/// A bias that keeps so much of its size was not mended.
constexpr double kMended = 0.5;

std::string whole_percent(double share) {
  return fmt::format("{:.0f}\u00a0%", 100.0 * std::abs(share));
}

/// "22 % too little chilled water"
std::string too_much_words(const FittedMeter& meter) {
  return fmt::format("{} too {} {}", whole_percent(meter.after),
                     meter.after < 0.0 ? "little" : "much", display::uncapitalised(meter.label));
}

bool has_become_worse(const FittedMeter& meter) {
  return std::abs(meter.after) > std::abs(meter.before) + kNoticeableBias;
}

const FittedMeter& farthest(const std::vector<FittedMeter>& meters) {
  return *std::ranges::max_element(meters, {},
                                   [](const FittedMeter& meter) { return std::abs(meter.after); });
}

void report_worse(const FittedMeter& meter, FirstScreen& first) {
  first.sentence =
      fmt::format("Calibration made the model worse: it now uses {}, and was {} off before.",
                  too_much_words(meter), whole_percent(meter.before));
  first.more =
      std::abs(meter.after) > assessment::kMonthlyLimits.nmbe
          ? "Something is missing in the model, and calibration has bent the parameters to "
            "make up for it. The forecasts correct for that; savings computed from the "
            "model do not."
          : "The forecasts correct for that; savings computed from the model do not.";
}

void report_bias(const FittedMeter& meter, FirstScreen& first) {
  const bool was_off = std::isfinite(meter.before);
  const bool mended = was_off && std::abs(meter.after) < kMended * std::abs(meter.before);
  first.sentence = fmt::format("The model uses {}; ", too_much_words(meter));
  if (mended) {
    first.sentence += fmt::format("calibration mended part of that, it was {} off before.",
                                  whole_percent(meter.before));
    first.more = "What is left may be something that the model lacks.";
  } else {
    first.sentence += "calibration did not mend that: something is missing in it.";
  }
}

void report_scatter(const FittedMeter& meter, FirstScreen& first) {
  first.sentence =
      fmt::format("The model uses the right amount of {} over the year, but its months are {} off.",
                  display::uncapitalised(meter.label), whole_percent(meter.scatter));
  first.more = "Something that changes with the season may be missing in it.";
}

void report_good_fit(const std::vector<FittedMeter>& meters, FirstScreen& first) {
  const double most = std::abs(farthest(meters).after);
  const bool unseen = meters.front().unseen;
  first.sentence =
      fmt::format("The model uses what the {} show{}, to within {}.",
                  meters.size() == 1 ? "meter" : "meters", meters.size() == 1 ? "s" : "",
                  whole_percent(std::ceil(100.0 * std::max(most, 0.001)) / 100.0));
  first.more = unseen ? "That holds in months that it was not fitted to."
                      : "No month was kept back to check it with.";
}

std::string months_words(const FittedMeter& meter) {
  return meter.unseen ? "in months that were not fitted" : "in the fitted months";
}

std::vector<KeyNumber> numbers_of(const std::vector<FittedMeter>& meters) {
  std::vector<KeyNumber> numbers;
  const auto add = [&](double share, std::string what) {
    if (numbers.size() < kFitNumbers && std::isfinite(share)) {
      numbers.push_back({signed_percent_text(share), std::move(what)});
    }
  };
  for (const FittedMeter& meter : meters) {
    add(meter.after, fmt::format("{}, model against meter {}", meter.label, months_words(meter)));
  }
  for (const FittedMeter& meter : meters) {
    if (meter.forecast) {
      add(*meter.forecast, meter.label + ", forecast against meter, errors of the model included");
    }
  }
  for (const FittedMeter& meter : meters) {
    add(meter.before, meter.label + ", model against meter before calibration");
  }
  return numbers;
}

}  // namespace

std::optional<FittedMeter> fitted_meter(std::string label,
                                        const assessment::OutputAssessment& fit) {
  FittedMeter meter{
      .label = std::move(label), .before = kAbsent, .after = kAbsent, .scatter = kAbsent};
  meter.unseen = fit.after.validation.has_value();
  const auto of = [&](const assessment::PeriodMetrics& stage) {
    return meter.unseen ? stage.validation : stage.calibration;
  };
  const auto after = of(fit.after);
  if (!after) return std::nullopt;
  meter.after = after->nmbe_sim_minus_meas;
  meter.scatter = after->cvrmse;
  if (const auto before = of(fit.before)) meter.before = before->nmbe_sim_minus_meas;
  const auto& forecast = meter.unseen ? fit.forecast.validation : fit.forecast.blocks;
  if (forecast.metrics) meter.forecast = forecast.metrics->nmbe_sim_minus_meas;
  return meter;
}

bool asks_for_diagnosis(const std::vector<FittedMeter>& meters) {
  return std::ranges::any_of(meters, [](const FittedMeter& meter) {
    return std::abs(meter.after) > assessment::kMonthlyLimits.nmbe ||
           meter.scatter > assessment::kMonthlyLimits.cvrmse;
  });
}

FirstScreen calibration_first_screen(const std::vector<FittedMeter>& meters, bool converged) {
  FirstScreen first;
  if (meters.empty()) {
    first.sentence = "No meter has enough measured months to judge the model by.";
    return first;
  }
  std::vector<FittedMeter> by_bias = meters;
  std::ranges::stable_sort(by_bias, std::greater{},
                           [](const FittedMeter& meter) { return std::abs(meter.after); });
  const auto worse = std::ranges::find_if(by_bias, has_become_worse);
  const auto scattered = std::ranges::max_element(by_bias, {}, &FittedMeter::scatter);
  if (worse != by_bias.end()) {
    report_worse(*worse, first);
  } else if (std::abs(by_bias.front().after) > assessment::kMonthlyLimits.nmbe) {
    report_bias(by_bias.front(), first);
  } else if (scattered->scatter > assessment::kMonthlyLimits.cvrmse) {
    report_scatter(*scattered, first);
  } else {
    report_good_fit(by_bias, first);
  }
  if (!converged) {
    first.more = first.sentence + (first.more.empty() ? "" : " " + first.more);
    first.sentence = "This calibration is rough: its chains have not converged.";
  }
  first.numbers = numbers_of(by_bias);
  return first;
}

}  // namespace recald::views
