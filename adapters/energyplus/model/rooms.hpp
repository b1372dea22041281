/// The rooms of an EnergyPlus model: floor areas, and what is installed or who is there per area.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "adapters/energyplus/model/model_document.hpp"

namespace recald::energyplus {

/// A field of an object that says how much there is of something.
struct Level {
  Json::json_pointer field;
  Sense sense = Sense::direct;
  double total = 0.0;              ///< Of the whole building: people, W.
  std::vector<std::string> rooms;  ///< Where; lower case.
};

/// Zones and spaces with their floors. An area is that of the zone's field if it has one, else of
/// the surfaces that are its floors, in m2; multipliers count.
class Rooms {
 public:
  explicit Rooms(const Json& objects);

  /// Each People, Lights … of the type, in the way that it gives its amount.
  [[nodiscard]] std::vector<Level> people() const;
  [[nodiscard]] std::vector<Level> lights() const;
  [[nodiscard]] std::vector<Level> equipment() const;  ///< Electric; servers too.

  /// The total over the floor of the rooms in which it is, per m2; 0 where there is no floor.
  [[nodiscard]] double density(const std::vector<Level>& levels) const;

  /// What DesignSpecification:OutdoorAir objects ask for in the zones that are sized with them,
  /// m3/s.
  [[nodiscard]] double outdoor_air_m3_s() const;

  /// Of the surfaces that face outdoors, their windows included, m2.
  [[nodiscard]] double exterior_area_m2() const { return exterior_m2_; }

 private:
  struct Way;
  [[nodiscard]] std::vector<std::string> rooms_of(std::string_view name) const;
  [[nodiscard]] double area_m2(const std::vector<std::string>& rooms) const;
  [[nodiscard]] double count(const std::vector<std::string>& rooms) const;
  [[nodiscard]] double people_in(const std::vector<std::string>& rooms) const;
  [[nodiscard]] std::vector<Level> levels(std::string_view type, std::string_view method,
                                          std::string_view usual,
                                          const std::vector<Way>& ways) const;

  const Json& objects_;
  std::map<std::string, double> area_m2_;     ///< By the name of a zone or space, lower case.
  std::map<std::string, double> multiplier_;  ///< Of zones and spaces.
  std::map<std::string, double> people_;
  std::map<std::string, std::vector<std::string>> lists_;
  double exterior_m2_ = 0.0;
};

}  // namespace recald::energyplus
