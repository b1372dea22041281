"""Meta-models of EnergyPlus models: left-out runs, corners, coverage. See energyplus.sh."""

import csv
import datetime
import json
import math
import os
import pathlib
import random
import subprocess
import sys
import tempfile
import time

from binomial import binomial

BUILD = pathlib.Path(sys.argv[1])
RECALD = BUILD / "daemon" / "recald"
RECALD_SIM = BUILD / "simulators" / "recald-sim"
RUNS = int(os.environ.get("RUNS", "200"))
TRUTHS = int(os.environ.get("TRUTHS", "30"))
CORNERS = 20
NOISE = 0.01  # of a month's figure
YEAR = 2021

# What each model's meters are called, and the utility that they measure.
METERS = {
    "5ZoneAutoDXVAV": {
        "electricity": ("electricity", ["Electricity:Facility", "-Cooling:Electricity", "-Heating:Electricity"]),
        "cooling": ("chilled_water", ["CoolingCoils:EnergyTransfer"]),
        "heat": ("heating", ["HeatingCoils:EnergyTransfer"]),
    },
    "ASHRAE901_Warehouse_STD2019_Denver": {
        "electricity": ("electricity", ["Electricity:Facility"]),
        "gas": ("gas", ["NaturalGas:Facility"]),
    },
    "2ZoneDataCenterHVAC_wEconomizer_DX": {
        "electricity": ("electricity", ["Electricity:Facility", "-Cooling:Electricity"]),
        "cooling": ("electricity", ["Cooling:Electricity"]),
    },
    "laboratory": {
        "electricity": ("electricity", ["Electricity:Facility"]),
        "chilled_water": ("chilled_water", ["DistrictCooling:Facility"]),
        "heat": ("heating", ["DistrictHeatingWater:Facility"]),
    },
    "small_office": {
        "electricity": ("electricity", ["Electricity:Facility"]),
        "chilled_water": ("chilled_water", ["DistrictCooling:Facility"]),
        "heat": ("heating", ["DistrictHeatingWater:Facility"]),
    },
}


def recald(*arguments, folder):
    done = subprocess.run([RECALD, *map(str, arguments)], cwd=folder, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"recald {' '.join(map(str, arguments))}: {done.stderr.strip()}")
    return done.stdout


def write_readings(file, meters):
    """A plain load: the design needs meters, not what they say."""
    begin = datetime.datetime(YEAR, 1, 1)
    with open(file, "w", encoding="utf-8") as out:
        out.write("timestamp,meter,value,unit\n")
        for i in range(365 * 24):
            stamp = (begin + datetime.timedelta(hours=i)).strftime("%Y-%m-%dT%H:%M:%SZ")
            for meter in meters:
                out.write(f"{stamp},{meter},{100 + 10 * math.sin(1.3 * i):.2f},kW\n")


def site_text(model, weather, meters, parameters):
    text = f"""[site]
id = "study"
timezone = "Etc/UTC"
latitude_deg = 40.6
longitude_deg = -73.8

[weather]
file = "{weather}"
format = "epw"

[period]
calibration = {{ from = "{YEAR}-01", to = "{YEAR}-12" }}
"""
    for name, (utility, _) in meters.items():
        text += f'\n[[meter]]\nid = "{name}"\nutility = "{utility}"\nfile = "readings.csv"\n'
        if utility == "gas":
            text += "gas_kWh_per_m3 = 10\n"
    text += f'\n[[model]]\nkind = "energyplus"\nfile = "{model}"\nruns = {RUNS}\noutputs = {json.dumps(list(meters))}\n'
    text += "[model.reports]\n"
    for name, (_, reports) in meters.items():
        text += f"{name} = {json.dumps(reports)}\n"
    for name in parameters:
        text += f'\n[[model.parameter]]\nname = "{name}"\n'
    return text


def measurements(truths, run, file, rng):
    """The months of one run, with noise, as a design folder's measurements: daily averages, as a site is fitted to."""
    rows = [row for row in csv.DictReader(open(truths / "doe_outputs.csv", encoding="utf-8")) if row["run"] == run]
    names = [name for name in rows[0] if "_daily_" in name]
    with open(file, "w", encoding="utf-8") as out:
        out.write("month," + ",".join(names) + "\n")
        for row in rows:
            values = [float(row[name]) * (1 + NOISE * rng.gauss(0, 1)) for name in names]
            out.write(row["month"] + "," + ",".join(f"{value:.6g}" for value in values) + "\n")


def study(name, model, weather, folder):
    meters = METERS[name]
    folder.mkdir(parents=True, exist_ok=True)
    write_readings(folder / "readings.csv", meters)
    site = folder / "site.toml"
    site.write_text(site_text(model, weather, meters, []), encoding="utf-8")
    shown = json.loads(recald("engine", "show", site, "--json", folder=folder))
    parameters = [parameter["name"] for parameter in shown["parameters"]]
    site.write_text(site_text(model, weather, meters, parameters), encoding="utf-8")
    begin = time.time()
    recald("doe", site, "--out", "runs", folder=folder)
    seconds = time.time() - begin
    recald("doe", site, "--out", "truths", "--priors", "--runs", TRUTHS, "--seed", 2, folder=folder)
    recald("doe", site, "--out", "corners", "--runs", CORNERS, "--corners", "--seed", 3, folder=folder)
    checks = {}
    for check in ("truths", "corners"):
        result = recald("metamodel", "--doe", "runs", "--form", "monthly", "--check", check, "--json", folder=folder)
        checks[check] = json.loads(result)["check"]
    inside = coverage(folder)
    return {"parameters": len(parameters), "seconds": seconds, "checks": checks, "hits": sum(inside), "count": len(inside)}


def coverage(folder):
    """Whether each parameter of each truth lies in its 90 % interval. Truths done are kept: a study that stopped goes on."""
    kept = folder / "coverage.json"
    done = json.loads(kept.read_text()) if kept.exists() else {}
    ran = {row["run"] for row in csv.DictReader(open(folder / "truths" / "doe_outputs.csv", encoding="utf-8"))}
    for truth in csv.DictReader(open(folder / "truths" / "doe_inputs.csv", encoding="utf-8")):
        run = truth["run"]
        if run in done or run not in ran:  # others failed in EnergyPlus
            continue
        file = folder / "measured.csv"
        measurements(folder / "truths", run, file, random.Random(int(run)))
        result = json.loads(recald("calibrate", "--doe", "runs", "--measurements", file, "--form", "monthly", "--json",
                                   "--sampler", "dram", folder=folder))
        done[run] = [parameter["q05"] <= float(truth[parameter["name"]]) <= parameter["q95"]
                     for parameter in result["parameters"]]
        kept.write_text(json.dumps(done))
    return [one for run in done.values() for one in run]


def directions(name, folder):
    """What one standard deviation of a parameter does to daily averages, of those that explain a hundredth of one."""
    screened = json.loads(recald("screen", "--doe", "runs", "--json", folder=folder))
    totals = {}
    for row in csv.DictReader(open(folder / "runs" / "doe_outputs.csv", encoding="utf-8")):
        for output in row:
            if "_daily_" in output:
                totals.setdefault(output, []).append(float(row[output]))
    for parameter in screened["parameters"]:
        moves = [f"{output.split('_daily_')[0]} {100 * effect['change_mean'] / (sum(values) / len(values)):+.1f} %"
                 for output, values in totals.items()
                 if (effect := parameter["effects"].get(output, {"share": 0}))["share"] >= 0.01]
        if moves:
            print(f"- {name}, {parameter['name']}: {', '.join(moves)}", flush=True)


def models():
    """(name, model, weather file, folder) of each."""
    out = pathlib.Path(os.environ.get("OUT") or tempfile.mkdtemp(prefix="recald-energyplus-")).resolve()
    print(f"Runs are kept in {out}")
    all_models = []
    for kind in os.environ.get("KINDS", "small_office laboratory").split():
        own = out / f"{kind}-model"
        if not (own / "model.epJSON").exists():
            subprocess.run([RECALD_SIM, "eplus", "--kind", kind, "--true", "--start", str(YEAR), "--years", "1", "--out", own],
                           check=True)
        all_models.append((kind, own / "model.epJSON", next(own.glob("*.epw")), out / kind))
    examples = os.environ.get("EXAMPLES")
    if examples:
        weather = pathlib.Path(os.environ["WEATHER"]).resolve()
        for file in sorted(pathlib.Path(examples).resolve().glob("*.epJSON")):
            if file.stem in METERS:
                all_models.append((file.stem, file, weather, out / file.stem))
    return all_models


def main():
    print("| model | parameters | s a run | output | R2, median month | R2, worst month (its error) | CV at corners | truth in 90 % |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- |")
    for name, model, weather, folder in models():
        result = study(name, model, weather, folder)
        for output, check in result["checks"]["truths"].items():
            corner = result["checks"]["corners"][output]["cvrmse"]
            print(f"| {name} | {result['parameters']} | {result['seconds'] / RUNS:.1f} | {output} "
                  f"| {check['r2_median_month']:.4f} | {check['r2_worst_month']:.4f} "
                  f"({100 * check['error_of_worst_month']:.2f} %) | {100 * corner:.1f} % "
                  f"| {binomial(result['hits'], result['count'])} |", flush=True)
        directions(name, folder)


if __name__ == "__main__":
    main()
