#include "core/change_point/temperature_sums.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace recald::change_point {

DaySums& DaySums::operator+=(const DaySums& other) {
  weight += other.weight;
  temperature += other.temperature;
  temperature_square += other.temperature_square;
  energy += other.energy;
  product += other.product;
  return *this;
}

DaySums operator-(const DaySums& a, const DaySums& b) {
  return {.weight = a.weight - b.weight,
          .temperature = a.temperature - b.temperature,
          .temperature_square = a.temperature_square - b.temperature_square,
          .energy = a.energy - b.energy,
          .product = a.product - b.product};
}

TemperatureSums::TemperatureSums(double lowest_C, double highest_C)
    : lowest_tenth_(static_cast<int>(std::floor(lowest_C * kEdgesPerKelvin))),
      edges_(static_cast<int>(std::ceil(highest_C * kEdgesPerKelvin)) - lowest_tenth_ + 2),
      reference_C_(0.5 * (lowest_C + highest_C)) {
  assert(lowest_C <= highest_C);
  for (auto& sums : sums_) sums.resize(static_cast<std::size_t>(edges_));
}

double TemperatureSums::edge_C(int edge) const {
  return static_cast<double>(lowest_tenth_ + edge) / kEdgesPerKelvin;
}

void TemperatureSums::clear() {
  for (auto& sums : sums_) std::fill(sums.begin(), sums.end(), DaySums{});
}

void TemperatureSums::add(model::DayType type, double dry_bulb_C, double energy_kWh,
                          double weight) {
  const int tenth = static_cast<int>(std::floor(dry_bulb_C * kEdgesPerKelvin));
  const int edge = tenth - lowest_tenth_ + 1;  // the first one above the day
  assert(edge >= 1 && edge < edges_);
  const double t = dry_bulb_C - reference_C_;
  sums_[static_cast<std::size_t>(type)][static_cast<std::size_t>(edge)] +=
      DaySums{.weight = weight,
              .temperature = weight * t,
              .temperature_square = weight * t * t,
              .energy = weight * energy_kWh,
              .product = weight * t * energy_kWh};
}

void TemperatureSums::cumulate() {
  for (auto& sums : sums_) {
    for (std::size_t edge = 1; edge < sums.size(); ++edge) sums[edge] += sums[edge - 1];
  }
}

}  // namespace recald::change_point
