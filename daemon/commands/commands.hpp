/// The commands of `recald`, one function each; they return the exit code.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "daemon/commands/console.hpp"

namespace recald::daemon {

struct SiteArguments {
  std::filesystem::path site;
  bool json = false;
};

struct ReplayArguments : SiteArguments {
  std::string from;  ///< Local day, or empty.
  std::string to;
  std::filesystem::path out;  ///< Folder for months.csv, or empty.
};

struct ProfileArguments : SiteArguments {
  std::filesystem::path out;
};

struct CalibrateArguments : SiteArguments {
  std::filesystem::path out;  ///< Folder; for `report` the page itself.
  std::string model = "epc";
  std::string sampler = "seed_rwm";
  std::string hyper_prior = "scaled";
  int iterations = 30'000;  ///< A chain, burn-in included.
  int burn_in = 3'000;
  int chains = 4;
  int design_runs = 200;
  std::uint64_t seed = 1;
  unsigned threads = 0;  ///< 0: one a core. No result depends on it.
  bool prior_sensitivity = false;
};

int run_check(const SiteArguments& arguments, const Console& console);
int run_replay(const ReplayArguments& arguments, const Console& console);
int run_profile(const ProfileArguments& arguments, const Console& console);
/// Writes calibration.json, draws, months.csv, profile.json and report.html into the folder.
int run_calibrate(const CalibrateArguments& arguments, const Console& console);
/// The same calibration, of which only the page is kept.
int run_report(const CalibrateArguments& arguments, const Console& console);

}  // namespace recald::daemon
