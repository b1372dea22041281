"""Scores a blind test: seals answers, keeps results, opens the answers once. See README.md.

score.py seal --answers DIR
score.py pending --population DIR --results F
score.py append --results F < line
score.py open --answers DIR --results F... --out scores.json
score.py hand-in --truth truth.json --classes FILE --answers DIR
"""

import argparse
import json
import pathlib
import sys

import numpy as np
import pandas as pd
from scipy import stats

import records
import tables
from records import CALIBRATE, DRIFT, NONE, ORACLE, UNKNOWN, Refused, competes, largest_share, most_affected_meter

SEED, RESAMPLES, RESAMPLED_MIN = 2026, 2000, 6
LARGE, SET_MEMBER_MIN, SURE, PROBABILITY_FLOOR, HARM_SE = 0.03, 0.1, 0.8, 1e-6, 2.0
SIZES = [(0.1, "single, above 10 %"), (0.03, "single, 3 to 10 %"), (0.01, "single, 1 to 3 %"), (0.0, "single, below 1 %")]
SLOPES = np.geomspace(0.02, 5.0, 161)
THRESHOLDS = [0.0, 0.3, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 0.99]

# A score: {"value", "cases", "hits"?, "interval95"?, "lower95"?, "upper95"?}, or None without cases.


def clopper_pearson(hits, cases, tail):
    """Exact interval of a share (Clopper, Pearson, 1934, Biometrika 26(4)); `tail` is left out on either side."""
    low = stats.beta.ppf(tail, hits, cases - hits + 1) if hits else 0.0
    high = stats.beta.ppf(1 - tail, hits + 1, cases - hits) if hits < cases else 1.0
    return [float(low), float(high)]


def share(hits):
    """Of booleans."""
    hits = np.asarray(hits, bool)
    n, k = len(hits), int(hits.sum())
    if n == 0:
        return None
    low, high = clopper_pearson(k, n, 0.05)
    return {"value": k / n, "cases": n, "hits": k, "interval95": clopper_pearson(k, n, 0.025), "lower95": low, "upper95": high}


def resampled(values, statistic):
    """A statistic of rows with its percentile bootstrap interval (Efron, Tibshirani, 1993, ch. 13).

    @param values     A row a case.
    @param statistic  Of (rows, counts): how often each row counts, for each resample; one value a resample.
    """
    values = np.asarray(values, float)
    n = len(values)
    if n == 0:
        return None
    score = {"value": float(statistic(values, np.ones((1, n)))[0]), "cases": n}
    if n < RESAMPLED_MIN:  # Far too narrow then.
        return score
    drawn = np.random.default_rng(SEED).multinomial(n, np.full(n, 1 / n), RESAMPLES).astype(float)
    bounds = [float(q) for q in np.quantile(statistic(values, drawn), [0.025, 0.975, 0.05, 0.95])]
    return score | {"interval95": bounds[:2], "lower95": bounds[2], "upper95": bounds[3]}


def mean(values):
    return resampled(values, lambda v, counts: counts @ v / len(v))


def median(values):
    def of(v, counts):
        order = np.argsort(v)
        rank, ordered, n = np.cumsum(counts[:, order], axis=1), v[order], len(v)
        return (ordered[(rank > (n - 1) // 2).argmax(axis=1)] + ordered[(rank > n // 2).argmax(axis=1)]) / 2

    return resampled(values, of)


# What was said, beside what is true.


def truths_of(answer):
    """What a perfect method says: the effects; "unknown" for those out of the catalogue; "none" where nothing is hidden."""
    if not answer["effects"]:
        return [NONE]
    return [UNKNOWN] if answer["block"] == "out_of_catalogue" else [effect["effect"] for effect in answer["effects"]]


def ranking_of(result, truth):
    """Effects added, in order; then the rest by probability. Of equal ones the true one comes last."""
    probabilities = result.get("probabilities", {})
    rest = sorted(
        (name for name in probabilities if name not in result["named"]), key=lambda name: (-probabilities[name], name in truth, name)
    )
    word = [result["outcome"]] if not probabilities and result["outcome"] in (NONE, UNKNOWN) else []
    return result["named"] + rest + word


def set_of(result):
    if result["outcome"] != "confusable":
        return []
    likely = [name for name, p in sorted(result.get("probabilities", {}).items()) if name not in (NONE, UNKNOWN) and p >= SET_MEMBER_MIN]
    return result.get("confusable") or likely


def judged(answer, result, classes):
    """A row of the table that everything is counted from."""
    effects, named, truth = answer["effects"], result["named"], truths_of(answer)
    ranking, offered = ranking_of(result, truth), set_of(result)
    outcome, meter = result["outcome"], most_affected_meter(effects)
    hidden = " + ".join(sorted(effect["effect"] for effect in effects)) or NONE
    located = [place["meter"] for place in result["located"]] if "located" in result else None
    return {
        "case": answer["case"], "world": answer["world"], "block": answer["block"], "answer": answer, "result": result, "outcome": outcome,
        "has_effect": bool(effects), "size": largest_share(effects), "meter": meter, "named": bool(named), "truth": truth,
        "hidden": f"unknown ({hidden})" if effects and answer["block"] == "out_of_catalogue" else hidden,
        "said": " + ".join(sorted(named)) or outcome,
        "right": set(named) == set(truth) if named else outcome != "confusable" and truth == [outcome],
        "top1": any(name in truth for name in ranking[:1]), "top3": any(name in truth for name in ranking[:3]),
        "class_right": bool(ranking) and classes.get(ranking[0]) in {effect["class"] for effect in effects},
        "hidden_named": sum(name in truth for name in named), "wrong_name": any(name not in truth for name in named),
        "set_has_truth": any(name in truth for name in offered), "located": located,
    }  # fmt: skip


def table_of(answers, results, method, classes):
    rows = [judged(answers[result["case"]], result, classes) for result in results if result["method"] == method]
    columns = judged(next(iter(answers.values())), {"named": [], "outcome": NONE}, {}).keys()
    flags = ["has_effect", "named", "right", "top1", "top3", "class_right", "wrong_name", "set_has_truth"]
    return pd.DataFrame(rows, columns=list(columns)).astype(dict.fromkeys(flags, bool)).sort_values("case", ignore_index=True)


# Names.


def group_scores(name, rows):
    catalogued = rows[rows.block.isin(["single", "pair"])]
    return {"group": name, "cases": len(rows), "right": share(rows.right), "top1": share(rows.top1), "top3": share(rows.top3),
            "class_right": share(catalogued.class_right), "wrong_name": share(rows.wrong_name),
            "said_unknown": share(rows.outcome == UNKNOWN), "said_confusable": share(rows.outcome == "confusable"),
            "said_none": share(rows.outcome == NONE)}  # fmt: skip


def size_group(size):
    return next(name for least, name in SIZES if size >= least)


def groups_of(rows):
    singles = rows[rows.block == "single"]
    sizes = singles["size"].map(size_group)
    groups = [("no effect", rows[rows.block == "no_effect"]), ("single, all", singles)]
    groups += [(name, singles[sizes == name]) for _, name in SIZES]
    groups += [("pair", rows[rows.block == "pair"]), ("out of catalogue", rows[rows.block == "out_of_catalogue"])]
    return [group_scores(name, members) for name, members in groups if len(members)]


def naming_scores(rows):
    nothing, outside, pairs = (rows[rows.block == block] for block in ("no_effect", "out_of_catalogue", "pair"))
    effect = rows[rows.has_effect]
    offered = effect[effect.outcome == "confusable"]
    decoys = rows[rows.answer.map(lambda answer: bool(answer["decoys"])).astype(bool)]
    placed = rows[rows.located.notna() & (rows.meter != "")]
    first = [located[:1] == [meter] for located, meter in zip(placed.located, placed.meter)]
    found = [meter in located for located, meter in zip(placed.located, placed.meter)]
    by = {}
    for answer, right in zip(rows.answer, rows.right):
        for what in ("climate " + answer["climate"], "use " + answer["use"], "with gaps" if answer["gaps"] else "without gaps"):
            by.setdefault(what, []).append(right)
    confusion = {}
    for hidden, said in zip(rows.hidden, rows.said):
        confusion.setdefault(hidden, {}).setdefault(said, 0)
        confusion[hidden][said] += 1
    return {
        "right": share(rows.right),
        "groups": groups_of(rows),
        "false_names": share(nothing.named),
        "false_alarms": share(nothing.outcome != NONE),
        "wrong_names": share(effect.wrong_name),
        "out_of_catalogue_wrong_name": share(outside.named),
        "out_of_catalogue_unknown": share(outside[outside.has_effect].outcome == UNKNOWN),
        "confusable_has_truth": share(offered.set_has_truth),
        "pair_both": share(pairs.hidden_named == 2),
        "pair_only_one": share(pairs.hidden_named == 1),
        "pair_neither": share(pairs.hidden_named == 0),
        "pair_both_large": share(pairs[pairs["size"] >= LARGE].hidden_named == 2),
        "decoys": {"cases": len(decoys), "right": share(decoys.right), "wrong_name": share(decoys.wrong_name)},
        "located_meter_right": share(first),
        "located_meter_among_all": share(found),
        "right_by": [{"what": what, "right": share(by[what])} for what in sorted(by)],
        "confusion": {hidden: dict(sorted(confusion[hidden].items())) for hidden in sorted(confusion)},
    }


# Probabilities. The answer judged is the most probable one (of equal ones a wrong one); of a pair either effect is right.


def top_answer(result, truth):
    probabilities = result["probabilities"]
    name = min(sorted(probabilities), key=lambda name: (-probabilities[name], name in truth))
    return {"answer": name, "p": probabilities[name], "is_true": name in truth, "is_name": name not in (NONE, UNKNOWN)}


def losses_by_slope(probabilities, truth):
    """-ln of the truth's part of sum p^s, for each s."""
    p = np.maximum([p for p in probabilities.values()] + ([] if truth in probabilities else [0.0]), PROBABILITY_FLOOR)
    of_truth = max(probabilities.get(truth, 0.0), PROBABILITY_FLOOR)
    return np.log((p[:, None] ** SLOPES).sum(axis=0)) - SLOPES * np.log(of_truth)


def best_slope(losses):
    return resampled(losses, lambda rows, counts: SLOPES[np.argmin(counts @ rows, axis=1)])


def reliability(name, tops):
    return name | {"cases": len(tops), "mean_probability": float(tops.p.mean()) if len(tops) else 0.0, "right": share(tops.is_true)}


def abstention(tops, threshold):
    """If an effect were named whenever it is the most probable answer and P reaches the threshold."""
    names = tops.is_name & (tops.p >= threshold)
    hidden, nothing = tops.block.isin(["single", "pair"]), tops.block == "no_effect"
    return {
        "threshold": threshold,
        "coverage": share(names[hidden]),
        "accuracy": share(tops.is_true[names]),
        "false_names": share(names[nothing]),
    }


def probability_scores(rows, bins):
    """Brier and log loss need one truth, so pairs are left out there (Brier, 1950; ECE: Naeini et al., 2015)."""
    empty = {"cases": 0, "brier": None, "log_loss": None, "log_loss_floored": 0, "slope": None, "ece": None, "reliability": [],
             "reliability_by_kind": [], "sure_names_right": None, "abstention": []}  # fmt: skip
    rows = rows[rows.result.map(lambda result: bool(result.get("probabilities"))).astype(bool)].reset_index(drop=True)
    if rows.empty:
        return empty
    tops = rows[["block"]].join(pd.DataFrame([top_answer(result, truth) for result, truth in zip(rows.result, rows.truth)]))
    briers, losses, slopes, floored = [], [], [], 0
    for result, truth in zip(rows.result, rows.truth):
        if len(truth) != 1:
            continue
        p = result["probabilities"]
        briers.append(sum((q - (name == truth[0])) ** 2 for name, q in p.items()) + (truth[0] not in p))
        losses.append(-np.log(max(p.get(truth[0], 0.0), PROBABILITY_FLOOR)))
        floored += p.get(truth[0], 0.0) < PROBABILITY_FLOOR
        slopes.append(losses_by_slope(p, truth[0]))
    bin_of = np.minimum((tops.p * bins).astype(int), bins - 1)
    # n_b |right_b - mean_b| = |sum over the bin of (right - probability)|
    excess = np.where(bin_of.to_numpy()[:, None] == np.arange(bins), (tops.is_true - tops.p).to_numpy()[:, None], 0.0)
    sure = [
        result["named"][0] in truth
        for result, truth in zip(rows.result, rows.truth)
        if result["named"] and result["probabilities"][result["named"][0]] >= SURE
    ]
    kinds = [("a name", tops.is_name), (NONE, tops.answer == NONE), (UNKNOWN, tops.answer == UNKNOWN)]
    return {
        "cases": len(tops),
        "brier": mean(briers),
        "log_loss": mean(losses),
        "log_loss_floored": floored,
        "slope": best_slope(slopes),
        "ece": resampled(excess, lambda v, counts: np.abs(counts @ v).sum(axis=1) / len(v)),
        "reliability": [reliability({"from": b / bins, "to": (b + 1) / bins}, tops[bin_of == b]) for b in range(bins)],
        "reliability_by_kind": [reliability({"kind": kind}, tops[members]) for kind, members in kinds],
        "sure_names_right": share(sure),
        "abstention": [abstention(tops, threshold) for threshold in THRESHOLDS],
    }


# What it was good for.


def full_gap(row, oracles):
    """The fits of a case, as far as they are known. Where nothing was added, nothing changed."""
    gap, oracle = row.result.get("gap"), oracles.get(row.case)
    if oracle is None:
        return gap
    if gap is None and not row.named:
        gap = {"before": oracle["before"], "after": oracle["before"]}
    return gap and {"oracle": oracle["after"]} | {when: fits for when, fits in gap.items() if fits is not None}


def reduction(row, oracles):
    """R = (before - after) / (before - oracle), by CV(RMSE) of the most affected meter and by minus the log score of all."""
    gap = full_gap(row, oracles)
    if not gap or not gap.get("oracle"):
        return None, None

    def part(measure):
        before, after, oracle = (measure(gap[when]) for when in ("before", "after", "oracle"))
        return (before - after) / (before - oracle) if None not in (before, after, oracle) and oracle < before else None

    def loss(fits):
        return -sum(fits[meter]["log_score"] for meter in gap["before"]) if gap["before"].keys() <= fits.keys() else None

    return part(lambda fits: fits[row.meter]["cvrmse"] if row.meter in fits else None), part(loss)


def known(values):
    return [value for value in values if value is not None]


def bias(answer, posteriors):
    """Mean over parameters of |mean - truth| / prior sd; None if none is shared."""
    truths = answer["true_parameters"]
    misses = [abs(posteriors[name]["mean"] - truths[name]) / answer["prior_sd"][name] for name in posteriors if name in truths]
    return sum(misses) / len(misses) if misses else None


def gap_scores(rows, oracles):
    catalogued = [row for row in rows.itertuples() if row.block in ("single", "pair")]
    all_of_them = [reduction(row, oracles) for row in catalogued]
    large = [row.named and row.size >= LARGE for row in catalogued]
    claimed = [of for of, is_large in zip(all_of_them, large) if is_large]
    biases = [(bias(row.answer, row.result.get("parameters_before", {})), bias(row.answer, row.result.get("parameters_after", {})))
              for row in catalogued if row.named]  # fmt: skip
    biases = [pair for pair in biases if None not in pair]
    additions = [row.result.get("other_meters_log_score_change") for row in rows.itertuples() if row.named]
    covered, other_units = [], 0
    for row in catalogued:
        interval = row.result.get("effect_parameter")
        if row.block != "single" or not row.right or not interval:
            continue
        effect = row.answer["effects"][0]
        if (interval.get("unit") or effect["unit"]) != effect["unit"]:
            other_units += 1
        else:
            covered.append(interval["q05"] <= effect["strength"] <= interval["q95"])
    said = {
        (name, row.Index)
        for row in rows.itertuples()
        for key in ("parameters_before", "parameters_after")
        for name in row.result.get(key, {})
    }
    return {
        "large_named": sum(large),
        "reduction_cvrmse": median(known(of[0] for of in claimed)),
        "reduction_log_score": median(known(of[1] for of in claimed)),
        "reduction_cvrmse_all": median(known(of[0] for of in all_of_them)),
        "reduction_log_score_all": median(known(of[1] for of in all_of_them)),
        "harm": share([any(of["mean"] < -HARM_SE * of["se"] for of in changes.values()) for changes in additions if changes]),
        "additions_without_harm_figures": sum(not changes for changes in additions),
        "bias_before": median([before for before, _ in biases]),
        "bias_after": median([after for _, after in biases]),
        "bias_ratio": median([after / before for before, after in biases if before > 0]),
        "effect_interval_coverage": share(covered),
        "effect_intervals_in_other_units": other_units,
        "parameters_without_truth": sorted({name for name, i in said if name not in rows.answer[i]["true_parameters"]}),
    }


def calibration_scores(rows, calibrations):
    """What calibrating does where nothing is hidden: it must do no harm. Over the meters of these cases."""
    fits = pd.DataFrame(
        [fit for row in rows.itertuples() if not row.has_effect for fit in calibrations.get(row.case, {}).values()],
        columns=["before", "after", "forecast", "yardstick"],
        dtype=float,
    )
    return {"cvrmse_by_drawings": median(fits.before), "cvrmse_calibrated": median(fits.after), "cvrmse_forecast": median(fits.forecast),
            "cvrmse_yardstick": median(fits.yardstick), "made_worse_by_calibrating": share(fits.after > fits.before),
            "yardstick_better": share(fits.yardstick < fits.forecast)}  # fmt: skip


# Drift. Effects that a parameter of the model stands for, and those that are loads of electricity.
PARAMETERS_OF = {
    "outdoor_air_amount": {"outdoor_airflow"}, "demand_ventilation": {"outdoor_airflow"}, "night_setback_missing": {"heating_setpoint"},
    "setpoint_raised": {"heating_setpoint", "cooling_setpoint"}, "vacancy": {"occupancy_density"}, "hybrid_work": {"occupancy_density"},
    "chiller_part_load": {"cooling_cop"}, "solar_gain_change": {"shgc_scale"}, "wind_infiltration": {"leakage_area"},
    "stack_infiltration": {"leakage_area"}, "seasonal_hot_water": {"hot_water_volume"}, "steam_trap_leak": {"base_heat"},
    "ground_coupling": {"ground_temperature"}, "thermal_mass": {"specific_heat_scale"},
}  # fmt: skip
USES = {"plug_growth", "equipment_step", "server_room", "exterior_lighting", "vacancy", "hybrid_work", "after_hours", "weekend_operation",
        "missing_holidays", "semester_calendar", "ev_charging", "solar_panels", "irrigation_pumps", "cooking", "event_evenings",
        "data_backup_nights"}  # fmt: skip


def is_right_cause(hidden, cause):
    """Whether a cause is what a hidden effect would be called, at best: its meter, parameter or use, else unknown."""
    effect, kind = hidden["effect"], cause["kind"]
    if hidden["class"] == "meters":
        return kind == "meter" and cause["subject"].startswith(most_affected_meter([hidden]))
    if kind == "parameter":
        return cause["subject"] in PARAMETERS_OF.get(effect, ())
    if kind == "effect":  # The same, or the same thing to a person who looks for it.
        other = cause["subject"]
        return effect == other or {effect, other} <= USES or bool(PARAMETERS_OF.get(effect, set()) & PARAMETERS_OF.get(other, set()))
    if kind == "use":
        return effect in USES
    return kind == "unknown" and effect not in PARAMETERS_OF and effect not in USES


def is_right_side(hidden, cause):
    return cause["kind"] != "nothing" and (hidden["class"] == "meters") == (cause["kind"] == "meter")


def months_between(start, end):
    """Of texts such as 2022-03 or 2022-03-01."""
    return 12 * (int(end[:4]) - int(start[:4])) + int(end[5:7]) - int(start[5:7])


def drift_scores(rows, drifts):
    """Of single effects that begin in a watched month; causes are those of the first alarm from that month on."""
    found, large, early, right, side, sure, false_alarms, delays = ([] for _ in range(8))
    for row in rows.itertuples():
        drift = drifts.get(row.case)
        if drift is None:
            continue
        if not row.has_effect:
            false_alarms.append(bool(drift["alarms"]))
        hidden = row.answer["effects"][0] if len(row.answer["effects"]) == 1 else {"from": None}
        if not hidden["from"] or not drift["from"] <= hidden["from"][:7] <= drift["to"]:
            continue
        after = [(months_between(hidden["from"], alarm["month"]), alarm) for alarm in drift["alarms"]]
        delay, first = min(((months, alarm) for months, alarm in after if months >= 0), key=lambda one: one[0], default=(None, None))
        early.append(any(months < 0 for months, _ in after))
        found.append(first is not None)
        if row.size >= LARGE:
            large.append(first is not None)
        if first is None:
            continue
        delays.append(delay)
        right.append(is_right_cause(hidden, first))
        side.append(is_right_side(hidden, first))
        if first["probability"] >= SURE:
            sure.append(right[-1])
    return {"found": share(found), "found_large": share(large), "delay_months": median(delays), "alarmed_too_early": share(early),
            "cause_right": share(right), "side_right": share(side), "sure_cause_right": share(sure), "false_alarms": share(false_alarms)}  # fmt: skip


def cost(rows, key):
    values = known(result.get(key) for result in rows.result)
    return {"median": median(values), "p95": float(np.quantile(values, 0.95)), "max": max(values)} if values else None


# Targets, fixed before any answer is opened: (quantity, where it stands, own world's, EnergyPlus's, aims, decimals).
def at_least(value):
    return value, None


def at_most(value):
    return None, value


TARGETS = [
    ("named right, above 10 %", "right", at_least(0.65), at_least(0.50), (at_least(0.80), at_least(0.70))),
    ("named right, 3 to 10 %", "right", at_least(0.40), at_least(0.30), (at_least(0.60), at_least(0.50))),
    ("top-1, above 10 %", "top1", at_least(0.85), at_least(0.75), None),
    ("top-1, 3 to 10 %", "top1", at_least(0.65), at_least(0.50), None),
    ("false name where nothing is hidden", ("naming", "false_names"), at_most(0.02), at_most(0.04), None),
    ("wrong name where something is", ("naming", "wrong_names"), at_most(0.08), at_most(0.10), None),
    ("name said with P >= 0.8 is right", ("probability", "sure_names_right"), at_least(0.92), at_least(0.88), None),
    ("slope of the probabilities", ("probability", "slope"), (0.8, 1.25), (0.75, 1.33), None),
    ("90 % interval of the effect has the truth", ("gap", "effect_interval_coverage"), (0.80, 0.95), (0.75, 0.95), None),
    ("gap closed (median R, 3 % and more, named)", ("gap", "reduction_cvrmse"), at_least(0.8), at_least(0.7), None),
    ("slowest case", ("wall_s",), at_most(10.0), at_most(10.0), None),
]  # fmt: skip


def verdict(score, goal, exact=False):
    """Met: the estimate reaches the goal and the one-sided 95 % bounds clear it. An `exact` figure has nothing to show."""
    if score is None:
        return "no cases"
    low, high = goal
    low, high = -np.inf if low is None else low, np.inf if high is None else high
    if not low <= score["value"] <= high:
        return "missed"
    cleared = "lower95" in score and (low == -np.inf or score["lower95"] >= low) and (high == np.inf or score["upper95"] <= high)
    return "met" if cleared or exact else "met, not shown at this size"


def goal_text(goal, unit, scale):
    low, high = goal
    if high is None:
        return f"at least {low * scale:g}{unit}"
    return f"at most {high * scale:g}{unit}" if low is None else f"{low * scale:g} to {high * scale:g}{unit}"


def targets(world):
    """What one world asks for, and whether its scores reach it."""
    listed = []
    groups = {group["group"]: group for group in world["naming"]["groups"]}
    for quantity, place, own, energyplus, aims in TARGETS:
        if isinstance(place, str):
            score = groups.get("single, " + quantity.split(", ")[1], {}).get(place)
        elif place == ("wall_s",):
            score = world["wall_s"] and {"value": world["wall_s"]["max"], "cases": world["wall_s"]["median"]["cases"]}
        else:
            score = world[place[0]][place[1]]
        goal = own if world["world"] == "own" else energyplus
        aim = aims and aims[world["world"] != "own"]
        exact = quantity == "slowest case"
        number = exact or quantity.startswith(("slope", "gap"))
        unit, scale = (" s", 1) if exact else ("", 1) if number else (" %", 100)
        listed.append({
            "world": world["world"], "quantity": quantity, "score": score, "minimum": goal_text(goal, unit, scale),
            "minimum_verdict": verdict(score, goal, exact), "excellent": goal_text(aim, unit, scale) if aim else "-",
            "excellent_verdict": verdict(score, aim, exact) if aim else "not gated", "decimals": (1 if exact else 3) if number else None,
        })  # fmt: skip
    return listed


# Methods side by side.


def paired_difference(main, other, oracles):
    """Over the cases that both have. Beaten: ahead with p < 0.05 by the exact McNemar test (1947, Psychometrika 12(2))."""
    both = main.merge(other, on="case", suffixes=("", "_other"))
    only_main, only_other = int((both.right & ~both.right_other).sum()), int((~both.right & both.right_other).sum())
    p = stats.binomtest(only_main, only_main + only_other).pvalue if only_main + only_other else 1.0
    theirs = {row.case: reduction(row, oracles)[0] for row in other.itertuples()}
    ours = {row.case: reduction(row, oracles)[0] for row in main.itertuples()}
    gaps = [ours[case] - theirs[case] for case in both.case if None not in (ours[case], theirs[case])]
    ahead = only_main > only_other
    return {"cases": len(both), "only_main_right": only_main, "only_other_right": only_other,
            "right_difference": mean(both.right.astype(float) - both.right_other.astype(float)), "mcnemar_p": float(p),
            "reduction_difference": median(gaps),
            "verdict": "not beaten" if not ahead else "beaten" if p < 0.05 else "not shown at this size"}  # fmt: skip


def method_row(method, rows, oracles):
    naming, wall = naming_scores(rows), cost(rows, "wall_s")
    singles = rows[rows.block == "single"]
    return {"method": method, "cases": len(rows), "right": naming["right"], "single_right": share(singles.right), "single_top1": share(singles.top1),
            "false_names": naming["false_names"], "out_of_catalogue_wrong_name": naming["out_of_catalogue_wrong_name"],
            "reduction_cvrmse_all": gap_scores(rows, oracles)["reduction_cvrmse_all"], "wall_s": wall and wall["median"]}  # fmt: skip


# Everything.


def probability_text(result, name):
    probability = result.get("probabilities", {}).get(name)
    return "" if probability is None else f" (P {probability:.2f})"


def said_in_full(row):
    result = row.result
    if row.named:
        return ", then ".join(name + probability_text(result, name) for name in result["named"])
    if row.outcome != "confusable":
        return row.outcome + probability_text(result, row.outcome)
    return "one of " + ", ".join(set_of(result)) + (" (the true one is among them)" if row.set_has_truth else "")


def truth_in_full(answer):
    def text(effect):
        dates = "".join(f" {word} {effect[word]}" for word in ("from", "to") if effect[word])
        shares = "".join(f", {100 * share:+.1f} % of {meter}" for meter, share in sorted(effect["share_of_meter"].items()))
        return f"{effect['effect']}, {effect['strength']:g} {effect['unit']}{dates}{shares}"

    effects = answer["effects"]
    decoy = "; decoy " + ", ".join(answer["decoys"]) if answer["decoys"] else ""
    moves = f" (moves {100 * largest_share(effects):.1f} %)" if effects else ""
    return ("; ".join(map(text, effects)) or NONE) + decoy + moves


def scores_of(answers, results, method, classes, bins):
    rows = table_of(answers, results, method, classes)
    by_method = {name: [result for result in results if result["method"] == name] for name in {result["method"] for result in results}}
    oracles = {result["case"]: result["gap"] for result in by_method.get(ORACLE, []) if "gap" in result}
    calibrations = {result["case"]: result.get("calibration", {}) for result in by_method.get(CALIBRATE, [])}
    drifts = {result["case"]: result["drift"] for result in by_method.get(DRIFT, []) if "drift" in result}

    def part(rows):
        return {"naming": naming_scores(rows), "probability": probability_scores(rows, bins), "gap": gap_scores(rows, oracles)}

    def costs(rows):
        return {"wall_s": cost(rows, "wall_s"), "peak_rss_MB": cost(rows, "peak_rss_MB")}

    worlds = []
    for world in sorted(set(rows.world)):
        of = rows[rows.world == world].reset_index(drop=True)
        worlds.append({"world": world, "cases": len(of)} | part(of)
                      | {"nothing_hidden": calibration_scores(of, calibrations), "drift": drift_scores(of, drifts)} | costs(of))  # fmt: skip
    methods = [method_row(method, rows, oracles)]
    for other in sorted(name for name in by_method if name != method and competes(name)):
        its = table_of(answers, results, other, classes)
        methods.append(method_row(other, its, oracles) | {"against": paired_difference(rows, its, oracles)})
    versions = pd.Series([result.get("version", "") for result in rows.result], dtype=object).value_counts()
    failures = [
        {"case": row.case, "block": row.block, "truth": truth_in_full(row.answer), "said": said_in_full(row)}
        for row in rows.itertuples()
        if not row.right
    ]
    return (
        {"method": method, "cases": len(rows), "population_cases": len(answers), "versions": {k: int(versions[k]) for k in sorted(versions.index)},
         "targets": [target for world in worlds for target in targets(world)], "worlds": worlds}
        | part(rows) | costs(rows) | {"methods": methods, "failures": failures}
    )  # fmt: skip


def missing_cases(answers, results, method):
    """A sentence for each method that lacks cases, the one under test even if it has no result at all."""
    done = {method: set()}
    for result in results:
        if competes(result["method"]):
            done.setdefault(result["method"], set()).add(result["case"])
    sentences = []
    for name in sorted(done):
        if missing := [case for case in answers if case not in done[name]]:
            shown = ", ".join(missing[:5]) + (", ..." if len(missing) > 5 else "")
            sentences.append(f"method {name}: {len(missing)} of {len(answers)} cases have no result ({shown})")
    return sentences


def read_classes(file):
    """{"effect": "class"} for effects that are hidden in no case; none without a file."""
    classes = records.parsed(records.read_text(file), file) if file else {}
    if not isinstance(classes, dict) or not all(isinstance(name, str) for name in classes.values()):
        raise Refused(f"{file}: must be a JSON object of effects and their classes")
    return classes


def classes_of(answers, listed):
    for case, answer in answers.items():
        for effect in answer["effects"]:
            known = listed.setdefault(effect["effect"], effect["class"])
            if known != effect["class"]:
                raise Refused(f"answer {case}: effect {effect['effect']} is of class {effect['class']}, but of class {known} elsewhere")
    return listed


def open_answers(given):
    """The one moment at which answers and results meet. What is refused leaves no record and tells nothing."""
    if given.out.suffix != ".json":
        raise Refused(f"--out is '{given.out}', must end in .json")
    whole = records.verify_seal(given.answers, given.published)
    answers = records.read_answers(given.answers)
    log = records.Log(given.results, given.allow_rerun)
    for result in log.results:
        if result["case"] not in answers:
            raise Refused(
                f"the results of method {result['method']} name the case {result['case']}, to which there is no answer; results of another population?"
            )
    classes = classes_of(answers, read_classes(given.classes))
    earlier = records.openings(given.answers)
    missing = missing_cases(answers, log.results, given.method)
    if missing and not given.partial:
        raise Refused(f"{'; '.join(missing)}; run them, or give --partial; nothing was opened")
    scores = scores_of(answers, log.results, given.method, classes, given.bins)
    warnings = ["Partial: " + sentence for sentence in missing]
    if earlier:
        warnings.append(f"The answers were opened {len(earlier)} time{'s' * (len(earlier) > 1)} before, last at {earlier[-1]['opened_at']}")
    warnings += log.torn
    if log.replaced:
        warnings.append(f"{log.replaced} results were replaced by later reruns")
    if len(scores["versions"]) > 1:
        warnings.append(f"The cases were run by {len(scores['versions'])} different versions of {given.method}")
    scores = {
        "warnings": warnings,
        "answers_sha256": whole,
        "results_sha256": log.hash,
        "bootstrap": {"seed": SEED, "resamples": RESAMPLES},
    } | scores
    # The record comes first: an opening whose scores got lost is an opening all the same.
    records.record_opening(given.answers, whole_sha256=whole, results_sha256=log.hash, cases_of_version=scores["versions"])
    records.write_text(given.out, json.dumps(scores, indent=2) + "\n")
    records.write_text(given.out.with_suffix(".md"), tables.page(scores))
    right = scores["naming"]["right"]
    return (
        "".join(warning + "\n" for warning in warnings)
        + f"{right['hits'] if right else 0} of {scores['cases']} cases right; wrote {given.out} and the page beside it\n"
    )


def pending(given):
    cases, torn = records.pending_cases(given.population, given.results, given.method)
    sys.stderr.writelines(f"score: {sentence}\n" for sentence in torn)
    return "".join(case + "\n" for case in cases)


def append(given):
    records.append_result(given.results, sys.stdin.read(), given.allow_rerun)
    return ""


def hand_in(given):
    return f"{records.write_handed_in(given.truth, given.world, read_classes(given.classes), given.answers)} answers in {given.answers}\n"


def bins(text):
    if not 2 <= int(text) <= 20:
        raise ValueError(text)
    return int(text)


def arguments():
    parser = argparse.ArgumentParser(prog="score", description="Keeps the results of a blind test and scores them against sealed answers.")
    commands = parser.add_subparsers(required=True)

    def command(name, run, help, **options):
        sub = commands.add_parser(name, help=help)
        sub.set_defaults(run=run)
        for option, of in options.items():
            sub.add_argument("--" + option.replace("_", "-"), **of)

    needed, flag = {"required": True}, {"action": "store_true"}
    method = {"default": "recald", "help": "the method under test"}
    command(
        "seal", lambda given: records.seal_answers(given.answers) + "\n", "hashes the answers; prints the hash to publish", answers=needed
    )
    command("pending", pending, "lists the cases without a result", population=needed, results=needed, method=method)
    command("append", append, "adds the result on standard input to a results file", results=needed, allow_rerun=flag)
    command("hand-in", hand_in, "makes answers of a truth.json that somebody else wrote", truth=needed, answers=needed, classes=needed,
            world={"default": "energyplus", "choices": ["own", "energyplus"]})  # fmt: skip
    command("open", open_answers, "verifies the seal, opens the answers, scores", answers=needed, results=needed | {"nargs": "+"},
            out=needed | {"type": pathlib.Path, "help": "scores.json; scores.md goes beside it"}, published={"help": "the hash that was published"},
            classes={"help": "JSON {effect: class} of the whole catalogue"}, method=method,
            bins={"type": bins, "default": 5, "help": "2 to 20, of the reliability table"}, partial=flag, allow_rerun=flag)  # fmt: skip
    return parser.parse_args()


def main():
    given = arguments()
    try:
        sys.stdout.write(given.run(given))
    except Refused as refused:
        sys.exit(f"score: {refused}")


if __name__ == "__main__":
    main()
