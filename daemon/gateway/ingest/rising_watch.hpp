/// Pushed values that only rise are those of a register, not amounts.
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "core/metering/reading.hpp"

namespace recald::daemon {

/// For one meter of which nobody says how much it can measure.
class RisingWatch {
 public:
  struct Doubt {
    std::string words = {};  ///< What it looks like, and what to write; empty: it looks right.
    std::vector<metering::Reading> before = {};  ///< Taken as measured before, and now suspect.
  };

  /// Takes readings that are about to be stored, and makes those suspect, reason `range`, that are
  ///
  /// - larger than any building's load;
  /// - or part of a run that rose at least three times, each time by less than a two hundredth, or
  ///   twenty times by anything, and never stood or fell: a load is not so even.
  [[nodiscard]] Doubt look(std::vector<metering::Reading>& readings, std::chrono::seconds interval);

 private:
  void enter(const metering::Reading& reading);
  [[nodiscard]] bool is_register() const;

  std::vector<metering::Reading> run_;  ///< That rises, with the value it began with.
  bool is_even_ = true;                 ///< Each rise of it was small.
};

}  // namespace recald::daemon
