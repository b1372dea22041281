#include "simulators/building/wall.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace recald::simulators::wall_test {
namespace {

constexpr double kRoomFilm_W_m2K = 7.7;

/// A room that holds `room_C` on the inner face.
double advance_against_room(Wall& wall, const OuterSide& outer, double room_C, double step_s) {
  const RoomSide side = wall.eliminate(outer, step_s);
  const double surface_C =
      (side.r_W_m2 + kRoomFilm_W_m2K * room_C) / (side.d_W_m2K + kRoomFilm_W_m2K);
  wall.substitute(surface_C);
  return kRoomFilm_W_m2K * (room_C - surface_C);  // into the wall
}

std::array<Layer, 3> brick_wall() {
  return {Layer{0.10, 0.8, 1.5e6, 2}, Layer{0.05, 0.035, 4.0e4, 1}, Layer{0.15, 0.9, 1.6e6, 3}};
}

TEST(Wall, SteadyStateFluxIsThatOfTheResistances) {
  auto layers = brick_wall();
  Wall wall(layers, 10.0);
  const OuterSide outer{25.0, 0.0, 0.0};
  double flux_W_m2 = 0.0;
  for (int i = 0; i < 20'000; ++i) flux_W_m2 = advance_against_room(wall, outer, 20.0, 3600.0);
  const double u_W_m2K = 1.0 / (1.0 / 25.0 + resistance_m2K_W(layers) + 1.0 / kRoomFilm_W_m2K);
  EXPECT_NEAR(flux_W_m2, u_W_m2K * 20.0, 1e-9);
  EXPECT_NEAR(wall.outer_flux_W_m2(), -u_W_m2K * 20.0, 1e-9);
}

TEST(Wall, EveryStepConservesEnergy) {
  Wall wall(brick_wall(), 15.0);
  for (int i = 0; i < 500; ++i) {
    const double before_J = wall.stored_J_m2();
    const OuterSide outer{10.0 + i % 7, -5.0 + i % 31, 40.0 * (i % 3)};
    const double inside_W = advance_against_room(wall, outer, 18.0 + i % 5, 300.0);
    EXPECT_NEAR(wall.stored_J_m2() - before_J, 300.0 * (inside_W + wall.outer_flux_W_m2()), 1e-5);
  }
}

// A semi-infinite solid after a step of its surface temperature: the flux is k dT / sqrt(pi a t)
// (Carslaw, Jaeger). Concrete half a metre thick is semi-infinite for an hour.
TEST(Wall, TransientMeetsSemiInfiniteSolid) {
  const std::array<Layer, 1> concrete{Layer{0.5, 1.6, 2.1e6, 200}};
  Wall wall(concrete, 0.0);
  const OuterSide held{1e7, 10.0, 0.0};
  double flux_W_m2 = 0.0;
  for (int i = 0; i < 720; ++i) {
    const RoomSide side = wall.eliminate(held, 5.0);
    wall.substitute(side.r_W_m2 / side.d_W_m2K);  // adiabatic room side
    flux_W_m2 = wall.outer_flux_W_m2();
  }
  const double diffusivity_m2_s = 1.6 / 2.1e6;
  const double exact_W_m2 = 1.6 * 10.0 / std::sqrt(3.14159265358979 * diffusivity_m2_s * 3600.0);
  EXPECT_NEAR(flux_W_m2, exact_W_m2, 0.01 * exact_W_m2);
}

TEST(Wall, InsulationIsSizedForTheUValue) {
  auto layers = brick_wall();
  set_u_value(layers, 1, 0.45);
  EXPECT_NEAR(1.0 / (1.0 / 25.0 + resistance_m2K_W(layers) + 1.0 / 7.7), 0.45, 1e-12);
}

TEST(Wall, MasslessPaneFollowsAtOnce) {
  Wall pane = Wall::massless(5.0);
  const double flux_W_m2 = advance_against_room(pane, {2.0, 0.0, 0.0}, 20.0, 300.0);
  EXPECT_NEAR(flux_W_m2, 20.0 / (1.0 / 2.0 + 1.0 / kRoomFilm_W_m2K), 1e-9);
  EXPECT_EQ(pane.stored_J_m2(), 0.0);
}

}  // namespace
}  // namespace recald::simulators::wall_test
