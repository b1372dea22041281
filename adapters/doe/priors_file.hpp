/// priors.csv: what is believed about each parameter before anything is measured.
///
///     parameter,unit,min,mode,max            and, optional,  distribution,sd
///
/// `distribution` is triangular where it is blank or absent. What the numbers mean:
///
///     triangular         min, mode, max
///     uniform            min, max; mode is ignored and may be blank
///     truncated_normal   mode and sd of the normal, cut off outside min, max (blank: not cut)
///     log_normal         mode is the median, sd that of the logarithm, cut off likewise
///
/// Other columns, such as a meaning in words, are ignored.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/model/parameter.hpp"
#include "core/result.hpp"

namespace recald::doe {

/// @return the parameters in the file's order, or the first fault: not_found, io_failed, malformed
///         (columns, numbers, repeated names), invalid_value (a prior that cannot be sampled),
///         not_enough_data (no parameter).
[[nodiscard]] Result<std::vector<Parameter>> read_priors(const std::filesystem::path& file);

/// The text of the file. Reading it back gives the same parameters, bit for bit.
[[nodiscard]] std::string priors_csv(std::span<const Parameter> parameters);

}  // namespace recald::doe
