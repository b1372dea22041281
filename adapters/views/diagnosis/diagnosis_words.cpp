#include "adapters/views/diagnosis/diagnosis_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "adapters/views/frame/cost_words.hpp"
#include "adapters/views/frame/format.hpp"
#include "core/absent.hpp"
#include "core/diagnosis/effect_posterior.hpp"
#include "core/display/id_words.hpp"
#include "core/display/prose.hpp"
#include "core/display/unit.hpp"
#include "core/display/warning.hpp"

namespace recald::views {
namespace {

using diagnosis::Addition;
using diagnosis::ChangeInterval;
using diagnosis::Diagnosis;
using diagnosis::ModelGap;
using diagnosis::NameProbability;
using diagnosis::NotIdentifiable;
using diagnosis::Outcome;
using diagnosis::ParameterPosterior;
using diagnosis::SiteProblem;

constexpr std::size_t kFindingsInWords = 5;
constexpr std::size_t kCandidatesInWords = 5;
// Changes smaller than this share of an effect's largest change are not mentioned.
constexpr double kImpactWorthAWord = 0.05;
constexpr double kLeastImpact_kWh = 0.5;
// Beyond ten times the simulation a percentage says nothing: almost nothing is simulated there.
constexpr double kSharePeopleRead = 10.0;
// Below this probability the likeliest effect is not worth a measurement.
constexpr double kLeadWorthMeasuring = 0.1;

std::string quoted_label(const SiteProblem& site, std::string_view effect, int meter) {
  return "\"" + effect_label(site, effect, meter) + "\"";
}

std::string label_of(const SiteProblem& site, const Addition& addition) {
  return quoted_label(site, addition.candidate.effect->id, addition.candidate.meter);
}

/// "a", "a and b", "a, b and c"
std::string listed(const std::vector<std::string>& items, const char* last) {
  std::string text;
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (i > 0) text += i + 1 == items.size() ? fmt::format(" {} ", last) : ", ";
    text += items[i];
  }
  return text;
}

std::string sentence_of(std::string words) {
  if (words.empty()) return words;
  if (words.front() >= 'a' && words.front() <= 'z') words.front() -= 'a' - 'A';
  return words + ".";
}

/// "about 4,200 kWh a month more at Steam and 120 kWh a month less at Chilled water"
std::string impact_words(const SiteProblem& site, const Addition& addition) {
  double most = 0.0;
  for (const double kWh : addition.monthly_kWh) most = std::max(most, std::abs(kWh));
  std::vector<std::string> items;
  for (std::size_t g = 0; g < addition.monthly_kWh.size(); ++g) {
    const double kWh = addition.monthly_kWh[g];
    if (!(std::abs(kWh) > std::max(kImpactWorthAWord * most, kLeastImpact_kWh))) continue;
    const display::Unit unit = display::unit_of(site.units, "kWh", site.meters[g].utility);
    const double shown = unit.shown(std::abs(kWh));
    items.push_back(fmt::format(
        "{} {} a month {} at {}", shown < 10.0 ? number_text(shown) : count_text(shown), unit.name,
        kWh > 0.0 ? "more" : "less", display::meter_label(site.meters[g].id)));
  }
  return items.empty() ? "no change in any meter's months" : "about " + listed(items, "and");
}

/// "It costs about 1,240 USD and 2.1 t of CO2 a year."; empty where no price is known.
std::string addition_cost(const SiteProblem& site, std::span<const double> monthly_kWh) {
  std::optional<double> money;
  std::optional<double> emissions_kg;
  for (std::size_t g = 0; g < monthly_kWh.size(); ++g) {
    const diagnosis::MeterData& meter = site.meters[g];
    if (meter.price_per_kWh) money = money.value_or(0.0) + *meter.price_per_kWh * monthly_kWh[g];
    if (meter.emissions_kg_per_kWh) {
      emissions_kg = emissions_kg.value_or(0.0) + *meter.emissions_kg_per_kWh * monthly_kWh[g];
    }
  }
  return cost_words(money, emissions_kg, site.currency);
}

std::string addition_words(const SiteProblem& site, const Addition& addition) {
  std::string text =
      fmt::format("{}: {} Probability {}. {} It makes {}.", label_of(site, addition),
                  addition.candidate.effect->meaning, probability_text(addition.probability),
                  when_words(site, addition), impact_words(site, addition));
  const std::string cost = addition_cost(site, addition.monthly_kWh);
  return cost.empty() ? text : text + " " + cost;
}

std::string confirmation_words(const Diagnosis& d, const SiteProblem& site) {
  if (!d.gap) {
    // If something was withdrawn for that reason, the reason is stated already.
    return d.not_confirmed ? ""
                           : "The held-out months have no readings, so nothing confirms this yet.";
  }
  std::vector<std::string> items;
  for (std::size_t g = 0; g < d.gap->before.size(); ++g) {
    items.push_back(
        fmt::format("{} {:.1f} % before, {:.1f} % after", display::meter_label(site.meters[g].id),
                    100.0 * d.gap->before[g].cvrmse_daily, 100.0 * d.gap->after[g].cvrmse_daily));
  }
  const auto kept = std::ranges::count(site.month_roles, diagnosis::Role::show);
  return fmt::format("Scatter of days (CV(RMSE)) in the {} held-out months: {}.", kept,
                     listed(items, "and"));
}

/// Empty where the model has nothing to judge by.
std::string other_model_words(const ModelGap& gap) {
  std::vector<std::string> items;
  for (std::size_t i = 0; i < gap.change.size(); ++i) {
    const ChangeInterval& change = gap.change[i].cvrmse;
    if (!std::isfinite(gap.before[i].cvrmse) || !std::isfinite(change.low)) continue;
    items.push_back(fmt::format(
        "{} {:.1f} % before, {:.1f} % after (90 % interval of the change: {:+.1f} to {:+.1f})",
        display::capitalised(display::output_words(gap.outputs[i])), 100.0 * gap.before[i].cvrmse,
        100.0 * gap.after[i].cvrmse, 100.0 * change.low, 100.0 * change.high));
  }
  if (items.empty()) return {};
  return fmt::format("Scatter of months in the {} model: {}.",
                     gap.model == ModelKind::energyplus ? "EnergyPlus" : "monthly",
                     listed(items, "and"));
}

/// What remains unexplained after the last search.
std::string remainder_words(const Diagnosis& d) {
  const diagnosis::Pass& last = d.passes.back();
  if (d.passes.size() < 2 || last.located.empty()) return {};
  return fmt::format(
      "Some disagreement remains: {} places still stand out (diagnosis.json lists the clearest); "
      "{}.",
      last.located.size(), last.naming.why);
}

/// The members of the confusable set with their meters, the likeliest first.
std::vector<std::pair<std::string, int>> confusable_names(const diagnosis::Naming& naming) {
  std::vector<std::pair<std::string, int>> names;
  for (const NameProbability& p : naming.probabilities) {
    const bool in_set = std::ranges::count(naming.confusable, p.effect) > 0;
    if (in_set && names.size() < naming.confusable.size()) names.emplace_back(p.effect, p.meter);
  }
  return names;
}

std::string confusable_headline(const Diagnosis& d, const SiteProblem& site) {
  std::vector<std::string> labels;
  for (const auto& [id, meter] : confusable_names(d.passes.front().naming)) {
    labels.push_back(quoted_label(site, id, meter));
  }
  return fmt::format("{} explanations fit equally well: {}.",
                     labels.size() == 2 ? "Two" : "Several", listed(labels, "or"));
}

std::string headline_of(const Diagnosis& d, const SiteProblem& site) {
  std::vector<std::string> labels;
  for (const Addition& addition : d.added) labels.push_back(label_of(site, addition));
  if (d.not_confirmed) {
    return fmt::format("Not confirmed: {} {} tried and withdrawn.", listed(labels, "and"),
                       labels.size() == 1 ? "was" : "were");
  }
  switch (d.outcome) {
    case Outcome::named:
      return fmt::format("Missing from the model: {}.", listed(labels, "and"));
    case Outcome::confusable:
      return confusable_headline(d, site);
    case Outcome::unknown:
      return "Something is missing from the model, but recald cannot tell what.";
    case Outcome::none:
      break;
  }
  return d.passes.front().located.empty()
             ? "The calibrated model agrees with the meters within chance."
             : "No missing effect was found.";
}

std::string find_it_words(const Diagnosis& d) {
  return d.passes.front().located.empty() ? ""
                                          : "Ask the building's operators what happens at the "
                                            "places where meters and model disagree.";
}

std::vector<std::string> separation_sentences(const Diagnosis& d, const SiteProblem& site) {
  std::vector<std::string> sentences;
  for (const Separation& s : separations_of(d, site)) {
    sentences.push_back(
        fmt::format("To tell \"{}\" from \"{}\": {}", s.effect, s.rival, s.measurement));
  }
  if (sentences.empty()) {
    sentences.emplace_back("The catalogue has no measurement that would tell them apart.");
  }
  return sentences;
}

/// The effects whose rivals are worth knowing.
std::vector<std::pair<std::string, int>> leads_of(const Diagnosis& d) {
  std::vector<std::pair<std::string, int>> leads;
  if (!d.added.empty()) {
    for (const Addition& addition : d.added) {
      leads.emplace_back(addition.candidate.effect->id, addition.candidate.meter);
    }
    return leads;
  }
  const diagnosis::Naming& naming = d.passes.front().naming;
  if (!naming.confusable.empty()) return confusable_names(naming);
  const auto first = std::ranges::find_if(
      naming.probabilities, [](const NameProbability& p) { return p.explanation.has_value(); });
  if (first != naming.probabilities.end() && first->probability >= kLeadWorthMeasuring) {
    leads.emplace_back(first->effect, first->meter);
  }
  return leads;
}

/// Summed over the meters of an effect; NaN where it was not weighed.
double probability_of(const diagnosis::Naming& naming, std::string_view effect) {
  double sum = kAbsent;
  for (const NameProbability& p : naming.probabilities) {
    if (p.effect == effect) sum = (std::isnan(sum) ? 0.0 : sum) + p.probability;
  }
  return sum;
}

std::string located_words(const Diagnosis& d, const SiteProblem& site) {
  const auto& located = d.passes.front().located;
  if (located.empty())
    return "No single hour, weather condition or month stands out beyond chance.\n";
  std::string text = "Where simulation and meters disagree most:\n";
  for (std::size_t i = 0; i < std::min(located.size(), kFindingsInWords); ++i) {
    const diagnosis::Misfit& f = located[i];
    const std::string share =
        std::abs(f.share) > kSharePeopleRead
            ? "the simulation has almost nothing there"
            : fmt::format("{:+.0f} % +- {:.0f}", 100.0 * f.share, 100.0 * f.share_se);
    text += fmt::format(
        "  {}, {}: {}, {} a month\n", display::meter_label(site.meters[f.meter].id), f.words, share,
        signed_amount_text(f.kWh_month,
                           display::unit_of(site.units, "kWh", site.meters[f.meter].utility)));
  }
  return text;
}

std::string probability_words(const Diagnosis& d, const SiteProblem& site) {
  std::string text = "Explanations:\n";
  const auto& probabilities = d.passes.front().naming.probabilities;
  for (std::size_t i = 0; i < std::min(probabilities.size(), kCandidatesInWords); ++i) {
    const NameProbability& p = probabilities[i];
    text += fmt::format("  {:5.1f} %  {}\n", 100.0 * p.probability,
                        effect_label(site, p.effect, p.meter));
  }
  return text;
}

}  // namespace

std::string effect_label(const SiteProblem& site, std::string_view effect, int meter) {
  if (effect == "none") return "No effect";
  if (effect == "unknown") return "Something else";
  const diagnosis::Effect* entry = diagnosis::find_effect(effect);
  const std::string title{entry == nullptr ? effect : entry->title};
  if (meter < 0) return title;
  return fmt::format("{} ({})", title,
                     display::meter_label(site.meters[static_cast<std::size_t>(meter)].id));
}

std::string day_words(metering::Day day) {
  return fmt::format("{} {}", unsigned{day.day()}, month_text(day.year() / day.month()));
}

std::string when_words(const SiteProblem& site, const Addition& addition) {
  const diagnosis::Candidate& candidate = addition.candidate;
  if (!candidate.begins && !candidate.ends) return "Throughout the record.";
  const std::vector<ParameterPosterior> posterior = posterior_of(addition);
  const auto day_with_range = [&](const ParameterPosterior& p) {
    return fmt::format("{} (90 %: {} to {})", day_words(day_after(site, p.mode)),
                       day_words(day_after(site, p.q05)), day_words(day_after(site, p.q95)));
  };
  // The days come after the effect's own parameters, the first before the last.
  const ParameterPosterior& last = posterior.back();
  if (!candidate.ends) return fmt::format("Since about {}.", day_with_range(last));
  if (!candidate.begins) return fmt::format("Until about {}.", day_with_range(last));
  return fmt::format("From about {} until about {}.", day_with_range(*(posterior.end() - 2)),
                     day_with_range(last));
}

std::vector<Separation> separations_of(const Diagnosis& d, const SiteProblem& site) {
  const diagnosis::Naming& naming = d.passes.front().naming;
  std::vector<Separation> list;
  for (const auto& [id, meter] : leads_of(d)) {
    const diagnosis::Effect* effect = diagnosis::find_effect(id);
    if (effect == nullptr) continue;
    for (const diagnosis::Confusable& rival : effect->confusable) {
      const bool in_set = std::ranges::count(naming.confusable, rival.effect) > 0;
      if (d.outcome == Outcome::confusable && !in_set) continue;
      list.push_back({.effect = effect_label(site, id, meter),
                      .rival = effect_label(site, rival.effect, -1),
                      .rival_probability = probability_of(naming, rival.effect),
                      .measurement = display::with_temperatures_in(
                          site.units, std::string{rival.separated_by})});
    }
  }
  return list;
}

std::vector<NotIdentifiable> not_seen_here(const Diagnosis& d) {
  std::vector<NotIdentifiable> list = d.not_identifiable;
  const auto is_reported = [&](std::string_view effect) {
    return std::ranges::any_of(list, [&](const NotIdentifiable& n) { return n.effect == effect; });
  };
  const auto was_weighed = [&](std::string_view effect) {
    return std::ranges::any_of(d.passes.front().naming.probabilities,
                               [&](const NameProbability& p) { return p.effect == effect; });
  };
  if (!was_weighed("none")) return list;  // an effect was assumed, and no other was asked for
  // An effect stands in the list of candidates once for each meter and way of dating it.
  for (const diagnosis::Candidate& candidate : d.candidates) {
    const std::string_view effect = candidate.effect->id;
    if (is_reported(effect) || was_weighed(effect)) continue;
    list.push_back({std::string{effect}, "it would not show at these meters"});
  }
  return list;
}

OutcomeWords outcome_words(const Diagnosis& d, const SiteProblem& site,
                           const std::vector<ModelGap>& others) {
  OutcomeWords words{.headline = headline_of(d, site), .sentences = {}};
  const auto add = [&words](std::string sentence) {
    if (!sentence.empty()) words.sentences.push_back(std::move(sentence));
  };
  add(sentence_of(d.why));
  if (!d.added.empty()) {
    add(confirmation_words(d, site));
    for (const ModelGap& gap : others) add(other_model_words(gap));
    if (!d.not_confirmed) add(remainder_words(d));
    return words;
  }
  if (d.outcome == Outcome::confusable) {
    for (std::string& sentence : separation_sentences(d, site)) add(std::move(sentence));
  } else {
    add(find_it_words(d));
  }
  return words;
}

std::string most_likely_words(const Diagnosis& d, const SiteProblem& site) {
  if (d.not_confirmed || d.added.empty()) return headline_of(d, site);
  const diagnosis::Candidate& candidate = d.added.front().candidate;
  std::string meaning{candidate.effect->meaning};
  meaning = display::uncapitalised(std::move(meaning));
  if (candidate.meter < 0) return "Most likely: " + meaning;
  const std::string& meter = site.meters[static_cast<std::size_t>(candidate.meter)].id;
  return fmt::format("Most likely ({}): {}", display::meter_label(meter), meaning);
}

std::string diagnosis_words(const Diagnosis& d, const SiteProblem& site,
                            const std::vector<ModelGap>& others) {
  const OutcomeWords words = outcome_words(d, site, others);
  std::string text = fmt::format("Outcome: {}. {}\n", to_string(d.outcome), words.headline);
  text += located_words(d, site) + probability_words(d, site);
  for (const Addition& addition : d.added) {
    text += fmt::format("{}{}\n", d.not_confirmed ? "Tried and withdrawn: " : "",
                        addition_words(site, addition));
  }
  for (const std::string& sentence : words.sentences) text += sentence + "\n";
  return text + display::warning_lines(d.warnings);
}

}  // namespace recald::views
