/// The library of parameter uncertainties: what can be calibrated, in which range, and how it
/// changes a building.
///
/// The ranges are those of Table 1 of the seed if it has the parameter, with the design value
/// as mode. Entries marked ours are for buildings that the seed did not have (gas boilers,
/// unknown floor areas), and for models in EnergyPlus: adapters/energyplus/known_parameters.hpp
/// says where they are in those.
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <string_view>

#include "core/model/building.hpp"
#include "core/model/parameter.hpp"
#include "core/result.hpp"

namespace recald::model {

enum class RangeKind {
  relative,  ///< low and high are factors on the design value.
  absolute,  ///< low and high are in the parameter's unit.
};

struct ParameterDefinition {
  std::string_view name;
  std::string_view unit;
  std::string_view label;  ///< For people.
  std::string_view group;  ///< As in Table 1 of the seed.
  RangeKind range;
  double low;
  double high;
  double (*get)(const Building&);        ///< Design value; null: no built-in model has it.
  void (*set)(Building&, double value);  ///< On a copy of the nominal building.
  double least = 0.0;                    ///< The physical minimum, whatever is usual.
  double most = std::numeric_limits<double>::infinity();

  [[nodiscard]] bool is_modelled() const { return set != nullptr; }
};

[[nodiscard]] std::span<const ParameterDefinition> parameter_library();

/// A heating set-point counts up to this below that of cooling, in every model.
inline constexpr double kLeastDeadBand_K = 1.0;

/// The seed's choice for the EPC: aggregated occupancy, outdoor airflow, cooling set-point.
inline constexpr std::string_view kSeedParameters[] = {"occupancy_density", "outdoor_airflow",
                                                       "cooling_setpoint"};

/// @return the entry; not_found with the nearest name; or unsupported for one that the built-in
/// models
///         do not have (visible reflectance …).
[[nodiscard]] Result<const ParameterDefinition*> find_parameter(std::string_view name);

/// A prior from the site, with open ends cut at the physical limits.
/// @return the prior, or invalid_value if it allows impossible values.
[[nodiscard]] Result<Prior> physical_prior(const ParameterDefinition& definition,
                                           const Prior& prior);

/// The parameter with its prior for this building; `prior` overrides the library's range. A
/// design value outside an absolute range widens it: the library says what is usual, the
/// drawings what is there.
/// @return the parameter; or invalid_value when the design value is not possible, or is 0 and the
///         range is relative to it; or as `physical_prior`.
[[nodiscard]] Result<Parameter> make_parameter(const ParameterDefinition& definition,
                                               const Building& nominal,
                                               const std::optional<Prior>& prior = {});

/// As above, around a design value that the caller knows: of a model that is no Building.
[[nodiscard]] Result<Parameter> make_parameter(const ParameterDefinition& definition, double design,
                                               const std::optional<Prior>& prior = {});

/// Call after setting all parameters: keeps set-points at least 1 K apart (by moving the heating
/// one) and factors within their physical limits.
void settle(Building& building);

}  // namespace recald::model
