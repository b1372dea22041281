"""Savings of measures, really carried out in EnergyPlus: see ecm_energyplus.sh."""

import calendar
import csv
import datetime
import json
import os
import random
import statistics

import energyplus
from binomial import binomial

TRUTHS = int(os.environ.get("TRUTHS", "17"))
# Of these a model gets the first two that it has a parameter for.
MEASURES = [
    ("Better lamps", "lighting_power", "scale", 0.6),
    ("Rooms 1.5 K warmer in summer", "cooling_setpoint", "add", 1.5),
    ("Half the infiltration", "infiltration_scale", "scale", 0.5),
    ("A fifth less of the machines", "equipment_power", "scale", 0.8),
]
A_MODEL = 2
TOGETHER = "All measures together"


def write_measures(file, measures):
    text = ""
    for name, parameter, change, value in measures:
        text += (f'[[measure]]\nname = "{name}"\n[[measure.change]]\nparameter = "{parameter}"\n'
                 f'change = "{change}"\nvalue = {value}\n')
    file.write_text(text)


def priors_of(folder):
    with open(folder / "priors.csv", encoding="utf-8") as file:
        return {row["parameter"]: [float(row[key]) for key in ("min", "mode", "max")] for row in csv.DictReader(file)}


def with_measures(priors, measures):
    """A change of a prior is the same change of each of its draws."""
    changed = dict(priors)
    for _, parameter, change, value in measures:
        changed[parameter] = [one * value if change == "scale" else one + value for one in changed[parameter]]
    return changed


def site_of(folder, name, model, weather, priors, readings="readings.csv", design=None):
    text = energyplus.site_text(model, weather, energyplus.METERS[name], [])
    text = text.replace("readings.csv", readings)
    if design:
        text = text.replace("\noutputs = ", f'\ndesign = "{design}"\noutputs = ')
    for parameter, prior in priors.items():
        text += f'\n[[model.parameter]]\nname = "{parameter}"\n'
        if design is None:
            text += f"prior = {prior}\n"
    file = folder / (readings.replace(".csv", ".toml") if design else "with.toml")
    file.write_text(text)
    return file


def figures(folder):
    """{run: {output: [twelve months]}}"""
    runs = {}
    with open(folder / "doe_outputs.csv", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            for output, value in row.items():
                if output not in ("run", "month"):
                    runs.setdefault(row["run"], {}).setdefault(output, []).append(float(value))
    return runs


def write_readings(file, truth, meters, rng):
    """Quarters of an hour with a month's mean and its peak, noise on each, and on the month."""
    with open(file, "w", encoding="utf-8") as out:
        out.write("timestamp,meter,value,unit\n")
        for month in range(12):
            slots = calendar.monthrange(energyplus.YEAR, month + 1)[1] * 96
            begin = datetime.datetime(energyplus.YEAR, month + 1, 1)
            for meter in meters:
                off = 1 + energyplus.NOISE * rng.gauss(0, 1)
                mean = truth[f"{meter}_daily_kWh"][month] / 24 * off
                peak = max(truth[f"{meter}_peak_kW"][month] * off, mean)
                rest = (mean * slots - peak) / (slots - 1)
                for slot in range(slots):
                    stamp = (begin + datetime.timedelta(minutes=15 * slot)).strftime("%Y-%m-%dT%H:%M:%SZ")
                    kW = peak if slot == 1200 else rest * (1 + 0.01 * rng.uniform(-1, 1))
                    out.write(f"{stamp},{meter},{kW:.4f},kW\n")


def year_of(months, output):
    days = [calendar.monthrange(energyplus.YEAR, month + 1)[1] for month in range(12)]
    total = sum(value * count for value, count in zip(months, days))
    return total / sum(days) if "peak" in output else total


def study(name, model, weather, folder):
    """Rows: one a truth, measure and output."""
    meters = energyplus.METERS[name]
    if not (folder / "runs" / "doe_outputs.csv").exists():
        energyplus.study(name, model, weather, folder)
    priors = priors_of(folder / "runs")
    measures = [measure for measure in MEASURES if measure[1] in priors][:A_MODEL]
    write_measures(folder / "measures.toml", measures)
    site = site_of(folder, name, model, weather, priors)
    energyplus.recald("doe", site, "--out", "ecm-truths", "--priors", "--runs", TRUTHS, "--seed", 4, folder=folder)
    plain = figures(folder / "ecm-truths")
    after = {}
    for measure, some in [(one[0], [one]) for one in measures] + [(TOGETHER, measures)]:
        out = f"ecm-truths-{len(after)}"
        site = site_of(folder, name, model, weather, with_measures(priors, some))
        energyplus.recald("doe", site, "--out", out, "--priors", "--runs", TRUTHS, "--seed", 4, folder=folder)
        after[measure] = figures(folder / out)
    rows = []
    for run, truth in plain.items():
        readings = f"ecm-{run}.csv"
        write_readings(folder / readings, truth, meters, random.Random(int(run)))
        site = site_of(folder, name, model, weather, priors, readings, "runs")
        result = json.loads(energyplus.recald("ecm", site, "--measure", folder / "measures.toml", "--json", folder=folder))
        (folder / readings).unlink()
        for measure in result["measures"]:
            if run not in after[measure["name"]]:
                continue  # failed in EnergyPlus
            for meter in measure["meters"]:
                output = f"{meter['meter']}_{'daily_kWh' if meter['unit'] == 'kWh' else 'peak_kW'}"
                saved = meter["saved"]
                before = year_of(truth[output], output)
                real = before - year_of(after[measure["name"]][run][output], output)
                if saved["q05"] == saved["q95"] == 0 and abs(real) < 1e-4 * before:
                    continue
                rows.append({"model": name, "run": run, "measure": measure["name"], "output": output, "before": before,
                             "truth": real, **{key: saved[key] for key in ("q05", "q50", "q95")}})
    return rows


def main():
    rows = []
    for name, model, weather, folder in energyplus.models():
        kept = folder / "ecm-rows.json"
        if not kept.exists():
            kept.write_text(json.dumps(study(name, model, weather, folder)))
        rows += json.loads(kept.read_text())
    print("| model | measure | output | n | truth in 90 % | saved, % of the use: truth, said (median) | "
          "error of the median, % of the use: median, worst | width, % of the use |")
    print("| --- |" + " --- |" * 7)
    groups = sorted({(row["model"], row["measure"], row["output"]) for row in rows}) + [("all", "all", "_kWh"), ("all", "all", "_kW")]
    for model, measure, output in groups:
        some = [row for row in rows if model in (row["model"], "all") and measure in (row["measure"], "all")
                and row["output"].endswith(output) and row["before"] > 0]
        if not some:
            continue
        share = [100 * row["truth"] / row["before"] for row in some]
        said = [100 * row["q50"] / row["before"] for row in some]
        errors = [abs(a - b) for a, b in zip(share, said)]
        inside = sum(row["q05"] <= row["truth"] <= row["q95"] for row in some)
        widths = [100 * (row["q95"] - row["q05"]) / row["before"] for row in some]
        print(f"| {model} | {measure} | {output} | {len(some)} | {binomial(inside, len(some))} | "
              f"{statistics.median(share):.1f}, {statistics.median(said):.1f} | {statistics.median(errors):.1f}, "
              f"{max(errors):.1f} | {statistics.median(widths):.1f} |")


if __name__ == "__main__":
    main()
