/// A regression fitted elsewhere: `term,coef`, as R writes its coefficients.
///
/// Terms are `(Intercept)`, the name of an input or parameter, `a:b` for a product, `a^2` for a
/// square.
#pragma once

#include <filesystem>
#include <vector>

#include "core/model/metamodel/builders.hpp"
#include "core/result.hpp"

namespace recald::doe {

/// @return the terms in the file's order, or malformed, not_enough_data (no term), not_found,
///         io_failed. `model_of` checks whether the terms' factors exist.
[[nodiscard]] Result<std::vector<model::metamodel::NamedCoefficient>> read_metamodel(
    const std::filesystem::path& file);

}  // namespace recald::doe
