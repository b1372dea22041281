"""Makes buildings without and with measures, asks recald, and prints the tables: see ecm.sh."""
import concurrent.futures
import json
import os
import pathlib
import shutil
import statistics
import subprocess
import sys
import tempfile

from binomial import binomial

build = pathlib.Path(sys.argv[1])
recald, simulator = build / "daemon/recald", build / "simulators/recald-sim"
out = pathlib.Path(os.environ.get("OUT") or tempfile.mkdtemp())
uses = os.environ.get("USES", "office school laboratory").split()
count = int(os.environ.get("COUNT", "17"))
first_seed = int(os.environ.get("SEED", "5001"))
models = os.environ.get("MODELS", "epc hourly").split()
looked_at_since = int(os.environ.get("SINCE", "12"))

CLIMATES = ["hot-humid", "hot-dry", "mixed", "cold", "marine"]
START = 2021
LIGHTS = 0.6  # what is left of the lamps' power
# name: (effect of the simulator, its strength from the drawings' lamps, the measure as recald has it)
MEASURES = {
    "Better lamps": ("equipment_step", lambda lamps: -(1 - LIGHTS) * lamps, "lighting_use", "scale", LIGHTS),
    "Set-point 1.5 K up": ("setpoint_raised", lambda lamps: 1.5, "cooling_setpoint", "add", 1.5),
    "A third less outdoor air": ("outdoor_air_amount", lambda lamps: -1 / 3, "outdoor_airflow", "scale", 2 / 3),
}
TOGETHER = "All measures together"


def scenario(use, number, effects, start):
    text = (f'[building]\nuse = "{use}"\nstoreys = {1 + number % 4}\n[climate]\n'
            f'name = "{CLIMATES[number % len(CLIMATES)]}"\n[period]\nstart = {START}\nyears = 3\nstep = "15m"\n')
    for name, strength in effects:
        text += f'[[effect]]\nname = "{name}"\nstrength = {strength}\nfrom = "{start}"\n'
    return text


def simulate(folder, use, number, seed, effects, start=f"{START}-01-01", keep=("truth.json",)):
    if (folder / keep[-1]).exists():
        return
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "scenario.toml").write_text(scenario(use, number, effects, start))
    with tempfile.TemporaryDirectory() as made:
        subprocess.run([simulator, "building", "--scenario", folder / "scenario.toml", "--out", made, "--seed",
                        str(seed)], check=True, capture_output=True, text=True)
        for name in keep:
            shutil.move(f"{made}/{name}", folder / name)


ALL_FILES = ("readings.csv", "weather.csv", "site.toml", "truth.json")


def lamps_of(site):
    line = next(l for l in site.read_text().splitlines() if l.startswith("lighting_W_m2"))
    return float(line.split("=")[1])


def make(plan):
    """The building without measures, and the truth with each of them."""
    use, number, seed = plan
    folder = out / f"{use}-{seed}"
    plain = folder / "plain"
    simulate(plain, use, number, seed, [], keep=ALL_FILES)
    lamps = lamps_of(plain / "site.toml")
    effects = {name: (effect, strength(lamps)) for name, (effect, strength, *_) in MEASURES.items()}
    for i, name in enumerate(MEASURES):
        simulate(folder / f"measure-{i}", use, number, seed, [effects[name]])
    simulate(folder / "together", use, number, seed, list(effects.values()))
    text = ""
    for name, (_, _, parameter, change, value) in MEASURES.items():
        text += (f'[[measure]]\nname = "{name}"\n[[measure.change]]\nparameter = "{parameter}"\n'
                 f'change = "{change}"\nvalue = {value}\n')
    (folder / "measures.toml").write_text(text)
    return folder


def kWh_by_meter(folder, first, last):
    """Free of noise and of gaps, over the months [first, last]."""
    import calendar
    truth = json.loads((folder / "truth.json").read_text())
    sums = {}
    for meter, record in truth["meters"].items():
        total = 0.0
        for month in record["monthly"]:
            if first <= month["month"] <= last:
                year, number = map(int, month["month"].split("-"))
                total += month["daily_average_kWh"] * calendar.monthrange(year, number)[1]
        sums[meter] = total
    return sums


def run(arguments, result):
    if not (result / "ecm.json").exists():
        done = subprocess.run(["timeout", "1800", recald, *arguments, "--threads", "1", "--out", result],
                              capture_output=True, text=True)
        if done.returncode != 0:
            print(f"- {result.relative_to(out)}: {done.stderr.strip().splitlines()[-1]}")
            return None
    return json.loads((result / "ecm.json").read_text())


def kind_of(meter):
    return "electricity" if "elec" in meter else "cooling" if "chill" in meter else "heating"


def row_of(case, measure, meter, baseline, saved, truth):
    return {"case": case, "measure": measure, "kind": kind_of(meter), "truth": truth, "baseline": baseline,
            "inside": saved["q05"] <= truth <= saved["q95"], "q50": saved["q50"],
            "width": saved["q95"] - saved["q05"], "probability": saved["probability_of_saving"]}


def ahead(folder, model):
    result = run(["ecm", folder / "plain/site.toml", "--measure", folder / "measures.toml", "--model", model],
                 folder / f"ecm-{model}")
    if result is None:
        return []
    months = result["months"][0], result["months"][-1]
    years = len(result["months"]) / 12
    plain = kWh_by_meter(folder / "plain", *months)
    rows = []
    for i, measure in enumerate(result["measures"]):
        with_it = kWh_by_meter(folder / ("together" if measure["name"] == TOGETHER else f"measure-{i}"), *months)
        for meter in measure["meters"]:
            if meter["unit"] != "kWh":
                continue
            truth = (plain[meter["meter"]] - with_it[meter["meter"]]) / years
            if meter["saved"]["q05"] == meter["saved"]["q95"] == 0 and abs(truth) < 0.005 * meter["baseline"]:
                continue  # nothing was said of a meter that hardly moves
            rows.append(row_of(folder.name, measure["name"], meter["meter"], meter["baseline"], meter["saved"], truth))
    return rows


def table(rows):
    print("| measure | meter | n | truth in 90 % | saved, % of the use: truth, said (median) | "
          "error of the median, % of the use: median, worst | width, % of the use | sign right |")
    print("| --- |" + " --- |" * 7)
    groups = [(m, k) for m in [*MEASURES, TOGETHER] for k in ("electricity", "cooling", "heating")]
    for measure, kind in groups + [("all", "all")]:
        some = [r for r in rows if measure in (r["measure"], "all") and kind in (r["kind"], "all")]
        if not some:
            continue
        share = [100 * r["truth"] / r["baseline"] for r in some]
        said = [100 * r["q50"] / r["baseline"] for r in some]
        errors = [abs(a - b) for a, b in zip(share, said)]
        sure = [r for r in some if abs(r["truth"]) > 0.01 * r["baseline"]]
        print(f"| {measure} | {kind} | {len(some)} | {binomial(sum(r['inside'] for r in some), len(some))} | "
              f"{statistics.median(share):.1f}, {statistics.median(said):.1f} | {statistics.median(errors):.1f}, "
              f"{max(errors):.1f} | {statistics.median(100 * r['width'] / r['baseline'] for r in some):.1f} | "
              f"{sum((r['probability'] > 0.5) == (r['truth'] > 0) for r in sure)} of {len(sure)} |")


def since(folder, model):
    """All measures on 1 July of the second year; the rest is looked at."""
    use, seed = folder.name.rsplit("-", 1)
    number = int(seed) - first_seed - 1000 * uses.index(use)
    lamps = lamps_of(folder / "plain/site.toml")
    effects = [(effect, strength(lamps)) for effect, strength, *_ in MEASURES.values()]
    date = f"{START + 1}-07-01"
    simulate(folder / "since", use, number, int(seed), effects, date, ALL_FILES)
    result = run(["ecm", folder / "since/site.toml", "--since", date, "--model", model], folder / f"since-{model}")
    if result is None:
        return []
    rows = []
    for meter in result["meters"]:
        measured = [m["month"] for m in meter["by_month_kWh_day"] if m["measured"] is not None]
        plain, with_it = ({name: sum(kWh_by_meter(folder / which, m, m)[name] for m in measured)
                           for name in [meter["meter"]]} for which in ("plain", "since"))
        truth = plain[meter["meter"]] - with_it[meter["meter"]]
        for option in ("option_c", "option_d"):
            if meter[option]:
                rows.append(row_of(folder.name, option, meter["meter"], meter[option]["expected_kWh"],
                                   meter[option]["avoided_kWh"], truth))
    return rows


def since_table(rows):
    print("| option | meter | n | truth in 90 % | avoided, % of what was expected: truth, said (median) | "
          "error, %: median, worst | width, % |")
    print("| --- |" + " --- |" * 6)
    for option in ("option_c", "option_d"):
        for kind in ("electricity", "cooling", "heating", "all"):
            some = [r for r in rows if r["measure"] == option and kind in (r["kind"], "all")]
            if not some:
                continue
            share = [100 * r["truth"] / r["baseline"] for r in some]
            said = [100 * r["q50"] / r["baseline"] for r in some]
            errors = [abs(a - b) for a, b in zip(share, said)]
            print(f"| {option[-1].upper()} | {kind} | {len(some)} | {binomial(sum(r['inside'] for r in some), len(some))} | "
                  f"{statistics.median(share):.1f}, {statistics.median(said):.1f} | {statistics.median(errors):.1f}, "
                  f"{max(errors):.1f} | {statistics.median(100 * r['width'] / r['baseline'] for r in some):.1f} |")


plans = [(use, i, first_seed + 1000 * u + i) for u, use in enumerate(uses) for i in range(count)]
with concurrent.futures.ThreadPoolExecutor(int(os.environ.get("JOBS") or os.cpu_count())) as pool:
    folders = list(pool.map(make, plans))
    for model in models:
        rows = [row for rows in pool.map(lambda f: ahead(f, model), folders) for row in rows]
        (out / f"rows-{model}.json").write_text(json.dumps(rows))
        print(f"\n## {model}: {len(folders)} buildings\n")
        table(rows)
        if looked_at_since:
            chosen = folders[:: max(1, len(folders) // looked_at_since)][:looked_at_since]
            print(f"\n### {model}: afterwards, {len(chosen)} buildings\n")
            since_table([row for rows in pool.map(lambda f: since(f, model), chosen) for row in rows])
