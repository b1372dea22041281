"""What `recald drift` finds in simulated buildings: see drift.sh. Prints tables; judges nothing."""
import json
import math
import os
import subprocess
import sys
import tempfile
import tomllib
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

BUILD = Path(sys.argv[1])
SCENARIOS = Path(sys.argv[2])
SEEDS = int(os.environ.get("SEEDS", 8))
QUIET = int(os.environ.get("QUIET", 40))
PARTICLES = os.environ.get("PARTICLES", "256")
JOBS = int(os.environ.get("JOBS", 2))
YEARS = os.environ.get("YEARS", "6")
FIRST_SEED = int(os.environ.get("FIRST_SEED", 1))

# What an answer has to be to count as right: (kind, words of the subject), any of them.
RIGHT = {
    "outdoor_air": [("parameter", "outdoor_airflow"), ("unknown", "")],
    "damper_failing": [("parameter", "outdoor_airflow"), ("unknown", "")],
    "fouling": [("parameter", "cop"), ("unknown", "")],
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


def run(scenario, seed, out):
    """drift.json of one building, made or kept from before."""
    folder = out / f"{scenario.stem}-{seed}"
    result = folder / "drift.json"
    if not result.exists():
        folder.mkdir(parents=True, exist_ok=True)
        years = ["--years", YEARS] if change_of(scenario) is None else []
        subprocess.run([BUILD / "simulators/recald-sim", "building", "--scenario", scenario, "--seed",
                        str(seed), "--out", folder] + years, check=True, stdout=subprocess.DEVNULL)
        # The monthly model has no chiller of its own.
        own_chiller = tomllib.loads(scenario.read_text()).get("plant", {}).get("cooling") == "chiller"
        model = ["--model", "hourly"] if own_chiller else []
        done = subprocess.run([BUILD / "daemon/recald", "drift", folder / "site.toml", "--out", folder,
                               "--particles", PARTICLES, "--threads", "1"] + model,
                              capture_output=True, text=True)
        if done.returncode != 0:
            return {"scenario": scenario.stem, "seed": seed, "error": done.stderr.strip().splitlines()[-1]}
        for name in ("readings.csv", "weather.csv"):
            (folder / name).unlink()
    return {**json.loads(result.read_text()), "scenario": scenario.stem, "seed": seed}


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


def first_alarm(result, change):
    """The first alarm that the change can have raised."""
    for alarm in result["alarms"]:
        if month_number(alarm["month"]) >= change:
            return alarm
    return None


def print_changes(results, scenarios):
    print("\n| scenario | buildings | found | delay, months: median, all | month within interval "
          "| first cause right | building or meter right | before the change |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- |")
    wrong = []
    for scenario in scenarios:
        change = change_of(scenario)
        mine = [r for r in results if r["scenario"] == scenario.stem]
        found = [(r, first_alarm(r, change)) for r in mine]
        found = [(r, a) for r, a in found if a]
        early = sum(month_number(a["month"]) < change for r in mine for a in r["alarms"])
        delays = [month_number(a["month"]) - change + 1 for _, a in found]
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
              f"{' '.join(map(str, sorted(delays)))} | {dated} | {right} | {side} | {early} |")
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
    changing = [s for s in scenarios if change_of(s) is not None]
    if changing:
        print_changes(results, changing)
    print(f"\ndetails in {out}")


main()
