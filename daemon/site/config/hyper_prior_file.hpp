/// Beliefs about discrepancy and error of one's own, instead of a profile:
///
///     [discrepancy]     # precision of the model discrepancy on outputs normalised to [0, 1]
///     shape = 10        # Gamma(shape, rate): mean shape / rate
///     rate = 0.0084
///     [error]           # precision of the measurement error, likewise
///     shape = 10
///     rate = 0.00084
///     [rho]             # Beta(a, b), correlation at half an input's range; absent: a = 1, b = 0.3
///     a = 1.0
///     b = 0.3
#pragma once

#include <filesystem>
#include <string>
#include <variant>

#include "adapters/toml/toml_reader.hpp"
#include "core/calibration/covariance/hyper_prior.hpp"

namespace recald::daemon {

/// @return the beliefs, named "custom", or every problem of the file.
[[nodiscard]] tl::expected<calibration::HyperPrior, Problems> load_hyper_prior(
    const std::filesystem::path& file);

/// What `--hyper-prior` says: the name of a profile, or a file whose name ends in .toml.
[[nodiscard]] tl::expected<std::variant<calibration::HyperPriorProfile, calibration::HyperPrior>,
                           Problems>
choose_hyper_prior(const std::string& text);

}  // namespace recald::daemon
