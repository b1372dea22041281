#include "adapters/views/meters/meters_words.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "adapters/views/frame/format.hpp"
#include "core/text/number_text.hpp"

namespace recald::views {
namespace {

using metering::LevelChange;
using metering::LevelChangeKind;
using metering::Month;
using metering::MonthlyFigure;

constexpr int kLeastCompared = 6;
constexpr double kNoticeableChange = 0.05;
constexpr std::size_t kMeterNumbers = 3;

double month_kWh(const MonthlyFigure& figure) {
  return figure.daily_average_kWh * metering::days_in(figure.month);
}

const MonthlyFigure* usable_month(const std::vector<MonthlyFigure>& figures, Month month) {
  const auto found = std::ranges::find(figures, month, &MonthlyFigure::month);
  return found != figures.end() && found->usable ? &*found : nullptr;
}

/// "812 MWh" @pre story.year
std::string used_text(const MeterStory& story) {
  return amount_text(story.year->energy_kWh / 1000.0, story.units.large_energy);
}

/// "12 % more", "3 % less"
std::string more_or_less(double change) {
  return fmt::format("{:.0f}\u00a0% {}", 100.0 * std::abs(change), change < 0.0 ? "less" : "more");
}

double deviation(const assessment::UnseenMean& unseen) {
  return unseen.measured / unseen.forecast.mean - 1.0;
}

bool is_surprising(const assessment::UnseenMean& unseen) {
  return unseen.measured < unseen.forecast.q05 || unseen.measured > unseen.forecast.q95;
}

/// The largest of what `size` says, or null where it says nothing of any. @param size  NaN:
/// nothing.
const MeterStory* largest(const std::vector<MeterStory>& stories,
                          const std::function<double(const MeterStory&)>& size) {
  const MeterStory* best = nullptr;
  double best_size = 0.0;
  for (const MeterStory& story : stories) {
    const double own = size(story);
    if (!(own > best_size)) continue;
    best = &story;
    best_size = own;
  }
  return best;
}

double change_size(const MeterStory& story) {
  return story.year && story.year->change ? std::abs(*story.year->change) : NAN;
}

double surprise_size(const MeterStory& story) {
  return story.unseen && is_surprising(*story.unseen) ? std::abs(deviation(*story.unseen)) : NAN;
}

/// The gravest change of level that has not ended. A changed unit is graver than any other.
std::string level_sentence(const std::vector<MeterStory>& stories) {
  const MeterStory* of = nullptr;
  const LevelChange* gravest = nullptr;
  const auto weight = [](const LevelChange& change) {
    return (change.kind == LevelChangeKind::scale ? 100.0 : 0.0) + std::abs(std::log(change.ratio));
  };
  for (const MeterStory& story : stories) {
    for (const LevelChange& change : story.changes) {
      if (change.back_since || (gravest != nullptr && weight(change) <= weight(*gravest))) continue;
      gravest = &change;
      of = &story;
    }
  }
  return gravest == nullptr ? "" : change_words(of->label, *gravest);
}

std::string surprise_sentence(const std::vector<MeterStory>& stories) {
  const MeterStory* story = largest(stories, surprise_size);
  if (story == nullptr) return "";
  return fmt::format("{} used {} than its weather led to expect.", story->label,
                     more_or_less(deviation(*story->unseen)));
}

std::string year_sentence(const std::vector<MeterStory>& stories) {
  const MeterStory* story = largest(stories, change_size);
  if (story == nullptr) return "";
  if (change_size(*story) < kNoticeableChange) {
    return "No meter used much more or less than a year before.";
  }
  std::string text = fmt::format("{} used {} in the {} months to {} than a year before.",
                                 story->label, more_or_less(*story->year->change),
                                 story->year->compared, month_text(story->year->last));
  const auto others = std::ranges::count_if(stories, [&](const MeterStory& other) {
    return &other != story && change_size(other) < kNoticeableChange;
  });
  if (others > 0 && others + 1 == std::ssize(stories)) {
    text += others == 1 ? " The other meter changed by less than 5\u00a0%."
                        : " The other meters changed by less than 5\u00a0%.";
  }
  return text;
}

std::string use_sentence(const std::vector<MeterStory>& stories) {
  std::vector<std::string> uses;
  for (const MeterStory& story : stories) {
    if (!story.year || uses.size() == kMeterNumbers) continue;
    uses.push_back(fmt::format("{}: {} in {} month{} to {}", story.label, used_text(story),
                               story.year->months, story.year->months == 1 ? "" : "s",
                               month_text(story.year->last)));
  }
  if (uses.empty()) return "No meter has a month that can be used.";
  return fmt::format("{}.", fmt::join(uses, "; "));
}

/// What weather explains, of the meters that it was asked about.
std::string weather_sentence(const std::vector<MeterStory>& stories) {
  int asked = 0;
  int inside = 0;
  for (const MeterStory& story : stories) {
    if (!story.unseen) continue;
    ++asked;
    if (!is_surprising(*story.unseen)) ++inside;
  }
  if (asked == 0) return "";
  if (asked == 1) {
    return inside == 1 ? "In the months that were not fitted, its weather explains what it used."
                       : "";
  }
  return fmt::format("In the months that were not fitted, the weather explains {} of {} meters.",
                     inside, asked);
}

void add_number(std::vector<KeyNumber>& numbers, std::string number, std::string what) {
  if (numbers.size() < kMeterNumbers) numbers.push_back({std::move(number), std::move(what)});
}

/// First what compares a meter with itself, then what it is by itself.
std::vector<KeyNumber> meter_numbers(const std::vector<MeterStory>& stories) {
  std::vector<KeyNumber> numbers;
  for (const MeterStory& story : stories) {
    if (story.unseen) {
      add_number(numbers, signed_percent_text(deviation(*story.unseen)),
                 story.label + ", against the forecast from its weather");
    } else if (story.year && story.year->change) {
      add_number(numbers, signed_percent_text(*story.year->change),
                 fmt::format("{}, {} months to {} against a year before", story.label,
                             story.year->compared, month_text(story.year->last)));
    }
  }
  for (const MeterStory& story : stories) {
    if (!story.year) continue;
    add_number(numbers, used_text(story),
               fmt::format("{}, {} month{} to {}", story.label, story.year->months,
                           story.year->months == 1 ? "" : "s", month_text(story.year->last)));
  }
  for (const MeterStory& story : stories) {
    if (!std::isfinite(story.base_share)) continue;
    add_number(numbers, percent_text(story.base_share, 0),
               story.label + ", share of the base load");
  }
  return numbers;
}

}  // namespace

std::optional<YearComparison> compare_years(const std::vector<MonthlyFigure>& figures,
                                            const std::vector<LevelChange>& changes) {
  const auto last = std::find_if(figures.rbegin(), figures.rend(),
                                 [](const MonthlyFigure& figure) { return figure.usable; });
  if (last == figures.rend()) return std::nullopt;
  YearComparison year{
      .first = last->month, .last = last->month, .energy_kWh = 0.0, .months = 0, .change = {}};
  double before_kWh = 0.0;
  double later_kWh = 0.0;
  const Month begin = last->month - std::chrono::months{11};
  for (Month month = begin; month <= last->month; month = metering::next_month(month)) {
    const MonthlyFigure* now = usable_month(figures, month);
    if (now == nullptr) continue;
    if (year.months++ == 0) year.first = month;
    year.energy_kWh += month_kWh(*now);
    const MonthlyFigure* before = usable_month(figures, month - std::chrono::months{12});
    if (before == nullptr ||
        metering::is_rescaled(changes, month) != metering::is_rescaled(changes, before->month)) {
      continue;
    }
    later_kWh += month_kWh(*now);
    // Of as many days: a leap day is no other use.
    before_kWh += before->daily_average_kWh * metering::days_in(month);
    ++year.compared;
  }
  if (year.compared >= kLeastCompared && before_kWh > 0.0)
    year.change = later_kWh / before_kWh - 1.0;
  return year;
}

std::string change_words(const std::string& label, const LevelChange& change) {
  if (change.kind == LevelChangeKind::scale) {
    return fmt::format(
        "{} has read about {:.3g} times what it read before since {}: probably a changed unit or "
        "multiplier, not the building.",
        label, change.factor, month_text(change.since));
  }
  const std::string ends =
      change.back_since ? fmt::format("; it is as before since {}", month_text(*change.back_since))
                        : "";
  return fmt::format(
      "{} has changed since {}: {} in that month than in the same "
      "months before{}.",
      label, month_text(change.since), more_or_less(change.ratio - 1.0), ends);
}

FirstScreen first_screen_of(const std::vector<MeterStory>& stories) {
  std::vector<MeterStory> by_size = stories;
  std::ranges::stable_sort(by_size, std::greater{}, [](const MeterStory& story) {
    return story.year ? story.year->energy_kWh : -INFINITY;
  });
  FirstScreen first{.sentence = level_sentence(by_size), .more = {}, .numbers = {}};
  for (const auto& sentence : {surprise_sentence, year_sentence, use_sentence}) {
    if (first.sentence.empty()) first.sentence = sentence(by_size);
  }
  first.more = weather_sentence(by_size);
  first.numbers = meter_numbers(by_size);
  return first;
}

}  // namespace recald::views
