#include <fmt/format.h>

#include <algorithm>

#include "tests/blind/scoring/markdown.hpp"
#include "tests/blind/scoring/report.hpp"

namespace recald::blind {
namespace {

std::string head(const Scores& scores, const Circumstances& circumstances) {
  std::string text = fmt::format("# Blind test: what {} said\n\n", scores.method);
  for (const std::string& warning : circumstances.warnings) text += "**" + warning + ".**\n\n";
  std::vector<std::string> versions;
  for (const auto& [version, cases] : scores.versions) {
    versions.push_back(
        fmt::format("{} ({} cases)", version.empty() ? "not stated" : version, cases));
  }
  text += fmt::format(
      "{} of {} cases scored; version {}. Answers {}, results {} (SHA-256), scorer {}.\n\n",
      scores.cases, scores.population_cases, fmt::join(versions, ", "), circumstances.whole_hash,
      circumstances.results_hash, circumstances.scorer_version);
  text += fmt::format("Right answer: {}. In brackets stand 95 % intervals.\n\n",
                      share_cell(scores.naming.right));
  return text;
}

std::string target_section(const Scores& scores) {
  MarkdownTable table({"world", "quantity", "measured", "target", "", "aim", ""});
  for (const Target& target : scores.targets) {
    table.add(
        {target.world, target.quantity,
         target.decimals ? number_cell(target.score, *target.decimals) : share_cell(target.score),
         target.minimum_text, std::string(verdict_name(target.minimum)), target.excellent_text,
         std::string(verdict_name(target.excellent))});
  }
  return "## Targets\n\n" + table.text() +
         "Met: the estimate reaches the target and the one-sided 95 % bound clears it. Met, not "
         "shown at this size: the estimate alone does. Per cent are those of the meter that is "
         "moved most.\n\n";
}

std::string naming_section(const NamingScores& naming) {
  MarkdownTable table({"hidden", "cases", "right", "top-1", "top-3", "class", "a wrong name",
                       "unknown", "confusable", "none"});
  for (const GroupScores& group : naming.groups) {
    table.add({group.group, std::to_string(group.cases), share_cell(group.right),
               share_cell(group.top1), share_cell(group.top3), share_cell(group.class_right),
               share_cell(group.wrong_name), share_cell(group.said_unknown),
               share_cell(group.said_confusable), share_cell(group.said_none)});
  }
  return "## What was said\n\n" + table.text() +
         "Right: the outcome and the names are exactly the true ones (out of the catalogue: "
         "unknown). Top-1, top-3: the truth is first, or among the first three, of all answers "
         "ranked by probability, none and unknown included; of a pair, either.\n\n";
}

std::string upper_bound(const std::optional<Score>& score) {
  return score ? fmt::format(", at most {:.1f} % (one-sided)", 100.0 * score->one_sided->high) : "";
}

std::string special_section(const NamingScores& naming) {
  MarkdownTable table({"question", "cases"});
  table.add({"nothing hidden, yet an effect named",
             share_cell(naming.false_names) + upper_bound(naming.false_names)});
  table.add({"nothing hidden, yet not said so", share_cell(naming.false_alarms)});
  table.add(
      {"something hidden, and an effect named that is not there", share_cell(naming.wrong_names)});
  table.add({"out of the catalogue, yet an effect named",
             share_cell(naming.out_of_catalogue_wrong_name)});
  table.add({"out of the catalogue, flagged unknown", share_cell(naming.out_of_catalogue_unknown)});
  table.add({"pair: both named", share_cell(naming.pairs.both)});
  table.add({"pair: one named", share_cell(naming.pairs.only_one)});
  table.add({"pair: neither named", share_cell(naming.pairs.neither)});
  table.add({"decoy on offer: right", share_cell(naming.decoys.right)});
  table.add({"decoy on offer: a wrong name", share_cell(naming.decoys.wrong_name)});
  table.add({"confusable: a true one in the set", share_cell(naming.confusable_has_truth)});
  table.add(
      {"located first: the meter most affected", share_cell(naming.places.first_meter_right)});
  table.add({"located at all: the meter most affected", share_cell(naming.places.found_among_all)});
  return "## Particular questions\n\n" + table.text();
}

std::string reliability_tables(const ProbabilityScores& probability) {
  MarkdownTable bins({"stated probability of the first answer", "cases", "mean stated", "right"});
  for (const ReliabilityBin& bin : probability.bins) {
    if (bin.cases == 0) continue;
    bins.add({fmt::format("{:.2f} to {:.2f}", bin.low, bin.high), std::to_string(bin.cases),
              fmt::format("{:.2f}", bin.mean_probability), share_cell(bin.right)});
  }
  MarkdownTable kinds({"first answer", "cases", "mean stated", "right"});
  for (const ReliabilityOfKind& kind : probability.kinds) {
    if (kind.cases == 0) continue;
    kinds.add({kind.kind, std::to_string(kind.cases), fmt::format("{:.2f}", kind.mean_probability),
               share_cell(kind.right)});
  }
  return bins.text() + kinds.text();
}

std::string probability_section(const ProbabilityScores& probability) {
  if (probability.cases == 0) return "## Probabilities\n\nThe results give none.\n\n";
  MarkdownTable summary({"score", "value"});
  summary.add({"Brier, 0 to 2 (without pairs)", number_cell(probability.brier, 3)});
  summary.add({"log loss, nats (without pairs)", number_cell(probability.log_loss, 3)});
  summary.add({fmt::format("cases whose truth had less than {:g}", kProbabilityFloor),
               std::to_string(probability.floored)});
  summary.add(
      {"slope that would be best (1: as sure as they may be)", number_cell(probability.slope, 2)});
  summary.add({"calibration error (ECE)", number_cell(probability.ece, 3)});
  summary.add({"name said with P >= 0.8 is right", share_cell(probability.sure_names_right)});

  MarkdownTable curve({"named from P", "named, of hidden", "right, of named", "named, of nothing"});
  for (const AbstentionPoint& point : probability.abstention) {
    curve.add({fmt::format("{:g}", point.threshold), share_cell(point.coverage),
               share_cell(point.accuracy), share_cell(point.false_names)});
  }
  return fmt::format("## Probabilities\n\n{} cases with probabilities.\n\n", probability.cases) +
         summary.text() + reliability_tables(probability) +
         "If an effect were named whenever it is the most probable answer, from a threshold "
         "on:\n\n" +
         curve.text();
}

std::string gap_section(const GapScores& gap) {
  MarkdownTable table({"quantity", "median or share"});
  table.add({"gap closed, R by CV(RMSE) of the most affected meter (3 % and more, named)",
             number_cell(gap.cvrmse)});
  table.add({"the same by log score of all meters", number_cell(gap.log_score)});
  table.add({"R by CV(RMSE), all cases with an effect, named or not", number_cell(gap.cvrmse_all)});
  table.add({"the same by log score", number_cell(gap.log_score_all)});
  table.add({"another meter made worse by more than 2 standard errors", share_cell(gap.harm)});
  table.add({"bias of parameters before, in prior sd", number_cell(gap.bias.before)});
  table.add({"bias of parameters after", number_cell(gap.bias.after)});
  table.add({"after / before", number_cell(gap.bias.ratio)});
  table.add({"90 % interval of the effect has the truth", share_cell(gap.effect_coverage)});
  std::string text = "## What it was good for\n\n" + table.text() +
                     "R: 0 closes nothing of the gap on held months, 1 as much as a refit with the "
                     "true effect.\n\n";
  if (gap.cvrmse && gap.cvrmse->cases < gap.large_named) {
    text += fmt::format(
        "R is known for {} of {} named cases; the others lack a fit, or the true "
        "effect closes nothing.\n\n",
        gap.cvrmse->cases, gap.large_named);
  }
  if (gap.additions_without_harm_figures > 0) {
    text += fmt::format("{} additions came without figures for other meters.\n\n",
                        gap.additions_without_harm_figures);
  }
  if (gap.other_units > 0) {
    text +=
        fmt::format("{} intervals of effects are in another unit than the answer: left out.\n\n",
                    gap.other_units);
  }
  if (!gap.parameters_without_truth.empty()) {
    text += fmt::format("Parameters without a known truth, left out: {}.\n\n",
                        fmt::join(gap.parameters_without_truth, ", "));
  }
  return text;
}

std::string method_section(const std::vector<MethodRow>& methods) {
  MarkdownTable table({"method", "cases", "right", "single right", "single top-1", "false names",
                       "out of catalogue: wrong name", "median R, all", "median s"});
  for (const MethodRow& row : methods) {
    table.add({row.method, std::to_string(row.cases), share_cell(row.right),
               share_cell(row.single_right), share_cell(row.single_top1),
               share_cell(row.false_names), share_cell(row.out_of_catalogue_wrong_name),
               number_cell(row.gap), number_cell(row.wall_s, 1)});
  }
  MarkdownTable pairs({"against", "shared cases", "only " + methods.front().method + " right",
                       "only the other right", "difference", "McNemar p", "difference in R", ""});
  for (const MethodRow& row : methods) {
    if (!row.against) continue;
    const PairedDifference& against = *row.against;
    pairs.add({row.method, std::to_string(against.cases), std::to_string(against.only_main_right),
               std::to_string(against.only_other_right), share_cell(against.right),
               fmt::format("{:.2g}", against.mcnemar_p), number_cell(against.gap),
               std::string(comparison_name(against.verdict))});
  }
  return "## Methods\n\n" + table.text() + pairs.text();
}

std::string cost_section(const CostScores& cost) {
  MarkdownTable table({"a case", "median", "95 % of cases", "largest"});
  const auto add = [&](const char* what, const std::optional<Spread>& spread) {
    if (!spread) return;
    table.add({what, number_cell(spread->median, 1), fmt::format("{:.1f}", spread->p95),
               fmt::format("{:.1f}", spread->max)});
  };
  add("time, s", cost.wall_s);
  add("memory, MB", cost.peak_rss_MB);
  return "## Time and memory\n\n" + (table.text().empty() ? "Not stated.\n\n" : table.text());
}

std::string breakdown_section(const NamingScores& naming) {
  MarkdownTable table({"cases with", "right"});
  for (const Breakdown& row : naming.breakdowns) table.add({row.what, share_cell(row.right)});
  return "## Where\n\n" + table.text();
}

/// A row a truth; columns would be forty, so what was said stands in a cell, most frequent first.
std::string confusion_section(const NamingScores& naming) {
  MarkdownTable table({"truth", "said (cases)"});
  for (const auto& [truth, said] : naming.confusion) {
    std::vector<std::pair<std::string, int>> sorted(said.begin(), said.end());
    std::ranges::stable_sort(sorted, std::ranges::greater{}, &std::pair<std::string, int>::second);
    std::vector<std::string> cells;
    cells.reserve(sorted.size());
    for (const auto& [name, cases] : sorted) cells.push_back(fmt::format("{} ({})", name, cases));
    table.add({truth, fmt::format("{}", fmt::join(cells, ", "))});
  }
  return "## What was taken for what\n\n" + table.text();
}

std::string failure_section(const std::vector<Failure>& failures) {
  if (failures.empty()) return "## Failures\n\nNone.\n";
  MarkdownTable table({"case", "block", "truth", "said"});
  for (const Failure& row : failures) table.add({row.case_id, row.block, row.truth, row.said});
  std::string text = "## Failures\n\n" + table.text();
  text.pop_back();  // The blank line after the table would end the file.
  return text;
}

}  // namespace

std::string scores_markdown(const Scores& scores, const Circumstances& circumstances) {
  return head(scores, circumstances) + target_section(scores) + naming_section(scores.naming) +
         special_section(scores.naming) + probability_section(scores.probability) +
         gap_section(scores.gap) + method_section(scores.methods) + cost_section(scores.cost) +
         breakdown_section(scores.naming) + confusion_section(scores.naming) +
         failure_section(scores.failures);
}

}  // namespace recald::blind
