#include "core/diagnosis/model_effects.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "core/absent.hpp"
#include "core/model/prior_from_draws.hpp"

namespace recald::diagnosis {
namespace {

using model::hourly::Alteration;
using std::chrono::sys_days;

/// Effects are tabulated up to this tail probability of a fitted prior, and held constant beyond.
constexpr double kTail = 0.005;

/// The first day of the drivers, from which the effect's days are counted. Records store the date
/// of dated effects, and drivers begin with a month, so this is the nearest first of a month.
sys_days origin_of(const AddedEffect& added, const Candidate& candidate, sys_days here) {
  if (!candidate.begins) return here;
  const std::size_t first_day = added.parameters.size() - (candidate.ends ? 2 : 1);
  const auto days = static_cast<int>(std::lround(added.parameters[first_day].q50));
  const sys_days about = sys_days{*added.from} - std::chrono::days{days};
  const auto middle = std::chrono::year_month_day{about + std::chrono::days{14}};
  return sys_days{middle.year() / middle.month() / 1};
}

Error not_usable(const AddedEffect& added, const std::string& why) {
  return {ErrorCode::unsupported, "the model version in force has the effect " + added.effect +
                                      ", " + why + "; `recald model revert` takes it out"};
}

/// The candidate in the current catalogue that was added.
Result<Candidate> candidate_of(const AddedEffect& added, const SiteProblem& site) {
  Candidate candidate{.effect = find_effect(added.effect),
                      .begins = added.from.has_value(),
                      .ends = added.to.has_value()};
  if (candidate.effect == nullptr) {
    return tl::unexpected(not_usable(added, "which the catalogue does not know"));
  }
  if (candidate.effect->of_one_meter) {
    const auto meter = std::ranges::find(site.meters, added.meter, &MeterData::id);
    if (meter == site.meters.end()) {
      return tl::unexpected(
          not_usable(added, "of meter '" + added.meter + "', which is not modelled"));
    }
    candidate.meter = static_cast<int>(meter - site.meters.begin());
  }
  candidate.parameters = candidate.effect->parameters(site.facts());
  const std::size_t own = candidate.parameters.size();
  const std::size_t days = (candidate.begins ? 1 : 0) + (candidate.ends ? 1 : 0);
  const bool same = added.parameters.size() == own + days &&
                    std::ranges::equal(candidate.parameters, std::span{added.parameters}.first(own),
                                       {}, &EffectParameter::name, &EffectParameterRecord::name);
  if (!same) {
    return tl::unexpected(not_usable(added, "with other parameters than the catalogue gives it"));
  }
  for (std::size_t j = own; j < own + days; ++j) {
    const EffectParameterRecord& day = added.parameters[j];
    candidate.parameters.push_back({day.name, day.unit, day.prior, kAbsent});
  }
  return candidate;
}

/// An effect that counts days but has no date does not say from which day.
Result<void> check_days(const AddedEffect& added, const Candidate& candidate,
                        const SiteProblem& site) {
  const bool counts_days =
      !candidate.begins && std::ranges::any_of(added.parameters, [](const auto& parameter) {
        return parameter.unit == "d" || parameter.unit == "day";
      });
  const metering::Month first = site.drivers->months.front();
  if (!counts_days || added.months_used.empty() || added.months_used.front() >= first) return {};
  return tl::unexpected(not_usable(
      added, "whose days count from " + metering::to_string(added.months_used.front()) +
                 " or before, and [period] begins with " + metering::to_string(first) + " only"));
}

std::shared_ptr<const EffectParameterLabel> label_of(const AddedEffect& added,
                                                     const EffectParameterRecord& parameter) {
  auto label = std::make_shared<EffectParameterLabel>();
  label->name = effect_parameter_name(added, parameter);
  label->unit = parameter.unit;
  label->label = added.title + ": " + parameter.name;
  std::ranges::replace(label->label, '_', ' ');
  label->definition = {.name = label->name,
                       .unit = label->unit,
                       .label = label->label,
                       .group = "effect",
                       .range = model::RangeKind::absolute,
                       .low = parameter.prior.min(),
                       .high = parameter.prior.max(),
                       .get = nullptr,
                       .set = nullptr};
  return label;
}

/// The original prior, shifted by whole days.
Prior moved(const Prior& prior, double days) {
  const auto* uniform = std::get_if<UniformPrior>(&prior.distribution());
  if (days == 0.0 || uniform == nullptr) return prior;
  return UniformPrior{uniform->min + days, uniform->max + days};
}

/// Appends the effect's parameters, with its days converted from its own origin to the site's.
void add_parameters(const AddedEffect& added, const Candidate& candidate, Eigen::Index& column,
                    ModelEffects& effects) {
  const sys_days here{effects.site->drivers->hours.front().date};
  const double shift_days = static_cast<double>((origin_of(added, candidate, here) - here).count());
  const std::size_t own =
      added.parameters.size() - (candidate.begins ? 1 : 0) - (candidate.ends ? 1 : 0);
  for (std::size_t j = 0; j < added.parameters.size(); ++j, ++column) {
    const EffectParameterRecord& record = added.parameters[j];
    const double shift = j < own ? 0.0 : shift_days;
    std::vector<double> here_draws = record.draws;
    for (double& draw : here_draws) draw += shift;
    // Effects were added one after the other, so their draws are independent of each other.
    for (Eigen::Index i = 0; i < effects.draws.rows(); ++i) {
      effects.draws(i, column) = here_draws[static_cast<std::size_t>(i) % here_draws.size()];
    }
    effects.labels.push_back(label_of(added, record));
    effects.parameters.push_back({effects.labels.back()->name, record.unit,
                                  prior_from_draws(moved(record.prior, shift), here_draws)});
  }
}

/// Index of the first η of effect `index`, and how many it has.
std::pair<std::size_t, std::size_t> place_of(const ModelEffects& effects, std::size_t index) {
  std::size_t first = 0;
  for (std::size_t e = 0; e < index; ++e) first += effects.added[e].parameters.size();
  return {first, effects.added[index].parameters.size()};
}

}  // namespace

std::vector<double> ModelEffects::mean() const {
  const Eigen::RowVectorXd mean = draws.colwise().mean();
  return {mean.begin(), mean.end()};
}

std::vector<std::shared_ptr<const Alteration>> ModelEffects::alterations(
    std::span<const double> eta) const {
  assert(eta.size() == parameters.size());
  const SiteFacts facts = site->facts();
  std::vector<std::shared_ptr<const Alteration>> bound;
  for (std::size_t e = 0; e < candidates.size(); ++e) {
    const auto [first, count] = place_of(*this, e);
    bound.push_back(alteration_of(candidates[e], facts, eta.subspan(first, count)));
  }
  return bound;
}

std::vector<MonthlyEffect> ModelEffects::monthly(std::span<const Parameter> theta) const {
  const auto spreads = spreads_of(theta);
  const auto at_mean = alterations(mean());
  std::vector<MonthlyEffect> tables;
  std::vector<std::shared_ptr<const Alteration>> before;
  for (std::size_t e = 0; e < candidates.size(); ++e) {
    const auto [first, count] = place_of(*this, e);
    std::vector<ParameterRange> ranges;
    for (std::size_t j = first; j < first + count; ++j) {
      const auto column = draws.col(static_cast<Eigen::Index>(j));
      const Prior& prior = parameters[j].prior;
      ranges.push_back({std::min(column.minCoeff(), prior.quantile(kTail)),
                        std::max(column.maxCoeff(), prior.quantile(1.0 - kTail))});
    }
    tables.push_back(tabulate_effect(*site, before, candidates[e], ranges, spreads));
    before.push_back(at_mean[e]);
  }
  return tables;
}

Result<ModelEffects> make_model_effects(std::vector<AddedEffect> added,
                                        std::shared_ptr<const SiteProblem> site) {
  ModelEffects effects;
  effects.site = std::move(site);
  effects.added = std::move(added);
  Eigen::Index parameters = 0;
  std::size_t draws = 0;
  for (const AddedEffect& effect : effects.added) {
    auto candidate = TRY(candidate_of(effect, *effects.site));
    TRY(check_days(effect, candidate, *effects.site));
    for (const EffectParameterRecord& parameter : effect.parameters) {
      if (parameter.draws.empty()) {
        return failure(ErrorCode::not_enough_data,
                       "the effect " + effect.effect +
                           " of the model version in force has no posterior draws of " +
                           parameter.name);
      }
      draws = std::max(draws, parameter.draws.size());
    }
    parameters += static_cast<Eigen::Index>(effect.parameters.size());
    effects.candidates.push_back(std::move(candidate));
  }
  effects.draws.resize(static_cast<Eigen::Index>(draws), parameters);
  Eigen::Index column = 0;
  for (std::size_t e = 0; e < effects.added.size(); ++e) {
    add_parameters(effects.added[e], effects.candidates[e], column, effects);
  }
  return effects;
}

/// Holds the effect that is currently bound.
class AlteredHourlyModel::Slot final : public Alteration {
 public:
  void put(std::shared_ptr<const Alteration> effect) { effect_ = std::move(effect); }

  void rebuild(model::Building& building) const override { effect_->rebuild(building); }
  [[nodiscard]] model::hourly::DayRange rebuilt() const override { return effect_->rebuilt(); }
  void operate(const model::DriverHour& hour,
               model::hourly::StepOperation& operation) const override {
    effect_->operate(hour, operation);
  }
  void supply(const model::Building& building, const model::DriverHour& hour,
              const model::hourly::StepOperation& operation,
              model::hourly::StepLoads& loads) const override {
    effect_->supply(building, hour, operation, loads);
  }
  void record(std::span<const model::DriverHour> hours, int meter,
              std::span<double> power_kW) const override {
    effect_->record(hours, meter, power_kW);
  }

 private:
  std::shared_ptr<const Alteration> effect_;
};

AlteredHourlyModel::AlteredHourlyModel(Factory make, std::shared_ptr<const ModelEffects> effects)
    : make_(std::move(make)), effects_(std::move(effects)) {
  std::vector<std::shared_ptr<const Alteration>> in_order;
  for (std::size_t e = 0; e < effects_->added.size(); ++e) {
    slots_.push_back(std::make_shared<Slot>());
    in_order.push_back(slots_.back());
  }
  model_ = make_(std::move(in_order));
  bind(effects_->mean());
}

AlteredHourlyModel::~AlteredHourlyModel() = default;

/// The clone has its own slots: clones run in parallel with different η.
std::unique_ptr<MonthlyModel> AlteredHourlyModel::clone() const {
  return std::make_unique<AlteredHourlyModel>(make_, effects_);
}

int AlteredHourlyModel::parameter_count() const {
  return model_->parameter_count() + static_cast<int>(effects_->parameters.size());
}

void AlteredHourlyModel::bind(std::span<const double> eta) {
  eta_.assign(eta.begin(), eta.end());
  const auto bound = effects_->alterations(eta);
  for (std::size_t e = 0; e < slots_.size(); ++e) slots_[e]->put(bound[e]);
}

void AlteredHourlyModel::evaluate(std::span<const double> theta_and_eta,
                                  std::span<double> outputs) {
  const auto q = static_cast<std::size_t>(model_->parameter_count());
  assert(theta_and_eta.size() == q + effects_->parameters.size());
  const std::span<const double> eta = theta_and_eta.subspan(q);
  if (!std::ranges::equal(eta, eta_)) bind(eta);
  model_->evaluate(theta_and_eta.first(q), outputs);
}

}  // namespace recald::diagnosis
