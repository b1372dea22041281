"""Scores of a blind test as a page of Markdown tables."""


def cell_text(text):
    return str(text).replace("|", "\\|").replace("\n", " ").replace("\r", " ")


def table(heads, rows):
    """With a blank line after it; nothing without rows."""
    if not rows:
        return ""
    lines = [heads, ["---"] * len(heads), *rows]
    return "".join("| " + " | ".join(map(cell_text, line)) + " |\n" for line in lines) + "\n"


def percent(share):
    """Whole per cents; one decimal where rounding would say 0 or 100 of something that is neither."""
    value = 100 * share
    return f"{value:.{1 if 0 < value < 1 or 99 < value < 100 else 0}f}"


def share_cell(score):
    if score is None:
        return "-"
    hits = f"{score['hits']} of {score['cases']}: " if "hits" in score else ""
    interval = " ({} to {})".format(*map(percent, score["interval95"])) if "interval95" in score else ""
    return f"{hits}{percent(score['value'])} %{interval}"


def number_cell(score, decimals=2):
    if score is None:
        return "-"
    interval = " ({:.{d}f} to {:.{d}f})".format(*score["interval95"], d=decimals) if "interval95" in score else f" (n = {score['cases']})"
    return f"{score['value']:.{decimals}f}{interval}"


def head(scores):
    versions = ", ".join(f"{version or 'not stated'} ({cases} cases)" for version, cases in scores["versions"].items())
    return (
        f"# Blind test: what {scores['method']} said\n\n"
        + "".join(f"**{warning}.**\n\n" for warning in scores["warnings"])
        + f"{scores['cases']} of {scores['population_cases']} cases scored; version {versions}. Answers {scores['answers_sha256']}, "
        f"results {scores['results_sha256']} (SHA-256).\n\n"
        f"Right answer: {share_cell(scores['naming']['right'])}. In brackets stand 95 % intervals.\n\n"
    )


def target_section(targets):
    rows = [
        [t["world"], t["quantity"], share_cell(t["score"]) if t["decimals"] is None else number_cell(t["score"], t["decimals"]),
         t["minimum"], t["minimum_verdict"], t["excellent"], t["excellent_verdict"]]
        for t in targets
    ]  # fmt: skip
    return (
        "## Targets\n\n"
        + table(["world", "quantity", "measured", "target", "", "aim", ""], rows)
        + "Met: the estimate reaches the target and the one-sided 95 % bound clears it. Met, not shown at this size: the estimate alone does. "
        "Per cent are those of the meter that is moved most.\n\n"
    )


def naming_section(naming):
    keys = ["right", "top1", "top3", "class_right", "wrong_name", "said_unknown", "said_confusable", "said_none"]
    rows = [[group["group"], group["cases"], *(share_cell(group[key]) for key in keys)] for group in naming["groups"]]
    heads = ["hidden", "cases", "right", "top-1", "top-3", "class", "a wrong name", "unknown", "confusable", "none"]
    return (
        "## What was said\n\n"
        + table(heads, rows)
        + "Right: the outcome and the names are exactly the true ones (out of the catalogue: unknown). Top-1, top-3: the truth is first, or among "
        "the first three, of all answers ranked by probability, none and unknown included; of a pair, either.\n\n"
    )


def special_section(naming):
    false = naming["false_names"]
    at_most = f", at most {100 * false['upper95']:.1f} % (one-sided)" if false else ""
    rows = [
        ["nothing hidden, yet an effect named", share_cell(false) + at_most],
        ["nothing hidden, yet not said so", share_cell(naming["false_alarms"])],
        ["something hidden, and an effect named that is not there", share_cell(naming["wrong_names"])],
        ["out of the catalogue, yet an effect named", share_cell(naming["out_of_catalogue_wrong_name"])],
        ["out of the catalogue, flagged unknown", share_cell(naming["out_of_catalogue_unknown"])],
        ["pair: both named", share_cell(naming["pair_both"])],
        ["pair: one named", share_cell(naming["pair_only_one"])],
        ["pair: neither named", share_cell(naming["pair_neither"])],
        ["decoy on offer: right", share_cell(naming["decoys"]["right"])],
        ["decoy on offer: a wrong name", share_cell(naming["decoys"]["wrong_name"])],
        ["confusable: a true one in the set", share_cell(naming["confusable_has_truth"])],
        ["located first: the meter most affected", share_cell(naming["located_meter_right"])],
        ["located at all: the meter most affected", share_cell(naming["located_meter_among_all"])],
    ]
    return "## Particular questions\n\n" + table(["question", "cases"], rows)


def probability_section(probability):
    if probability["cases"] == 0:
        return "## Probabilities\n\nThe results give none.\n\n"
    summary = [
        ["Brier, 0 to 2 (without pairs)", number_cell(probability["brier"], 3)],
        ["log loss, nats (without pairs)", number_cell(probability["log_loss"], 3)],
        ["cases whose truth had less than 1e-06", probability["log_loss_floored"]],
        ["slope that would be best (1: as sure as they may be)", number_cell(probability["slope"])],
        ["calibration error (ECE)", number_cell(probability["ece"], 3)],
        ["name said with P >= 0.8 is right", share_cell(probability["sure_names_right"])],
    ]

    def said(rows, name):
        return [[name(row), row["cases"], f"{row['mean_probability']:.2f}", share_cell(row["right"])] for row in rows if row["cases"]]

    bins = said(probability["reliability"], lambda row: f"{row['from']:.2f} to {row['to']:.2f}")
    kinds = said(probability["reliability_by_kind"], lambda row: row["kind"])
    curve = [
        [f"{row['threshold']:g}", *(share_cell(row[key]) for key in ("coverage", "accuracy", "false_names"))]
        for row in probability["abstention"]
    ]
    return (
        f"## Probabilities\n\n{probability['cases']} cases with probabilities.\n\n"
        + table(["score", "value"], summary)
        + table(["stated probability of the first answer", "cases", "mean stated", "right"], bins)
        + table(["first answer", "cases", "mean stated", "right"], kinds)
        + "If an effect were named whenever it is the most probable answer, from a threshold on:\n\n"
        + table(["named from P", "named, of hidden", "right, of named", "named, of nothing"], curve)
    )


def gap_section(gap):
    rows = [
        ["gap closed, R by CV(RMSE) of the most affected meter (3 % and more, named)", number_cell(gap["reduction_cvrmse"])],
        ["the same by log score of all meters", number_cell(gap["reduction_log_score"])],
        ["R by CV(RMSE), all cases with an effect, named or not", number_cell(gap["reduction_cvrmse_all"])],
        ["the same by log score", number_cell(gap["reduction_log_score_all"])],
        ["another meter made worse by more than 2 standard errors", share_cell(gap["harm"])],
        ["bias of parameters before, in prior sd", number_cell(gap["bias_before"])],
        ["bias of parameters after", number_cell(gap["bias_after"])],
        ["after / before", number_cell(gap["bias_ratio"])],
        ["90 % interval of the effect has the truth", share_cell(gap["effect_interval_coverage"])],
    ]
    text = "## What it was good for\n\n" + table(["quantity", "median or share"], rows)
    text += "R: 0 closes nothing of the gap on held months, 1 as much as a refit with the true effect.\n\n"
    closed, named = gap["reduction_cvrmse"], gap["large_named"]
    if closed and closed["cases"] < named:
        text += f"R is known for {closed['cases']} of {named} named cases; the others lack a fit, or the true effect closes nothing.\n\n"
    if gap["additions_without_harm_figures"]:
        text += f"{gap['additions_without_harm_figures']} additions came without figures for other meters.\n\n"
    if gap["effect_intervals_in_other_units"]:
        text += f"{gap['effect_intervals_in_other_units']} intervals of effects are in another unit than the answer: left out.\n\n"
    if gap["parameters_without_truth"]:
        text += f"Parameters without a known truth, left out: {', '.join(gap['parameters_without_truth'])}.\n\n"
    return text


def world_section(worlds):
    """What was counted besides names, worlds side by side."""
    rows = [
        ["nothing hidden: CV(RMSE) over unseen months of each meter, by the drawings", "nothing_hidden", "cvrmse_by_drawings"],
        ["calibrated, the model alone", "nothing_hidden", "cvrmse_calibrated"],
        ["calibrated, the forecast", "nothing_hidden", "cvrmse_forecast"],
        ["yardstick: the meter's regression on temperature", "nothing_hidden", "cvrmse_yardstick"],
        ["meters whose model calibrating made worse", "nothing_hidden", "made_worse_by_calibrating"],
        ["meters that the yardstick forecasts better", "nothing_hidden", "yardstick_better"],
        ["drift: changes by date found", "drift", "found"],
        ["those of 3 % of a meter and more", "drift", "found_large"],
        ["months until the alarm", "drift", "delay_months"],
        ["alarmed before anything changed", "drift", "alarmed_too_early"],
        ["likeliest cause right", "drift", "cause_right"],
        ["meter or building rightly blamed", "drift", "side_right"],
        ["causes said with P of 0.8 or more: right", "drift", "sure_cause_right"],
        ["nothing hidden, yet an alarm", "drift", "false_alarms"],
    ]

    def cell(score):
        return share_cell(score) if score is None or "hits" in score else number_cell(score, 3)

    return "## Calibration and drift\n\n" + table(
        ["median, or share", *(world["world"] for world in worlds)],
        [[what, *(cell(world[part][key]) for world in worlds)] for what, part, key in rows],
    )


def method_section(methods):
    rows = [
        [row["method"], row["cases"], *(share_cell(row[key]) for key in ("right", "single_right", "single_top1", "false_names", "out_of_catalogue_wrong_name")),
         number_cell(row["reduction_cvrmse_all"]), number_cell(row["wall_s"], 1)]
        for row in methods
    ]  # fmt: skip
    pairs = [
        [row["method"], of["cases"], of["only_main_right"], of["only_other_right"], share_cell(of["right_difference"]), f"{of['mcnemar_p']:.2g}",
         number_cell(of["reduction_difference"]), of["verdict"]]
        for row in methods if (of := row.get("against"))
    ]  # fmt: skip
    return (
        "## Methods\n\n"
        + table(
            [
                "method",
                "cases",
                "right",
                "single right",
                "single top-1",
                "false names",
                "out of catalogue: wrong name",
                "median R, all",
                "median s",
            ],
            rows,
        )
        + table(
            [
                "against",
                "shared cases",
                f"only {methods[0]['method']} right",
                "only the other right",
                "difference",
                "McNemar p",
                "difference in R",
                "",
            ],
            pairs,
        )
    )


def cost_section(scores):
    rows = [
        [what, number_cell(spread["median"], 1), f"{spread['p95']:.1f}", f"{spread['max']:.1f}"]
        for what, key in (("time, s", "wall_s"), ("memory, MB", "peak_rss_MB"))
        if (spread := scores[key])
    ]
    return "## Time and memory\n\n" + (table(["a case", "median", "95 % of cases", "largest"], rows) or "Not stated.\n\n")


def confusion_section(naming):
    """A row a truth; columns would be forty, so what was said stands in a cell, most frequent first."""
    rows = [
        [truth, ", ".join(f"{name} ({cases})" for name, cases in sorted(said.items(), key=lambda one: -one[1]))]
        for truth, said in naming["confusion"].items()
    ]
    return "## What was taken for what\n\n" + table(["truth", "said (cases)"], rows)


def page(scores):
    """Same scores, same bytes."""
    naming, failures = scores["naming"], scores["failures"]
    return (
        head(scores)
        + target_section(scores["targets"])
        + naming_section(naming)
        + special_section(naming)
        + probability_section(scores["probability"])
        + gap_section(scores["gap"])
        + world_section(scores["worlds"])
        + method_section(scores["methods"])
        + cost_section(scores)
        + "## Where\n\n"
        + table(["cases with", "right"], [[row["what"], share_cell(row["right"])] for row in naming["right_by"]])
        + confusion_section(naming)
        + "## Failures\n\n"
        + (
            table(
                ["case", "block", "truth", "said"], [[row[key] for key in ("case", "block", "truth", "said")] for row in failures]
            ).removesuffix("\n")
            or "None.\n"
        )
    )
