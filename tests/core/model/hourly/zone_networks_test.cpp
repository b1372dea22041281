#include "core/model/hourly/zone_networks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/sample_building.hpp"

namespace recald::model::hourly::zone_networks_test {
namespace {

using testing::sample_building;

constexpr double kHour_s = 3600.0;

/// The sample building without handlers, sun-lit roofs or leaks: one zone.
Building one_zone() {
  Building building = sample_building();
  building.air.reset();
  building.leakage_cm2_m2 = 0.0;
  return building;
}

std::vector<weather::Orientation> orientations_of(const Building& building) {
  return testing::sample_drivers(building, 1).orientations;
}

Zone zone_of(const Building& building, const std::vector<weather::Orientation>& orientations) {
  std::vector<Zone> zones(1);
  zones[0].solar_aperture_m2.resize(orientations.size());
  describe_zones(building, orientations, zones);
  return zones[0];
}

constexpr double kWindows_W_K = 4 * 150.0 * 2.5;

// H_em is not U A: what the inner surface already resists must not count twice.
TEST(ZoneConductances, LeavesTheInnerSurfaceOutOfTheEnvelope) {
  Building building;
  building.floor_area_m2 = 100.0;
  Zone zone;
  zone.transmission_W_K = 130.0;
  const ZoneConductances c = zone_conductances(building, zone, 30.0);
  EXPECT_DOUBLE_EQ(c.surface_to_mass_W_K, 2275.0);  // 9.1 * 2.5 * 100
  EXPECT_DOUBLE_EQ(c.air_to_surface_W_K, 1552.5);   // 3.45 * 4.5 * 100
  EXPECT_NEAR(c.mass_to_outdoor_W_K, 104.597701, 1e-6);
  EXPECT_NEAR(1.0 / (1.0 / c.mass_to_outdoor_W_K + 1.0 / c.surface_to_mass_W_K), 100.0, 1e-9);
}

TEST(ZoneConductances, StaysFiniteWithoutAnEnvelopeAndWithTooMuchOfOne) {
  Building building;
  building.floor_area_m2 = 100.0;
  Zone zone;
  EXPECT_EQ(zone_conductances(building, zone, 0.0).mass_to_outdoor_W_K, 0.0);
  zone.floor_share = 0.0;
  zone.transmission_W_K = 1e4;
  const ZoneConductances c = zone_conductances(building, zone, 5e3);
  EXPECT_GT(c.mass_to_outdoor_W_K, 0.0);
  EXPECT_TRUE(std::isfinite(c.mass_to_outdoor_W_K));
  EXPECT_GT(c.surface_share, 0.0);
}

/// Annex C as it is printed, with its probe of 10 W/m² for the demand.
class AnnexC {
 public:
  AnnexC(const ZoneConductances& c, double mass_C) : c_(c), mass_C_(mass_C) {}

  /// @return Φ_HC, positive: heating.
  double step(double outdoor_C, double H_ve, double internal_W, double solar_W, double heating_C,
              double cooling_C) {
    const auto at = [&](double demand_W) {
      return air_and_mass(outdoor_C, H_ve, internal_W, solar_W, demand_W);
    };
    constexpr double probe_W = 50e3;
    const double free_C = at(0.0).first;
    double demand_W = 0.0;
    if (free_C < heating_C || free_C > cooling_C) {
      const double set_C = free_C < heating_C ? heating_C : cooling_C;
      demand_W = probe_W * (set_C - free_C) / (at(probe_W).first - free_C);
    }
    mass_C_ = at(demand_W).second;
    return demand_W;
  }
  [[nodiscard]] double mass_C() const { return mass_C_; }

 private:
  [[nodiscard]] std::pair<double, double> air_and_mass(double e, double H_ve, double internal_W,
                                                       double solar_W, double demand_W) const {
    const double H_is = c_.air_to_surface_W_K;
    const double H_ms = c_.surface_to_mass_W_K;
    const double H_w = c_.surface_to_outdoor_W_K;
    const double H_em = c_.mass_to_outdoor_W_K;
    const double ia = 0.5 * internal_W;
    const double m = c_.mass_share * (0.5 * internal_W + solar_W);
    const double st = c_.surface_share * (0.5 * internal_W + solar_W);
    const double H_1 = H_ve * H_is / (H_ve + H_is);
    const double H_2 = H_1 + H_w;
    const double H_3 = H_2 * H_ms / (H_2 + H_ms);
    const double by_air = H_is / (H_ve + H_is) * (ia + demand_W + H_ve * e);
    const double total = m + H_em * e + H_3 / H_2 * (st + H_w * e + by_air);
    const double C = c_.capacity_J_K / kHour_s;
    const double next = (mass_C_ * (C - 0.5 * (H_3 + H_em)) + total) / (C + 0.5 * (H_3 + H_em));
    const double mean = 0.5 * (mass_C_ + next);
    const double s = (H_ms * mean + st + H_w * e + by_air) / (H_ms + H_w + H_1);
    return {(H_is * s + H_ve * e + ia + demand_W) / (H_is + H_ve), next};
  }

  ZoneConductances c_;
  double mass_C_;
};

TEST(ZoneNetworks, FollowAnnexCStepByStep) {
  Building building = one_zone();
  std::erase_if(building.surfaces, [](const Surface& s) { return s.kind == SurfaceKind::ground; });
  const auto orientations = orientations_of(building);
  const Zone zone = zone_of(building, orientations);
  ZoneNetworks zones;
  zones.describe(building, orientations, kHour_s, 1);
  zones.reset(20.0);
  AnnexC reference{zone_conductances(building, zone, kWindows_W_K), 20.0};

  std::vector<double> sun(orientations.size());
  for (int hour = 0; hour < 500; ++hour) {
    const double outdoor_C = 8.0 + 14.0 * std::sin(hour / 40.0) + 5.0 * std::sin(hour / 3.8);
    const double internal_W = 40e3 * (1.0 + std::sin(hour / 3.8 + 1.0));
    const double vent_W_K = hour % 24 < 8 ? 200.0 : 3000.0;
    std::ranges::fill(sun, 100.0 * (1.0 + std::sin(hour / 3.8)));
    double solar_W = -zone.sky_loss_W;
    for (std::size_t k = 0; k < sun.size(); ++k) solar_W += zone.solar_aperture_m2[k] * sun[k];
    zones.expose({outdoor_C, 10.0, internal_W, 1.0, sun});
    const ZoneTotals totals =
        zones.serve(0, {.outdoor_W_K = vent_W_K, .heating_C = 20.0, .cooling_C = 25.0});
    const double expected_W = reference.step(outdoor_C, vent_W_K, internal_W, solar_W, 20.0, 25.0);
    ASSERT_NEAR(totals.zone_heating_W - totals.cooling_W, expected_W, 1e-4) << hour;
    ASSERT_NEAR(zones.mass_C(0, 0), reference.mass_C(), 1e-9) << hour;
  }
}

TEST(ZoneNetworks, SettleAtTheTransmissionOfTheNetwork) {
  const Building building = one_zone();
  const auto orientations = orientations_of(building);
  const Zone zone = zone_of(building, orientations);
  ZoneNetworks zones;
  zones.describe(building, orientations, kHour_s, 1);
  zones.reset(20.0);
  ZoneTotals totals;
  for (int hour = 0; hour < 5000; ++hour) {
    zones.expose({.dry_bulb_C = 0.0, .ground_C = 0.0, .internal_W = 0.0, .solar_share = 1.0});
    totals = zones.serve(0, {.outdoor_W_K = 500.0, .heating_C = 20.0, .cooling_C = 99.0});
  }
  const ZoneConductances c = zone_conductances(building, zone, kWindows_W_K);
  const double shell_W_K = zone.transmission_W_K + zone.ground_W_K;
  const double shell_and_air_W_K = 1.0 / (1.0 / shell_W_K + 1.0 / c.air_to_surface_W_K);
  EXPECT_EQ(totals.cooling_W, 0.0);
  // The sky's loss is drawn from the surface and mass nodes; without it, exactly U A dT.
  Building dark = building;
  for (Surface& s : dark.surfaces) s.emissivity = 0.0;
  zones.describe(dark, orientations, kHour_s, 1);
  for (int hour = 0; hour < 5000; ++hour) {
    zones.expose({.dry_bulb_C = 0.0, .ground_C = 0.0, .internal_W = 0.0, .solar_share = 1.0});
    totals = zones.serve(0, {.outdoor_W_K = 500.0, .heating_C = 20.0, .cooling_C = 99.0});
  }
  EXPECT_NEAR(totals.zone_heating_W, 20.0 * (shell_and_air_W_K + 500.0), 1e-3);
}

// Windowless, so that the mean of the mass tells all flows: what comes in is stored or leaves.
TEST(ZoneNetworks, EnergyOfAStepIsStoredOrLeaves) {
  Building building = one_zone();
  std::erase_if(building.surfaces, [](const Surface& s) { return s.kind == SurfaceKind::window; });
  for (Surface& s : building.surfaces) s.emissivity = 0.0;
  const auto orientations = orientations_of(building);
  const Zone zone = zone_of(building, orientations);
  const ZoneConductances c = zone_conductances(building, zone, 0.0);
  for (const bool boxes : {false, true}) {
    ZoneNetworks zones;
    zones.describe(building, orientations, kHour_s, 1);
    zones.reset(21.0);
    double into_W = 0.0;
    double moved_W = 0.0;
    for (int hour = 0; hour < 1000; ++hour) {
      const double outdoor_C = 12.0 + 16.0 * std::sin(hour / 50.0);
      const double internal_W = 60e3 * (1.0 + std::sin(hour / 3.8));
      zones.expose({outdoor_C, 14.0, internal_W, 1.0, {}});
      const ZoneService service{.outdoor_W_K = 800.0,
                                .heating_C = 21.0,
                                .cooling_C = 24.0,
                                .supply_C = 13.0,
                                .least_W_K = 2000.0,
                                .most_W_K = 20000.0,
                                .scheduled_share = 1.0};
      const double before_C = zones.mass_C(0, 0);
      const ZoneTotals t = boxes ? zones.serve_with_boxes(0, service) : zones.serve(0, service);
      const double mean_C = 0.5 * (before_C + zones.mass_C(0, 0));
      const double air_W = t.scheduled_return_W - 13.0 * t.scheduled_W_K;
      const double in_W = internal_W + t.zone_heating_W + t.reheat_W - t.cooling_W - air_W;
      const double out_W = 800.0 * (t.mean_air_C - outdoor_C) +
                           c.mass_to_outdoor_W_K * (mean_C - outdoor_C) +
                           c.mass_to_ground_W_K * (mean_C - 14.0);
      const double stored_W = c.capacity_J_K * (zones.mass_C(0, 0) - before_C) / kHour_s;
      ASSERT_NEAR(in_W - out_W, stored_W, 1e-3) << hour;
      into_W += in_W;
      moved_W += std::abs(stored_W);
    }
    EXPECT_GT(moved_W, 1e3);
  }
}

TEST(ZoneNetworks, BoxesCoolByFlowThenFloatThenReheat) {
  Building building = one_zone();
  const auto orientations = orientations_of(building);
  ZoneNetworks zones;
  zones.describe(building, orientations, kHour_s, 1);
  const ZoneService service{.heating_C = 21.0,
                            .cooling_C = 24.0,
                            .supply_C = 13.0,
                            .least_W_K = 3000.0,
                            .most_W_K = 30000.0,
                            .scheduled_share = 1.0};
  const auto serve = [&](double internal_W, double mass_C) {
    zones.reset(mass_C);
    zones.expose({20.0, 18.0, internal_W, 1.0, {}});
    return zones.serve_with_boxes(0, service);
  };
  const ZoneTotals cooled = serve(150e3, 24.0);
  EXPECT_NEAR(cooled.mean_air_C, 24.0, 1e-9);
  EXPECT_GT(cooled.scheduled_W_K, 3000.0);
  EXPECT_EQ(cooled.reheat_W, 0.0);
  const ZoneTotals short_of_air = serve(900e3, 24.0);
  EXPECT_DOUBLE_EQ(short_of_air.scheduled_W_K, 30000.0);
  EXPECT_GT(short_of_air.mean_air_C, 24.0);
  const ZoneTotals floating = serve(20e3, 24.0);
  EXPECT_DOUBLE_EQ(floating.scheduled_W_K, 3000.0);
  EXPECT_GT(floating.mean_air_C, 21.0);
  EXPECT_LT(floating.mean_air_C, 24.0);
  EXPECT_EQ(floating.reheat_W + floating.zone_heating_W, 0.0);
  const ZoneTotals reheated = serve(5e3, 21.4);
  EXPECT_DOUBLE_EQ(reheated.mean_air_C, 21.0);
  EXPECT_GT(reheated.reheat_W, 0.0);
  EXPECT_LE(reheated.reheat_W, 3000.0 * 8.0 + 1e-6);

  // Handlers that stand by schedule are called when the room gets too warm, and only then.
  ZoneService night = service;
  night.least_W_K = night.scheduled_share = 0.0;
  zones.reset(24.0);
  zones.expose({20.0, 18.0, 150e3, 1.0, {}});
  const ZoneTotals called = zones.serve_with_boxes(0, night);
  EXPECT_EQ(called.scheduled_W_K, 0.0);
  EXPECT_GT(called.on_call_W_K, 0.0);
  EXPECT_NEAR(called.on_call_return_W, 24.0 * called.on_call_W_K, 1e-6 * called.on_call_return_W);
}

// Of a room that is left at 28 °C, air and furniture are to be cooled as well as the mass.
TEST(ZoneNetworks, AirAndFurnitureCostTheFirstHourOnly) {
  Building building = one_zone();
  const auto orientations = orientations_of(building);
  const auto cold_W = [&](double air_capacity_J_m2K, int hours) {
    building.air_capacity_J_m2K = air_capacity_J_m2K;
    ZoneNetworks zones;
    zones.describe(building, orientations, kHour_s, 1);
    zones.reset(28.0);
    double cooling_W = 0.0;
    for (int hour = 0; hour < hours; ++hour) {
      zones.expose({28.0, 28.0, 0.0, 1.0, {}});
      cooling_W = zones.serve(0, {.heating_C = 10.0, .cooling_C = 24.0}).cooling_W;
    }
    return cooling_W;
  };
  // 40 kJ/(m²K) over 5000 m² by 4 K in an hour.
  EXPECT_NEAR(cold_W(40e3, 1) - cold_W(0.0, 1), 40e3 * 5000.0 * 4.0 / kHour_s, 1e-3);
  EXPECT_NEAR(cold_W(40e3, 2), cold_W(0.0, 2), 1e-3);
}

// A room warmer than it was has stored its gains in air and furniture until they fill.
TEST(ZoneNetworks, AirAndFurnitureDelayTheFloatingRoom) {
  Building building = one_zone();
  const auto orientations = orientations_of(building);
  const auto air_C = [&](double air_capacity_J_m2K) {
    building.air_capacity_J_m2K = air_capacity_J_m2K;
    ZoneNetworks zones;
    zones.describe(building, orientations, kHour_s, 1);
    zones.reset(20.0);
    zones.expose({20.0, 20.0, 100e3, 1.0, {}});
    return zones.serve_with_boxes(0, {.heating_C = 10.0, .cooling_C = 40.0, .supply_C = 13.0})
        .mean_air_C;
  };
  EXPECT_GT(air_C(40e3), 20.0);
  EXPECT_LT(air_C(40e3), 0.5 * (20.0 + air_C(0.0)));
}

TEST(ZoneNetworks, ALooserMassTakesLessAndLeavesTheAirWarmer) {
  Building building = one_zone();
  const auto orientations = orientations_of(building);
  const auto after_an_hour = [&](double coupling) {
    building.mass_coupling = coupling;
    ZoneNetworks zones;
    zones.describe(building, orientations, kHour_s, 1);
    zones.reset(20.0);
    zones.expose({20.0, 20.0, 100e3, 1.0, {}});
    const double air_C = zones.serve(0, {.heating_C = 10.0, .cooling_C = 40.0}).mean_air_C;
    return std::pair{air_C, zones.mass_C(0, 0)};
  };
  const auto [tight_air_C, tight_mass_C] = after_an_hour(1.0);
  const auto [loose_air_C, loose_mass_C] = after_an_hour(0.3);
  EXPECT_GT(loose_air_C, tight_air_C + 0.1);
  EXPECT_LT(loose_mass_C, tight_mass_C);
}

// The façades come first, the core under the roof and that of the storeys below last.
TEST(ZoneNetworks, ALighterCoreWarmsFasterAndNoOtherRoomDoes) {
  Building building = sample_building();
  const auto orientations = orientations_of(building);
  const auto mass_C = [&](double core_share) {
    building.core_mass_share = core_share;
    ZoneNetworks zones;
    zones.describe(building, orientations, kHour_s, 1);
    zones.reset(20.0);
    zones.expose({20.0, 20.0, 100e3, 1.0, {}});
    zones.serve_with_boxes(0, {.heating_C = 10.0, .cooling_C = 40.0, .supply_C = 13.0});
    std::vector<double> masses_C;
    for (std::size_t z = 0; z < zones.zones(); ++z) masses_C.push_back(zones.mass_C(0, z));
    return masses_C;
  };
  const auto even_C = mass_C(1.0);
  const auto light_C = mass_C(0.2);
  const std::size_t first_core = even_C.size() - 2;
  for (std::size_t z = 0; z < even_C.size(); ++z) {
    SCOPED_TRACE(z);
    if (z < first_core) {
      EXPECT_EQ(light_C[z], even_C[z]);
    } else {
      EXPECT_GT(light_C[z] - 20.0, 2.0 * (even_C[z] - 20.0));
    }
  }
}

// Two weeks must forget where the masses began, to the 0.01 K that ends a warm-up.
TEST(ZoneNetworks, FourteenDaysForgetTheStart) {
  const Building building = sample_building();
  const auto orientations = orientations_of(building);
  ZoneNetworks zones;
  zones.describe(building, orientations, kHour_s, 1);
  std::vector<double> ends;
  for (const double start_C : {16.0, 28.0}) {
    zones.reset(start_C);
    for (int hour = 0; hour < 14 * 24; ++hour) {
      const bool day = hour % 24 >= 7 && hour % 24 < 19;
      zones.expose({5.0, 16.0, day ? 90e3 : 20e3, 1.0, {}});
      zones.serve_with_boxes(0, {.leakage_W_K_cm2 = 0.003,
                                 .heating_C = day ? 21.0 : 16.0,
                                 .cooling_C = day ? 24.0 : 28.0,
                                 .supply_C = 13.0,
                                 .least_W_K = day ? 10e3 : 0.0,
                                 .most_W_K = 30e3,
                                 .scheduled_share = day ? 1.0 : 0.0});
    }
    for (std::size_t z = 0; z < zones.zones(); ++z) ends.push_back(zones.mass_C(0, z));
  }
  const std::size_t n = zones.zones();
  for (std::size_t z = 0; z < n; ++z) EXPECT_NEAR(ends[z], ends[n + z], 1e-2) << "zone " << z;
}

}  // namespace
}  // namespace recald::model::hourly::zone_networks_test
