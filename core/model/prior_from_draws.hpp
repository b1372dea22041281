/// Turns what earlier data have shown about a parameter into a prior for later data.
#pragma once

#include <span>

#include "core/model/prior.hpp"

namespace recald {

/// A posterior of joint draws as a prior for later months: only the margins, each on the support of
/// the original prior, with mean and spread of the draws.
/// @param draws  At least one.
[[nodiscard]] Prior prior_from_draws(const Prior& original, std::span<const double> draws);

}  // namespace recald
