"""Table of a demo-seeds study: fit before and after by meter, contraction, interval coverage."""
import json
import pathlib
import statistics
import sys

folder = pathlib.Path(sys.argv[1])
cases = sorted((p for p in folder.iterdir() if (p / "calibration.json").exists()),
               key=lambda p: int(p.name))
results = {p.name: json.loads((p / "calibration.json").read_text()) for p in cases}
truths = {p.name: json.loads((p / "truth.json").read_text()) for p in cases}
outputs = list(next(iter(results.values()))["after"]["calibration"])


def metric(result, stage, period, output, key):
    entry = result[stage][period].get(output)
    return None if entry is None else entry[key]


def median(values):
    values = [v for v in values if v is not None]
    return statistics.median(values) if values else float("nan")


print(f"{len(cases)} buildings; NMBE is simulated minus measured, median of its size in brackets\n")
print("| meter | stage | CV(RMSE) cal | NMBE cal | CV(RMSE) val | NMBE val |")
print("| --- | --- | --- | --- | --- | --- |")
for output in outputs:
    for stage in ("before", "prior_mean", "after"):
        cells = []
        for period in ("calibration", "validation"):
            cv = median(metric(r, stage, period, output, "cvrmse") for r in results.values())
            bias = [metric(r, stage, period, output, "nmbe_sim_minus_meas") for r in results.values()]
            size = median(abs(b) for b in bias if b is not None)
            cells += [f"{cv:.3f}", f"{median(bias):+.3f} ({size:.3f})"]
        print(f"| {output} | {stage} | " + " | ".join(cells) + " |")

print("\n| seed | " + " | ".join(f"{o.split('_daily')[0]} CV, NMBE cal; val" for o in outputs) + " |")
print("| --- |" + " --- |" * len(outputs))
for seed, result in results.items():
    row = []
    for output in outputs:
        parts = []
        for period in ("calibration", "validation"):
            cv = metric(result, "after", period, output, "cvrmse")
            bias = metric(result, "after", period, output, "nmbe_sim_minus_meas")
            parts.append("-" if cv is None else f"{cv:.3f}, {bias:+.3f}")
        row.append("; ".join(parts))
    print(f"| {seed} | " + " | ".join(row) + " |")

print("\n| parameter | truth inside 90 % interval | median contraction | median (mean - truth) / prior sd |")
print("| --- | --- | --- | --- |")
names = [p["name"] for p in next(iter(results.values()))["parameters"]]
for name in names:
    inside, contraction, errors = 0, [], []
    for seed, result in results.items():
        posterior = next(p for p in result["parameters"] if p["name"] == name)
        truth = truths[seed]["parameters"][name]["value"]
        prior = posterior["prior"]
        a, c, b = prior["min"], prior["mode"], prior["max"]
        prior_sd = ((a * a + b * b + c * c - a * b - a * c - b * c) / 18) ** 0.5
        inside += posterior["q05"] <= truth <= posterior["q95"]
        contraction.append(posterior["contraction"])
        errors.append((posterior["mean"] - truth) / prior_sd)
    print(f"| {name} | {inside} of {len(results)} | {median(contraction):.2f} | {median(errors):+.2f} |")
unconverged = sum(r["status"] != "converged" for r in results.values())
print(f"\n{unconverged} of {len(results)} runs did not pass the convergence gate.")
