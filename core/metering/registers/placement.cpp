#include "core/metering/registers/placement.hpp"

#include <cassert>
#include <cmath>

namespace recald::metering {
namespace {

int strength(Validity validity) {
  switch (validity) {
    case Validity::missing:
      return 0;
    case Validity::suspect:
      return 1;
    case Validity::filled:
      return 2;
    case Validity::scaled:
      return 3;
    case Validity::ok:
      return 4;
  }
  assert(false && "every validity has a strength");
  return 0;
}

/// The same value, or no value in both; text and registers round, so the last digits may differ.
bool same_value(double a_kW, double b_kW) {
  if (std::isnan(a_kW) || std::isnan(b_kW)) return std::isnan(a_kW) && std::isnan(b_kW);
  return std::abs(a_kW - b_kW) <= 1e-9 * std::max(std::abs(a_kW), std::abs(b_kW));
}

}  // namespace

Placement place(const std::optional<Reading>& known, const Reading& arriving, bool supersedes) {
  if (!known) return Placement::first;
  const bool same = same_value(known->mean_kW, arriving.mean_kW);
  if (same && known->validity == arriving.validity) return Placement::duplicate;
  // A missing interval never corrects anything.
  if (supersedes && arriving.validity != Validity::missing) return Placement::replaces;
  const int gain = strength(arriving.validity) - strength(known->validity);
  if (gain > 0) return Placement::replaces;
  return gain < 0 ? Placement::weaker : Placement::conflict;
}

}  // namespace recald::metering
