#include "tests/blind/population/share_search.hpp"

#include <algorithm>
#include <cmath>

namespace recald::blind {

Result<std::optional<double>> strength_in(const ShareBin& wanted, const StrengthLimits& limits,
                                          int tries, const ShareOf& share_of) {
  constexpr double kSame = 0.01;
  const double aim = std::sqrt(wanted.least * wanted.most);
  const double least = std::abs(limits.least);
  const double most = std::abs(limits.most);
  double size = std::sqrt(least * most);
  for (int i = 0; i < tries; ++i) {
    const double strength = std::copysign(size, limits.most);
    const auto share = share_of(strength);
    if (!share) return tl::unexpected(share.error());
    if (wanted.holds(*share)) return std::optional{strength};
    // What shows nothing may still show something at its strongest.
    const double next = *share > 0.0 ? std::clamp(size * aim / *share, least, most) : most;
    if (std::abs(next - size) <= kSame * size) break;
    size = next;
  }
  return std::optional<double>{};
}

}  // namespace recald::blind
