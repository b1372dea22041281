#include "daemon/site/savings/measured_model.hpp"

#include <fmt/format.h>

namespace recald::daemon {

std::string prior_stands(const std::string& label) {
  return fmt::format("{}: the meters do not settle what it is today, so its prior stands.", label);
}

std::string drawn_from(const std::string& label, const Prior& prior) {
  return fmt::format("{} is not calibrated: what it is today is drawn from {:.3g} to {:.3g}.",
                     label, prior.min(), prior.max());
}

}  // namespace recald::daemon
