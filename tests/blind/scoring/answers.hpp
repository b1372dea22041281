/// The answer key of a blind population: what is hidden in each case.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.hpp"

namespace recald::blind {

/// What kind of case it is; the blocks are drawn and scored apart.
enum class Block { no_effect, single, out_of_catalogue, pair };

[[nodiscard]] std::string_view block_name(Block block);

struct HiddenEffect {
  std::string effect;        ///< Its id, as results name it: "night_setback_missing".
  std::string effect_class;  ///< "schedules".
  bool in_catalogue = false;
  double strength = 0.0;
  std::string unit;                 ///< Of the strength.
  std::optional<std::string> from;  ///< First day, "2022-03-01"; absent: from the beginning.
  std::optional<std::string> to;    ///< Last day; absent: to the end.
  std::map<std::string, double> share_of_meter;  ///< Meter -> sum of the footprint / sum of meter.
  /// Meter -> what the footprint moves, within the day too, / sum of meter; may be absent.
  std::map<std::string, double> moved_share;
};

struct Answer {
  std::string case_id;
  Block block = Block::no_effect;
  std::string world = "own";  ///< Whose buildings: "own" or "energyplus".
  std::vector<HiddenEffect> effects;
  std::vector<std::string> decoys;  ///< Drivers on offer that cause nothing.
  std::string climate;
  std::string use;
  bool gaps = false;
  std::map<std::string, double> true_parameters;  ///< Of the base model, each in its own unit.
  std::map<std::string, double> prior_sd;         ///< Of the same parameters, same units.
};

/// @param expected_case  The file's name without ".json"; the answer must say the same.
/// @return malformed or invalid_value with the case, the key and the value.
[[nodiscard]] Result<Answer> parse_answer(std::string_view text, const std::string& expected_case);

/// Answers by case.
using AnswerKey = std::map<std::string, Answer>;

/// Reads every `<case>.json` of the folder (not `opened.json`). The seal is checked by
/// `verify_seal`, which comes first.
/// @return not_found if there is no answer at all; else as `parse_answer`.
[[nodiscard]] Result<AnswerKey> read_answers(const std::filesystem::path& folder);

/// Names of the answer files in the folder, sorted.
[[nodiscard]] Result<std::vector<std::string>> answer_files(const std::filesystem::path& folder);

/// The meter that the hidden effects move most; empty when there is none.
[[nodiscard]] std::string most_affected_meter(const Answer& answer);

/// What is moved of the meter that is moved most; of two effects, by the weaker one. 0 where
/// nothing is hidden.
[[nodiscard]] double largest_share(const Answer& answer);

}  // namespace recald::blind
