// The priors that calibrations teach a building, as lines of its site file, for
// portfolio_priors.py.
//
//   portfolio_priors_study BUILDING.json SITE.json…     each a calibration.json; the model is the
//   building's

#include <fmt/format.h>

#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "adapters/results/learned_priors.hpp"

int main(int argc, char** argv) {
  using namespace recald;
  std::vector<nlohmann::json> documents;
  for (int i = 1; i < argc; ++i) {
    std::ifstream file(argv[i]);
    documents.push_back(nlohmann::json::parse(file, nullptr, false));
    if (documents.back().is_discarded()) {
      fmt::print(stderr, "{} is no JSON\n", argv[i]);
      return 1;
    }
  }
  if (documents.size() < 2) {
    fmt::print(stderr, "give the calibration.json of a building, and those of sites\n");
    return 2;
  }
  const nlohmann::json building = documents.front();
  documents.erase(documents.begin());
  const auto priors = results::learned_priors(documents, results::parameters_of(building),
                                              building.value("model", std::string{}));
  for (const results::LearnedPrior& prior : priors) fmt::print("# {}\n", prior.sentence);
  fmt::print("{}", results::site_file_lines(priors, "study"));
  return 0;
}
