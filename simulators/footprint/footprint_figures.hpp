/// Figures of what each hidden effect does to the meters.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

#include "core/result.hpp"
#include "simulators/effects/effect_kind.hpp"

namespace recald::simulators {

/// Simulates each kind of effect at its typical strength, with and without it, and writes to the
/// folder (created if absent): `<effect id>.svg` for each kind, `week_<use>.svg` for each use of
/// building without effects, and a `README.md` that shows them all. Same build, same bytes. Each
/// figure takes one simulated year.
///
/// @return number of figures, or
///         io_failed  the folder or a file in it cannot be written.
[[nodiscard]] Result<std::size_t> draw_footprints(
    const std::filesystem::path& folder, std::span<const EffectKind> kinds = effect_kinds());

}  // namespace recald::simulators
