/// The program as its user meets it, without a process of its own.
#pragma once

#include <sstream>
#include <string>
#include <vector>

#include "daemon/commands/line/cli.hpp"

namespace recald::daemon::testing {

struct Outcome {
  int exit_code;
  std::string out;
  std::string err;
};

inline Outcome run(const std::vector<std::string>& arguments) {
  std::vector<const char*> argv = {"recald"};
  for (const std::string& argument : arguments) argv.push_back(argument.c_str());
  std::ostringstream out;
  std::ostringstream err;
  const int exit_code =
      run_cli(static_cast<int>(argv.size()), argv.data(), Console{out, err, false});
  return {exit_code, out.str(), err.str()};
}

}  // namespace recald::daemon::testing
