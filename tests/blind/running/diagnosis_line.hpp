/// A results line of what `recald diagnose` wrote about a case.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.hpp"

namespace recald::blind {

/// Keys stay in the order in which they were put in: lines are read by people, too.
using Json = nlohmann::ordered_json;

/// Whose line it is, and what the process took.
struct CaseRun {
  std::string case_id;
  std::string method;
  double wall_s = 0.0;
  double cpu_s = 0.0;
  double peak_rss_MB = 0.0;
  std::string version;  ///< As the program says it.
};

/// Case, method, outcome and version: what every line has.
[[nodiscard]] Json line_head(const CaseRun& run, std::string_view outcome);

/// A case without a diagnosis counts as "none", and says why.
[[nodiscard]] Json failure_line(const CaseRun& run, const std::string& why);

/// Nothing of what was tried and withdrawn counts: then there is no gap in the line, and the names
/// tried stand in `extra`.
/// @param diagnosis  diagnosis.json, as `recald diagnose` writes it.
/// @return malformed if a key is missing, or what it holds makes no line.
[[nodiscard]] Result<Json> diagnosis_line(const Json& diagnosis, const CaseRun& run);

/// The refit with the true effects: its gap counts whether it was confirmed or not.
/// @param assumed  Ids of the effects that the diagnosis was told, at least one.
/// @return malformed as above; not_found if there is no gap, because no month was kept back or
///         no meter has figures.
[[nodiscard]] Result<Json> oracle_line(const Json& diagnosis, const CaseRun& run,
                                       const std::vector<std::string>& assumed);

}  // namespace recald::blind
