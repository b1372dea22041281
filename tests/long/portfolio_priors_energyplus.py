"""Priors learned from a portfolio, where the model is right but for its parameters: see portfolio-priors-energyplus.sh."""

import csv
import json
import math
import os
import pathlib
import random
import shutil
import statistics
import subprocess
import tempfile

import energyplus
from binomial import binomial
from energyplus import BUILD, RECALD_SIM, recald

LEARNING = int(os.environ.get("LEARNING", "16"))
JUDGED = int(os.environ.get("JUDGED", "12"))
SPANS = [int(m) for m in os.environ.get("MONTHS", "2 3 6").split()]
PARAMETERS = os.environ.get("PARAMETERS", "occupancy_density cooling_setpoint heating_setpoint equipment_power "
                            "infiltration_scale").split()
KIND = os.environ.get("KIND", "small_office")
LEARNER = (BUILD / "tests/long/portfolio_priors_study").resolve()
PRIORS = ("library", "learned", "five")


def population(prior, number, mirrored):
    """A third of the prior's range, beside its middle: above it for every other parameter."""
    low, _, high = prior
    above = (number % 2 == 0) != mirrored
    first = 0.55 if above else 0.12
    return [low + share * (high - low) for share in (first, first + 0.165, first + 0.33)]


def write_site(folder, model, weather, priors):
    text = energyplus.site_text(model, weather, energyplus.METERS[KIND], [])
    for name, prior in priors.items():
        text += f'\n[[model.parameter]]\nname = "{name}"\n' + (f"prior = {prior}\n" if prior else "")
    (folder / "site.toml").write_text(text)
    return folder / "site.toml"


def priors_of(design):
    with open(design / "priors.csv", encoding="utf-8") as file:
        return {row["parameter"]: [float(row[key]) for key in ("min", "mode", "max")] for row in csv.DictReader(file)}


def with_priors(design, learned, at):
    """The same runs under other priors."""
    shutil.copytree(design, at)
    rows = list(csv.DictReader(open(design / "priors.csv", encoding="utf-8")))
    for row in rows:
        if row["parameter"] in learned:
            row["min"], row["mode"], row["max"] = map(str, learned[row["parameter"]])
    with open(at / "priors.csv", "w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, rows[0].keys())
        writer.writeheader()
        writer.writerows(rows)


def learned_from(building, documents):
    """{name: [min, mode, max]}, and the sentences."""
    lines = subprocess.run([LEARNER, building, *documents], check=True, capture_output=True, text=True).stdout
    learned, name = {}, None
    for line in lines.splitlines():
        if line.startswith("name ="):
            name = line.split('"')[1]
        if line.startswith("prior ="):
            learned[name] = json.loads(line.split("=")[1])
    return learned, [line for line in lines.splitlines() if line.startswith("#")]


def calibrate(folder, design, truths, run, months, kept):
    if not kept.exists():
        kept.parent.mkdir(parents=True, exist_ok=True)
        measured = kept.with_suffix(".csv")
        energyplus.measurements(truths, run, measured, random.Random(f"{truths.name} {run}"))
        lines = measured.read_text().splitlines()
        first = 1 + 5 * int(run) % 12
        chosen = {1 + (first + i) % 12 for i in range(months)}
        measured.write_text("\n".join([lines[0]] + [l for i, l in enumerate(lines[1:], 1) if i in chosen]) + "\n")
        done = subprocess.run([energyplus.RECALD.resolve(), "calibrate", "--doe", design, "--measurements", measured, "--form",
                               "monthly", "--parameters", "all", "--json"], cwd=folder,
                              capture_output=True, text=True)
        kept.write_text(done.stdout if done.returncode == 0 else json.dumps({"status": "failed", "why": done.stderr}))
    document = json.loads(kept.read_text())
    return None if document["status"] == "failed" else document


def runs_of(truths):
    ran = {row["run"] for row in csv.DictReader(open(truths / "doe_outputs.csv", encoding="utf-8"))}
    return [row for row in csv.DictReader(open(truths / "doe_inputs.csv", encoding="utf-8")) if row["run"] in ran]


def crps_normal(mean, sd, x):
    z = (x - mean) / sd
    return sd * (z * math.erf(z / math.sqrt(2)) + 2 * math.exp(-z * z / 2) / math.sqrt(2 * math.pi) - 1 / math.sqrt(math.pi))


def bootstrap(values):
    rng = random.Random(1)
    means = sorted(statistics.fmean(rng.choices(values, k=len(values))) for _ in range(4000))
    return statistics.fmean(values), means[100], means[3900]


def judge(folder, fleet, rows, teachers):
    results = []
    for row in rows:
        for months in SPANS:
            at = folder / "judged" / f"{fleet}-{row['run']}-{months}"
            before = calibrate(folder, folder / "runs", folder / fleet, row["run"], months, at.with_suffix(".library.json"))
            if before is None:
                continue
            results.append((row, months, "library", before, before))
            for prior in PRIORS[1:]:
                documents = teachers[:5] if prior == "five" else teachers
                learned, _ = learned_from(at.with_suffix(".library.json"), documents)
                with tempfile.TemporaryDirectory() as made:
                    design = pathlib.Path(made) / "runs"
                    with_priors(folder / "runs", learned, design)
                    after = calibrate(folder, design, folder / fleet, row["run"], months, at.with_suffix(f".{prior}.json"))
                if after is not None:
                    results.append((row, months, prior, before, after))
    return results


def table(title, results):
    print(f"\n### {title}\n")
    print("| months of data | priors | buildings | truth in 90 %, all parameters | CRPS of the parameters, over the library's | "
          "error of the mean, prior sd (rms) |")
    print("| --- |" + " --- |" * 5)
    for months in SPANS:
        for prior in PRIORS:
            inside, count, changes, errors = 0, 0, [], []
            for row, m, p, before, after in results:
                if (m, p) != (months, prior):
                    continue
                ratios = []
                for b, a in zip(before["parameters"], after["parameters"]):
                    truth = float(row[a["name"]])
                    inside += a["q05"] <= truth <= a["q95"]
                    count += 1
                    errors.append((a["mean"] - truth) / b["prior"]["sd"])
                    ratios.append((crps_normal(b["mean"], b["sd"], truth) / b["prior"]["sd"],
                                   crps_normal(a["mean"], a["sd"], truth) / b["prior"]["sd"]))
                changes.append(math.log(sum(r[1] for r in ratios) / sum(r[0] for r in ratios)))
            if changes:
                mean, low, high = (math.exp(v) for v in bootstrap(changes))
                print(f"| {months} | {prior} | {len(changes)} | {binomial(inside, count)} | {mean:.3f} ({low:.3f}–{high:.3f}) | "
                      f"{math.sqrt(statistics.fmean(e * e for e in errors)):.2f} |")


def main():
    folder = pathlib.Path(os.environ.get("OUT") or tempfile.mkdtemp()).resolve()
    folder.mkdir(parents=True, exist_ok=True)
    own = folder / "own"
    if not (own / "model.epJSON").exists():
        subprocess.run([RECALD_SIM, "eplus", "--kind", KIND, "--true", "--start", str(energyplus.YEAR), "--years", "1", "--out",
                        own], check=True)
    model, weather = own / "model.epJSON", next(own.glob("*.epw"))
    energyplus.write_readings(folder / "readings.csv", energyplus.METERS[KIND])
    site = write_site(folder, model, weather, dict.fromkeys(PARAMETERS))
    if not (folder / "runs" / "doe_outputs.csv").exists():
        recald("doe", site, "--out", "runs", folder=folder)
    priors = priors_of(folder / "runs")
    for fleet, count, seed in (("alike", LEARNING + JUDGED, 5), ("other", max(10, JUDGED), 6)):
        if not (folder / fleet / "doe_outputs.csv").exists():
            drawn = {name: population(prior, i, fleet == "other") for i, (name, prior) in enumerate(priors.items())}
            site = write_site(folder, model, weather, drawn)
            recald("doe", site, "--out", fleet, "--priors", "--runs", count, "--seed", seed, folder=folder)
    rows = runs_of(folder / "alike")
    teachers = []
    for row in rows[:LEARNING]:
        kept = folder / "teaching" / f"{row['run']}.json"
        if calibrate(folder, folder / "runs", folder / "alike", row["run"], 12, kept) is not None:
            teachers.append(kept)
    print(f"## {KIND} in EnergyPlus: {len(teachers)} buildings teach with twelve months\n")
    for count in (len(teachers), 5):
        print("\n".join(learned_from(teachers[0], teachers[:count])[1]) + "\n")
    table("Judged buildings of the fleet that taught", judge(folder, "alike", rows[LEARNING:], teachers))
    table("Judged buildings of another fleet", judge(folder, "other", runs_of(folder / "other")[:JUDGED], teachers))
    print(f"\nresults in {folder}")


if __name__ == "__main__":
    main()
