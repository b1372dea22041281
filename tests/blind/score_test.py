"""The scorer on hand-made answers: each expectation is worked out beside it."""

import contextlib
import copy
import hashlib
import io
import json
import math
import pathlib
import random
import subprocess
import sys
import tempfile
import unittest
from unittest import mock

import records
import score

HERE = pathlib.Path(__file__).parent


def effect(name, group="schedules", share=None, **changed):
    """Moves steam by 10 %, or electricity by `share`."""
    moved = {} if share is None else {"moved_share": {"electricity": share, "steam": 0.0}}
    return {"effect": name, "class": group, "in_catalogue": True, "strength": 3.0, "unit": "h", "from": None, "to": None,
            "share_of_meter": {"electricity": 0.03, "steam": -0.10}} | moved | changed  # fmt: skip


def answer(case, block="no_effect", *effects, **changed):
    return {"case": case, "world": "own", "block": block, "effects": list(effects), "decoys": [], "climate": "cold", "use": "office", "gaps": False,
            "true_parameters": {"cooling_setpoint_C": 24.0, "occupancy": 1.0}, "prior_sd": {"cooling_setpoint_C": 2.0, "occupancy": 0.5}} | changed  # fmt: skip


def single(case, name="A", group="schedules", **changed):
    return answer(case, "single", effect(name, group, **changed))


def said(case, outcome="none", probabilities=None, method="recald", **more):
    line = {"case": case, "method": method, "outcome": outcome, "named": []} | more
    return line | ({"probabilities": probabilities} if probabilities else {})


def named(case, *names, probabilities=None, method="recald", **more):
    return said(case, "named", probabilities, method, named=list(names), **more)


class Population:
    def __init__(self):
        self.answers, self.results = {}, []

    def add(self, its_answer, *results):
        self.answers[its_answer["case"]] = its_answer
        self.results += results

    def rows(self, method="recald"):
        return score.table_of(self.answers, self.results, method, score.classes_of(self.answers, {}))

    def scores(self):
        return score.scores_of(self.answers, self.results, "recald", score.classes_of(self.answers, {}), 5)

    def naming(self):
        return score.naming_scores(self.rows())

    def probability(self, bins=5):
        return score.probability_scores(self.rows(), bins)


def counts(of):
    return of and (of["hits"], of["cases"])


def group(naming, name):
    return next(of for of in naming["groups"] if of["group"] == name)


def judged(its_answer, result, **classes):
    return score.judged(its_answer, result, classes)


class Intervals(unittest.TestCase):
    def test_clopper_pearson_meets_published_values(self):
        # The last: R's help page of binom.test (Conover, 1971, p. 97). The others: the plan of the first blind test.
        for hits, cases, low, high, rounding in [
            (0, 60, 0, 6.0, 0.05), (1, 60, 0, 8.9, 0.05), (3, 60, 1.0, 13.9, 0.05), (45, 60, 62, 85, 0.5), (51, 60, 73, 93, 0.5),
            (36, 40, 76, 97, 0.5), (2, 20, 1, 32, 0.5), (12, 20, 36, 81, 0.5), (682, 925, 70.76683, 76.54066, 5e-6),
        ]:  # fmt: skip
            found = score.share([True] * hits + [False] * (cases - hits))["interval95"]
            self.assertAlmostEqual(100 * found[0], low, delta=rounding)
            self.assertAlmostEqual(100 * found[1], high, delta=rounding)

    def test_one_sided_bounds(self):
        for hits, cases, upper in ((0, 60, 4.9), (1, 60, 7.7), (3, 60, 12.4)):
            self.assertAlmostEqual(100 * score.share([True] * hits + [False] * (cases - hits))["upper95"], upper, delta=0.05)
        self.assertLessEqual(score.share([False] * 299)["upper95"], 0.01)
        self.assertGreater(score.share([False] * 298)["upper95"], 0.01)

    def test_closed_forms_at_the_ends(self):
        for cases in (1, 7, 1000):
            self.assertEqual(score.clopper_pearson(0, cases, 0.025)[0], 0)
            self.assertAlmostEqual(score.clopper_pearson(0, cases, 0.025)[1], 1 - 0.025 ** (1 / cases), places=12)
            self.assertAlmostEqual(score.clopper_pearson(cases, cases, 0.025)[0], 0.025 ** (1 / cases), places=12)

    def test_few_cases_have_an_estimate_but_no_resampled_interval(self):
        for of in (score.share, score.median, score.mean):
            self.assertIsNone(of([]))
        self.assertEqual(score.median([5, 1, 2, 4, 3]), {"value": 3.0, "cases": 5})
        self.assertEqual(score.median([5, 1, 2, 4, 3, 6])["value"], 3.5)
        self.assertIn("interval95", score.median([5, 1, 2, 4, 3, 6]))

    def test_bootstrap_meets_theory(self):
        # The mean of 0 … 99 has a standard error of 2.887; the median of 1 … 100 lies between ranks 40 and 61.
        mean, median = score.mean(range(100)), score.median(range(1, 101))
        self.assertAlmostEqual(mean["interval95"][0], 49.5 - 1.960 * 2.887, delta=0.7)
        self.assertAlmostEqual(mean["upper95"], 49.5 + 1.645 * 2.887, delta=0.7)
        self.assertAlmostEqual(median["interval95"][0], 40.5, delta=2)
        self.assertAlmostEqual(median["interval95"][1], 60.5, delta=2)
        self.assertEqual(mean, score.mean(range(100)))

    def test_a_resample_without_repetition_is_the_sample(self):
        for n in (6, 7):
            values = random.Random(n).sample(range(100), n)
            with mock.patch.object(score.np.random, "default_rng") as rng:
                rng.return_value.multinomial.return_value = score.np.ones((3, n), int)
                self.assertEqual(score.median(values)["interval95"], [score.np.median(values)] * 2)


class Naming(unittest.TestCase):
    def each(self):
        pair = answer("p1", "pair", effect("setback"), effect("economiser", "outdoor_air"))
        return [answer("n1"), answer("n2"), single("s1", "setback"), single("s2", "holiday"), single("s3", "infiltration", "envelope"), pair,
                answer("o1", "out_of_catalogue", effect("ev_charging", in_catalogue=False)),
                answer("o2", "out_of_catalogue", decoys=["neighbour_meter"])]  # fmt: skip

    def test_an_oracle_scores_one_everywhere(self):
        population = Population()
        for one in self.each():
            truth = score.truths_of(one)
            population.add(
                one, named(one["case"], *truth) if truth[0] not in ("none", "unknown") else said(one["case"], truth[0], {truth[0]: 1.0})
            )
        naming = population.naming()
        self.assertEqual(counts(naming["right"]), (8, 8))
        for of in naming["groups"]:
            for key in ("right", "top1", "top3"):
                self.assertEqual(counts(of[key]), (of["cases"], of["cases"]), of["group"])
            self.assertEqual(counts(of["wrong_name"]), (0, of["cases"]))
        self.assertEqual(counts(group(naming, "single, all")["class_right"]), (3, 3))
        self.assertEqual(counts(naming["out_of_catalogue_unknown"]), (1, 1))
        self.assertEqual(counts(naming["pair_both"]), (1, 1))

    def test_always_none_is_right_only_where_nothing_is_hidden(self):
        population = Population()
        for one in self.each():
            population.add(one, said(one["case"]))
        naming = population.naming()
        self.assertEqual(counts(naming["right"]), (3, 8))  # n1, n2 and the decoy
        self.assertEqual(counts(group(naming, "single, all")["said_none"]), (3, 3))
        self.assertEqual(counts(group(naming, "single, all")["top3"]), (0, 3))
        self.assertEqual(counts(naming["pair_neither"]), (1, 1))

    def test_a_random_guesser_scores_by_chance(self):
        # Of 42 answers: first with 1/42, among three with 3/42; of 4200, 100 +- 9.9 and 300 +- 16.7.
        rng, population = random.Random(5), Population()
        for i in range(4200):
            names = [f"e{k}" for k in range(40)]
            p = {name: rng.random() for name in [*names, "none", "unknown"]}
            population.add(single(f"s{i}", rng.choice(names)), said(f"s{i}", "none", p))
        singles = group(population.naming(), "single, all")
        self.assertAlmostEqual(singles["top1"]["hits"], 100, delta=40)
        self.assertAlmostEqual(singles["top3"]["hits"], 300, delta=67)

    def test_the_ranking(self):
        p = {"none": 0.4, "A": 0.3, "unknown": 0.2, "B": 0.1}
        self.assertEqual([judged(single("s", t), said("s", "none", p))["top3"] for t in "AB"], [True, False])
        self.assertFalse(judged(single("s"), said("s", "none", p))["top1"])
        tie = dict.fromkeys(["none", "A", "B", "C"], 0.25)
        for truth in "ABC":  # Were the truth taken first, a method could say the same of everything.
            self.assertFalse(judged(single("s", truth), said("s", "none", tie))["top3"], truth)
        # What was said goes before what was thought.
        result = named("s", "A", probabilities={"A": 0.4, "B": 0.6})
        self.assertEqual([judged(single("s", t), result)["top1"] for t in "AB"], [True, False])

    def test_a_second_name_that_is_not_there_spoils_the_answer(self):
        row = judged(single("s"), named("s", "A", "B"))
        self.assertEqual((row["top1"], row["right"], row["wrong_name"], row["hidden_named"], row["said"]), (True, False, True, 1, "A + B"))

    def test_pairs_are_counted_by_how_many_were_named(self):
        population = Population()
        for i, names in enumerate(["BA", "A", "AC", "C", "ABC", ""]):
            case = f"p{i}"
            population.add(answer(case, "pair", effect("A"), effect("B")), named(case, *names) if names else said(case, "unknown"))
        naming = population.naming()
        self.assertEqual([counts(naming[key]) for key in ("pair_both", "pair_only_one", "pair_neither", "pair_both_large", "right")],
                         [(2, 6), (2, 6), (2, 6), (2, 6), (1, 6)])  # fmt: skip
        self.assertEqual(counts(group(naming, "pair")["wrong_name"]), (3, 6))
        self.assertEqual(naming["confusion"]["A + B"], {"A": 1, "A + B": 1, "A + B + C": 1, "A + C": 1, "C": 1, "unknown": 1})

    def test_of_two_effects_the_weaker_one_counts(self):
        self.assertEqual(records.largest_share([effect("A", share=0.2), effect("B", share=0.02)]), 0.02)
        self.assertEqual(records.largest_share([]), 0.0)
        self.assertEqual(records.most_affected_meter([effect("A")]), "steam")

    def test_classes_are_the_answers_or_listed(self):
        classes = {"A": "schedules", "B": "schedules", "C": "plant"}
        self.assertEqual([judged(single("s"), named("s", n), **classes)["class_right"] for n in "ABCD"], [True, True, False, False])
        with self.assertRaisesRegex(records.Refused, "answer b: effect A is of class plant, but of class schedules elsewhere"):
            score.classes_of({"a": single("a"), "b": single("b", group="plant")}, {})

    def test_singles_are_scored_by_the_share_that_they_move(self):
        population = Population()
        for case, share, names in (("a", 0.03, "A"), ("b", 0.099, "B"), ("c", 0.1, "A"), ("d", 0.009, ""), ("e", None, "A")):
            population.add(single(case, share=share), named(case, *names) if names else said(case, "unknown"))
        naming = population.naming()
        self.assertEqual(counts(group(naming, "single, 3 to 10 %")["top1"]), (1, 2))
        self.assertEqual(counts(group(naming, "single, above 10 %")["right"]), (2, 2))
        self.assertEqual(counts(group(naming, "single, below 1 %")["said_unknown"]), (1, 1))
        self.assertEqual(counts(naming["wrong_names"]), (1, 5))

    def test_a_confusable_set_is_the_one_given_or_the_probable_names(self):
        result = said("s", "confusable", {"A": 0.5, "B": 0.4, "none": 0.1})
        self.assertEqual(score.set_of(result), ["A", "B"])
        result["confusable"] = ["B", "C"]
        row = judged(single("s", "C"), result)
        self.assertEqual((row["set_has_truth"], row["right"]), (True, False))

    def test_false_alarms_decoys_and_places(self):
        population = Population()
        for case, outcome in (("a", "unknown"), ("b", "confusable"), ("c", "named"), ("d", "none")):
            population.add(answer(case), named(case, "A") if outcome == "named" else said(case, outcome))
        for case, outcome in (("x", "none"), ("y", "unknown"), ("z", "named")):
            decoy = answer(case, "out_of_catalogue", decoys=["wind"], climate="hot-dry", gaps=True)
            population.add(decoy, named(case, "wind") if outcome == "named" else said(case, outcome))
        for case, places in (("l1", ["steam", "electricity"]), ("l2", ["electricity", "steam"]), ("l3", []), ("l4", None)):
            located = {} if places is None else {"located": [{"meter": meter} for meter in places]}
            population.add(single(case), said(case, "unknown") | located)
        naming = population.naming()
        self.assertEqual((counts(naming["false_names"]), counts(naming["false_alarms"])), ((1, 4), (3, 4)))
        self.assertEqual((counts(naming["decoys"]["right"]), counts(naming["decoys"]["wrong_name"])), ((1, 3), (1, 3)))
        self.assertIsNone(naming["out_of_catalogue_unknown"])
        self.assertEqual((counts(naming["located_meter_right"]), counts(naming["located_meter_among_all"])), ((1, 3), (2, 3)))
        by = {row["what"]: counts(row["right"]) for row in naming["right_by"]}
        self.assertEqual((by["climate hot-dry"], by["with gaps"], by["use office"]), ((1, 3), (1, 3), (2, 11)))


class Probabilities(unittest.TestCase):
    def test_brier_and_log_loss_by_hand(self):
        # Truth A: 0.09 + 0.04 + 0.01. Truth none: 0.49 + 0.64 + 0.01. Truth unknown: 0.49 + 0.04 + 0.81.
        p, population = {"A": 0.7, "none": 0.2, "unknown": 0.1}, Population()
        outside = answer("c", "out_of_catalogue", effect("ev", in_catalogue=False))
        for one in (single("a"), answer("b"), outside):
            population.add(one, said(one["case"], "none", p))
        found = population.probability()
        self.assertAlmostEqual(found["brier"]["value"], (0.14 + 1.14 + 1.34) / 3)
        self.assertAlmostEqual(found["log_loss"]["value"], (0.356675 + 1.609438 + 2.302585) / 3, places=6)

    def test_the_best_and_the_worst(self):
        best, worst = Population(), Population()
        best.add(answer("b"), said("b", "none", {"none": 1.0}))
        worst.add(single("a"), said("a", "none", {"none": 1.0}))
        self.assertEqual([best.probability()[key]["value"] for key in ("brier", "log_loss", "ece")], [0, 0, 0])
        found = worst.probability()
        self.assertEqual((found["brier"]["value"], found["log_loss_floored"], found["ece"]["value"]), (2, 1, 1))
        self.assertAlmostEqual(found["log_loss"]["value"], -math.log(1e-6))

    def stated(self, *given):
        """`right` of `all` cases in which "none" has probability p and is true."""
        population = Population()
        for p, right, every in given:
            for i in range(every):
                case = f"c{len(population.answers):03}"
                outside = answer(case, "out_of_catalogue", effect("ev", in_catalogue=False))
                population.add(answer(case) if i < right else outside, said(case, "none", {"none": p, "unknown": 1 - p}))
        return population

    def test_miscalibration_by_hand(self):
        found = self.stated((0.9, 6, 10), (0.7, 7, 10)).probability()
        self.assertAlmostEqual(found["ece"]["value"], 0.15)  # 10/20 |0.6 - 0.9|
        self.assertEqual([(row["cases"], counts(row["right"])) for row in found["reliability"][3:]], [(10, (7, 10)), (10, (6, 10))])
        self.assertIsNone(found["reliability"][0]["right"])
        # In one bin errors of either sign cancel, in two they do not. One belongs to the last bin.
        both = self.stated((0.85, 10, 10), (0.95, 8, 10))
        self.assertAlmostEqual(both.probability(5)["ece"]["value"], 0.0)
        self.assertAlmostEqual(both.probability(10)["ece"]["value"], 0.15)
        self.assertEqual(self.stated((1.0, 1, 1)).probability()["reliability"][-1]["cases"], 1)

    def test_the_slope_is_below_one_where_they_are_too_sure(self):
        # Said 0.9 and right 6 of 10: best where 0.9^s / (0.9^s + 0.1^s) = 0.6, s = ln 1.5 / ln 9 = 0.185.
        slope = self.stated((0.9, 60, 100)).probability()["slope"]
        self.assertAlmostEqual(slope["value"], 0.185, delta=0.007)
        self.assertLess(slope["interval95"][1], 0.4)

    def test_pairs_count_for_reliability_only(self):
        population = Population()
        population.add(answer("p", "pair", effect("A"), effect("B")), named("p", "A", "B", probabilities={"A": 0.4, "B": 0.6}))
        found = population.probability()
        self.assertIsNone(found["brier"])
        self.assertAlmostEqual(found["ece"]["value"], 0.4)  # B with 0.6, right

    def test_a_tied_truth_is_not_the_first_answer(self):
        for truth in "AB":
            self.assertFalse(score.top_answer(said("a", "none", {"A": 0.5, "B": 0.5}), [truth])["is_true"])

    def test_thresholds_and_sure_names(self):
        population = Population()
        population.add(single("a"), named("a", "A", probabilities={"A": 0.85, "none": 0.15}))
        population.add(single("b"), named("b", "B", probabilities={"B": 0.95, "none": 0.05}))
        population.add(answer("c"), said("c", "none", {"B": 0.6, "none": 0.4}))
        found = population.probability()
        self.assertEqual(counts(found["sure_names_right"]), (1, 2))
        at = {point["threshold"]: [counts(point[key]) for key in ("coverage", "accuracy", "false_names")] for point in found["abstention"]}
        self.assertEqual(at[0.5], [(2, 2), (1, 3), (1, 1)])
        self.assertEqual(at[0.9], [(1, 2), (0, 1), (0, 1)])


def fit(cvrmse, log_score):
    return {"steam": {"log_score": log_score, "cvrmse": cvrmse}, "electricity": {"log_score": -1.0, "cvrmse": 0.02}}


def closing(share):
    return {"before": fit(0.2, -3), "after": fit(0.2 - 0.1 * share, -3 + share), "oracle": fit(0.1, -2)}


class Gaps(unittest.TestCase):
    def reduction(self, result, oracles=None):
        population = Population()
        population.add(single("s"), result)
        return score.reduction(next(population.rows().itertuples()), oracles or {})

    def test_reduction_by_hand(self):
        # (0.20 - 0.11) / (0.20 - 0.08) = 0.75; electricity cancels: (3 - 2.2) / (3 - 2) = 0.8.
        gap = {"before": fit(0.20, -3.0), "after": fit(0.11, -2.2)}
        oracle = {"before": fit(0.20, -3.0), "after": fit(0.08, -2.0)}
        for result, oracles in ((named("s", "A", gap=gap | {"oracle": oracle["after"]}), {}), (named("s", "A", gap=gap), {"s": oracle})):
            for found, wanted in zip(self.reduction(result, oracles), (0.75, 0.8)):
                self.assertAlmostEqual(found, wanted)
        self.assertEqual(self.reduction(named("s", "A", gap=gap)), (None, None))
        # Nothing added closes nothing; an addition without figures is not known to.
        self.assertEqual(self.reduction(said("s"), {"s": oracle}), (0.0, 0.0))
        self.assertEqual(self.reduction(named("s", "A"), {"s": oracle}), (None, None))
        # Where the oracle closes nothing there is no gap; better than the truth is not clipped.
        by_error, by_score = self.reduction(named("s", "A", gap=gap | {"oracle": fit(0.20, -2.9)}))
        self.assertIsNone(by_error)
        self.assertAlmostEqual(by_score, 8.0)

    def test_medians_by_hand(self):
        population = Population()
        population.add(single("a"), named("a", "A", gap=closing(0.2)))
        population.add(single("b"), named("b", "A", gap=closing(0.6)))
        population.add(answer("c", "pair", effect("A"), effect("B")), named("c", "A", gap=closing(0.9)))
        population.add(single("d"), said("d", gap=closing(0.0)))
        population.add(single("e", share=0.02), named("e", "A", gap={w: {"electricity": f["steam"]} for w, f in closing(0.4).items()}))
        population.add(answer("f"), named("f", "A", gap=closing(1.0)))
        population.add(single("g"), named("g", "A"))
        found = score.gap_scores(population.rows(), {})
        self.assertEqual((found["large_named"], found["reduction_cvrmse"]["cases"], found["reduction_cvrmse_all"]["cases"]), (4, 3, 5))
        self.assertAlmostEqual(found["reduction_cvrmse"]["value"], 0.6)
        self.assertAlmostEqual(found["reduction_log_score"]["value"], 0.6)
        self.assertAlmostEqual(found["reduction_cvrmse_all"]["value"], 0.4)

    def test_harm_is_more_than_two_standard_errors(self):
        population = Population()
        for case, changes in (("a", {"x": (0.5, 0.1), "y": (-0.3, 0.1)}), ("b", {"x": (-0.2, 0.1)}), ("c", {"x": (0.3, 0.1)}), ("d", {})):
            change = {meter: {"mean": mean, "se": se} for meter, (mean, se) in changes.items()}
            population.add(single(case), named(case, "A", other_meters_log_score_change=change))
        found = score.gap_scores(population.rows(), {})
        self.assertEqual((counts(found["harm"]), found["additions_without_harm_figures"]), ((1, 3), 1))

    def test_bias_and_coverage_by_hand(self):
        def posteriors(**means):
            return {name: {"mean": value, "q05": value, "q95": value} for name, value in means.items()}

        population = Population()  # |27 - 24| / 2 and |1.25 - 1| / 0.5: 1.0. Then 0.3 and 0.1: 0.2.
        before, after = (
            posteriors(cooling_setpoint_C=27.0, occupancy=1.25),
            posteriors(cooling_setpoint_C=24.6, occupancy=0.95, zone_mass=7.0),
        )
        population.add(single("a"), named("a", "A", parameters_before=before, parameters_after=after))
        population.add(single("b"), said("b", parameters_before=before, parameters_after=before))  # nothing was done about it
        for case, name, interval in (
            ("c", "A", (2.0, 3.5, "")),
            ("d", "A", (3.0, 3.0, "h")),
            ("e", "A", (3.1, 4.0, "")),
            ("f", "A", (2, 4, "min")),
            ("g", "B", (2, 4, "")),
        ):
            population.add(single(case), named(case, name, effect_parameter=dict(zip(("q05", "q95", "unit"), interval))))
        found = score.gap_scores(population.rows(), {})
        self.assertEqual(found["bias_before"]["cases"], 1)
        for key, wanted in (("bias_before", 1.0), ("bias_after", 0.2), ("bias_ratio", 0.2)):
            self.assertAlmostEqual(found[key]["value"], wanted)
        self.assertEqual(found["parameters_without_truth"], ["zone_mass"])
        self.assertEqual((counts(found["effect_interval_coverage"]), found["effect_intervals_in_other_units"]), ((2, 3), 1))

    def test_costs_and_calibrations(self):
        population = Population()
        for i in range(1, 21):
            population.add(answer(f"c{i:02}"), said(f"c{i:02}", wall_s=float(i)))
        wall = score.cost(population.rows(), "wall_s")
        self.assertEqual((wall["median"]["value"], wall["max"]), (10.5, 20.0))
        self.assertAlmostEqual(wall["p95"], 19.05)
        self.assertIsNone(score.cost(population.rows(), "peak_rss_MB"))
        keys = ("before", "after", "forecast", "yardstick")
        fits = {"c01": {"el": dict(zip(keys, (0.10, 0.05, 0.04, 0.06))), "gas": dict(zip(keys, (0.20, 0.30, 0.20, 0.10)))},
                "c02": {"el": dict(zip(keys, (0.12, 0.06, 0.05, 0.07)))}, "s": {"el": dict(zip(keys, (0.9, 0.95, 0.9, 0.1)))}}  # fmt: skip
        population.add(single("s"), said("s"))
        found = score.calibration_scores(population.rows(), fits)
        self.assertEqual(
            [found[key]["value"] for key in ("cvrmse_by_drawings", "cvrmse_calibrated", "cvrmse_forecast", "cvrmse_yardstick")],
            [0.12, 0.06, 0.05, 0.07],
        )
        self.assertEqual((counts(found["made_worse_by_calibrating"]), counts(found["yardstick_better"])), ((1, 3), (1, 3)))


class Drift(unittest.TestCase):
    def test_counts_what_begins_in_a_watched_month(self):
        population = Population()

        def add(one, *alarms):
            alarms = [dict(zip(("month", "kind", "subject", "probability"), alarm)) for alarm in alarms]
            drift = {"from": "2021-01", "to": "2022-12", "alarms": alarms}
            population.add(one, said(one["case"]), said(one["case"], method="drift", drift=drift))

        march = {"from": "2022-03-10"}
        add(
            single("a", "scale_fault", "meters", share=0.2, **march),
            ("2022-05", "meter", "electricity_daily_kWh", 0.9),
            ("2022-04", "use", "", 0.5),
        )
        add(single("b", "outdoor_air_amount", "outdoor_air", share=0.02, **march))
        add(single("c", "server_room", "electrical", share=0.05, **march), ("2022-01", "use", "el", 0.9), ("2022-03", "use", "el", 0.95))
        add(single("d", "server_room", "electrical", share=0.2) | {}, ("2022-03", "meter", "gas", 0.9))
        add(single("e", share=0.2, **{"from": "2020-03-10"}))
        add(answer("f"), ("2022-03", "nothing", "", 0.0))
        add(answer("g"))
        population.add(answer("h"), said("h"))  # was not followed
        found = population.scores()["worlds"][0]["drift"]
        self.assertEqual([counts(found[key]) for key in ("found", "found_large", "alarmed_too_early", "cause_right", "side_right", "sure_cause_right", "false_alarms")],
                         [(2, 3), (2, 2), (1, 3), (1, 2), (1, 2), (1, 1), (1, 2)])  # fmt: skip
        self.assertEqual(found["delay_months"]["value"], 0.5)
        self.assertEqual(len(population.scores()["methods"]), 1)
        self.assertEqual(score.missing_cases(population.answers, population.results, "recald"), [])

    def test_a_cause_is_right_if_it_is_what_the_effect_would_best_be_called(self):
        def right(hidden, kind, subject=""):
            return score.is_right_cause(hidden, {"kind": kind, "subject": subject}), score.is_right_side(
                hidden, {"kind": kind, "subject": subject}
            )

        meter, air = effect("scale_fault", "meters", 0.2), effect("outdoor_air_amount", "outdoor_air")
        server, pool = effect("server_room", "electrical"), effect("swimming_pool", "outside_catalogue")
        self.assertEqual(right(meter, "meter", "electricity_daily_kWh"), (True, True))
        self.assertEqual(right(meter, "meter", "steam_daily_kWh"), (False, True))
        self.assertEqual(right(meter, "unknown", "electricity_daily_kWh"), (False, False))
        self.assertEqual(right(air, "parameter", "outdoor_airflow"), (True, True))
        self.assertEqual(right(air, "parameter", "heating_setpoint"), (False, True))
        self.assertEqual(right(air, "unknown"), (False, True))  # a parameter says it
        self.assertEqual(right(air, "effect", "demand_ventilation"), (True, True))  # the same air
        self.assertEqual(right(air, "effect", "server_room"), (False, True))
        self.assertEqual(right(server, "use", "electricity use"), (True, True))
        self.assertEqual(right(pool, "unknown"), (True, True))
        self.assertEqual(right(pool, "nothing"), (False, False))


class Methods(unittest.TestCase):
    def duel(self, both, main, other):
        population = Population()
        for i in range(20):
            case, ours = f"c{i:02}", i < both + main
            theirs = i < both or both + main <= i < both + main + other
            population.add(single(case), named(case, "A" if ours else "B"), named(case, "A" if theirs else "B", method="aic"))
        return score.paired_difference(population.rows(), population.rows("aic"), {})

    def test_verdicts_go_by_the_cases_in_which_the_methods_differ(self):
        clear = self.duel(10, 6, 0)
        self.assertEqual((clear["only_main_right"], clear["only_other_right"], clear["verdict"]), (6, 0, "beaten"))
        self.assertAlmostEqual(clear["right_difference"]["value"], 0.3)
        self.assertAlmostEqual(clear["mcnemar_p"], 0.03125)  # 2 / 2^6
        self.assertAlmostEqual(self.duel(5, 8, 2)["mcnemar_p"], 0.109375)  # 2 (1 + 10 + 45) / 2^10
        self.assertEqual(
            [self.duel(*of)["verdict"] for of in ((10, 5, 0), (10, 3, 3), (10, 0, 6))],
            ["not shown at this size", "not beaten", "not beaten"],
        )

    def test_the_main_method_comes_first_and_the_oracle_is_no_rival(self):
        population = Population()
        population.add(
            single("a"),
            named("a", "A", gap=closing(0.9)),
            named("a", "A", method="aic", gap=closing(0.4)),
            named("a", "A", method="oracle"),
        )
        rows = population.scores()["methods"]
        self.assertEqual([row["method"] for row in rows], ["recald", "aic"])
        self.assertAlmostEqual(rows[1]["against"]["reduction_difference"]["value"], 0.5)


class Targets(unittest.TestCase):
    def verdict(self, quantity, right, every, share=0.2, world="own"):
        population = Population()
        for i in range(every):
            case = f"{world}{i:03}"
            if share is None:
                population.add(answer(case), said(case) if i < right else named(case, "A"))
            else:
                population.add(single(case, share=share) | {"world": world}, named(case, "A" if i < right else "B"))
        return next(target["minimum_verdict"] for target in population.scores()["targets"] if target["quantity"] == quantity)

    def test_an_estimate_is_met_before_it_is_shown(self):
        unsure = "met, not shown at this size"
        for right, wanted in ((38, "missed"), (39, unsure), (45, unsure), (46, "met")):
            self.assertEqual(self.verdict("named right, above 10 %", right, 60), wanted)
        for right, wanted in ((23, "missed"), (24, unsure), (31, "met")):
            self.assertEqual(self.verdict("named right, 3 to 10 %", right, 60, 0.05), wanted)
        for right, every, wanted in ((97, 100, "missed"), (98, 100, unsure), (148, 148, unsure), (149, 149, "met")):
            self.assertEqual(self.verdict("false name where nothing is hidden", right, every, None), wanted)
        # What is missed in the one world may be enough in the other.
        self.assertEqual(self.verdict("named right, above 10 %", 33, 60, world="energyplus"), unsure)
        self.assertEqual(self.verdict("named right, above 10 %", 1, 1, 0.05), "no cases")

    def test_coverage_has_two_sides(self):
        goal = (0.80, 0.97)
        verdicts = [
            score.verdict(score.share([True] * hits + [False] * (n - hits)), goal)
            for hits, n in ((100, 100), (79, 100), (90, 100), (9, 10))
        ]
        self.assertEqual(verdicts, ["missed", "missed", "met", "met, not shown at this size"])

    def test_missing_cases_are_listed_by_method(self):
        answers = {case: answer(case) for case in "abcdefg"}
        self.assertEqual(score.missing_cases(answers, [said("a", method="aic"), said("a", method="oracle")], "recald"), [
            "method aic: 6 of 7 cases have no result (b, c, d, e, f, ...)", "method recald: 7 of 7 cases have no result (a, b, c, d, e, ...)"])  # fmt: skip


def answer_file(case):
    hidden = effect("night_setback_missing", unit="K", **{"from": "2022-03-01"}) | {"share_of_meter": {"electricity": 0.01, "steam": 0.09}}
    found = answer(case, "single", hidden, true_parameters={"cooling_setpoint_C": 24.3}, prior_sd={"cooling_setpoint_C": 1.5})
    del found["world"]
    return found


def result_line(case):
    fits, posterior = {"steam": {"log_score": -2.0, "cvrmse": 0.2}}, {"cooling_setpoint_C": {"mean": 24.0, "q05": 23.0, "q95": 25.0}}
    return {"case": case, "method": "recald", "outcome": "named", "named": ["night_setback_missing"],
            "probabilities": {"night_setback_missing": 0.9, "none": 0.06, "unknown": 0.04}, "gap": {"before": fits, "after": fits, "oracle": fits},
            "other_meters_log_score_change": {"electricity": {"mean": 0.0, "se": 0.1}}, "parameters_before": posterior, "parameters_after": posterior,
            "effect_parameter": {"q05": 2.0, "q95": 4.0}, "located": [{"meter": "steam"}], "wall_s": 12.5, "peak_rss_MB": 80.0,
            "version": "recald 0.1.0", "extra": {"x": [1]}}  # fmt: skip


class Files(unittest.TestCase):
    def refusal(self, run, *given):
        with self.assertRaises(records.Refused) as refused:
            run(*given)
        return str(refused.exception)

    def test_mistakes_in_results_are_named(self):
        self.assertEqual(records.parse_result(json.dumps(result_line("a")), "f line 1"), result_line("a"))
        for path, value, part in [
            ("probabilities.none", 0.16, "'probabilities' sum to 1.1, must sum to 1"), ("probabilities.none", -0.06, "probabilities.none: -0.06"),
            ("probabilities", {"none": 1.0}, "to which 'probabilities' gives none"), ("named", [], "'named' exactly if"), ("outcome", "unknown", "'named' exactly if"),
            ("outcome", "maybe", "outcome: 'maybe'"), ("named", ["none"], "named.0"), ("named", ["a", "a"], "named"), ("wal_s", 1.0, "'wal_s' was unexpected"),
            ("gap.after", {"water": {"log_score": 1, "cvrmse": 1}}, "different meters"), ("gap.before", {}, "gap.before"), ("gap.before.steam", {"cvrmse": 1}, "log_score"),
            ("other_meters_log_score_change.electricity.se", -1, "se: -1"), ("parameters_after.cooling_setpoint_C.q05", 26, "has q05 above q95"),
            ("effect_parameter.q05", 5, "has q05 above q95"), ("located", ["steam"], "located.0"), ("wall_s", -1, "wall_s: -1"), ("wall_s", "1", "wall_s"),
            ("method", "a b", "method"), ("case", 3, "case"),
        ]:  # fmt: skip
            line = copy.deepcopy(result_line("a"))
            *keys, last = path.split(".")
            place = line
            for key in keys:
                place = place[key]
            place[last] = value
            message = self.refusal(records.parse_result, json.dumps(line), "f line 7")
            self.assertTrue(message.startswith("f line 7"), message)
            self.assertIn(part, message)
        for text in ("{", "1e999", '{"wall_s": NaN}', '{"wall_s": 1e999}'):
            self.assertEqual(self.refusal(records.parse_result, text, "f line 3"), "f line 3: not valid JSON")

    def test_any_changed_byte_is_read_or_named(self):
        text, read = json.dumps(result_line("a")), 0
        for at in range(len(text)):
            for other in '\0"}9-':
                try:
                    read += bool(records.parse_result(text[:at] + other + text[at + 1 :], "f line 1"))
                except records.Refused as refused:
                    self.assertTrue(str(refused).startswith("f line 1"))
        self.assertGreater(read, 0)

    def test_mistakes_in_answers_are_named(self):
        hidden = answer_file("a")["effects"][0]
        for changed, part in [
            ({"case": "b"}, "must be the file's name"), ({"effects": [hidden, hidden]}, "it must hide one of the catalogue"),
            ({"block": "pair", "effects": [hidden, hidden]}, "two different ones"), ({"block": "no_effect"}, "it must hide none"),
            ({"block": "out_of_catalogue", "effects": []}, "or a decoy"), ({"block": "double"}, "block"), ({"prior_sd": {}}, "cooling_setpoint_C"),
            ({"prior_sd": {"cooling_setpoint_C": 0}}, "must be positive"), ({"effects": [hidden | {"from": "March"}]}, "effects.0.from"),
            ({"effects": [hidden | {"strength": "3"}]}, "effects.0.strength"), ({"gaps": "no"}, "gaps"), ({"world": "mine"}, "world"),
        ]:  # fmt: skip
            message = self.refusal(records.parse_answer, json.dumps(answer_file("a") | changed), "a")
            self.assertTrue(message.startswith("answer a: "), message)
            self.assertIn(part, message)
        absent = answer_file("a") | {"true_parameters": {"x": 0, "y": 1}, "prior_sd": {"x": 0, "y": 1}}
        self.assertEqual(records.parse_answer(json.dumps(absent), "a")["prior_sd"], {"y": 1})

    def test_a_log_torn_at_every_byte_keeps_the_whole_lines_and_goes_on(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "r"
            lines = [json.dumps(result_line(case)) + "\n" for case in "abc"]
            text = "".join(lines)
            for size in range(0, len(text) + 1, 7):
                log = records.Log()
                log.add(text[:size], "f")
                whole = text[:size].count("\n")
                self.assertEqual((len(log.results), bool(log.torn)), (whole, not text[:size].endswith("\n") and size > 0))
                self.assertEqual(log.hash, records.hash_of("".join(lines[:whole])))
                file.write_text(text[:size])
                if whole < 3:
                    records.append_result(file, lines[whole])
                    self.assertEqual(file.read_text(), "".join(lines[: whole + 1]))
            message = self.refusal(records.append_result, file, lines[0])
            self.assertIn("case a has two results of method recald", message)
            records.append_result(file, lines[0], allow_rerun=True)
            log = records.Log([file], allow_rerun=True)
            self.assertEqual((len(log.results), log.replaced), (3, 1))
            self.assertIn("more than one line", self.refusal(records.append_result, file, text))

    def test_several_runners_append_to_one_file(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "r"
            command = [sys.executable, "-c", "import sys, records; records.append_result(sys.argv[1], sys.stdin.read())", str(file)]
            runs = [subprocess.Popen(command, stdin=subprocess.PIPE, text=True, cwd=HERE) for _ in range(4)]
            for i, run in enumerate(runs):
                run.communicate(json.dumps(result_line(f"c{i}")))
                self.assertEqual(run.returncode, 0)
            self.assertEqual({result["case"] for result in records.Log([file]).results}, {"c0", "c1", "c2", "c3"})

    def test_answers_of_others(self):
        truth = {"plain": {"archetype": "retail", "weather": "newyork", "effects": {}},
                 "dirty": {"archetype": "clinic", "weather": "sydney", "effects": {"fouling": {
                     "strength": 0.4, "unit": "share", "from": "2021-03-01", "share_of_meter": {"electricity": 0.05}, "moved_share": {"electricity": 0.06}}}},
                 "both": {"archetype": "clinic", "weather": "sydney", "effects": {name: {"strength": 0.4, "unit": "share"} for name in ("fouling", "vacancy")}},
                 "other": {"archetype": "strip", "weather": "tucson", "effects": {"aquarium": {"strength": 1, "unit": "m3"}}}}  # fmt: skip
        with tempfile.TemporaryDirectory() as folder:
            file, out = pathlib.Path(folder) / "truth.json", pathlib.Path(folder) / "answers"
            file.write_text(json.dumps(truth))
            catalogue = {"fouling": "plant", "vacancy": "schedules"}
            self.assertEqual(records.write_handed_in(file, "energyplus", catalogue, out), 4)
            found = records.read_answers(out)
            self.assertEqual(
                {case: one["block"] for case, one in found.items()},
                {"plain": "no_effect", "dirty": "single", "both": "pair", "other": "out_of_catalogue"},
            )
            self.assertEqual((found["dirty"]["effects"][0]["class"], records.largest_share(found["dirty"]["effects"])), ("plant", 0.06))
            for text, part in (('{"a": {"archetype": "x", "weather": "y", "effects": {"fouling": {}}}}', "case a"),
                               ('{"a": {"archetype": "x", "effects": {}}}', "weather"), ("{}", "names no case"), ("no", "truth.json")):  # fmt: skip
                file.write_text(text)
                self.assertIn(part, self.refusal(records.write_handed_in, file, "energyplus", catalogue, out))


class Opening(unittest.TestCase):
    """The program, from the seal to the scores."""

    def setUp(self):
        place = tempfile.TemporaryDirectory()
        self.addCleanup(place.cleanup)
        self.folder = pathlib.Path(place.name)
        self.answers, self.results = self.folder / "answers", self.folder / "r"
        self.answers.mkdir()
        for case in "abc":
            (self.answers / f"{case}.json").write_text(json.dumps(answer_file(case)))
        self.whole = self.run_score("seal", "--answers", self.answers).strip()
        self.results.write_text("".join(json.dumps(result_line(case)) + "\n" for case in "abc"))

    def run_score(self, *given, stdin=""):
        """What it printed; what ends it is raised."""
        out = io.StringIO()
        with mock.patch.object(sys, "argv", ["score", *map(str, given)]), mock.patch.object(sys, "stdin", io.StringIO(stdin)):
            with contextlib.redirect_stdout(out), contextlib.redirect_stderr(io.StringIO()):
                score.main()
        return out.getvalue()

    def open(self, *more):
        return self.run_score("open", "--answers", self.answers, "--results", self.results, "--out", self.folder / "s.json", *more)

    def refused(self, *more):
        with self.assertRaises(SystemExit) as ended:
            self.open(*more)
        self.assertFalse((self.folder / "s.json").exists())
        self.assertFalse((self.answers / "opened.json").exists())
        return str(ended.exception)

    def scores(self):
        return json.loads((self.folder / "s.json").read_text())

    def test_writes_scores_a_page_and_a_record(self):
        self.assertEqual(
            self.open("--bins", 10, "--published", self.whole),
            f"3 of 3 cases right; wrote {self.folder / 's.json'} and the page beside it\n",
        )
        scores, page = self.scores(), (self.folder / "s.md").read_text()
        self.assertEqual(
            (counts(scores["naming"]["right"]), scores["answers_sha256"], len(scores["probability"]["reliability"])),
            ((3, 3), self.whole, 10),
        )
        self.assertIn("Right answer: 3 of 3: 100 % (29 to 100).", page)
        self.assertTrue(page.endswith("## Failures\n\nNone.\n"))
        record = json.loads((self.answers / "opened.json").read_text())
        self.assertEqual(
            (record[0]["results_sha256"], record[0]["cases_of_version"]),
            (hashlib.sha256(self.results.read_bytes()).hexdigest(), {"recald 0.1.0": 3}),
        )
        self.open()
        self.assertIn("The answers were opened 2 times before", self.open())
        self.assertEqual(len(self.scores()["warnings"]), 1)

    def test_the_seal_is_what_sha256sum_checks(self):
        subprocess.run(["sha256sum", "--check", "--quiet", "answers.sha256"], cwd=self.answers, check=True)
        with self.assertRaises(SystemExit):
            self.run_score("seal", "--answers", self.answers)

    def test_every_changed_byte_is_refused(self):
        for file in (self.answers / "b.json", self.answers / "answers.sha256"):
            content = file.read_bytes()
            for at in range(0, len(content) - 1, 3):
                file.write_bytes(content[:at] + bytes([content[at] ^ 1]) + content[at + 1 :])
                self.assertRaises(records.Refused, records.verify_seal, self.answers)
            file.write_bytes(content)
        self.assertEqual(records.verify_seal(self.answers), self.whole)
        (self.answers / "d.json").write_text(json.dumps(answer_file("d")))
        self.assertIn("added after the seal; not opened", self.refused())
        (self.answers / "d.json").unlink()
        (self.answers / "a.json").unlink()
        self.assertIn("removed after the seal; not opened", self.refused())

    def test_what_cannot_be_scored_is_refused_without_a_trace(self):
        self.assertIn(f"{'a' * 64} was published; not opened", self.refused("--published", "a" * 64))
        lines = self.results.read_text().splitlines(keepends=True)
        self.results.write_text(lines[1])
        self.assertIn("method recald: 2 of 3 cases have no result (a, c); run them, or give --partial; nothing was opened", self.refused())
        self.assertIn("method reclad: 3 of 3", self.refused("--method", "reclad"))
        self.results.write_text("".join(lines) + lines[0])
        self.assertIn("give --allow-rerun", self.refused())
        self.results.write_text("".join(lines) + json.dumps(result_line("z")) + "\n")
        self.assertIn("the case z, to which there is no answer", self.refused())
        self.results.write_text("".join(lines))
        classes = self.folder / "classes.json"
        for text, part in (
            ('{"night_setback_missing": "plant"}', "of class schedules, but of class plant"),
            ("[]", "must be a JSON object"),
            ('{"a": 3}', "must be"),
        ):
            classes.write_text(text)
            self.assertIn(part, self.refused("--classes", classes))
        for wrong in (["open"], ["open", "--bins", "1"], []):
            with self.assertRaises(SystemExit) as ended:
                self.run_score(*wrong)
            self.assertEqual(ended.exception.code, 2)

    def test_a_part_is_scored_and_says_so_on_top(self):
        self.results.write_text(json.dumps(result_line("b")) + "\n" + json.dumps(result_line("c"))[:50])
        said = self.open("--partial")
        self.assertIn("line 2: torn after 50 bytes, ignored; the case runs again\n1 of 1 cases right", said)
        self.assertTrue((self.folder / "s.md").read_text().startswith("# Blind test: what recald said\n\n**Partial: method recald: 2 of 3"))
        self.results.write_text("")
        self.assertIn("0 of 0 cases right", self.open("--partial"))

    def test_failures_stand_by_case_whatever_the_order(self):
        wrong = result_line("c") | {
            "named": ["holiday_missing"],
            "probabilities": {"holiday_missing": 0.83, "none": 0.17},
            "version": "recald 0.2.0",
        }
        lines = [json.dumps(line) + "\n" for line in (result_line("a"), result_line("b"), wrong)]
        pages = []
        for order in (lines, lines[::-1]):
            self.results.write_text("".join(order))
            self.assertIn("2 different versions of recald\n2 of 3", self.open())
            (self.answers / "opened.json").unlink()
            found = self.scores()
            del found["results_sha256"]
            pages.append(found)
        self.assertEqual(*pages)
        self.assertIn("| c | single | night_setback_missing, 3 K from 2022-03-01, +1.0 % of electricity, +9.0 % of steam (moves 9.0 %) | holiday_missing (P 0.83) |\n",
                      (self.folder / "s.md").read_text())  # fmt: skip
        self.run_score("append", "--results", self.folder / "new", stdin=lines[0])
        for case in "ab":
            (self.folder / case).mkdir()
            (self.folder / case / "site.toml").touch()
        self.assertEqual(self.run_score("pending", "--population", self.folder, "--results", self.folder / "new"), "b\n")

    def test_scores_that_cannot_be_written_are_an_opening_all_the_same(self):
        with self.assertRaises(SystemExit):
            self.open("--out", self.folder / "absent" / "s.json")
        self.assertTrue((self.answers / "opened.json").exists())


if __name__ == "__main__":
    unittest.main()
