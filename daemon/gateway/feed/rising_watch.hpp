/// Pushed values that only rise are those of a register, not amounts.
#pragma once

#include <chrono>
#include <cstddef>
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
    bool is_weak = false;                        ///< Nothing is made suspect.
  };

  /// Takes readings that are about to be stored, and makes those suspect, reason `range`, that are
  ///
  /// - larger than any building's load;
  /// - or part of a run that has not fallen for a day, which no load does, nor what the sun yields;
  /// - or part of a run that rose eight times in two hours or more, each time by less than a two
  ///   thousandth: so a total grows, but no load that is measured.
  ///
  /// Of a few small rises of a megawatt and more it only says what they may be.
  [[nodiscard]] Doubt look(std::vector<metering::Reading>& readings, std::chrono::seconds interval);

 private:
  void enter(const metering::Reading& reading);
  [[nodiscard]] bool is_register() const;
  [[nodiscard]] bool may_be_register() const;

  std::vector<metering::Reading> run_;  ///< That never falls, with the value it began with.
  std::size_t rises_ = 0;
  bool is_even_ = true;   ///< Each rise of it was next to nothing …
  bool is_small_ = true;  ///< … or small.
};

}  // namespace recald::daemon
