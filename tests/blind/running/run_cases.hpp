/// The blind run: every case of a population diagnosed by the product, a results line each.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "core/result.hpp"

namespace recald::blind {

struct RunRequest {
  std::filesystem::path population;  ///< Holds a folder a case, or `cases/` that does.
  std::filesystem::path results;     ///< Made if absent; lines that are there are not made again.
  std::filesystem::path program;     ///< recald
  /// "oracle": told what is hidden, needs `answers`; "calibrate", "drift": that command
  /// instead of a diagnosis.
  std::string method = "recald";
  std::filesystem::path answers;  ///< Read for the oracle and by nobody else.
  std::filesystem::path keep;     ///< Gets what each case wrote, as CASE.json; empty: none is kept.
  std::string cases;              ///< "1-20" of the sorted cases; empty: all.
  unsigned jobs = 2;
  double limit_s = 90.0;  ///< Wall time of a diagnosis.
};

struct RunSummary {
  std::size_t cases = 0;   ///< In the range, for the oracle those that hide what it can be told.
  std::size_t found = 0;   ///< Had a line before.
  std::size_t done = 0;    ///< Have one now.
  std::size_t failed = 0;  ///< Of these, without a diagnosis.
  std::size_t over_limit = 0;  ///< Of these, because of the limit.
  bool stopped = false;
  std::vector<std::string> torn;  ///< Lines that a power cut tore, in words.
};

/// Told after each case: how many are done, of how many, and how many failed.
using RunObserver = std::function<void(std::size_t done, std::size_t of, std::size_t failed)>;

/// A diagnosis that fails, is killed, takes longer than the limit or writes what makes no line is
/// a line of outcome "none". What would spoil every case ends the run instead: a program that
/// cannot be started or refuses the command line, results that cannot be appended.
///
/// @param stop  When it turns true diagnoses under way are ended, and no line says so.
/// @return invalid_value for a range or method that makes no sense; not_found, io_failed.
[[nodiscard]] Result<RunSummary> run_cases(const RunRequest& request, const std::atomic<bool>& stop,
                                           const RunObserver& observer = {});

}  // namespace recald::blind
