/// The building's constructions: creates the zones and sets the conditions on their outer faces.
#pragma once

#include <array>
#include <vector>

#include "simulators/building/operation.hpp"
#include "simulators/building/truth.hpp"
#include "simulators/building/zone.hpp"
#include "simulators/climate/weather.hpp"

namespace recald::simulators {

/// Sun through a zone's windows, and air through its cracks, in one step.
struct EnvelopeEffect {
  double transmitted_sun_W = 0.0;
  double infiltration_kg_s = 0.0;
};

class Envelope {
 public:
  Envelope(const Truth& truth, AirState initial);

  /// Sets every outer face for the next step and computes sun and infiltration of each zone.
  /// @param pressurised  Per storey, 0…1: how much outdoor air the perimeter's air
  ///                     handler supplies.
  const std::vector<EnvelopeEffect>& expose(const Outdoors& outdoors,
                                            const std::vector<double>& pressurised,
                                            const EnvelopeOperation& operation);

  /// Heat into all faces towards weather or ground, during the zones' last step.
  [[nodiscard]] double exposed_heat_W() const;

  [[nodiscard]] std::vector<Zone>& zones() { return zones_; }
  [[nodiscard]] const std::vector<Zone>& zones() const { return zones_; }

 private:
  enum class Face { wall, window, skylight, roof, ground };
  struct Exposed {
    std::size_t zone;
    std::size_t surface;
    Face face;
    std::size_t side;  ///< Facade of a wall or window.
    double area_m2;
  };
  /// Two halves of one partition or slab, in different zones, joined at its middle.
  struct Joint {
    std::size_t first_zone, first_surface;
    std::size_t second_zone, second_surface;
    double conductance_W_m2K;
  };
  void build_zone(std::size_t zone, AirState initial);
  void add_facade(std::size_t zone, std::size_t side, std::vector<ZoneSurface>& surfaces,
                  double start_C);
  void join_neighbours();
  void expose_faces(const Outdoors& outdoors, const std::array<Irradiance, 5>& irradiance,
                    const EnvelopeOperation& operation);
  /// Outer side of a pane; directly transmitted sun goes to the zone's effect.
  [[nodiscard]] OuterSide expose_window(const Exposed& face, const OuterSide& film,
                                        const Irradiance& sun, double sun_factor);
  void join_halves();
  [[nodiscard]] double leaking_m2(std::size_t side, bool top) const;
  [[nodiscard]] double infiltration_kg_s(std::size_t zone, const Outdoors& outdoors,
                                         double pressurised,
                                         const EnvelopeOperation& operation) const;
  [[nodiscard]] double shaft_kg_s(std::size_t storey, double warmer_inside_K, double density,
                                  const Outdoors& outdoors, double shaft_m2) const;
  [[nodiscard]] double open_window_kg_s(std::size_t zone, double warmer_inside_K, double density,
                                        double wind_m_s, double all_windows_m2) const;

  Truth truth_;
  std::vector<Zone> zones_;
  std::vector<Exposed> exposed_;
  std::vector<Joint> joints_;
  std::vector<EnvelopeEffect> effects_;
};

}  // namespace recald::simulators
