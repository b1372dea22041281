#include "simulators/building/wall.hpp"

#include <cassert>

namespace recald::simulators {

Wall::Wall(std::span<const Layer> layers, double initial_C) {
  capacity_J_m2K_.push_back(0.0);
  for (const Layer& layer : layers) {
    assert(layer.slices >= 1 && layer.thickness_m > 0.0 && layer.conductivity_W_mK > 0.0);
    const double slice_m = layer.thickness_m / layer.slices;
    for (int slice = 0; slice < layer.slices; ++slice) {
      const double half_J_m2K = 0.5 * slice_m * layer.heat_capacity_J_m3K;
      capacity_J_m2K_.back() += half_J_m2K;
      capacity_J_m2K_.push_back(half_J_m2K);
      conductance_W_m2K_.push_back(layer.conductivity_W_mK / slice_m);
    }
  }
  const std::size_t nodes = capacity_J_m2K_.size();
  temperature_C_.assign(nodes, initial_C);
  pivot_W_m2K_.assign(nodes, 0.0);
  inverse_pivot_.assign(nodes, 0.0);
  reduced_W_m2_.assign(nodes, 0.0);
}

Wall Wall::massless(double initial_C) {
  Wall wall;
  wall.capacity_J_m2K_ = {0.0};
  wall.temperature_C_ = {initial_C};
  wall.pivot_W_m2K_ = {0.0};
  wall.inverse_pivot_ = {0.0};
  wall.reduced_W_m2_ = {0.0};
  return wall;
}

void Wall::factorise(double outer_conductance_W_m2K, double step_s) {
  const std::size_t last = temperature_C_.size() - 1;
  double carried = outer_conductance_W_m2K;
  for (std::size_t i = 0; i <= last; ++i) {
    const double inward = i < last ? conductance_W_m2K_[i] : 0.0;
    pivot_W_m2K_[i] = capacity_J_m2K_[i] / step_s + carried + inward;
    inverse_pivot_[i] = pivot_W_m2K_[i] > 0.0 ? 1.0 / pivot_W_m2K_[i] : 0.0;
    // Schur complement: the neighbour keeps k − k²/pivot of the conductance towards this node.
    carried = inward - inward * inward * inverse_pivot_[i];
  }
  factorised_for_conductance_ = outer_conductance_W_m2K;
  factorised_for_step_s_ = step_s;
}

RoomSide Wall::eliminate(const OuterSide& outer, double step_s) {
  outer_ = outer;
  if (outer.conductance_W_m2K != factorised_for_conductance_ || step_s != factorised_for_step_s_) {
    factorise(outer.conductance_W_m2K, step_s);
  }
  const std::size_t last = temperature_C_.size() - 1;
  const double per_step = 1.0 / step_s;
  double carried_W_m2 = outer.conductance_W_m2K * outer.temperature_C + outer.source_W_m2;
  for (std::size_t i = 0; i <= last; ++i) {
    reduced_W_m2_[i] = capacity_J_m2K_[i] * per_step * temperature_C_[i] + carried_W_m2;
    if (i < last) carried_W_m2 = conductance_W_m2K_[i] * inverse_pivot_[i] * reduced_W_m2_[i];
  }
  return {pivot_W_m2K_[last], reduced_W_m2_[last]};
}

void Wall::substitute(double room_side_C) {
  const std::size_t last = temperature_C_.size() - 1;
  temperature_C_[last] = room_side_C;
  for (std::size_t i = last; i-- > 0;) {
    temperature_C_[i] =
        (reduced_W_m2_[i] + conductance_W_m2K_[i] * temperature_C_[i + 1]) * inverse_pivot_[i];
  }
}

double Wall::outer_flux_W_m2() const {
  return outer_.conductance_W_m2K * (outer_.temperature_C - temperature_C_.front()) +
         outer_.source_W_m2;
}

double Wall::stored_J_m2() const {
  double sum_J_m2 = 0.0;
  for (std::size_t i = 0; i < temperature_C_.size(); ++i) {
    sum_J_m2 += capacity_J_m2K_[i] * temperature_C_[i];
  }
  return sum_J_m2;
}

double Wall::heat_capacity_J_m2K() const {
  double sum_J_m2K = 0.0;
  for (const double capacity : capacity_J_m2K_) sum_J_m2K += capacity;
  return sum_J_m2K;
}

double resistance_m2K_W(std::span<const Layer> layers) {
  double sum_m2K_W = 0.0;
  for (const Layer& layer : layers) sum_m2K_W += layer.thickness_m / layer.conductivity_W_mK;
  return sum_m2K_W;
}

void set_u_value(std::span<Layer> layers, std::size_t insulation, double u_W_m2K) {
  constexpr double films_m2K_W = 1.0 / 25.0 + 1.0 / 7.7;
  Layer& layer = layers[insulation];
  const double others_m2K_W =
      resistance_m2K_W(layers) - layer.thickness_m / layer.conductivity_W_mK;
  const double needed_m2K_W = 1.0 / u_W_m2K - films_m2K_W - others_m2K_W;
  assert(needed_m2K_W > 0.0);
  layer.thickness_m = needed_m2K_W * layer.conductivity_W_mK;
}

}  // namespace recald::simulators
