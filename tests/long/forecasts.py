"""Makes effect-free buildings, calibrates them and prints the table: see forecasts.sh."""
import concurrent.futures
import json
import math
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile

from binomial import binomial
from buildings import make_buildings

build = pathlib.Path(sys.argv[1])
recald = build / "daemon/recald"
out = pathlib.Path(os.environ.get("OUT") or tempfile.mkdtemp())
models = os.environ.get("MODELS", "epc hourly").split()


def calibrate(folder, site, model):
    result = folder / model
    if not (result / "calibration.json").exists() and not (result / "failed.txt").exists():
        done = subprocess.run(["timeout", "1200", recald, "calibrate", site, "--model", model,
                               "--threads", "1", "--out", result], capture_output=True, text=True)
        for draws in result.glob("draws_*.csv"):
            draws.unlink()
        if not (result / "calibration.json").exists():
            kept = result.with_name(result.name + ".unconverged")
            result.mkdir(parents=True, exist_ok=True)
            if (kept / "calibration.json").exists():
                (result / "calibration.json").write_text((kept / "calibration.json").read_text())
            else:
                (result / "failed.txt").write_text(done.stderr[-2000:] or "no answer in 1200 s\n")
    return result


def median(values):
    values = [v for v in values if v is not None and math.isfinite(v)]
    return statistics.median(values) if values else float("nan")


def kind_of(name):
    if name.endswith("_peak_kW"):
        return None
    if "elec" in name or "main" in name:
        return "electricity"
    return "cooling" if "chill" in name or "cool" in name else "heating"


def mean_use(result, output):
    values = [p["measured"] for p in result["predictions"]
              if p["output"] == output and p["role"] == "validation" and p["measured"] is not None]
    return statistics.fmean(values) if values else None


def rows_of(results):
    """One entry a meter of every calibration."""
    rows = []
    for name, result in results.items():
        for output, fit in result["forecast"]["validation"].items():
            kind = kind_of(output)
            if kind is None or fit is None or "cvrmse" not in fit:
                continue
            use = mean_use(result, output)
            yardstick = (result["yardstick"]["validation"].get(output) or {}).get("cvrmse")
            year = result["forecast"]["unseen_mean"].get(output)
            score = next(v for k, v in fit.items() if k.startswith("interval_score"))
            # A model that was not calibrated has neither.
            before = (result.get("before", {}).get("validation", {}).get(output) or {})
            after = (result.get("after", {}).get("validation", {}).get(output) or {})
            rows.append({"case": name, "kind": kind, "cv": fit["cvrmse"],
                         "nmbe": fit["nmbe_sim_minus_meas"], "months": fit["months"],
                         "inside": fit["inside_90"], "score": 100 * score / use,
                         "yardstick": yardstick,
                         "year": year and year["q05"] <= year["measured"] <= year["q95"],
                         "before": before.get("nmbe_sim_minus_meas"),
                         "after": after.get("nmbe_sim_minus_meas"),
                         "after_cv": after.get("cvrmse")})
    return rows


def forecast_table(rows):
    print("| meters | n | CV(RMSE) % median / worst | NMBE size % | yardstick's CV % | better than it | "
          "months in 90 % | years in 90 % | score % | model alone, NMBE size % before → after | not worse |")
    print("| --- |" + " --- |" * 10)
    for kind in ("cooling", "heating", "electricity", "thermal"):
        some = [r for r in rows if r["kind"] == kind or (kind == "thermal" and r["kind"] != "electricity")]
        if not some:
            continue
        against = [r for r in some if r["yardstick"] is not None]
        years = [r["year"] for r in some if r["year"] is not None]
        moved = [r for r in some if r["before"] is not None and r["after"] is not None]
        print(f"| {kind} | {len(some)} | {100 * median(r['cv'] for r in some):.1f} / "
              f"{100 * max(r['cv'] for r in some):.0f} | {100 * median(abs(r['nmbe']) for r in some):.1f} | "
              f"{100 * median(r['yardstick'] for r in against):.1f} | "
              f"{binomial(sum(r['cv'] < r['yardstick'] for r in against), len(against))} | "
              f"{binomial(sum(r['inside'] for r in some), sum(r['months'] for r in some))} | "
              f"{binomial(sum(years), len(years))} | {median(r['score'] for r in some):.1f} | "
              f"{100 * median(abs(r['before']) for r in moved):.1f} → "
              f"{100 * median(abs(r['after']) for r in moved):.1f} | "
              f"{binomial(sum(abs(r['after']) <= abs(r['before']) + 0.01 for r in moved), len(moved))} |")


def log_normal(x, of):
    """Log density of a normal with this mean and sd: posterior and prior are compared alike."""
    return -0.5 * ((x - of["mean"]) / of["sd"]) ** 2 - math.log(of["sd"] * math.sqrt(2 * math.pi))


def truth_table(results, truths):
    print("\n| parameter | truth in 90 % | median contraction | mean − truth, prior sd: bias, rms | "
          "log density of the truth, posterior − prior (mean) |")
    print("| --- |" + " --- |" * 4)
    identified = []
    names = sorted({p["name"] for r in results.values() for p in r["parameters"]})
    for name in names:
        inside, contraction, errors, gain = 0, [], [], []
        for case, result in results.items():
            posterior = next((p for p in result["parameters"] if p["name"] == name), None)
            truth = truths.get(case, {}).get(name)
            if posterior is None or truth is None:
                continue
            prior = posterior["prior"]
            inside_now = posterior["q05"] <= truth <= posterior["q95"]
            inside += inside_now
            contraction.append(posterior["contraction"])
            errors.append((posterior["mean"] - truth) / prior["sd"])
            gain.append(log_normal(truth, posterior) - log_normal(truth, prior))
            if posterior["identified"]:
                identified.append(inside_now)
        if errors:
            rms = math.sqrt(statistics.fmean(e * e for e in errors))
            print(f"| {name} | {binomial(inside, len(errors))} | {median(contraction):.2f} | "
                  f"{statistics.fmean(errors):+.2f}, {rms:.2f} | {statistics.fmean(gain):+.2f} |")
    if identified:
        print(f"\nOf parameters called identified the truth is in 90 %: "
              f"{binomial(sum(identified), len(identified))}.")


def truth_of(folder):
    file = folder / "truth.json"
    if not file.exists():
        return {}
    parameters = json.loads(file.read_text()).get("parameters", {})
    return {name: entry["value"] for name, entry in parameters.items()
            if isinstance(entry, dict) and "value" in entry}


folders = []
if os.environ.get("SITES"):
    for site in os.environ["SITES"].split():
        source = pathlib.Path(site)
        folder = out / source.name
        folder.mkdir(parents=True, exist_ok=True)
        folders.append((folder, source / "site.toml", truth_of(source)))
else:
    uses = os.environ.get("USES", "office school laboratory").split()
    for folder in make_buildings(build, out, uses, int(os.environ.get("COUNT", "12")),
                                 int(os.environ.get("SEED", "9001"))):
        if os.environ.get("ERRORS"):  # of the same buildings, in a folder of their own
            site = folder / "site.toml"
            text = site.read_text()
            if "[model.errors]" not in text:
                place = text.index("[building]")
                site.write_text(f"{text[:place]}[model.errors]\n{os.environ['ERRORS']}\n\n{text[place:]}")
        folders.append((folder, folder / "site.toml", truth_of(folder)))

for model in models:
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        done = list(pool.map(lambda f: calibrate(f[0], f[1], model), folders))
    results, failures = {}, []
    for (folder, _, _), result in zip(folders, done):
        file = result / "calibration.json"
        if file.exists():
            results[folder.name] = json.loads(file.read_text())
        else:
            failures.append(f"{folder.name}: {(result / 'failed.txt').read_text().strip().splitlines()[-1]}")
    print(f"\n## {model}: {len(folders)} buildings, {len(failures)} failed, "
          f"{sum(r['status'] == 'unconverged' for r in results.values())} not converged, "
          f"{sum(r['status'] == 'forecast' for r in results.values())} without a calibration, "
          f"{median(r['wall_s'] for r in results.values()):.1f} s each (median)\n")
    for failure in failures:
        print(f"- {failure}")
    forecast_table(rows_of(results))
    truth_table(results, {f.name: t for f, _, t in folders})
print(f"\nresults in {out}")
