#include "adapters/csv/row_steps.hpp"

#include <algorithm>
#include <array>
#include <map>

namespace recald::csv {

using metering::Instant;
using std::chrono::seconds;

std::optional<StampSteps> steps_of(std::vector<Instant> stamps) {
  std::sort(stamps.begin(), stamps.end());
  std::vector<seconds> steps;
  std::map<seconds, int> counts;
  for (std::size_t i = 1; i < stamps.size(); ++i) {
    if (stamps[i] == stamps[i - 1]) continue;
    steps.push_back(stamps[i] - stamps[i - 1]);
    ++counts[steps.back()];
  }
  if (steps.empty()) return {};
  const auto most =
      std::max_element(counts.begin(), counts.end(),
                       [](const auto& a, const auto& b) { return a.second < b.second; });
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return StampSteps{.commonest = most->first,
                    .median = *middle,
                    .share = static_cast<double>(most->second) / static_cast<double>(steps.size()),
                    .are_multiples = std::all_of(steps.begin(), steps.end(), [&](seconds step) {
                      return step % most->first == seconds{0};
                    })};
}

bool is_interval(seconds step) {
  return step >= kIntervalMin && step <= kIntervalMax && step % kIntervalMin == seconds{0} &&
         kIntervalMax % step == seconds{0};
}

std::optional<seconds> interval_for(seconds step) {
  constexpr std::array kMinutes{1, 5, 10, 15, 30, 60};
  for (const int minutes : kMinutes) {
    const seconds interval = std::chrono::minutes{minutes};
    if (10 * step <= 11 * interval) return interval;
  }
  return {};
}

std::string in_words(seconds span) {
  constexpr std::int64_t kDay_s = 86'400;
  if (span.count() >= 2 * kDay_s) return std::to_string(span.count() / kDay_s) + " days";
  if (span.count() == kDay_s) return "day";
  if (span.count() == 60) return "minute";
  return span.count() % 60 == 0 ? std::to_string(span.count() / 60) + " minutes"
                                : std::to_string(span.count()) + " seconds";
}

std::vector<std::string> step_sentences(std::span<const RowStep> steps, seconds interval) {
  std::vector<std::string> sentences;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const RowStep& one = steps[i];
    const bool is_usual = one.step == interval;
    if (is_usual && i == 0) continue;
    std::string words = i == 0 ? "Its rows come every " + in_words(one.step)
                               : "From row " + std::to_string(one.line) + " (" +
                                     metering::to_string(one.stamp) + ") on its rows come every " +
                                     in_words(one.step) + ", before that every " +
                                     in_words(steps[i - 1].step);
    if (one.spread > 0) {
      words += "; each of these " + std::to_string(one.spread) +
               " counts evenly over its time, as an estimate: sums are right, peaks are not";
    }
    if (one.left_out > 0) {
      words += "; these " + std::to_string(one.left_out) + " rows are left out, for " +
               (one.step > kIntervalMax
                    ? "recald needs values of an hour or less"
                    : "they are longer than its interval of " + in_words(interval) +
                          "; write interval = \"" + std::to_string(one.step.count() / 60) +
                          "m\" to have both");
    } else if (!is_usual && one.spread == 0) {
      words += "; its intervals of " + in_words(interval) + " are means of them";
    }
    sentences.push_back(words + ".");
  }
  return sentences;
}

}  // namespace recald::csv
