"""Makes fleets, learns priors from them, judges them and prints the tables: see portfolio-priors.sh."""
import concurrent.futures
import json
import math
import os
import pathlib
import random
import shutil
import statistics
import subprocess
import sys
import tempfile

from binomial import binomial
from buildings import CLIMATES

build = pathlib.Path(sys.argv[1])
recald, simulator = build / "daemon/recald", build / "simulators/recald-sim"
learner = build / "tests/long/portfolio_priors_study"
out = pathlib.Path(os.environ.get("OUT") or tempfile.mkdtemp())
learning = int(os.environ.get("LEARNING", "24"))
judged = int(os.environ.get("JUDGED", "16"))
others = int(os.environ.get("OTHERS", "12"))
plain = int(os.environ.get("PLAIN", "0"))
spans = [int(m) for m in os.environ.get("MONTHS", "2 3 6").split()]
model = os.environ.get("MODEL", "epc")
first_seed = int(os.environ.get("SEED", "41001"))

# Of each fleet: use, vintage, outdoor air as a share of the drawings', cooling set-point in degC (mean, sd). Without them:
# drawn by the simulator, as the library expects it.
use_of_fleet = os.environ.get("USE", "office")
FLEETS = {
    "alike": (use_of_fleet, "2000s", (0.55, 0.08), (25.5, 0.5)),
    "other": ("school", "1980s", (1.05, 0.08), (22.5, 0.5)),
    "plain": (use_of_fleet, "2000s", None, None),
}
PRIORS = ("library", "learned", "five")


def scenario(use, vintage, number, effects, years):
    text = (f'[building]\nuse = "{use}"\nvintage = "{vintage}"\nstoreys = {1 + number % 4}\n[climate]\n'
            f'name = "{CLIMATES[number % len(CLIMATES)]}"\n[period]\nstart = 2021\nyears = {years}\nstep = "15m"\n')
    for name, strength in effects:
        text += f'[[effect]]\nname = "{name}"\nstrength = {strength:.4f}\nfrom = "2021-01-01"\n'
    return text


def simulate(folder, text, seed):
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "scenario.toml").write_text(text)
    subprocess.run([simulator, "building", "--scenario", folder / "scenario.toml", "--out", folder, "--seed", str(seed)],
                   check=True, capture_output=True, text=True)


def design_airflow(folder):
    line = next(l for l in (folder / "site.toml").read_text().splitlines() if l.startswith("outdoor_air_m3_s"))
    return float(line.split("=")[1])


def make(fleet, number, seed):
    """A building whose true values are of the fleet's population; truth of the two parameters in target.json."""
    folder = out / f"{fleet}-{seed}"
    if (folder / "target.json").exists():
        return folder
    use, vintage, air, setpoint = FLEETS[fleet]
    rng = random.Random(seed)
    with tempfile.TemporaryDirectory() as first:
        first = pathlib.Path(first)
        simulate(first, scenario(use, vintage, number, [], 1), seed)
        built = {name: p["value"] for name, p in json.loads((first / "truth.json").read_text())["parameters"].items()}
        target, effects = dict(built), []
        if air:
            wanted = design_airflow(first) * rng.gauss(*air)
            change = min(max(wanted / built["outdoor_airflow"] - 1, -0.6), 1.5)  # what the effect can do
            target["outdoor_airflow"] = built["outdoor_airflow"] * (1 + change)
            change_K = min(max(rng.gauss(*setpoint) - built["cooling_setpoint"], -2.0), 3.0)
            target["cooling_setpoint"] = built["cooling_setpoint"] + change_K
            effects = [("outdoor_air_amount", change), ("setpoint_raised", change_K)]
    simulate(folder, scenario(use, vintage, number, effects, 3), seed)
    (folder / "target.json").write_text(json.dumps(target))
    return folder


def month_name(index):
    return f"{2021 + index // 12}-{1 + index % 12:02d}"


def site_of(folder, name, last, months, ahead, lines):
    """`months` of data up to month `last` (0: January 2021), and `ahead` unseen ones after it."""
    text = []
    for line in (folder / "site.toml").read_text().splitlines():
        if line.startswith("calibration ="):
            line = f'calibration = {{ from = "{month_name(last - months + 1)}", to = "{month_name(last)}" }}'
        elif line.startswith("validation ="):
            line = f'validation = {{ from = "{month_name(last + 1)}", to = "{month_name(last + ahead)}" }}'
        text.append(line)
        if line.startswith("outputs ="):
            text.append("\n" + lines)
    site = folder / f"{name}.toml"
    site.write_text("\n".join(text) + "\n")
    return site


def calibrate(folder, name, last, months, ahead, lines=""):
    """The calibration's document; none if it failed."""
    kept = folder / f"{model}-{name}.json"
    if not kept.exists():
        site = site_of(folder, name, last, months, ahead, lines)
        with tempfile.TemporaryDirectory() as made:
            result = pathlib.Path(made) / "r"
            done = subprocess.run(["timeout", "1200", recald, "calibrate", site, "--model", model, "--threads", "1", "--out",
                                   result], capture_output=True, text=True)
            for found in (result, result.with_name("r.unconverged")):
                if (found / "calibration.json").exists():
                    shutil.copy(found / "calibration.json", kept)
                    break
            else:
                kept.write_text(json.dumps({"status": "failed", "why": done.stderr[-500:]}))
    document = json.loads(kept.read_text())
    return None if document["status"] == "failed" else document


def teach(folder):
    calibrate(folder, "teaching", 23, 24, 12)
    return folder / f"{model}-teaching.json"


def learn(building, documents):
    """Lines for the site file of the building whose calibration under the library's priors is this."""
    return subprocess.run([learner, building, *documents], check=True, capture_output=True, text=True).stdout


def judge(plan):
    """Under each prior, by months of data: documents of one building."""
    folder, number, teachers = plan
    last = 12 + 5 * number % 12  # any month of the second year
    done = {}
    for months in spans:
        before = calibrate(folder, f"{months}-library", last, months, 12)
        if before is None:
            continue
        done[months, "library"] = before
        for prior in PRIORS[1:]:
            if before["status"] == "forecast":  # nothing is calibrated, whatever the priors
                done[months, prior] = before
                continue
            lines = learn(folder / f"{model}-{months}-library.json", teachers[:5] if prior == "five" else teachers)
            if "prior" not in lines:  # nothing was learned
                done[months, prior] = before
                continue
            after = calibrate(folder, f"{months}-{prior}", last, months, 12, lines)
            if after is not None:
                done[months, prior] = after
    return folder, done


def figures(document):
    """Of one calibration, by meter."""
    rows = {}
    for output, fit in document["forecast"]["validation"].items():
        year = document["forecast"]["unseen_mean"].get(output)
        if output.endswith("_peak_kW") or not fit or not fit.get("crps_kWh") or not year:
            continue
        alone = (document.get("after", {}).get("validation", {}).get(output) or {}).get("nmbe_sim_minus_meas")
        rows[output] = {"crps": fit["crps_kWh"], "inside": fit["inside_90"], "months": fit["months"],
                        "year": abs(year["mean"] / year["measured"] - 1),
                        "year_inside": year["q05"] <= year["measured"] <= year["q95"],
                        "alone": abs(alone) if alone is not None else None}
    return rows


def bootstrap(values, count=4000):
    """Mean over sites with its 95 % interval."""
    rng = random.Random(1)
    means = sorted(statistics.fmean(rng.choices(values, k=len(values))) for _ in range(count))
    return statistics.fmean(values), means[int(0.025 * count)], means[int(0.975 * count)]


def paired(pairs, key, ratio):
    """Mean over sites of the change of a figure, of its logarithm if a ratio is asked for."""
    changes = []
    for before, after in pairs:
        common = [(before[m][key], after[m][key]) for m in before if m in after and before[m][key] is not None
                  and after[m][key] is not None]
        if common:
            changes.append(statistics.fmean(math.log(a / b) if ratio else a - b for b, a in common))
    if not changes:
        return "–"
    mean, low, high = bootstrap(changes)
    if ratio:
        return f"{math.exp(mean):.3f} ({math.exp(low):.3f}–{math.exp(high):.3f})"
    return f"{100 * mean:+.2f} ({100 * low:+.2f} to {100 * high:+.2f})"


def table(title, results):
    print(f"\n### {title}\n")
    print("| months of data | priors | calibrated | CRPS, over the library's | months in 90 % | years in 90 % | "
          "error of the year, % of it (median) | change of it, points | model alone, \\|NMBE\\|, change, points |")
    print("| --- |" + " --- |" * 8)
    for months in spans:
        for prior in PRIORS:
            done = [(r[months, "library"], r[months, prior]) for _, r in results if (months, prior) in r]
            calibrated = [d for d in done if d[0]["status"] != "forecast"]
            pairs = [(figures(b), figures(a)) for b, a in calibrated]
            rows = [row for _, after in pairs for row in after.values()]
            if not rows:
                print(f"| {months} | {prior} | 0 of {len(done)} |" + " – |" * 6)
                continue
            print(f"| {months} | {prior} | {len(calibrated)} of {len(done)} | "
                  f"{paired(pairs, 'crps', True) if prior != 'library' else '1'} | "
                  f"{binomial(sum(r['inside'] for r in rows), sum(r['months'] for r in rows))} | "
                  f"{binomial(sum(r['year_inside'] for r in rows), len(rows))} | "
                  f"{100 * statistics.median(r['year'] for r in rows):.1f} | "
                  f"{paired(pairs, 'year', False) if prior != 'library' else '0'} | "
                  f"{paired(pairs, 'alone', False) if prior != 'library' else '0'} |")
    print("\n| months of data | parameter | priors | truth in 90 % | error of the mean, prior sd (rms) | "
          "its change (absolute) | width of 90 %, over the library's |")
    print("| --- |" + " --- |" * 6)
    for months in spans:
        for name in ("outdoor_airflow", "cooling_setpoint", "occupancy_density"):
            for prior in PRIORS:
                inside, errors, changes, widths = 0, [], [], []
                for folder, r in results:
                    before, after = r.get((months, "library")), r.get((months, prior))
                    if not before or not after or "forecast" in (before["status"], after["status"]):
                        continue
                    truth = json.loads((folder / "target.json").read_text())[name]
                    b, a = ({p["name"]: p for p in d["parameters"]}[name] for d in (before, after))
                    inside += a["q05"] <= truth <= a["q95"]
                    sd = b["prior"]["sd"]
                    errors.append((a["mean"] - truth) / sd)
                    changes.append((abs(a["mean"] - truth) - abs(b["mean"] - truth)) / sd)
                    widths.append((a["q95"] - a["q05"]) / (b["q95"] - b["q05"]))
                if errors and (prior == "library" or any(changes)):
                    mean, low, high = bootstrap(changes)
                    print(f"| {months} | {name} | {prior} | {binomial(inside, len(errors))} | "
                          f"{math.sqrt(statistics.fmean(e * e for e in errors)):.2f} | "
                          f"{f'{mean:+.2f} ({low:+.2f} to {high:+.2f})' if prior != 'library' else '0'} | "
                          f"{statistics.median(widths):.2f} |")


def show_learned(building, documents, title):
    print(f"\nLearned from {title}, for {building.parent.name}:\n\n```toml\n{learn(building, documents).strip()}\n```")


def main():
    plans = [("alike", i, first_seed + i) for i in range(learning + judged)]
    plans += [("other", i, first_seed + 1000 + i) for i in range(others)]
    if plain:
        plans += [("plain", i, first_seed + 2000 + i) for i in range(learning + plain)]
    with concurrent.futures.ThreadPoolExecutor(int(os.environ.get("JOBS", "2"))) as pool:
        folders = dict(zip(plans, pool.map(lambda plan: make(*plan), plans)))
        groups = {fleet: [folders[p] for p in plans if p[0] == fleet] for fleet in FLEETS}
        teachers = list(pool.map(teach, groups["alike"][:learning]))
        print(f"## {model}: {learning} buildings teach; seeds from {first_seed}")
        judged_plans = [(f, i, teachers) for i, f in enumerate(groups["alike"][learning:])]
        results = list(pool.map(judge, judged_plans))
        example = groups["alike"][learning] / f"{model}-{spans[-1]}-library.json"
        show_learned(example, teachers, f"{learning}")
        show_learned(example, teachers[:5], "five")
        table("Judged buildings of the fleet that taught", results)
        if others:
            judged_plans = [(f, i, teachers) for i, f in enumerate(groups["other"])]
            table("Judged buildings of another fleet", list(pool.map(judge, judged_plans)))
        if plain:
            teachers = list(pool.map(teach, groups["plain"][:learning]))
            judged_plans = [(f, i, teachers) for i, f in enumerate(groups["plain"][learning:])]
            table("A fleet as the library expects it", list(pool.map(judge, judged_plans)))
    print(f"\nresults in {out}")


if __name__ == "__main__":
    main()
