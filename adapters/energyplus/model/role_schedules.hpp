/// Temperatures that schedules give to controls, and which schedule is whose.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "adapters/energyplus/model/model_document.hpp"

namespace recald::energyplus {

/// What the temperatures are for. Air and water are those that leave an air loop or a plant loop of
/// cooling.
enum class Role : std::uint8_t {
  cooling_setpoint,
  heating_setpoint,
  supply_temperature,
  chilled_water_temperature,
};
inline constexpr Role kRoles[] = {Role::cooling_setpoint, Role::heating_setpoint,
                                  Role::supply_temperature, Role::chilled_water_temperature};

[[nodiscard]] std::string_view name_of(Role role);  ///< Of the library of parameters.

/// A schedule in a role, with all its numbers: those of its days too.
struct RoleSchedule {
  std::string type;
  std::string name;
  std::vector<Json::json_pointer> numbers;
};

/// Those that thermostats in use, or managers of set-points, point at. One in a file has no numbers
/// and is left out.
[[nodiscard]] std::vector<RoleSchedule> schedules_of(const Json& objects, Role role);

/// The fields of managers of set-points in a role that are temperatures themselves, not schedules.
struct RoleField {
  Json::json_pointer main;                  ///< Of a cooling day.
  std::vector<Json::json_pointer> numbers;  ///< What moves together, `main` among them.
};
[[nodiscard]] std::vector<RoleField> manager_fields(const Json& objects, Role role);

/// Gives each role schedules of its own: one that also serves something else is copied, with the
/// days that it is made of, and the role's fields point at the copy. So a role can be changed
/// alone. What EnergyPlus gives out, and programs of its energy management that read a schedule, do
/// not count.
void split_schedules(ModelDocument& model);

}  // namespace recald::energyplus
