#include "core/diagnosis/evidence/site_problem.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/absent.hpp"

namespace recald::diagnosis {
namespace {

using metering::Utility;

// A first or last day this close to an end of the record shows nothing of the time before or after.
constexpr double kLeastDaysAtEnds = 21.0;

bool has(const SiteProblem& site, Utility utility) {
  return std::ranges::any_of(site.meters,
                             [utility](const MeterData& m) { return m.utility == utility; });
}

bool has_night_set_back(const model::SetPoints& set) {
  return set.heating_unoccupied_C < set.heating_occupied_C ||
         set.cooling_unoccupied_C > set.cooling_occupied_C;
}

/// What is missing to judge the effect, in words; empty: nothing.
std::string lacking(const Effect& effect, const SiteProblem& site) {
  const EffectNeeds& needs = effect.needs;
  const model::Building& b = site.nominal;
  if (needs.air_system && !b.air) {
    return "the site file describes no air handlers or units in rooms";
  }
  if (needs.reheat_boxes && !has_reheat_boxes(b)) {
    return "the site file describes no air handlers with reheat boxes";
  }
  if (needs.humidity && !site.drivers->has_humidity) return "the weather has no humidity";
  if (needs.wind && !site.drivers->has_wind) return "the weather has no wind";
  if (needs.sun && !site.has_sun) return "the weather has no sun";
  if (needs.own_chiller && !b.chiller_cop) return "the site does not have its own chiller";
  if (needs.heat_pump) return "the site file describes no heat pump";
  if (needs.economiser && !(b.air && b.air->economiser_lockout_C)) {
    return "the site file describes no economiser";
  }
  if (needs.night_set_back && !has_night_set_back(b.set_points)) {
    return "the site file describes no night set-back";
  }
  if (!effect.meter_utilities.empty() &&
      std::ranges::none_of(effect.meter_utilities,
                           [&](Utility utility) { return has(site, utility); })) {
    return "the model has no meter of the kind it affects";
  }
  return {};
}

EffectParameter day_parameter(const char* name, double first_day, double last_day) {
  return {name, "day", UniformPrior{first_day, last_day}, kAbsent};
}

Candidate make_candidate(const Effect& effect, const SiteFacts& facts, int meter, Dating dating,
                         double days) {
  Candidate candidate{.effect = &effect,
                      .meter = meter,
                      .begins = dating != Dating::always,
                      .ends = dating == Dating::window,
                      .parameters = effect.parameters(facts)};
  if (candidate.begins) {
    candidate.parameters.push_back(
        day_parameter("first_day", kLeastDaysAtEnds, days - kLeastDaysAtEnds));
  }
  if (candidate.ends) {
    candidate.parameters.push_back(day_parameter("last_day", kLeastDaysAtEnds, days));
  }
  return candidate;
}

void add_candidates(const Effect& effect, const SiteFacts& facts, int meter, double days,
                    std::vector<Candidate>& candidates) {
  using enum Dating;
  const auto add = [&](Dating dating) {
    candidates.push_back(make_candidate(effect, facts, meter, dating, days));
  };
  if (effect.dating == may_begin) {
    add(always);
    add(must_begin);
  } else {
    add(effect.dating);
  }
}

}  // namespace

SiteFacts SiteProblem::facts() const {
  SiteFacts facts{.building = nominal, .drivers = *drivers, .utilities = {}, .mean_kW = {}};
  for (std::size_t g = 0; g < meters.size(); ++g) {
    facts.utilities.push_back(meters[g].utility);
    double sum = 0.0;
    int n = 0;
    for (Eigen::Index i = 0; i < measured_parts_kW.rows(); ++i) {
      const double value = measured_parts_kW(i, static_cast<Eigen::Index>(g));
      if (!std::isfinite(value)) continue;
      sum += value;
      ++n;
    }
    facts.mean_kW.push_back(n > 0 ? sum / n : 0.0);
  }
  return facts;
}

SiteProblem without_shown_months(SiteProblem site) {
  for (Eigen::Index i = 0; i < site.day_parts.count(); ++i) {
    if (site.roles[static_cast<std::size_t>(i)] != Role::show) continue;
    const DayPart& part = site.day_parts.parts[static_cast<std::size_t>(i)];
    site.measured_kW.middleRows(part.first_hour, part.hours) = kAbsent;
    site.measured_parts_kW.row(i) = kAbsent;
  }
  return site;
}

std::string Candidate::key(const SiteProblem& site) const {
  if (effect == nullptr) return "none";
  std::string text{effect->id};
  if (meter >= 0) text += ":" + site.meters[static_cast<std::size_t>(meter)].id;
  if (begins && effect->dating == Dating::may_begin) text += "@";
  return text;
}

CandidateList list_candidates(const SiteProblem& site) {
  CandidateList list;
  const SiteFacts facts = site.facts();
  const double days = site.drivers->hours.back().day_index + 1.0;
  for (const Effect& effect : catalogue()) {
    if (const std::string why = lacking(effect, site); !why.empty()) {
      list.not_identifiable.push_back({std::string{effect.id}, why});
      continue;
    }
    if (!effect.of_one_meter) {
      add_candidates(effect, facts, -1, days, list.candidates);
      continue;
    }
    for (std::size_t g = 0; g < site.meters.size(); ++g) {
      const bool applies = effect.meter_utilities.empty() ||
                           std::ranges::find(effect.meter_utilities, site.meters[g].utility) !=
                               effect.meter_utilities.end();
      if (applies) add_candidates(effect, facts, static_cast<int>(g), days, list.candidates);
    }
  }
  return list;
}

std::unique_ptr<model::hourly::Alteration> alteration_of(const Candidate& candidate,
                                                         const SiteFacts& facts,
                                                         std::span<const double> values) {
  const std::size_t days = (candidate.begins ? 1 : 0) + (candidate.ends ? 1 : 0);
  auto alteration =
      candidate.effect->bind(facts, values.first(values.size() - days), candidate.meter);
  if (days == 0) return alteration;
  const double from = values[values.size() - days];
  const double to = candidate.ends ? values.back() : std::numeric_limits<double>::infinity();
  return within_dates(std::move(alteration), from, to);
}

Eigen::Index profile_meter(const SiteProblem& site) {
  const auto found = std::ranges::find_if(site.meters, [](const MeterData& meter) {
    return meter.utility == Utility::electricity &&
           (meter.end_uses[model::EndUse::lighting] > 0.0 ||
            meter.end_uses[model::EndUse::plugs] > 0.0);
  });
  return found == site.meters.end() ? -1 : found - site.meters.begin();
}

ProfileReading::ProfileReading(const SiteProblem& site) : site_(&site) {
  if (site.measured_kW.size() == 0) return;
  meter_ = profile_meter(site);
  if (meter_ < 0) return;
  const auto& hours = site.drivers->hours;
  counts_.assign(hours.size(), 0);
  for (std::size_t p = 0; p < site.roles.size(); ++p) {
    if (site.roles[p] == Role::show) continue;
    const DayPart& part = site.day_parts.parts[p];
    for (int i = part.first_hour; i < part.first_hour + part.hours; ++i) {
      counts_[static_cast<std::size_t>(i)] = std::isfinite(site.measured_kW(i, meter_)) ? 1 : 0;
    }
  }
  for (std::size_t i = 0; i < hours.size(); ++i) {
    const auto cell =
        static_cast<std::size_t>(hours[i].day) * 24 + static_cast<std::size_t>(hours[i].local_hour);
    cell_.push_back(cell);
    lights_kW_[cell] = 1e-3 * hours[i].lights_W;
    plugs_kW_[cell] = 1e-3 * hours[i].plugs_W;
    per_hour_[cell] += counts_[i];
  }
  for (double& per_hour : per_hour_) per_hour = per_hour > 0.0 ? 1.0 / per_hour : 0.0;
  measured_kW_ = means_of(site.measured_kW);
}

ProfileReading::Cells ProfileReading::means_of(const Eigen::ArrayXXd& hours_kW) const {
  Cells means{};
  for (std::size_t i = 0; i < cell_.size(); ++i) {
    if (counts_[i] != 0) means[cell_[i]] += hours_kW(static_cast<Eigen::Index>(i), meter_);
  }
  for (std::size_t cell = 0; cell < kCells; ++cell) means[cell] *= per_hour_[cell];
  return means;
}

void ProfileReading::take_usual_day_from(Eigen::ArrayXXd& change_kW) const {
  if (meter_ < 0) return;
  const Cells means = means_of(change_kW);
  for (std::size_t i = 0; i < cell_.size(); ++i) {
    change_kW(static_cast<Eigen::Index>(i), meter_) -= means[cell_[i]];
  }
}

void ProfileReading::apply(const model::Use& use, const Eigen::ArrayXXd& hours_kW,
                           Eigen::ArrayXXd& parts_kW) const {
  if (meter_ < 0) return;
  Cells more_kW = means_of(hours_kW);
  for (std::size_t cell = 0; cell < kCells; ++cell) {
    if (per_hour_[cell] == 0.0) continue;
    const double all_kW = use.lights_scale * lights_kW_[cell] + use.plugs_scale * plugs_kW_[cell];
    more_kW[cell] = std::max(measured_kW_[cell] - more_kW[cell], -all_kW);
  }
  for (Eigen::Index p = 0; p < parts_kW.rows(); ++p) {
    const DayPart& part = site_->day_parts.parts[static_cast<std::size_t>(p)];
    double sum_kWh = 0.0;
    for (int i = 0; i < part.hours; ++i) {
      sum_kWh += more_kW[cell_[static_cast<std::size_t>(part.first_hour + i)]];
    }
    parts_kW(p, meter_) += sum_kWh / part.hours;
  }
}

Predictor::Predictor(const SiteProblem& site,
                     std::vector<std::shared_ptr<const model::hourly::Alteration>> accepted,
                     std::function<bool()> proceed, ForEachIndex executor)
    : site_(&site),
      accepted_(std::move(accepted)),
      building_(site.nominal),
      hourly_(site.drivers),
      profile_(site),
      hours_kW_(Eigen::ArrayXXd::Zero(static_cast<Eigen::Index>(site.drivers->hours.size()),
                                      static_cast<Eigen::Index>(site.meters.size()))),
      parts_kW_(Eigen::ArrayXXd::Zero(site.day_parts.count(), hours_kW_.cols())),
      proceed_(std::move(proceed)),
      executor_(std::move(executor)) {
  for (const MeterData& meter : site.meters) maps_.push_back(meter.end_uses);
}

const Eigen::ArrayXXd& Predictor::parts_kW(std::span<const double> theta,
                                           const model::hourly::Alteration* extra) {
  is_stopped_ = is_stopped_ || (proceed_ && !proceed_());
  if (is_stopped_) return parts_kW_;
  building_ = site_->nominal;  // same sizes, nothing is allocated
  for (std::size_t j = 0; j < theta.size(); ++j) {
    site_->parameters[j].definition->set(building_, theta[j]);
  }
  model::settle(building_);
  active_.clear();
  for (const auto& alteration : accepted_) active_.push_back(alteration.get());
  if (extra != nullptr) active_.push_back(extra);
  hourly_.run(building_, active_, maps_, hours_kW_);
  site_->day_parts.average_into(hours_kW_, parts_kW_);
  profile_.apply(building_.use, hours_kW_, parts_kW_);
  ++runs_;
  return parts_kW_;
}

void Predictor::for_each(std::size_t count,
                         const std::function<void(Predictor&, std::size_t)>& body) {
  const auto ask = [this] {
    const std::scoped_lock lock{mutex_};
    is_stopped_ = is_stopped_ || (proceed_ && !proceed_());
    return !is_stopped_;
  };
  const auto take = [&] {
    const std::scoped_lock lock{mutex_};
    if (idle_.empty()) {
      helpers_.push_back(std::make_unique<Predictor>(*site_, accepted_, ask));
      idle_.push_back(helpers_.back().get());
    }
    Predictor* const helper = idle_.back();
    idle_.pop_back();
    return helper;
  };
  executor_(count, [&](std::size_t i) {
    Predictor* const helper = take();
    body(*helper, i);
    const std::scoped_lock lock{mutex_};
    runs_ += std::exchange(helper->runs_, 0);
    idle_.push_back(helper);
  });
}

Eigen::ArrayXXd Predictor::change_kW(std::span<const double> theta,
                                     const model::hourly::Alteration& effect) {
  parts_kW(theta, &effect);
  const Eigen::ArrayXXd with_kW = hours_kW_;
  parts_kW(theta);
  Eigen::ArrayXXd change = parts_kW_;
  site_->day_parts.average_into(with_kW - hours_kW_, change);
  return change;
}

Error diagnosis_cancelled() { return {ErrorCode::cancelled, "the diagnosis was cancelled"}; }

}  // namespace recald::diagnosis
