"""The blind run: every case of a population by the product's command line, a results line each. See README.md."""

import argparse
import concurrent.futures
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time

import records
from records import CALIBRATE, DRIFT, NONE, ORACLE, Refused

WRITTEN = {CALIBRATE: "calibration.json", DRIFT: "drift.json"}
OF_ONE_METER = {"clock_offset", "phase_lost", "scale_fault", "stuck_meter"}  # The diagnosis is told which.
USAGE, STOPPED = 2, 130
POLL_S = 0.02

# Parameters of the catalogue that are the quantity in which answers state the strength, as factor * parameter + offset,
# with the answer's unit. A clock that is fast by an hour shows at ten what happened at nine: y(t - 1 h).
STRENGTH_OF = {
    "after_hours": ("late_stop", 1, 0, "hours later than planned, on an average working day"),
    "clock_offset": ("offset", -60, 0, "minutes fast, negative for slow"),
    "constant_speed_fans": ("constant_share", 1, 0, "share of the fans that do not slow down"),
    "economiser_changeover": ("shift", 1, 0, "K that the change-over is too high, negative for too low"),
    "economiser_failed": ("failed_share", 1, 0, "share of the free cooling that is lost"),
    "night_setback_missing": ("missing_share", 1, 0, "share of the set-back that is missing"),
    "outdoor_air_amount": ("change", 1, 0, "share added to the designed outdoor air"),
    "phase_lost": ("lost_share", 1, 0, "share lost"),
    "plug_growth": ("growth", 1, 0, "share a year, negative for shrinking"),
    "round_the_clock_zone": ("floor_share", 1, 0, "share of the floor that never closes"),
    "scale_fault": ("scale", 1, -1, "share above what is right, negative for below"),
    "semester_calendar": ("absent_share", 1, 0, "share of the people who follow the terms"),
    "thermal_mass": ("mass_factor", 1, -1, "share of the heat capacity, negative for less"),
    "vacancy": ("absent_share", 1, 0, "share of the people who stay away"),
}


class Failed(Exception):
    """Why a case has no diagnosis."""


def distinct(names):
    return list(dict.fromkeys(names))


# What a program wrote, as keys of a line.


def hourly(diagnosis):
    return (diagnosis.get("gap") or {}).get("hourly")


def gap_of(diagnosis):
    """Of the hourly model, over meters whose four figures are there."""
    gap = {"before": {}, "after": {}}
    fits = hourly(diagnosis) or {"before": {}}
    for meter in fits["before"]:
        both = [fits[when][meter] for when in gap]
        if all(fit.get(key) is not None for fit in both for key in ("log_score", "cvrmse")):
            for when, fit in zip(gap, both):
                gap[when][meter] = {"log_score": fit["log_score"], "cvrmse": fit["cvrmse"]}
    return gap if gap["before"] else None


def other_meters_of(diagnosis):
    """Of all meters but the one that gained most: that is what the effect was added for. Sums over months; with a single
    month there is no standard error."""
    changes = (hourly(diagnosis) or {"log_score_change": {}})["log_score_change"]
    others = {meter: {"mean": of["sum"], "se": of["se"]} for meter, of in changes.items() if of.get("sum") is not None and of.get("se")}
    if others:
        del others[max(others, key=lambda meter: others[meter]["mean"])]
    return others


def interval_of(addition):
    """In the answer's terms where the parameter is the strength's quantity; else in its own unit, which the scorer leaves out."""
    parameters = {parameter["name"]: parameter for parameter in addition["parameters"]}
    name, factor, offset, unit = STRENGTH_OF.get(addition["effect"], (None, 0, 0, ""))
    if not parameters:
        return None
    if name not in parameters:
        return {key: next(iter(parameters.values()))[key] for key in ("q05", "q95", "unit")}
    low, high = sorted(factor * parameters[name][q] + offset for q in ("q05", "q95"))
    return {"q05": low, "q95": high, "unit": unit}


def facts_of(diagnosis):
    facts = {"extra": {"why": diagnosis["why"], "seed": diagnosis["seed"]},
             "located": [{"meter": meter} for meter in distinct(place["meter"] for place in diagnosis["located"])]}  # fmt: skip
    for key in ("parameters_before", "parameters_after"):
        if diagnosis.get(key) is not None:
            facts[key] = {
                p["name"]: {"mean": p["mean"] if "mean" in p else p["mode"], "q05": p["q05"], "q95": p["q95"]} for p in diagnosis[key]
            }
    return facts


def of_diagnosis(diagnosis):
    """Nothing of what was tried and withdrawn counts: then there is no gap, and the names tried stand in `extra`."""
    added = distinct(diagnosis["added"])
    probabilities = {}
    for candidate in diagnosis["candidates"]:  # Summed over the meters of a name.
        probabilities[candidate["effect"]] = probabilities.get(candidate["effect"], 0.0) + candidate["probability"]
    line = {"outcome": diagnosis["outcome"], "named": added, "probabilities": probabilities} | facts_of(diagnosis)
    for effect in added:  # What a later pass added may have been no candidate of the first.
        probabilities.setdefault(effect, 0.0)
    if diagnosis["outcome"] == "confusable":
        line["confusable"] = distinct(diagnosis["confusable"])
    if not added:
        line["extra"]["taken_back"] = distinct(addition["effect"] for addition in diagnosis["additions"])
        return line
    line["other_meters_log_score_change"] = other_meters_of(diagnosis)
    return line | {key: of for key, of in (("gap", gap_of(diagnosis)), ("effect_parameter", interval_of(diagnosis["additions"][0]))) if of}


def of_oracle(diagnosis, assumed):
    """The refit with the true effects: its gap counts whether it was confirmed or not."""
    gap = gap_of(diagnosis)
    if gap is None:
        raise Failed("diagnosis.json has no gap of the hourly model")
    return {"outcome": "named", "named": distinct(assumed), "gap": gap} | facts_of(diagnosis)


def of_calibration(calibration):
    """For each meter the CV(RMSE) over unseen months of mean daily energies; a meter that lacks one of the four is left out."""
    meters = {}
    for key in ("before", "after", "forecast", "yardstick"):
        if "validation" not in (calibration.get(key) or {}):
            raise Failed(f"calibration.json has no '{key}' of unseen months")
        for output, fit in calibration[key]["validation"].items():
            if output.endswith("_daily_kWh") and fit and fit.get("cvrmse") is not None:
                meters.setdefault(output.removesuffix("_daily_kWh"), {})[key] = fit["cvrmse"]
    return {"calibration": {meter: fits for meter, fits in meters.items() if len(fits) == 4}}


def of_drift(drift):
    """Each alarm with its likeliest cause; a changed unit, or lost readings, is an alarm that blames the meter."""
    months, learnt = drift["months"], drift["learning_months"]
    if learnt >= len(months):
        raise Failed("drift.json watches no month")
    alarms = []
    for alarm in drift["alarms"]:
        cause = alarm["causes"][0] if alarm["causes"] else {"kind": "nothing", "subject": None, "probability": 0.0}
        alarms.append(
            {"month": alarm["month"], "kind": cause["kind"], "subject": cause["subject"] or "", "probability": cause["probability"]}
        )
    for change in drift["meter_changes"]:
        if change["seen"] >= months[learnt]:
            alarms.append({"month": change["seen"], "kind": "meter", "subject": change["meter"], "probability": 1.0})
    return {"drift": {"from": months[learnt], "to": months[-1], "alarms": alarms}}


class Run:
    def __init__(self, given):
        self.given = given
        inner = given.population / "cases"
        self.population = inner if inner.is_dir() else given.population
        self.written = WRITTEN.get(given.method, "diagnosis.json")
        self.assumed = assumptions(given.answers) if given.method == ORACLE else None
        self.stop = threading.Event()
        self.lock = threading.Lock()
        self.done = self.failed = self.over_limit = 0
        every = records.cases_in(self.population)
        first, last = range_of(given.cases, len(every))
        self.cases = [case for case in every[first - 1 : last] if self.assumed is None or case in self.assumed]
        pending, self.torn = records.pending_cases(self.population, given.results, given.method)
        self.open = [case for case in self.cases if case in set(pending)]

    def ended(self, arguments, said):
        """Runs the program. @return its status as os.wait4 has it, what it used, seconds, and whether it took too long."""
        began = time.monotonic()
        with open(said, "wb") as output:
            try:
                child = subprocess.Popen(
                    [self.given.recald, *arguments],
                    stdout=output,
                    stderr=subprocess.STDOUT,
                    stdin=subprocess.DEVNULL,
                    start_new_session=True,
                )
            except OSError as error:
                raise Refused(f"cannot start '{self.given.recald}': {error.strerror}") from None
        late = False
        while True:
            pid, status, usage = os.wait4(child.pid, os.WNOHANG)
            if pid:
                child.returncode = os.waitstatus_to_exitcode(status)
                return child.returncode, usage, time.monotonic() - began, late
            late = late or time.monotonic() - began > self.given.limit_s
            if late or self.stop.is_set():
                os.killpg(child.pid, signal.SIGKILL)
            time.sleep(POLL_S)

    def diagnose(self, case, scratch):
        try:
            if not self.stop.is_set():
                self.diagnose_one(case, scratch)
        except Refused:  # What would spoil every case ends the run.
            self.stop.set()
            raise

    def diagnose_one(self, case, scratch):
        folder = scratch / case
        folder.mkdir()
        said = folder / "said.txt"
        command = self.given.method if self.given.method in WRITTEN else "diagnose"
        arguments = [command, str(self.population / case / "site.toml"), "--out", str(folder), "--seed", "1"]
        arguments += ["--threads", "1"] if command == DRIFT else []
        for name in self.assumed[case][1] if self.assumed else ():
            arguments += ["--assume", name]
        code, usage, wall_s, late = self.ended(arguments, said)
        if self.stop.is_set():
            return
        if code == USAGE:
            raise Refused(f"{case}: the program refuses its arguments: {said.read_text(errors='replace')}")
        line = {"case": case, "method": self.given.method, "outcome": NONE, "named": [], "version": self.version}
        cost = {"wall_s": wall_s, "peak_rss_MB": usage.ru_maxrss * 1024 / 1e6}
        cpu = {"cpu_s": usage.ru_utime + usage.ru_stime}
        try:
            found = self.line_of(case, folder, code, late)
            extra = found.pop("extra", {}) | cpu
            line |= found | cost | {"extra": extra}
            records.parse_result(json.dumps(line), f"the line made of {self.written}")
        except (Failed, Refused) as why:  # A case without a diagnosis counts as "none", and says why.
            line = (
                {key: line[key] for key in ("case", "method", "version")}
                | {"outcome": NONE, "named": []}
                | cost
                | {"extra": cpu | {"failed": str(why)}}
            )
        shutil.rmtree(folder)
        with self.lock:
            records.append_result(self.given.results, json.dumps(line))
            self.done += 1
            self.failed += "failed" in line["extra"]
            self.over_limit += late
            print(f"\r{self.done} of {len(self.open)}, {self.failed} without a diagnosis   ", end="", file=sys.stderr, flush=True)

    def line_of(self, case, folder, code, late):
        if late:
            raise Failed(f"no diagnosis within {self.given.limit_s:g} s")
        if code < 0:
            raise Failed(f"ended by signal {-code}")
        if code > 0:
            raise Failed(f"exit code {code}: {last_words(folder / 'said.txt')}")
        file = folder / self.written
        if not file.exists():
            raise Failed(f"exit code 0, but no {self.written}")
        if self.given.keep:
            shutil.copyfile(file, self.given.keep / f"{case}.json")
        try:
            wrote = json.loads(file.read_text())
        except ValueError:
            raise Failed(f"{self.written} is no JSON") from None
        try:
            if self.assumed:
                return of_oracle(wrote, self.assumed[case][0])
            return {CALIBRATE: of_calibration, DRIFT: of_drift}.get(self.given.method, of_diagnosis)(wrote)
        except (KeyError, TypeError, AttributeError, IndexError) as error:
            raise Failed(f"{self.written}: {type(error).__name__} {error}") from None

    def run(self):
        if self.given.keep:
            self.given.keep.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory() as scratch, concurrent.futures.ThreadPoolExecutor(self.given.jobs) as pool:
            scratch = pathlib.Path(scratch)
            self.ended(["--version"], scratch / "version.txt")
            self.version = "recald " + last_words(scratch / "version.txt")
            waiting = [pool.submit(self.diagnose, case, scratch) for case in self.open]
            try:
                for one in concurrent.futures.as_completed(waiting):
                    one.result()
            except BaseException:
                self.stop.set()
                raise

    def report(self):
        if self.done:
            print(file=sys.stderr)
        for sentence in self.torn:
            print(f"run_cases: {sentence}", file=sys.stderr)
        print(f"{self.given.method}: {len(self.cases) - len(self.open) + self.done} of {len(self.cases)} cases have a line in {self.given.results}, "
              f"{self.done} of them new; {self.failed} of the new without a diagnosis, {self.over_limit} of these over {self.given.limit_s:g} s")  # fmt: skip
        stopped = self.stop.is_set() and self.done < len(self.open)
        if stopped:
            print("stopped; the same command goes on")
        return STOPPED if stopped else 0


def last_words(said):
    """The last line that says anything."""
    lines = said.read_text(errors="replace").split("\n") if said.exists() else []
    return next((line.strip("\r") for line in reversed(lines) if line.strip()), "")


def assumptions(answers):
    """Case -> effects of the catalogue, and how a diagnosis is told of them: EFFECT or EFFECT:METER."""
    found = {}
    for case, answer in records.read_answers(answers).items():
        known = [effect for effect in answer["effects"] if effect["in_catalogue"]]
        told = [effect["effect"] + (":" + records.most_affected_meter([effect])) * (effect["effect"] in OF_ONE_METER) for effect in known]
        if known:
            found[case] = ([effect["effect"] for effect in known], told)
    return found


class WrongUse(Refused):
    pass


def range_of(text, count):
    """ "3" or "3-17", counted from 1; empty for all."""
    first, dash, last = (text or f"1-{count}").partition("-")
    last = last if dash else first
    if not (first.isdigit() and last.isdigit() and 1 <= int(first) <= int(last) <= count):
        raise WrongUse(f"--cases {text}: give one number or two with a dash, 1 to {count}")
    return int(first), int(last)


def arguments():
    parser = argparse.ArgumentParser(prog="run_cases", description="Diagnoses the cases of a blind population, one results line each.")
    path = {"type": pathlib.Path}
    parser.add_argument("--population", required=True, help="folder that holds cases/, or one folder a case", **path)
    parser.add_argument("--results", required=True, help="results file; a run goes on where it ends", **path)
    parser.add_argument(
        "--method", default="recald", help="its name in the results; oracle needs --answers; calibrate and drift run those commands"
    )
    parser.add_argument("--answers", help="folder with <case>.json, for method oracle", **path)
    parser.add_argument("--jobs", type=int, default=2, choices=range(1, 65), metavar="N", help="diagnoses at a time")
    parser.add_argument("--cases", default="", help="only these, such as 1-20")
    parser.add_argument("--limit-s", type=float, default=90.0, help="wall time of a diagnosis")
    parser.add_argument("--keep", help="folder that gets each case's diagnosis.json, calibration.json or drift.json", **path)
    parser.add_argument("--recald", required=True, help="the program")
    given = parser.parse_args()
    if (given.method == ORACLE) != bool(given.answers):
        parser.error("--answers is for method oracle alone" if given.answers else "method oracle needs --answers")
    return given


def main():
    given = arguments()
    try:
        run = Run(given)
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, lambda *_: run.stop.set())
        run.run()
    except Refused as refused:
        print(f"run_cases: {refused}", file=sys.stderr)
        sys.exit(USAGE if isinstance(refused, WrongUse) else 1)
    sys.exit(run.report())


if __name__ == "__main__":
    main()
