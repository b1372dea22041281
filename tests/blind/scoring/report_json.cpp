#include <nlohmann/json.hpp>

#include "tests/blind/scoring/report.hpp"

namespace recald::blind {
namespace {

using Json = nlohmann::ordered_json;

Json of(const std::optional<Score>& score) {
  if (!score) return nullptr;
  Json json{{"value", score->value}, {"cases", score->cases}};
  if (score->hits) json["hits"] = *score->hits;
  if (score->interval) json["interval95"] = {score->interval->low, score->interval->high};
  if (score->one_sided) {
    json["lower95"] = score->one_sided->low;
    json["upper95"] = score->one_sided->high;
  }
  return json;
}

Json of(const std::optional<Spread>& spread) {
  if (!spread) return nullptr;
  return {{"median", of(spread->median)}, {"p95", spread->p95}, {"max", spread->max}};
}

/// `row` of each item, as a list.
template <class Items, class Row>
Json list_of(const Items& items, Row row) {
  Json list = Json::array();
  for (const auto& item : items) list.push_back(row(item));
  return list;
}

Json of_target(const Target& target) {
  return {{"world", target.world},
          {"quantity", target.quantity},
          {"score", of(target.score)},
          {"minimum", target.minimum_text},
          {"minimum_verdict", verdict_name(target.minimum)},
          {"excellent", target.excellent_text},
          {"excellent_verdict", verdict_name(target.excellent)}};
}

Json of_group(const GroupScores& group) {
  return {{"group", group.group},
          {"cases", group.cases},
          {"right", of(group.right)},
          {"top1", of(group.top1)},
          {"top3", of(group.top3)},
          {"class_right", of(group.class_right)},
          {"wrong_name", of(group.wrong_name)},
          {"said_unknown", of(group.said_unknown)},
          {"said_confusable", of(group.said_confusable)},
          {"said_none", of(group.said_none)}};
}

Json of_naming(const NamingScores& naming) {
  const auto breakdown = [](const Breakdown& row) {
    return Json{{"what", row.what}, {"right", of(row.right)}};
  };
  return {{"right", of(naming.right)},
          {"groups", list_of(naming.groups, of_group)},
          {"false_names", of(naming.false_names)},
          {"false_alarms", of(naming.false_alarms)},
          {"wrong_names", of(naming.wrong_names)},
          {"out_of_catalogue_wrong_name", of(naming.out_of_catalogue_wrong_name)},
          {"out_of_catalogue_unknown", of(naming.out_of_catalogue_unknown)},
          {"confusable_has_truth", of(naming.confusable_has_truth)},
          {"pair_both", of(naming.pairs.both)},
          {"pair_only_one", of(naming.pairs.only_one)},
          {"pair_neither", of(naming.pairs.neither)},
          {"pair_both_large", of(naming.pairs.both_large)},
          {"decoys",
           {{"cases", naming.decoys.cases},
            {"right", of(naming.decoys.right)},
            {"wrong_name", of(naming.decoys.wrong_name)}}},
          {"located_meter_right", of(naming.places.first_meter_right)},
          {"located_meter_among_all", of(naming.places.found_among_all)},
          {"right_by", list_of(naming.breakdowns, breakdown)},
          {"confusion", naming.confusion}};
}

Json of_probability(const ProbabilityScores& probability) {
  const auto bin = [](const ReliabilityBin& row) {
    return Json{{"from", row.low},
                {"to", row.high},
                {"cases", row.cases},
                {"mean_probability", row.mean_probability},
                {"right", of(row.right)}};
  };
  const auto kind = [](const ReliabilityOfKind& row) {
    return Json{{"kind", row.kind},
                {"cases", row.cases},
                {"mean_probability", row.mean_probability},
                {"right", of(row.right)}};
  };
  const auto abstention = [](const AbstentionPoint& row) {
    return Json{{"threshold", row.threshold},
                {"coverage", of(row.coverage)},
                {"accuracy", of(row.accuracy)},
                {"false_names", of(row.false_names)}};
  };
  return {{"cases", probability.cases},
          {"brier", of(probability.brier)},
          {"log_loss", of(probability.log_loss)},
          {"log_loss_floored", probability.floored},
          {"slope", of(probability.slope)},
          {"ece", of(probability.ece)},
          {"reliability", list_of(probability.bins, bin)},
          {"reliability_by_kind", list_of(probability.kinds, kind)},
          {"sure_names_right", of(probability.sure_names_right)},
          {"abstention", list_of(probability.abstention, abstention)}};
}

Json of_gap(const GapScores& gap) {
  return {{"large_named", gap.large_named},
          {"reduction_cvrmse", of(gap.cvrmse)},
          {"reduction_log_score", of(gap.log_score)},
          {"reduction_cvrmse_all", of(gap.cvrmse_all)},
          {"reduction_log_score_all", of(gap.log_score_all)},
          {"harm", of(gap.harm)},
          {"additions_without_harm_figures", gap.additions_without_harm_figures},
          {"bias_before", of(gap.bias.before)},
          {"bias_after", of(gap.bias.after)},
          {"bias_ratio", of(gap.bias.ratio)},
          {"effect_interval_coverage", of(gap.effect_coverage)},
          {"effect_intervals_in_other_units", gap.other_units},
          {"parameters_without_truth", gap.parameters_without_truth}};
}

Json of_method(const MethodRow& row) {
  Json json{{"method", row.method},
            {"cases", row.cases},
            {"right", of(row.right)},
            {"single_right", of(row.single_right)},
            {"single_top1", of(row.single_top1)},
            {"false_names", of(row.false_names)},
            {"out_of_catalogue_wrong_name", of(row.out_of_catalogue_wrong_name)},
            {"reduction_cvrmse_all", of(row.gap)},
            {"wall_s", of(row.wall_s)}};
  if (!row.against) return json;
  json["against"] = {{"cases", row.against->cases},
                     {"only_main_right", row.against->only_main_right},
                     {"only_other_right", row.against->only_other_right},
                     {"right_difference", of(row.against->right)},
                     {"mcnemar_p", row.against->mcnemar_p},
                     {"reduction_difference", of(row.against->gap)},
                     {"verdict", comparison_name(row.against->verdict)}};
  return json;
}

Json of_calibration(const CalibrationScores& calibration) {
  return {{"cvrmse_by_drawings", of(calibration.before)},
          {"cvrmse_calibrated", of(calibration.after)},
          {"cvrmse_forecast", of(calibration.forecast)},
          {"cvrmse_yardstick", of(calibration.yardstick)},
          {"made_worse_by_calibrating", of(calibration.harmed)},
          {"yardstick_better", of(calibration.beaten)}};
}

Json of_drift(const DriftScores& drift) {
  return {{"found", of(drift.found)},
          {"found_large", of(drift.found_large)},
          {"delay_months", of(drift.delay_months)},
          {"alarmed_too_early", of(drift.early)},
          {"cause_right", of(drift.cause_right)},
          {"side_right", of(drift.side_right)},
          {"sure_cause_right", of(drift.sure_right)},
          {"false_alarms", of(drift.false_alarms)}};
}

Json of_world(const WorldScores& world) {
  return {{"world", world.world},
          {"cases", world.cases},
          {"naming", of_naming(world.naming)},
          {"probability", of_probability(world.probability)},
          {"gap", of_gap(world.gap)},
          {"nothing_hidden", of_calibration(world.calibration)},
          {"drift", of_drift(world.drift)},
          {"wall_s", of(world.cost.wall_s)},
          {"peak_rss_MB", of(world.cost.peak_rss_MB)}};
}

}  // namespace

std::string scores_json(const Scores& scores, const Circumstances& circumstances) {
  const auto failure_row = [](const Failure& row) {
    return Json{
        {"case", row.case_id}, {"block", row.block}, {"truth", row.truth}, {"said", row.said}};
  };
  const Json json{{"warnings", circumstances.warnings},
                  {"method", scores.method},
                  {"cases", scores.cases},
                  {"population_cases", scores.population_cases},
                  {"versions", scores.versions},
                  {"scorer", circumstances.scorer_version},
                  {"answers_sha256", circumstances.whole_hash},
                  {"results_sha256", circumstances.results_hash},
                  {"bootstrap", {{"seed", kBootstrapSeed}, {"resamples", kBootstrapResamples}}},
                  {"targets", list_of(scores.targets, of_target)},
                  {"worlds", list_of(scores.worlds, of_world)},
                  {"naming", of_naming(scores.naming)},
                  {"probability", of_probability(scores.probability)},
                  {"gap", of_gap(scores.gap)},
                  {"wall_s", of(scores.cost.wall_s)},
                  {"peak_rss_MB", of(scores.cost.peak_rss_MB)},
                  {"methods", list_of(scores.methods, of_method)},
                  {"failures", list_of(scores.failures, failure_row)}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace recald::blind
