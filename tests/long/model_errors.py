"""Makes effect-free buildings and prints the likeliest sizes of a model's own errors: see model-errors.sh."""
import collections
import concurrent.futures
import json
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile

from buildings import make_buildings

build = pathlib.Path(sys.argv[1])
out = pathlib.Path(os.environ.get("OUT") or tempfile.mkdtemp())
uses = os.environ.get("USES", "office school laboratory").split()
folders = make_buildings(build, out, uses, int(os.environ.get("COUNT", "15")),
                         int(os.environ.get("SEED", "7001")))


def study(job):
    model, folder = job
    file = folder / f"model_errors_{model}.json"
    if not file.exists():
        done = subprocess.run([build / "tests/long/model_errors_study", model, folder],
                              capture_output=True, text=True)
        file.write_text(done.stdout)
    return model, json.loads(file.read_text())


def likeliest(studies):
    """Sizes (parameter share, cooling, heating) and the gain in log likelihood over none, a building."""
    total = collections.Counter()
    for one in studies:
        for share, cooling, heating, value in one["grid"]:
            total[share, cooling, heating] += value
    best, value = max(total.items(), key=lambda item: item[1])
    return best, (value - total[0.0, 0.0, 0.0]) / len(studies)


def row(name, studies):
    if not studies:
        return
    (share, cooling, heating), gain = likeliest(studies)
    levels = {"cooling": [], "heating": []}
    for one in studies:
        for output, level in one["levels"].items():
            if output.endswith("_kW") or output.startswith("elec"):
                continue
            levels["cooling" if output.startswith("chill") else "heating"].append(100 * level)
    words = [f"{statistics.fmean(v):+.1f} ± {statistics.pstdev(v):.1f}" if v else "-" for v in levels.values()]
    print(f"| {name} | {len(studies)} | {share} | {cooling} | {heating} | {gain:.1f} | " + " | ".join(words) + " |")


models = os.environ.get("MODELS", "epc hourly").split()
with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
    done = list(pool.map(study, [(model, folder) for model in models for folder in folders]))
for model in models:
    studies = [one for name, one in done if name == model and "grid" in one]
    failed = [one for name, one in done if name == model and "grid" not in one]
    print(f"\n## {model}\n")
    for one in failed:
        print(f"- {one['folder']}: {one['failed']}")
    print("| buildings | n | c | cooling level | heating level | log likelihood a building | "
          "cooling at the truth, model − meter % | heating |")
    print("| --- |" + " --- |" * 7)
    row("all", studies)
    for use in uses:
        row(use, [one for one in studies if f"/{use}-" in one["folder"]])
        row(f"all but {use}", [one for one in studies if f"/{use}-" not in one["folder"]])
