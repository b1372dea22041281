"""Builds the laboratory, runs its truth, calibrates both models and writes the tables: see seed.sh."""
import concurrent.futures
import json
import os
import pathlib
import subprocess
import sys
import time

build = pathlib.Path(sys.argv[1]).resolve()
recald = build / "daemon/recald"
simulator = build / "simulators/recald-sim"
program = os.environ["RECALD_ENERGYPLUS"]
out = pathlib.Path(os.environ["OUT"]).resolve()
seed = os.environ.get("SEED", "1")
runs = os.environ.get("RUNS", "200")
page = pathlib.Path(__file__).resolve().parent.parent / "results/seed.md"
YEARS = (2011, 2012, 2013)
METERS = {"electricity": "Electricity:Facility", "chilled_water": "DistrictCooling:Facility",
          "heat": "DistrictHeatingWater:Facility"}

# Tables 3 and 4 of the paper: NMBE (simulated minus measured) and CV(RMSE).
PAPER = {("energyplus", "consumption", "calibration"): ((0.17, 0.40), (-0.04, 0.13)),
         ("epc", "consumption", "calibration"): ((0.09, 0.19), (0.02, 0.16)),
         ("energyplus", "peak", "calibration"): ((0.52, 0.57), (-0.03, 0.08)),
         ("energyplus", "consumption", "validation"): ((0.34, 0.56), (0.07, 0.15)),
         ("epc", "consumption", "validation"): ((0.12, 0.18), (-0.01, 0.13)),
         ("energyplus", "peak", "validation"): ((0.72, 0.75), (0.11, 0.14))}

# Name, change, prior (min, mode, max), targets, and whether the paper's Table 2 kept it.
PARAMETERS = [
    ("cooling_setpoint", "set", (20, 24, 27.8), ["Schedule:Constant/Cooling set-point/hourly_value"], True),
    ("occupancy_office", "scale", (0, 1, 2), ["People/Offices people/people_per_floor_area"], True),
    ("occupancy_laboratory", "scale", (0, 1, 2), ["People/Laboratories people/people_per_floor_area"], True)]
PARAMETERS += [
    (f"outdoor_air_{name}", "scale", (0.3, 1, 1.2),
     [f"Controller:OutdoorAir/{handler} outdoor air controller/minimum_outdoor_air_flow_rate"], True)
    for name, handler in (("office", "Office handler"), ("laboratory_1", "Laboratory handler 1"),
                          ("laboratory_2", "Laboratory handler 2"))]
PARAMETERS += [
    ("lighting", "scale", (0.7, 1, 1.3), ["Lights/*/watts_per_floor_area"], False),
    ("equipment", "scale", (0.7, 1, 1.3), ["ElectricEquipment/*/watts_per_floor_area"], False),
    ("infiltration", "scale", (0.2, 1, 3),
     ["ZoneInfiltration:DesignFlowRate/*/flow_rate_per_exterior_surface_area"], False),
    ("supply_temperature", "set", (11, 13, 14), ["Schedule:Constant/* supply temperature/hourly_value"], False),
    ("window_u", "scale", (0.85, 1, 1.15), ["WindowMaterial:SimpleGlazingSystem/*/u_factor"], False)]


def run(*command, log):
    """Its output goes to a file, which is named if it fails."""
    with open(log, "w") as file:
        done = subprocess.run([str(word) for word in command], stdout=file, stderr=subprocess.STDOUT)
    if done.returncode != 0:
        sys.exit(f"{' '.join(str(word) for word in command)}: ended with {done.returncode}; see {log}")


def run_truth(year):
    folder = out / f"truth-{year}"
    if (folder / "done").exists():
        return
    run("sh", "-c", 'cd "$1" && exec "$2" --weather "$3.epw" --output-directory "truth-$3" "truth-$3.epJSON"', "sh", out,
        program, year, log=out / f"truth-{year}.log")
    (folder / "done").touch()


def heading(holidays):
    dates = ", ".join(f'"{date}"' for date in holidays)
    meters = "".join(f'[[meter]]\nid = "{name}"\nutility = "{utility}"\nfile = "readings.csv"\nstamps = "start"\n'
                     f'rated_kW = {rated}\nzero_run_max = "9000h"   # no chilled water in winter\n\n'
                     for name, utility, rated in (("electricity", "electricity", 450),
                                                  ("chilled_water", "chilled_water", 2500),
                                                  ("heat", "heating", 2500)))
    return f'''# Campus laboratory, from the drawings.
[site]
id = "seed"
timezone = "America/New_York"
latitude_deg = 33.65
longitude_deg = -84.43
altitude_m = 308
interval = "15m"
holidays = [{dates}]

[weather]
file = "weather.csv"
format = "csv"
stamps = "end"
values = "instant"

{meters}[period]
calibration = {{ from = "2011-01", to = "2012-12" }}
validation = {{ from = "2013-01", to = "2013-12" }}

'''


def energyplus_model():
    reports = "".join(f'{name} = ["{meter}"]\n' for name, meter in METERS.items())
    text = f'''[[model]]
kind = "energyplus"
file = "model.epJSON"
outputs = ["electricity", "chilled_water", "heat"]
design = "runs"
runs = {runs}
interval_noise = 0.02
[model.reports]
{reports}'''
    for name, change, prior, targets, _ in PARAMETERS:
        text += (f'[[model.parameter]]\nname = "{name}"\ntargets = {json.dumps(targets)}\nchange = "{change}"\n'
                 f'prior = {list(prior)}\n')
    return text


# The drawings of simulators/energyplus/laboratory.hpp, as an EPC sees them: 2560 m2 of offices, 3840 m2 of
# laboratories.
EPC = '''[[model]]
kind = "epc"
outputs = ["electricity", "chilled_water", "heat"]

[building]
floor_area_m2 = 6400
storeys = 2
storey_height_m = 4.0
mass = "heavy"

''' + "".join(
    f'[[building.surface]]\nname = "{side} wall"\nkind = "wall"\narea_m2 = {wall}\nu_W_m2K = 0.47\n'
    f'azimuth_deg = {azimuth}\nsolar_absorptance = 0.6\n'
    f'[[building.surface]]\nname = "{side} windows"\nkind = "window"\narea_m2 = {window}\nu_W_m2K = 2.7\n'
    f'azimuth_deg = {azimuth}\nshgc = 0.4\nframe_fraction = 0.0\nshading_factor = 1.0\n'
    for side, azimuth, wall, window in (("south", 180, 416.0, 224.0), ("north", 0, 416.0, 224.0),
                                        ("east", 90, 275.2, 44.8), ("west", 270, 275.2, 44.8))) + '''
[[building.surface]]
name = "roof"
kind = "roof"
area_m2 = 3200
u_W_m2K = 0.32
solar_absorptance = 0.7
[[building.surface]]
name = "ground slab"
kind = "ground"
area_m2 = 3200
u_W_m2K = 0.57

[building.use]
occupancy_person_m2 = 0.048
lighting_W_m2 = 10.4
plugs_W_m2 = 20.8
zone_heat_share = 1.0

[building.schedule]   # the mean of offices and laboratories
workday = [0.01, 0.01, 0.01, 0.01, 0.01, 0.01, 0.03, 0.13, 0.37, 0.64, 0.77, 0.79, 0.64, 0.69, 0.8, 0.8, 0.73, 0.51, 0.28, 0.17, 0.12, 0.09, 0.05, 0.02]
saturday = [0.01, 0.01, 0.01, 0.01, 0.01, 0.01, 0.01, 0.02, 0.04, 0.07, 0.1, 0.12, 0.12, 0.12, 0.12, 0.11, 0.09, 0.07, 0.05, 0.04, 0.03, 0.02, 0.02, 0.01]
sunday = [0.01, 0.01, 0.01, 0.01, 0.01, 0.01, 0.01, 0.01, 0.02, 0.04, 0.06, 0.07, 0.08, 0.08, 0.08, 0.07, 0.06, 0.05, 0.04, 0.03, 0.03, 0.02, 0.02, 0.01]

[building.setpoint]
cooling_occupied_C = 24.0
cooling_unoccupied_C = 24.0
heating_occupied_C = 21.0
heating_unoccupied_C = 21.0
occupied_from = 6
occupied_to = 20

[building.infiltration]
ela_cm2_m2 = 3.0

[building.air]
outdoor_air_m3_s = 19.0
outdoor_air_unoccupied_fraction = 0.84   # laboratories run always
supply_flow_design_m3_s = 44.2
supply_flow_min_m3_s = 27.0
supply_temperature_C = 13.0
fan_design_kW = 81
pump_design_kW = 20

[building.heating]
efficiency = 1.0

[building.ground]
temperature_C = 18.0
'''


def prepare():
    out.mkdir(parents=True, exist_ok=True)
    if not (out / "weather.csv").exists():
        run(simulator, "eplus", "--kind", "laboratory", "--true", "--start", YEARS[0], "--years", len(YEARS),
            "--seed", seed, "--out", out, log=out / "eplus.log")
    # EnergyPlus is a process of its own, so threads are enough.
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        list(pool.map(run_truth, YEARS))
    if not (out / "readings.csv").exists():
        run(simulator, "eplus-readings", *(out / f"truth-{year}/eplusout.sql" for year in YEARS), "--seed", seed,
            "--out", out / "readings.csv", log=out / "readings.log")
    holidays = []
    for year in YEARS:  # of the weather file's header, which EnergyPlus goes by
        words = (out / f"{year}.epw").read_text().split("\n")[4].split(",")
        holidays += [f"{year}-{int(m):02}-{int(d):02}" for m, d in (day.split("/") for day in words[6::2])]
    (out / "energyplus.toml").write_text(heading(holidays) + energyplus_model())
    (out / "epc.toml").write_text(heading(holidays) + EPC)


def calibrate(kind):
    """The result, or why there is none."""
    result = out / kind
    if not (result / "calibration.json").exists():
        begin = time.time()
        with open(out / f"{kind}.log", "w") as log:
            subprocess.run([recald, "calibrate", out / f"{kind}.toml", "--discrepancy",
                            os.environ.get("DISCREPANCY", "sound"), "--out", result],
                           stdout=log, stderr=subprocess.STDOUT)
        print(f"{kind}: {time.time() - begin:.0f} s")
    for folder in (result, result.with_name(result.name + ".unconverged")):
        if (folder / "calibration.json").exists():
            return json.loads((folder / "calibration.json").read_text()), ""
    return None, (out / f"{kind}.log").read_text().strip().split("\n")[-1]


def figure(fit):
    return f"{fit['nmbe_sim_minus_meas']:+.2f} / {fit['cvrmse']:.2f}" if fit and "cvrmse" in fit else "–"


def tables(results):
    truth = json.loads((out / "truth.json").read_text())["parameters"]
    text = "## Table 2: what is calibrated\n\n| parameter | in the paper's Table 2 | truth | posterior mean | 90 % |\n"
    text += "| --- | --- | --- | --- | --- |\n"
    found = {}
    if results["energyplus"][0]:
        found = {one["name"]: one for one in results["energyplus"][0]["parameters"]}
    for name, change, _, _, kept in PARAMETERS:
        one = found.get(name)
        true = truth[name]["by"] if change == "scale" else truth[name]["truth"]
        posterior = f"{one['mean']:.3g} | {one['q05']:.3g} to {one['q95']:.3g}" if one else "not calibrated | –"
        text += f"| {name} | {'yes' if kept else 'no'} | {true:.3g} | {posterior} |\n"
    for number, role in ((3, "calibration"), (4, "validation")):
        text += (f"\n## Table {number}: {role}\n\nNMBE (simulated − measured) / CV(RMSE).\n\n"
                 "| model | output | before | after | the paper: before | after |\n| --- | --- | --- | --- | --- | --- |\n")
        for kind in ("energyplus", "epc"):
            result = results[kind][0]
            for output in (f"{meter}_{what}" for what in ("daily_kWh", "peak_kW") for meter in METERS):
                if not result or output not in result["after"][role]:
                    continue
                paper = PAPER.get((kind, "peak" if output.endswith("_peak_kW") else "consumption", role))
                # The paper's building has one figure: its chilled water.
                beside = ("", "") if not paper or "chilled" not in output else tuple(f"{a:+.2f} / {b:.2f}" for a, b in paper)
                text += (f"| {kind} | {output} | {figure(result['before'][role][output])} | "
                         f"{figure(result['after'][role][output])} | {beside[0]} | {beside[1]} |\n")
    for kind, (result, why) in results.items():
        if not result:
            text += f"\n{kind} was not calibrated: {why}\n"
    return text


prepare()
results = {kind: calibrate(kind) for kind in ("epc", "energyplus")}
words = (f"# The seed, again\n\nA campus laboratory in EnergyPlus with hidden true parameters (seed {seed}), {runs} runs, "
         "calibrated on 2011 and 2012, held against 2013. Repeat with `sh tests/run.sh --long seed`. What the paper's figures "
         "2 to 6 show is in `report.html` of the folders `energyplus` and `epc` that it leaves.\n\n"
         + tables(results))
(out / "seed.md").write_text(words)
print(words)
if all(result for result, _ in results.values()):
    page.write_text(words)
