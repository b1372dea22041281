#include "core/savings/year_weights.hpp"

#include <algorithm>
#include <array>

namespace recald::savings {

YearWeights year_weights(std::span<const metering::Month> months) {
  const auto index = [](metering::Month month) { return unsigned{month.month()} - 1U; };
  std::array<int, 12> count{};
  for (const metering::Month month : months) ++count[index(month)];
  YearWeights weights{Eigen::VectorXd(std::ssize(months)),
                      std::ranges::none_of(count, [](int times) { return times == 0; })};
  for (std::size_t i = 0; i < months.size(); ++i) {
    const double times = weights.is_year ? count[index(months[i])] : 1.0;
    weights.days(static_cast<Eigen::Index>(i)) = metering::days_in(months[i]) / times;
  }
  return weights;
}

}  // namespace recald::savings
