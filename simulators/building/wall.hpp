/// Heat conduction through a layered construction by finite volumes in one dimension.
///
/// Nodes lie on the layers' boundaries and inside them, with half a slice of mass on either
/// side, so both surfaces are nodes. Time is implicit. The room-side node stays open:
/// `eliminate` folds all other nodes into d·T = r for it, the room solves this equation together
/// with its air (no lag between wall and air, so energy is conserved exactly), and `substitute`
/// computes the other nodes.
#pragma once

#include <span>
#include <vector>

namespace recald::simulators {

struct Layer {
  double thickness_m;
  double conductivity_W_mK;
  double heat_capacity_J_m3K;
  int slices;
};

/// The side away from the room: flux = conductance · (temperature − outer node) + source.
struct OuterSide {
  double conductance_W_m2K = 0.0;
  double temperature_C = 0.0;
  double source_W_m2 = 0.0;
};

/// Everything behind the room-side node, per m²: d·T_room_side = r + flux from the room.
struct RoomSide {
  double d_W_m2K;
  double r_W_m2;
};

class Wall {
 public:
  /// Layers from the outside in. @pre every layer has slices >= 1 and positive properties.
  Wall(std::span<const Layer> layers, double initial_C);

  /// Glazing: one node without mass.
  [[nodiscard]] static Wall massless(double initial_C);

  [[nodiscard]] RoomSide eliminate(const OuterSide& outer, double step_s);
  void substitute(double room_side_C);

  /// Flux into the construction from the outer side during the last step, W/m².
  [[nodiscard]] double outer_flux_W_m2() const;
  [[nodiscard]] double outer_node_C() const { return temperature_C_.front(); }
  [[nodiscard]] double stored_J_m2() const;  ///< Relative to 0 degC.
  [[nodiscard]] double heat_capacity_J_m2K() const;

 private:
  Wall() = default;
  void factorise(double outer_conductance_W_m2K, double step_s);

  std::vector<double> temperature_C_;
  std::vector<double> capacity_J_m2K_;
  std::vector<double> conductance_W_m2K_;  ///< Between node i and i + 1.
  // Factors of the forward sweep; they change only with the step and the outer conductance.
  std::vector<double> pivot_W_m2K_;
  std::vector<double> inverse_pivot_;
  std::vector<double> reduced_W_m2_;
  double factorised_for_conductance_ = -1.0;
  double factorised_for_step_s_ = -1.0;
  OuterSide outer_;
};

/// Thermal resistance of the layers alone, m²K/W.
[[nodiscard]] double resistance_m2K_W(std::span<const Layer> layers);

/// Sets the thickness of layer `insulation` to reach the U-value (films 1/25 and 1/7.7 included).
/// @pre the other layers insulate less than 1/u_W_m2K.
void set_u_value(std::span<Layer> layers, std::size_t insulation, double u_W_m2K);

}  // namespace recald::simulators
