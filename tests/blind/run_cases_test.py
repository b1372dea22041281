"""The blind run, with a shell script in the place of recald."""

import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

import records
import run_cases
from score_test import answer_file

HERE = pathlib.Path(__file__).parent
# `diagnose CASE/site.toml --out DIR ...` notes its arguments, then does what the site file says.
FAKE_RECALD = """#!/bin/sh
[ "$1" != --version ] || { echo 9.9; exit; }
here=$(dirname "$0")
echo "$(basename "$(dirname "$2")") $*" >> "$here/calls"
out=$4
. "$2"
"""


def parameter(name, unit, q05, q95):
    return {"name": name, "unit": unit, "mode": (q05 + q95) / 2, "sd": 0.1, "q05": q05, "q50": (q05 + q95) / 2, "q95": q95}


def fit(log_score, cvrmse):
    return {"nmbe_sim_minus_meas": 0.0, "cvrmse": cvrmse, "cvrmse_daily": 0.3, "log_score": log_score}


def diagnosis(**changed):
    """A wrong scale, named at one of two meters, and from the second pass a clock."""
    return {
        "outcome": "named", "why": "one effect explains the gap better", "seed": 1, "confusable": [], "added": ["scale_fault", "clock_offset"],
        "located": [{"meter": "heating"}, {"meter": "electricity"}, {"meter": "heating"}],
        "candidates": [{"effect": "scale_fault", "meter": "electricity", "probability": 0.5}, {"effect": "scale_fault", "meter": "heating", "probability": 0.3},
                       {"effect": "none", "probability": 0.15}, {"effect": "unknown", "probability": 0.05}],
        "additions": [{"effect": "scale_fault", "parameters": [parameter("scale", "-", 0.9, 0.94)]},
                      {"effect": "clock_offset", "parameters": [parameter("offset", "h", -1.0, 0.5)]}],
        "gap": {"hourly": {"before": {"electricity": fit(-60.0, 0.2), "heating": fit(-50.0, 0.1)},
                           "after": {"electricity": fit(-55.0, 0.05), "heating": fit(-51.0, 0.12)},
                           "log_score_change": {"electricity": {"sum": 35.0, "se": 4.0}, "heating": {"sum": -7.0, "se": 2.0}}},
                "epc": {"before": {}, "after": {}}},
    } | changed  # fmt: skip


class Lines(unittest.TestCase):
    def test_names_with_their_gap(self):
        line = run_cases.of_diagnosis(diagnosis())
        self.assertEqual(line["gap"]["after"]["heating"], {"log_score": -51.0, "cvrmse": 0.12})
        self.assertAlmostEqual(line["probabilities"]["scale_fault"], 0.8)  # of both meters
        self.assertEqual(line["probabilities"]["clock_offset"], 0.0)  # of a later pass
        self.assertEqual(line["located"], [{"meter": "heating"}, {"meter": "electricity"}])
        self.assertEqual(line["other_meters_log_score_change"], {"heating": {"mean": -7.0, "se": 2.0}})
        self.assertNotIn("parameters_after", line)
        setpoint = parameter("cooling_setpoint", "degC", 23.0, 25.0)
        line = run_cases.of_diagnosis(diagnosis(parameters_before=[setpoint], parameters_after=[setpoint | {"mean": 23.9}]))
        self.assertEqual(
            (line["parameters_before"]["cooling_setpoint"]["mean"], line["parameters_after"]["cooling_setpoint"]["mean"]), (24.0, 23.9)
        )

    def test_what_has_no_figures_is_left_out(self):
        found = diagnosis()
        hourly = found["gap"]["hourly"]
        hourly["log_score_change"]["heating"]["se"] = 0.0  # a single month
        hourly["after"]["heating"]["cvrmse"] = None
        line = run_cases.of_diagnosis(found)
        self.assertEqual((line["other_meters_log_score_change"], list(line["gap"]["before"])), ({}, ["electricity"]))
        hourly["before"]["electricity"]["log_score"] = None
        self.assertNotIn("gap", run_cases.of_diagnosis(found))
        self.assertNotIn("gap", run_cases.of_diagnosis(diagnosis(gap=None)))

    def test_an_interval_is_in_the_answers_terms(self):
        first, clock = diagnosis()["additions"]
        interval = run_cases.interval_of(first)
        self.assertAlmostEqual(interval["q05"], -0.1)  # a scale of 0.9 is 10 % too little
        self.assertEqual(interval["unit"], "share above what is right, negative for below")
        self.assertEqual([run_cases.interval_of(clock)[q] for q in ("q05", "q95")], [-30.0, 60.0])  # a turned sign
        other = {"effect": "server_room", "parameters": [parameter("power", "kW", 3.0, 5.0)]}
        self.assertEqual(run_cases.interval_of(other), {"q05": 3.0, "q95": 5.0, "unit": "kW"})

    def test_what_was_taken_back_closes_no_gap(self):
        line = run_cases.of_diagnosis(diagnosis(outcome="unknown", added=[]))
        self.assertEqual(line["extra"]["taken_back"], ["scale_fault", "clock_offset"])
        self.assertFalse({"gap", "effect_parameter"} & line.keys())
        line = run_cases.of_diagnosis(diagnosis(outcome="confusable", added=[], confusable=["scale_fault", "scale_fault", "phase_lost"]))
        self.assertEqual(line["confusable"], ["scale_fault", "phase_lost"])

    def test_the_oracles_gap_counts_even_if_taken_back(self):
        line = run_cases.of_oracle(diagnosis(outcome="unknown", added=[]), ["scale_fault"])
        self.assertEqual((line["outcome"], line["gap"]["after"]["electricity"]["cvrmse"]), ("named", 0.05))
        self.assertRaises(run_cases.Failed, run_cases.of_oracle, diagnosis(gap=None), ["scale_fault"])


class Runs(unittest.TestCase):
    def setUp(self):
        place = tempfile.TemporaryDirectory()
        self.addCleanup(place.cleanup)
        self.folder = pathlib.Path(place.name)
        (self.folder / "recald").write_text(FAKE_RECALD)
        (self.folder / "recald").chmod(0o755)
        (self.folder / "named.json").write_text(json.dumps(diagnosis()))
        (self.folder / "calls").touch()

    def add(self, *cases, script='cp "$here/named.json" "$out/diagnosis.json"'):
        for case in cases:
            (self.folder / "cases" / case).mkdir(parents=True)
            (self.folder / "cases" / case / "site.toml").write_text(script + "\n")

    def run_cases(self, *options):
        """@return the exit code and what was said."""
        command = [sys.executable, str(HERE / "run_cases.py"), "--population", ".", "--results", "r", "--recald", "./recald", *options]
        ended = subprocess.run(command, cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
        return ended.returncode, ended.stdout

    def results(self):
        return records.Log([self.folder / "r"]).results

    def calls(self):
        return [call.split(" ", 1) for call in (self.folder / "calls").read_text().splitlines()]

    def test_a_line_for_each_case(self):
        self.add("a", "b")
        code, said = self.run_cases("--jobs", "1", "--keep", "kept")
        self.assertEqual(code, 0, said)
        self.assertIn(
            "recald: 2 of 2 cases have a line in r, 2 of them new; 0 of the new without a diagnosis, 0 of these over 90 s\n", said
        )
        first, second = self.results()
        self.assertEqual((second["case"], second["named"], second["version"]), ("b", ["scale_fault", "clock_offset"], "recald 9.9"))
        self.assertGreater(first["peak_rss_MB"], 0.0)
        self.assertIn("cpu_s", first["extra"])
        self.assertIn("--seed 1", self.calls()[0][1])
        self.assertEqual((self.folder / "kept" / "a.json").read_text(), (self.folder / "named.json").read_text())

    def test_a_calibration_in_the_place_of_a_diagnosis(self):
        wrote = {"before": {"validation": {"gas_daily_kWh": {"cvrmse": 0.4}, "gas_peak_kW": {"cvrmse": 9}, "steam_daily_kWh": {"cvrmse": None}}},
                 "after": {"validation": {"gas_daily_kWh": {"cvrmse": 0.3}, "steam_daily_kWh": {"cvrmse": 1}}},
                 "forecast": {"validation": {"gas_daily_kWh": {"cvrmse": 0.1}}},
                 "yardstick": {"validation": {"gas_daily_kWh": {"cvrmse": 0.2}, "steam_daily_kWh": None}}}  # fmt: skip
        self.add("a", script=f"echo '{json.dumps(wrote)}' > \"$out/calibration.json\"")
        self.add("b", script="echo '{}' > \"$out/calibration.json\"")
        self.assertEqual(self.run_cases("--jobs", "1", "--method", "calibrate")[0], 0)
        self.assertTrue(self.calls()[0][1].startswith("calibrate "))
        first, second = self.results()
        self.assertEqual(first["calibration"], {"gas": {"before": 0.4, "after": 0.3, "forecast": 0.1, "yardstick": 0.2}})
        self.assertEqual(second["extra"]["failed"], "calibration.json has no 'before' of unseen months")

    def test_months_followed_in_the_place_of_a_diagnosis(self):
        wrote = {"months": ["2021-01", "2021-02", "2021-03", "2021-04"], "learning_months": 2,
                 "alarms": [{"month": "2021-04", "causes": [{"kind": "effect", "subject": "server_room", "probability": 0.7}]}, {"month": "2021-03", "causes": []}],
                 "meter_changes": [{"meter": "gas", "kind": "unit", "seen": "2021-03"}, {"meter": "steam", "kind": "readings", "seen": "2021-02"}]}  # fmt: skip
        self.add("a", script=f"echo '{json.dumps(wrote)}' > \"$out/drift.json\"")
        self.add("b", script="""echo '{"months": ["2021-01"], "learning_months": 1}' > "$out/drift.json\"""")
        self.assertEqual(self.run_cases("--jobs", "1", "--method", "drift")[0], 0)
        self.assertIn("--threads 1", self.calls()[0][1])
        first, second = self.results()
        self.assertEqual((first["drift"]["from"], first["drift"]["to"]), ("2021-03", "2021-04"))
        self.assertEqual([(a["month"], a["kind"], a["subject"]) for a in first["drift"]["alarms"]],
                         [("2021-04", "effect", "server_room"), ("2021-03", "nothing", ""), ("2021-03", "meter", "gas")])  # fmt: skip
        self.assertEqual(second["extra"]["failed"], "drift.json watches no month")

    def test_goes_on_where_it_was_stopped(self):
        self.add("a", "b", "c", "d")
        self.assertEqual(self.run_cases("--jobs", "1", "--cases", "2-3")[0], 0)
        text = (self.folder / "r").read_text()
        (self.folder / "r").write_text(text[:-9])  # the power was cut
        code, said = self.run_cases("--jobs", "1")
        self.assertEqual(code, 0, said)
        self.assertIn("r line 2: torn", said)
        self.assertIn("4 of 4 cases have a line in r, 3 of them new", said)
        self.assertEqual([case for case, _ in self.calls()], ["b", "c", "a", "c", "d"])
        self.assertEqual(self.run_cases()[0], 0)
        self.assertEqual((len(self.calls()), len(self.results())), (5, 4))

    def test_a_failure_is_a_line_that_says_why(self):
        self.add("a", script="echo 'recald: no reading in 2016' >&2; echo; exit 1")
        self.add("b", script="kill -SEGV $$")
        self.add("c", script="exit 0")
        self.add("d", script="echo '{' > \"$out/diagnosis.json\"")
        self.add("e", script="echo '{}' > \"$out/diagnosis.json\"")
        self.add("f", script="sleep 1000")
        self.add("g", script=f"echo '{json.dumps(diagnosis(added=[]))}' > \"$out/diagnosis.json\"")
        code, said = self.run_cases("--jobs", "2", "--limit-s", "1")
        self.assertEqual(code, 0, said)
        self.assertIn("7 of the new without a diagnosis, 1 of these over 1 s", said)
        failed = {line["case"]: line["extra"]["failed"] for line in self.results()}
        self.assertEqual([failed[case] for case in "abcdf"], ["exit code 1: recald: no reading in 2016", "ended by signal 11", "exit code 0, but no diagnosis.json",
                                                               "diagnosis.json is no JSON", "no diagnosis within 1 s"])  # fmt: skip
        self.assertIn("'added'", failed["e"])
        self.assertIn("'outcome' is 'named' with 0 effects", failed["g"])
        self.assertTrue(all(line["outcome"] == "none" for line in self.results()))

    def test_what_would_spoil_every_case_ends_the_run(self):
        self.add("a", script="echo 'recald: --assume: unknown option' >&2; exit 2")
        self.add("b")
        code, said = self.run_cases("--jobs", "1")
        self.assertEqual(code, 1)
        self.assertIn("a: the program refuses its arguments: recald: --assume", said)
        self.assertEqual(len(self.calls()), 1)
        self.assertFalse((self.folder / "r").exists())
        (self.folder / "recald").unlink()
        code, said = self.run_cases()
        self.assertEqual(code, 1)
        self.assertIn("cannot start './recald'", said)

    def test_who_stops_it_loses_nothing(self):
        self.add("a")
        self.add("b", script="kill -TERM $PPID; sleep 1000")
        code, said = self.run_cases("--jobs", "1")
        self.assertEqual(code, 130)
        self.assertIn("stopped; the same command goes on", said)
        self.assertEqual([line["case"] for line in self.results()], ["a"])

    def test_the_oracle_is_told_what_is_hidden(self):
        self.add("a", "b", "c")
        (self.folder / "answers").mkdir()
        pair, outside, nothing = answer_file("a"), answer_file("b"), answer_file("c")
        pair["block"] = "pair"
        pair["effects"].append(pair["effects"][0] | {"effect": "scale_fault", "share_of_meter": {"electricity": 0.01, "heating": -0.05}})
        outside["block"], outside["effects"][0]["in_catalogue"] = "out_of_catalogue", False
        nothing["block"], nothing["effects"] = "no_effect", []
        for answer in (pair, outside, nothing):
            (self.folder / "answers" / f"{answer['case']}.json").write_text(json.dumps(answer))
        code, said = self.run_cases("--method", "oracle", "--answers", "answers")
        self.assertEqual(code, 0, said)
        self.assertIn("oracle: 1 of 1 cases have a line", said)
        self.assertEqual(len(self.calls()), 1)
        self.assertTrue(self.calls()[0][1].endswith("--assume night_setback_missing --assume scale_fault:heating"))
        self.assertEqual(self.results()[0]["gap"]["after"]["electricity"]["cvrmse"], 0.05)

    def test_wrong_use(self):
        self.add("a")
        for options, part in ((["--answers", "answers"], "--answers is for method oracle alone"), (["--method", "oracle"], "method oracle needs --answers"),
                              (["--cases", "2"], "--cases 2: give one number or two with a dash, 1 to 1")):  # fmt: skip
            code, said = self.run_cases(*options)
            self.assertEqual(code, 2)
            self.assertIn(part, said)
        self.assertEqual(self.calls(), [])


if __name__ == "__main__":
    unittest.main()
