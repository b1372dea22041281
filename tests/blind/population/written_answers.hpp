/// Answers as files, for tests.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

namespace recald::blind {

/// By case.
inline std::map<std::string, nlohmann::json> written_answers(const std::filesystem::path& folder) {
  std::map<std::string, nlohmann::json> answers;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".json") continue;
    answers[entry.path().stem().string()] = nlohmann::json::parse(std::ifstream(entry.path()));
  }
  return answers;
}

/// Whether coreutils find every answer as it was sealed, and the whole in the last line.
inline bool is_sealed(const std::filesystem::path& answers) {
  const std::string check =
      "cd '" + answers.string() +
      "' && sha256sum --check --strict --quiet answers.sha256 && test \"$(tail -n 1 "
      "answers.sha256)\" = \"# whole $(head -n -1 answers.sha256 | sha256sum | cut -c 1-64)\"";
  return std::system(check.c_str()) == 0;
}

/// What is moved of the meter that is moved most; of two effects, by the weaker one.
inline double largest_share(const nlohmann::json& answer) {
  double weakest = answer["effects"].empty() ? 0.0 : 1.0;
  for (const nlohmann::json& effect : answer["effects"]) {
    double largest = 0.0;
    for (const auto& [meter, share] : effect["moved_share"].items()) {
      largest = std::max(largest, std::abs(share.get<double>()));
    }
    weakest = std::min(weakest, largest);
  }
  return weakest;
}

}  // namespace recald::blind
