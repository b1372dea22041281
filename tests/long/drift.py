"""What `recald drift` finds in simulated buildings: see drift.sh. Prints tables; judges nothing."""
import json
import math
import os
import subprocess
import sys
import tempfile
import tomllib
from concurrent.futures import ThreadPoolExecutor
from datetime import date
from pathlib import Path

BUILD = Path(sys.argv[1])
SCENARIOS = Path(sys.argv[2])
SEEDS = int(os.environ.get("SEEDS", 8))
QUIET = int(os.environ.get("QUIET", 40))
PARTICLES = os.environ.get("PARTICLES", "256")
JOBS = int(os.environ.get("JOBS", 2))
YEARS = os.environ.get("YEARS", "6")
FIRST_SEED = int(os.environ.get("FIRST_SEED", 1))
SCRATCH = int(os.environ.get("SCRATCH", 1))

# What an answer has to be to count as right: (kind, words of the subject), any of them.
RIGHT = {
    "outdoor_air": [("parameter", "outdoor_airflow"), ("unknown", "")],
    "damper_failing": [("parameter", "outdoor_airflow"), ("unknown", "")],
    "fouling": [("parameter", "cop"), ("unknown", "")],
    "slow_fouling": [("parameter", "cop"), ("unknown", "")],
    "plug_growth": [("use", "electricity")],
    "setpoint_raised": [("parameter", "cooling_setpoint")],
    "people_away": [("parameter", "occupancy"), ("use", "electricity")],
    "new_equipment": [("use", "electricity")],
    "meter_scale": [("meter", "chilled_water")],
    "heat_meter_scale": [("meter", "heating")],
    "stuck_meter": [("meter", "chilled_water")],
}
BUILDING = {"parameter", "use", "unknown"}


def month_number(name):
    return 12 * int(name[:4]) + int(name[5:7]) - 1


def follow(folder, out, options):
    """recald drift. @return the last line of what went wrong, if it did."""
    done = subprocess.run([BUILD / "daemon/recald", "drift", folder / "site.toml", "--out", out,
                           "--particles", PARTICLES, "--threads", "1"] + options,
                          capture_output=True, text=True)
    return done.stderr.strip().splitlines()[-1] if done.returncode != 0 else None


def run(scenario, seed, out):
    """drift.json of one building, made or kept from before; for the first SCRATCH buildings of a
    scenario that of a calibration from scratch each month as well."""
    folder = out / f"{scenario.stem}-{seed}"
    result = folder / "drift.json"
    scratch = folder / "from-scratch" / "drift.json"
    has_scratch = seed < FIRST_SEED + SCRATCH
    if not result.exists() or (has_scratch and not scratch.exists()):
        folder.mkdir(parents=True, exist_ok=True)
        years = ["--years", YEARS] if change_of(scenario) is None else []
        subprocess.run([BUILD / "simulators/recald-sim", "building", "--scenario", scenario, "--seed",
                        str(seed), "--out", folder] + years, check=True, stdout=subprocess.DEVNULL)
        # The monthly model has no chiller of its own.
        own_chiller = tomllib.loads(scenario.read_text()).get("plant", {}).get("cooling") == "chiller"
        model = ["--model", "hourly"] if own_chiller else []
        wrong = follow(folder, folder, model)
        if not wrong and has_scratch:
            wrong = follow(folder, scratch.parent, model + ["--anew-every", "1"])
        if wrong:
            return {"scenario": scenario.stem, "seed": seed, "error": wrong}
        for name in ("readings.csv", "weather.csv"):
            (folder / name).unlink()
    return {**json.loads(result.read_text()), "scenario": scenario.stem, "seed": seed,
            "scratch": json.loads(scratch.read_text()) if scratch.exists() else None}


def change_of(scenario):
    """Month of the change, counted from year 0; None where nothing changes."""
    effects = tomllib.loads(scenario.read_text()).get("effect", [])
    return month_number(effects[0]["from"]) if effects else None


def is_right(scenario, cause):
    return any(cause["kind"] == kind and word in (cause["subject"] or "")
               for kind, word in RIGHT[scenario])


def median(values):
    values = sorted(values)
    return values[len(values) // 2] if values else None


def poisson_upper(count, level=0.95):
    """One-sided upper bound of the mean of a Poisson variable of which `count` was seen."""
    low, high = 0.0, 10.0 + 4.0 * count
    for _ in range(100):
        middle = 0.5 * (low + high)
        term, total = math.exp(-middle), 0.0
        for k in range(count + 1):
            total += term
            term *= middle / (k + 1)
        low, high = (middle, high) if total > 1.0 - level else (low, middle)
    return high


def ks_uniform(pits):
    """Kolmogorov-Smirnov distance from uniform, and its asymptotic p-value."""
    pits = sorted(pits)
    n = len(pits)
    if n == 0:
        return 0.0, 1.0
    d = max(max((i + 1) / n - p, p - i / n) for i, p in enumerate(pits))
    x = (math.sqrt(n) + 0.12 + 0.11 / math.sqrt(n)) * d
    return d, min(1.0, 2.0 * sum((-1) ** (k - 1) * math.exp(-2.0 * (k * x) ** 2) for k in range(1, 101)))


def print_forecasts(title, results, until=None):
    print(f"\n{title}\n")
    print("| output | months | in 50 % | in 90 % | sd of z | mean of z | KS D | p |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- |")
    outputs = {}
    for result in results:
        for output in result["outputs"]:
            for month in output["months"]:
                if until is None or month_number(month["month"]) < until:
                    outputs.setdefault(output["name"], []).append(month)
    for name, months in sorted(outputs.items()):
        z = [m["standardised"] for m in months]
        pits = [m["pit"] for m in months]
        mean = sum(z) / len(z)
        sd = math.sqrt(sum((v - mean) ** 2 for v in z) / len(z))
        half = sum(0.25 <= p <= 0.75 for p in pits) / len(pits)
        ninety = sum(0.05 <= p <= 0.95 for p in pits) / len(pits)
        d, p = ks_uniform(pits)
        print(f"| {name} | {len(z)} | {half:.2f} | {ninety:.2f} | {sd:.2f} | {mean:+.2f} | {d:.3f} "
              f"| {p:.2g} |")


def print_quiet(results):
    years = sum((len(r["months"]) - r["learning_months"]) / 12.0 for r in results)
    alarms = [(r["seed"], a) for r in results for a in r["alarms"]]
    print(f"\nNothing changes: {len(results)} buildings, {years:.0f} years, {len(alarms)} alarms")
    rate = poisson_upper(len(alarms)) / years
    print(f"upper 95 % bound {rate:.4f} a year; nominal 0.05 (one in twenty building-years)")
    for seed, alarm in alarms:
        print(f"  seed {seed}: {alarm['sentence']}")
    print_forecasts("Forecasts where nothing changes", results)


def notices(result):
    """Alarms, and meters that lose their readings (settled by the month after), in order of time."""
    found = list(result["alarms"])
    for change in result.get("meter_changes", []):
        if change.get("kind") != "readings":
            continue
        seen = month_number(change["since"]) + 1
        found.append({"month": f"{seen // 12}-{seen % 12 + 1:02}", "since_earliest": change["since"],
                      "since_latest": change["since"], "sentence": change["sentence"], "days": None,
                      "causes": [{"kind": "meter", "subject": change["meter"]}]})
    return sorted(found, key=lambda notice: notice["month"])


def first_alarm(result, change):
    """The first notice that the change can have raised."""
    for alarm in notices(result):
        if month_number(alarm["month"]) >= change:
            return alarm
    return None


def days_after(alarm, change):
    """From the first day of the month `change` to the day of the alarm; None: raised by a month."""
    if not alarm["days"]:
        return None
    return (date.fromisoformat(alarm["days"]["raised"]) - date(change // 12, change % 12 + 1, 1)).days


def chart_alarms(result):
    """Months in which a plain control chart would be raised: an output's error over its mean, above
    mean and three sd of the first twelve forecasts; the chart begins anew twelve months after."""
    months = []
    for output in result["outputs"]:
        errors = [(month_number(m["month"]), abs(m["measured"] - m["mean"])) for m in output["months"]]
        start = 0
        while start + 12 < len(errors):
            first = [e for _, e in errors[start:start + 12]]
            centre = sum(first) / 12.0
            limit = centre + 3.0 * math.sqrt(sum((e - centre) ** 2 for e in first) / 11.0)
            over = [i for i in range(start + 12, len(errors)) if errors[i][1] > limit]
            if not over:
                break
            months.append(errors[over[0]][0])
            start = over[0]
    return sorted(months)


def print_chart(quiet, changed, scenarios):
    """What a control chart on the same forecasts would have found."""
    print("\nA control chart on each output's error, mean and three sd of its first year, beside it:")
    if quiet:
        years = sum(len(r["months"]) - r["learning_months"] - 12 for r in quiet) / 12.0
        count = sum(len(chart_alarms(r)) for r in quiet)
        print(f"nothing changes: {count} alarms in {years:.0f} years, {count / years:.3f} a year")
    for scenario in scenarios:
        change = change_of(scenario)
        mine = [r for r in changed if r["scenario"] == scenario.stem]
        first = [[m - change + 1 for m in chart_alarms(r) if m >= change] for r in mine]
        delays = sorted(f[0] for f in first if f)
        early = sum(m < change for r in mine for m in chart_alarms(r))
        print(f"  {scenario.stem}: found {len(delays)} of {len(mine)}, after "
              f"{' '.join(map(str, delays)) or '-'} months; before the change: {early}")


def print_scratch(results):
    """Calibrating from scratch each month, beside posteriors that are carried along."""
    pairs = [(r, r["scratch"]) for r in results if r["scratch"]]
    if not pairs:
        return
    ratio = median([scratch["wall_s"] / carried["wall_s"] for carried, scratch in pairs])
    print(f"\nRecalibrated from scratch each month beside it: {len(pairs)} buildings, {ratio:.1f} times "
          "as long (median)\n")
    print("| output | months | log score a month, carried | from scratch | rms difference of z |")
    print("| --- | --- | --- | --- | --- |")
    outputs = {}
    for carried, scratch in pairs:
        for mine, other in zip(carried["outputs"], scratch["outputs"]):
            others = {m["month"]: m for m in other["months"]}
            both = [(m, others[m["month"]]) for m in mine["months"] if m["month"] in others]
            outputs.setdefault(mine["name"], []).extend(both)
    for name, months in sorted(outputs.items()):
        n = len(months)
        rms = math.sqrt(sum((a["standardised"] - b["standardised"]) ** 2 for a, b in months) / n)
        print(f"| {name} | {n} | {sum(a['log_score'] for a, _ in months) / n:.3f} "
              f"| {sum(b['log_score'] for _, b in months) / n:.3f} | {rms:.2f} |")

    def told(result):
        return " ".join(f"{a['month']} {a['causes'][0]['kind'] if a['causes'] else 'open'}"
                        for a in notices(result)) or "none"
    print("\nalarms, carried and from scratch:")
    for carried, scratch in pairs:
        print(f"  {carried['scenario']}-{carried['seed']}: {told(carried)} | {told(scratch)}")


def print_parameters(out, quiet):
    """Whether intervals hold the simulator's own parameters, and shifts where nothing moved."""
    print("\n| parameter | window | truth in 90 % | its bias, in posterior sds |")
    print("| --- | --- | --- | --- |")
    held, biases, shifts = {}, {}, {}
    for result in quiet:
        folder = out / f"{result['scenario']}-{result['seed']}"
        truth = json.loads((folder / "truth.json").read_text())["parameters"]
        for window in result["windows"]:
            for parameter in window["parameters"]:
                if parameter["name"] not in truth:
                    continue
                value = truth[parameter["name"]]["value"]
                key = (parameter["name"], window["name"])
                months = [m for m in parameter["months"] if m["q05"] is not None]
                held.setdefault(key, []).extend(m["q05"] <= value <= m["q95"] for m in months)
                last = months[-1]
                biases.setdefault(key, []).append((last["mean"] - value) * 3.29
                                                  / (last["q95"] - last["q05"]))
        for shift in result["last_year"]:
            if "pvalue" in shift:
                shifts.setdefault(shift["name"], []).append(shift["pvalue"])
    for (name, window), inside in held.items():
        bias = biases[name, window]
        print(f"| {name} | {window} | {sum(inside) / len(inside):.2f} | {sum(bias) / len(bias):+.1f} |")
    for name, pvalues in shifts.items():
        print(f"shift of {name} within the last year: p < 0.05 in {sum(p < 0.05 for p in pvalues)}, "
              f"p < 0.2 in {sum(p < 0.2 for p in pvalues)} of {len(pvalues)}")


def print_changes(results, scenarios):
    print("\n| scenario | buildings | found | delay, months: median, all | days, where raised by days "
          "| month within interval | first cause right | building or meter right | before the change |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- | --- |")
    wrong = []
    for scenario in scenarios:
        change = change_of(scenario)
        mine = [r for r in results if r["scenario"] == scenario.stem]
        found = [(r, first_alarm(r, change)) for r in mine]
        found = [(r, a) for r, a in found if a]
        early = sum(month_number(a["month"]) < change for r in mine for a in r["alarms"])
        delays = [month_number(a["month"]) - change + 1 for _, a in found]
        days = sorted(d for d in (days_after(a, change) for _, a in found) if d is not None)
        dated = sum(month_number(a["since_earliest"]) <= change <= month_number(a["since_latest"])
                    for _, a in found)
        right = side = 0
        for result, alarm in found:
            if not alarm["causes"]:
                continue
            cause = alarm["causes"][0]
            right += is_right(scenario.stem, cause)
            is_meter = RIGHT[scenario.stem][0][0] == "meter"
            side += (cause["kind"] == "meter") if is_meter else (cause["kind"] in BUILDING)
            if not is_right(scenario.stem, cause):
                wrong.append(f"  {scenario.stem}-{result['seed']}: {alarm['sentence']}")
        print(f"| {scenario.stem} | {len(mine)} | {len(found)} | {median(delays)}: "
              f"{' '.join(map(str, sorted(delays)))} | {' '.join(map(str, days)) or '-'} | {dated} "
              f"| {right} | {side} | {early} |")
    print("\nFound, and called something else:")
    print("\n".join(wrong) if wrong else "  none")


def main():
    out = Path(os.environ.get("DRIFT_DIR") or tempfile.mkdtemp())
    scenarios = sorted(SCENARIOS.glob("*.toml"))
    only = os.environ.get("ONLY", "").split()
    if only:
        scenarios = [s for s in scenarios if s.stem in only]
    jobs = [(s, FIRST_SEED + i) for s in scenarios
            for i in range(QUIET if change_of(s) is None else SEEDS)]
    with ThreadPoolExecutor(JOBS) as pool:
        results = list(pool.map(lambda job: run(*job, out), jobs))
    for failed in [r for r in results if "error" in r]:
        print(f"{failed['scenario']}-{failed['seed']}: {failed['error']}")
    results = [r for r in results if "error" not in r]
    print(f"{PARTICLES} particles, seeds from {FIRST_SEED}; "
          f"{median([r['wall_s'] for r in results])} s a building (median)")
    quiet = [r for r in results if change_of(SCENARIOS / (r["scenario"] + ".toml")) is None]
    if quiet:
        print_quiet(quiet)
        print_parameters(out, quiet)
    changing = [s for s in scenarios if change_of(s) is not None]
    if changing:
        print_changes(results, changing)
    print_chart(quiet, results, changing)
    print_scratch(results)
    print(f"\ndetails in {out}")


main()
