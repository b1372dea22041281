/// What earlier data have taught a parameter, as a prior for later data.
#pragma once

#include <span>

#include "core/model/prior.hpp"

namespace recald {

/// A posterior of joint draws as a prior for later months: margins alone, each in the support of
/// the original prior and with mean and spread of the draws.
/// @param draws  At least one.
[[nodiscard]] Prior prior_from_draws(const Prior& original, std::span<const double> draws);

}  // namespace recald
