#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "daemon/commands/commands.hpp"
#include "daemon/commands/doctor/facts.hpp"

namespace recald::daemon {
namespace {

void print_fact(const Fact& fact, const Console& console) {
  console.out << fmt::format("{:<24} {}\n", fact.name, fact.value);
  if (!fact.problem.empty()) console.out << fmt::format("  ! {}\n", fact.problem);
}

nlohmann::ordered_json json_of(const std::vector<Fact>& facts, bool is_sound) {
  auto list = nlohmann::ordered_json::array();
  for (const Fact& fact : facts) {
    nlohmann::ordered_json one{{"name", fact.name}, {"value", fact.value}};
    if (!fact.problem.empty()) {
      one["problem"] = fact.problem;
      one["stops_work"] = fact.stops_work;
    }
    list.push_back(std::move(one));
  }
  return {{"sound", is_sound}, {"facts", std::move(list)}};
}

}  // namespace

int run_doctor(const SiteArguments& arguments, const Console& console) {
  std::vector<Fact> facts = machine_facts();
  if (!arguments.site.empty()) {
    for (Fact& fact : site_facts(arguments.site)) facts.push_back(std::move(fact));
  }
  const bool is_sound = std::ranges::none_of(facts, &Fact::stops_work);
  if (arguments.json) {
    console.out << json_of(facts, is_sound)
                       .dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace)
                << "\n";
  } else {
    for (const Fact& fact : facts) print_fact(fact, console);
  }
  return is_sound ? kSuccess : kFailure;
}

}  // namespace recald::daemon
