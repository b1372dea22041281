#include <chrono>

#include "core/random/streams.hpp"
#include "core/screening/screen.hpp"
#include "daemon/commands/commands.hpp"
#include "daemon/commands/model/design_input.hpp"
#include "daemon/site/results/design_files.hpp"

namespace recald::daemon {

int run_screen(const ScreenArguments& arguments, const Console& console) {
  const auto begin = std::chrono::steady_clock::now();
  const auto design = open_design_folder(arguments.design, console);
  if (!design) return design.error();
  Rng rng{arguments.seed, streams::kScreening.first};
  const auto screening = screening::screen(design_data(*design), {}, rng);
  if (!screening) return console.fail(screening.error());
  auto facts = facts_of_files(design->files, "design");
  if (!facts) return console.fail(facts.error());
  facts->seed = arguments.seed;
  facts->design_runs = static_cast<int>(design->runs.size());
  facts->wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();

  const std::string json = screen_json(*screening, design->parameters, design->notes, *facts);
  if (auto written = write_result(arguments.out, "screen.json", json); !written) {
    return console.fail(written.error());
  }
  console.out << (arguments.json ? json
                                 : screen_table(*screening, design->parameters, design->notes));
  return kSuccess;
}

}  // namespace recald::daemon
