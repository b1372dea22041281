/// The commands of recald-sim that need more than buildings: devices to read, EnergyPlus models.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "simulators/energyplus/model_files.hpp"
#include "simulators/energyplus/run_readings.hpp"

namespace CLI {
class App;
}

namespace recald::simulators {

struct MetersArguments {
  std::string plan;
  std::string clock;
  std::string faults;
};

struct ReadingArguments {
  std::string out;
  std::string zone = energyplus::kTimeZone;
  std::vector<std::string> meters;
  energyplus::ReadingOptions options;
};

/// What these commands are given on the command line; has to outlive its parsing and `run`.
struct MoreArguments {
  MetersArguments meters;
  energyplus::ModelFileOptions eplus;
  ReadingArguments readings;
};

/// Adds them to `app`; the one that is parsed becomes `run`.
void add_more_commands(CLI::App& app, MoreArguments& given, std::function<int()>& run);

}  // namespace recald::simulators
