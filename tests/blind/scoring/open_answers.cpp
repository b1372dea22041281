#include "tests/blind/scoring/open_answers.hpp"

#include <fmt/format.h>

#include "adapters/system/write_file.hpp"
#include "tests/blind/scoring/files.hpp"
#include "tests/blind/scoring/json_fields.hpp"
#include "tests/blind/scoring/report.hpp"
#include "tests/blind/scoring/seal.hpp"

namespace recald::blind {
namespace {

/// All that is needed for scores, read and checked.
struct Material {
  std::string whole_hash;
  AnswerKey key;
  ResultLog log;
  EffectClasses classes;
  std::vector<std::string> missing;
  std::vector<std::string> earlier;
};

Result<Material> read_material(const OpenRequest& request) {
  const auto whole = verify_seal(request.answers, request.published);
  if (!whole) return tl::unexpected(whole.error());
  auto key = read_answers(request.answers);
  if (!key) return tl::unexpected(key.error());
  auto log = read_results(request.results, request.reruns);
  if (!log) return tl::unexpected(log.error());
  const auto known = check_cases_known(*key, log->results);
  if (!known) return tl::unexpected(known.error());
  auto listed = read_classes(request.classes);
  if (!listed) return tl::unexpected(listed.error());
  auto classes = classes_of(*key, std::move(*listed));
  if (!classes) return tl::unexpected(classes.error());
  auto earlier = earlier_openings(request.answers);
  if (!earlier) return tl::unexpected(earlier.error());
  std::vector<std::string> missing = missing_cases(*key, log->results, request.options.method);
  return Material{.whole_hash = *whole,
                  .key = std::move(*key),
                  .log = std::move(*log),
                  .classes = std::move(*classes),
                  .missing = std::move(missing),
                  .earlier = std::move(*earlier)};
}

std::vector<std::string> warnings_of(const Material& material, const Scores& scores) {
  std::vector<std::string> warnings;
  for (const std::string& sentence : material.missing) warnings.push_back("Partial: " + sentence);
  if (const std::size_t count = material.earlier.size(); count > 0) {
    warnings.push_back(fmt::format("The answers were opened {} time{} before, last at {}", count,
                                   count == 1 ? "" : "s", material.earlier.back()));
  }
  for (const std::string& torn : material.log.torn) warnings.push_back(torn);
  if (material.log.replaced > 0) {
    warnings.push_back(
        fmt::format("{} results were replaced by later reruns", material.log.replaced));
  }
  if (scores.versions.size() > 1) {
    warnings.push_back(fmt::format("The cases were run by {} different versions of {}",
                                   scores.versions.size(), scores.method));
  }
  return warnings;
}

Result<void> write_scores(const OpenRequest& request, const Scores& scores,
                          const Circumstances& circumstances) {
  auto json = system::write_file(request.out, scores_json(scores, circumstances));
  if (!json) return json;
  std::filesystem::path page = request.out;
  auto written =
      system::write_file(page.replace_extension(".md"), scores_markdown(scores, circumstances));
  if (!written) return written;
  return system::write_file(page.replace_extension(".html"), scores_html(scores, circumstances));
}

}  // namespace

Result<EffectClasses> read_classes(const std::optional<std::filesystem::path>& file) {
  EffectClasses classes;
  if (!file) return classes;
  const auto text = read_file(*file);
  if (!text) return tl::unexpected(text.error());
  const auto parsed = parse_json(*text, file->string());
  if (!parsed) return tl::unexpected(parsed.error());
  JsonFields fields(*parsed, file->string());
  if (fields.error()) return tl::unexpected(*fields.error());
  for (const auto& [effect, ignored] : parsed->items()) classes[effect] = fields.name(effect);
  if (fields.error()) return tl::unexpected(*fields.error());
  return classes;
}

Result<std::string> open_answers(const OpenRequest& request) {
  if (request.out.extension() != ".json") {
    return failure(ErrorCode::invalid_value,
                   "--out is '" + request.out.string() + "', must end in .json");
  }
  const auto material = read_material(request);
  if (!material) return tl::unexpected(material.error());
  if (!material->missing.empty() && !request.partial) {
    return failure(ErrorCode::invalid_value,
                   fmt::format("{}; run them, or give --partial; nothing was opened",
                               fmt::join(material->missing, "; ")));
  }
  const Scores scores =
      compute_scores(material->key, material->log.results, material->classes, request.options);
  const Circumstances circumstances{.warnings = warnings_of(*material, scores),
                                    .whole_hash = material->whole_hash,
                                    .results_hash = material->log.hash,
                                    .scorer_version = request.scorer_version};
  // The record comes first: an opening whose scores got lost is an opening all the same.
  const auto recorded = record_opening(request.answers, {.at = request.now,
                                                         .scorer_version = request.scorer_version,
                                                         .whole_hash = material->whole_hash,
                                                         .results_hash = material->log.hash,
                                                         .cases_of_version = scores.versions});
  if (!recorded) return tl::unexpected(recorded.error());
  const auto written = write_scores(request, scores, circumstances);
  if (!written) return tl::unexpected(written.error());

  std::string console;
  for (const std::string& warning : circumstances.warnings) console += warning + "\n";
  const int right = scores.naming.right ? *scores.naming.right->hits : 0;
  return console + fmt::format("{} of {} cases right; wrote {} and the page beside it\n", right,
                               scores.cases, request.out.string());
}

}  // namespace recald::blind
