#include "tests/blind/population/moved_share.hpp"

#include <array>
#include <cmath>
#include <numeric>

namespace recald::blind {

std::vector<std::size_t> blocks_of(const simulators::Recording& recording,
                                   const metering::LocalCalendar& calendar) {
  std::vector<std::size_t> blocks;
  for (std::size_t slot = 0; slot < recording.power.size(); ++slot) {
    const metering::LocalTime local = calendar.local_time(recording.start_of(slot));
    const auto month = static_cast<std::size_t>(static_cast<unsigned>(local.date.month())) - 1;
    const std::chrono::weekday weekday{std::chrono::sys_days{local.date}};
    const std::size_t weekend = weekday.iso_encoding() >= 6 ? 1 : 0;
    blocks.push_back((month * 2 + weekend) * 6 +
                     static_cast<std::size_t>(local.minute_of_day / 240));
  }
  return blocks;
}

double moved_share(const std::vector<double>& footprint_kW, const std::vector<std::size_t>& blocks,
                   double whole_kW) {
  std::array<double, 144> sum_kW{};
  for (std::size_t slot = 0; slot < blocks.size(); ++slot)
    sum_kW[blocks[slot]] += footprint_kW[slot];
  double moved_kW = 0.0;
  for (const double block_kW : sum_kW) moved_kW += std::abs(block_kW);
  return whole_kW > 0.0 ? moved_kW / whole_kW : 0.0;
}

void leave_out_small_meters(std::span<const double> whole_kW, std::span<double> moved_shares) {
  constexpr double kSmall = 0.02;
  const double all_kW = std::accumulate(whole_kW.begin(), whole_kW.end(), 0.0);
  for (std::size_t meter = 0; meter < whole_kW.size(); ++meter) {
    if (whole_kW[meter] < kSmall * all_kW) moved_shares[meter] = 0.0;
  }
}

}  // namespace recald::blind
