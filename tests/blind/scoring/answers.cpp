#include "tests/blind/scoring/answers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

#include "tests/blind/scoring/files.hpp"
#include "tests/blind/scoring/json_fields.hpp"

namespace recald::blind {
namespace {

// In the order of the enumeration.
constexpr std::array<std::string_view, 4> kBlocks{"no_effect", "single", "out_of_catalogue",
                                                  "pair"};

constexpr std::array<std::string_view, 2> kWorlds{"own", "energyplus"};

Block block_of(std::string_view name) {
  const auto found = std::ranges::find(kBlocks, name);
  return found == kBlocks.end() ? Block::no_effect : static_cast<Block>(found - kBlocks.begin());
}

std::optional<std::string> day(JsonFields& fields, std::string_view key) {
  if (!fields.has(key)) return std::nullopt;
  const std::string text = fields.text(key);
  constexpr std::string_view pattern = "dddd-dd-dd";
  const bool fits = std::ranges::equal(text, pattern, [](char c, char wanted) {
    return wanted == 'd' ? std::isdigit(static_cast<unsigned char>(c)) != 0 : c == wanted;
  });
  if (!fits) fields.fail(fmt::format("'{}' is '{}', must be a day as in 2022-03-01", key, text));
  return text;
}

HiddenEffect read_effect(JsonFields& fields) {
  HiddenEffect effect;
  effect.effect = fields.name("effect");
  effect.effect_class = fields.name("class");
  effect.in_catalogue = fields.boolean("in_catalogue");
  effect.strength = fields.number("strength");
  effect.unit = fields.text("unit");
  effect.from = day(fields, "from");
  effect.to = day(fields, "to");
  effect.share_of_meter = fields.numbers("share_of_meter");
  if (fields.has("moved_share")) effect.moved_share = fields.numbers("moved_share");
  return effect;
}

/// What a block promises about its effects; empty when it is kept.
std::string broken_promise(const Answer& answer) {
  const auto in_catalogue = static_cast<std::size_t>(
      std::ranges::count_if(answer.effects, [](const HiddenEffect& e) { return e.in_catalogue; }));
  const std::size_t count = answer.effects.size();
  const auto counted = [&](std::string_view promise) {
    return fmt::format("block '{}' with {} effects, {} of them in the catalogue; {}",
                       block_name(answer.block), count, in_catalogue, promise);
  };
  switch (answer.block) {
    case Block::no_effect:
      return count == 0 ? "" : counted("it must hide none");
    case Block::single:
      return count == 1 && in_catalogue == 1 ? "" : counted("it must hide one of the catalogue");
    case Block::pair:
      return count == 2 && in_catalogue == 2 && answer.effects[0].effect != answer.effects[1].effect
                 ? ""
                 : counted("it must hide two different ones of the catalogue");
    case Block::out_of_catalogue:
      if (in_catalogue != 0) return counted("it must hide none of the catalogue");
      return count != 0 || !answer.decoys.empty() ? ""
                                                  : counted("it must hide one or have a decoy");
  }
  return "";
}

/// What a building has none of, and whose drawings say so, is nothing to find: a house without
/// ventilation has no outdoor airflow.
void leave_out_what_is_not_there(Answer& answer) {
  std::erase_if(answer.prior_sd, [&](const auto& parameter) {
    const auto truth = answer.true_parameters.find(parameter.first);
    const bool is_absent =
        parameter.second == 0.0 && truth != answer.true_parameters.end() && truth->second == 0.0;
    if (is_absent) answer.true_parameters.erase(truth);
    return is_absent;
  });
}

void check_parameters(const Answer& answer, JsonFields& fields) {
  for (const auto& [name, value] : answer.true_parameters) {
    const auto sd = answer.prior_sd.find(name);
    if (sd == answer.prior_sd.end()) {
      fields.fail(fmt::format("'prior_sd' lacks the parameter '{}'", name));
    } else if (!(sd->second > 0.0)) {
      fields.fail(fmt::format("'prior_sd.{}' is {:g}, must be positive", name, sd->second));
    }
  }
  if (answer.prior_sd.size() > answer.true_parameters.size()) {
    fields.fail("'prior_sd' has parameters that 'true_parameters' lacks");
  }
}

}  // namespace

std::string_view block_name(Block block) { return kBlocks[static_cast<std::size_t>(block)]; }

Result<Answer> parse_answer(std::string_view text, const std::string& expected_case) {
  const auto parsed = parse_json(text, "answer " + expected_case);
  if (!parsed) return tl::unexpected(parsed.error());
  JsonFields fields(*parsed, "answer " + expected_case);

  Answer answer;
  answer.case_id = fields.name("case");
  if (answer.case_id != expected_case) {
    fields.fail("'case' is '" + answer.case_id + "', must be the file's name");
  }
  answer.block = block_of(fields.word("block", kBlocks));
  if (fields.has("world")) answer.world = fields.word("world", kWorlds);
  fields.each("effects", [&](const std::string&, JsonFields& effect) {
    answer.effects.push_back(read_effect(effect));
  });
  answer.decoys = fields.names("decoys");
  answer.climate = fields.name("climate");
  answer.use = fields.name("use");
  answer.gaps = fields.boolean("gaps");
  answer.true_parameters = fields.numbers("true_parameters");
  answer.prior_sd = fields.numbers("prior_sd");
  leave_out_what_is_not_there(answer);
  check_parameters(answer, fields);
  if (std::string broken = broken_promise(answer); !broken.empty()) fields.fail(std::move(broken));
  if (fields.error()) return tl::unexpected(*fields.error());
  return answer;
}

Result<std::vector<std::string>> answer_files(const std::filesystem::path& folder) {
  auto names = names_in(folder);
  if (!names) return names;
  std::erase_if(*names, [](const std::string& name) {
    return !name.ends_with(".json") || name == "opened.json";
  });
  if (names->empty()) {
    return failure(ErrorCode::not_found, "no answers (<case>.json) in '" + folder.string() + "'");
  }
  return names;
}

Result<AnswerKey> read_answers(const std::filesystem::path& folder) {
  const auto names = answer_files(folder);
  if (!names) return tl::unexpected(names.error());
  AnswerKey key;
  for (const std::string& name : *names) {
    const auto text = read_file(folder / name);
    if (!text) return tl::unexpected(text.error());
    auto answer = parse_answer(*text, std::filesystem::path(name).stem().string());
    if (!answer) return tl::unexpected(answer.error());
    key.emplace(answer->case_id, std::move(*answer));
  }
  return key;
}

std::string most_affected_meter(const Answer& answer) {
  std::map<std::string, double> total;
  for (const HiddenEffect& effect : answer.effects) {
    // An effect that takes and gives back within the day has no net share to judge it by.
    const auto& shares = effect.moved_share.empty() ? effect.share_of_meter : effect.moved_share;
    for (const auto& [meter, share] : shares) total[meter] += std::abs(share);
  }
  const auto most = std::ranges::max_element(
      total, {}, [](const auto& meter_and_share) { return meter_and_share.second; });
  return most == total.end() || most->second == 0.0 ? "" : most->first;
}

double largest_share(const Answer& answer) {
  std::optional<double> weakest;
  for (const HiddenEffect& effect : answer.effects) {
    const auto& shares = effect.moved_share.empty() ? effect.share_of_meter : effect.moved_share;
    double largest = 0.0;
    for (const auto& [meter, share] : shares) largest = std::max(largest, std::abs(share));
    weakest = std::min(weakest.value_or(largest), largest);
  }
  return weakest.value_or(0.0);
}

}  // namespace recald::blind
