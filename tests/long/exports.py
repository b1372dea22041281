"""Makes random exports, runs recald on them and prints the rates by kind: see exports.sh."""
import collections
import concurrent.futures
import csv
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "exports"))

from binomial import binomial
from generate import make_export
from judge import CLASSES, judge

recald = os.environ.get("RECALD") or str(pathlib.Path(sys.argv[1]) / "daemon/recald")
seed = int(os.environ.get("SEED", "1"))
only = [int(number) for number in os.environ.get("EXPORTS_ONLY", "").replace(",", " ").split()]
out = pathlib.Path(os.environ.get("OUT") or tempfile.mkdtemp())


def study(number):
    """Number, kind, traits, whether it settles everything, result, what was wrong or refused."""
    export = make_export(seed, number)
    folder = out / str(number)
    shutil.rmtree(folder, ignore_errors=True)
    outcome = judge(export, folder, recald)
    if not only:
        shutil.rmtree(folder)
    return (number, export.kind, sorted(export.traits), export.undecided, outcome.result, outcome.problems, outcome.answered)


def row(name, outcomes):
    """Settled exports first, then those from which something is missing."""
    counts = collections.Counter(outcome[4] for outcome in outcomes)
    settled = [outcome for outcome in outcomes if not outcome[3]]
    right = binomial(counts["right"], len(settled)) if settled else "–"
    return f"| {name} | {len(outcomes)} | {right} | " + " | ".join(str(counts[result]) for result in CLASSES[1:]) + " |"


def print_table(title, groups):
    print(f"\n| {title} | exports | right at the first go, of those that settle everything | " + " | ".join(CLASSES[1:]) + " |")
    print("| --- |" + " --- |" * (len(CLASSES) + 1))
    for name in sorted(groups):
        print(row(name, groups[name]))


def grouped(outcomes, names_of):
    groups = collections.defaultdict(list)
    for outcome in outcomes:
        for name in names_of(outcome):
            groups[name].append(outcome)
    return groups


def describe(outcome):
    number, kind, traits, undecided, result, problems, answered = outcome
    print(f"{number}: {kind} ({', '.join(traits)}){f', undecided: {undecided}' if undecided else ''}: {result}")
    for problem in problems:
        print(f"    {problem}")
    if answered:
        print(f"    with the option that it named: {answered}")


def main():
    numbers = only or range(int(os.environ.get("COUNT", "2000")))
    jobs = int(os.environ.get("JOBS", os.cpu_count()))
    out.mkdir(parents=True, exist_ok=True)
    with concurrent.futures.ProcessPoolExecutor(jobs) as pool:
        outcomes = list(pool.map(study, numbers, chunksize=1))
    if only:
        for outcome in outcomes:
            describe(outcome)
        print(f"files, truth and results are in {out}")
        return
    with open(out / "outcomes.csv", "w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["number", "kind", "traits", "undecided", "result", "problems", "answered"])
        for number, kind, traits, undecided, result, problems, answered in outcomes:
            writer.writerow([number, kind, "; ".join(traits), undecided, result, " | ".join(problems), answered])
    version = subprocess.run([recald, "--version"], capture_output=True, text=True, check=True).stdout.strip()
    print(f"{len(outcomes)} exports of seed {seed}, {version}")
    print_table("all", {"all": outcomes})
    print_table("kind", grouped(outcomes, lambda outcome: [outcome[1]]))
    print_table("with", grouped(outcomes, lambda outcome: outcome[2]))
    print(f"\n{out}/outcomes.csv has each; EXPORTS_ONLY=NUMBER makes one again and keeps its folder")


main()
