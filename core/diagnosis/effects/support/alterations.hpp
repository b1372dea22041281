/// What the entries of the catalogue are written with: an alteration from a function of its hours.
#pragma once

#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "core/diagnosis/effects/support/effect.hpp"
#include "core/model/hourly/alteration.hpp"

namespace recald::diagnosis::effects {

using model::DriverHour;
using model::hourly::Alteration;
using model::hourly::StepLoads;
using model::hourly::StepOperation;

using Altered = std::unique_ptr<Alteration>;
using Parameters = std::vector<EffectParameter>;
using Values = std::span<const double>;

/// @param change  (Building&), see `Alteration::rebuild`.
template <class Change>
Altered rebuilding(Change change) {
  struct Rebuilding final : Alteration {
    explicit Rebuilding(Change given) : change(std::move(given)) {}
    void rebuild(model::Building& building) const override { change(building); }
    Change change;
  };
  return std::make_unique<Rebuilding>(std::move(change));
}

/// @param change  (const DriverHour&, StepOperation&), see `Alteration::operate`.
template <class Change>
Altered operating(Change change) {
  struct Operating final : Alteration {
    explicit Operating(Change given) : change(std::move(given)) {}
    void operate(const DriverHour& hour, StepOperation& op) const override { change(hour, op); }
    Change change;
  };
  return std::make_unique<Operating>(std::move(change));
}

/// @param change  (const Building&, const DriverHour&, const StepOperation&, StepLoads&), see
///                `Alteration::supply`.
template <class Change>
Altered supplying(Change change) {
  struct Supplying final : Alteration {
    explicit Supplying(Change given) : change(std::move(given)) {}
    void supply(const model::Building& building, const DriverHour& hour, const StepOperation& op,
                StepLoads& loads) const override {
      change(building, hour, op, loads);
    }
    Change change;
  };
  return std::make_unique<Supplying>(std::move(change));
}

/// Of one meter's record. @param change  (hours, power_kW), see `Alteration::record`.
template <class Change>
Altered recording(int meter, Change change) {
  struct Recording final : Alteration {
    Recording(int of, Change given) : meter(of), change(std::move(given)) {}
    void record(std::span<const DriverHour> hours, int recorded,
                std::span<double> power_kW) const override {
      if (recorded == meter) change(hours, power_kW);
    }
    int meter;
    Change change;
  };
  return std::make_unique<Recording>(meter, std::move(change));
}

}  // namespace recald::diagnosis::effects
