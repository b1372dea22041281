"""An alarm's money against the simulator's twin: see alarm_costs.sh. Prints tables; judges nothing."""
import csv
import json
import os
import re
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from datetime import datetime, timedelta, timezone
from pathlib import Path

from binomial import binomial

BUILD = Path(sys.argv[1])
BUILDINGS = int(os.environ.get("BUILDINGS", 40))
JOBS = int(os.environ.get("JOBS", 2))
SEED = 4100

# Changes that begin on a day and stay.
CHANGES = ["outdoor_air_amount", "after_hours", "night_setback_missing", "weekend_operation",
           "simultaneous_heating_cooling", "early_start", "round_the_clock_zone"]
USES = ["office", "school", "clinic", "laboratory"]
BEGINS = ["2022-03-01", "2022-06-01", "2022-09-01", "2022-12-01"]
PER_KWH = {"electricity": 0.2, "chilled_water": 0.07, "heating": 0.11}
STEP_H = 0.25


def make_and_follow(number, folder):
    """@return the folder, or what went wrong."""
    begin = BEGINS[number % len(BEGINS)]
    if not (folder / "drift.json").exists():
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "scenario.toml").write_text(
            f'[building]\nuse = "{USES[(number // 7) % len(USES)]}"\n'
            f'[period]\nstart = 2020\nyears = 4\nstep = "15m"\n'
            f'[[effect]]\nname = "{CHANGES[number % len(CHANGES)]}"\nfrom = "{begin}"\n')
        made = subprocess.run([BUILD / "simulators/recald-sim", "building", "--scenario",
                               folder / "scenario.toml", "--seed", str(SEED + number), "--twin", "--out",
                               folder], capture_output=True, text=True)
        if made.returncode != 0:
            return made.stderr.strip()
        with open(folder / "site.toml", "a") as site:
            site.write('\n[tariff]\ncurrency = "EUR"\n')
            for utility, price in PER_KWH.items():
                site.write(f"[tariff.{utility}]\nper_kWh = {price}\n")
        done = subprocess.run([BUILD / "daemon/recald", "drift", folder / "site.toml", "--out", folder,
                               "--threads", "1"], capture_output=True, text=True)
        (folder / "said.txt").write_text(done.stdout)
        if done.returncode != 0:
            return done.stderr.strip().splitlines()[-1]
    return folder


def added_by(folder):
    """kWh of each meter by day, in UTC."""
    days = {}
    with open(folder / "footprint.csv") as lines:
        for row in csv.DictReader(lines):
            day = days.setdefault(row["meter"], {})
            day[row["timestamp"][:10]] = day.get(row["timestamp"][:10], 0.0) + STEP_H * float(row["value"])
    return days


def sum_of(days, first, after):
    return sum(value for day, value in days.items() if first <= day < after)


def month_after(month):
    year, number = int(month[:4]), int(month[5:7])
    return f"{year + number // 12}-{number % 12 + 1:02d}"


def amount(sentence, period):
    """EUR, negative where it saves; None where nothing is said of it."""
    found = re.search(rf"[Ii]t (costs|saves) about ([\d,]+) EUR {period}", sentence)
    if not found:
        return None
    value = float(found[2].replace(",", ""))
    return value if found[1] == "costs" else -value


def alarms_of(number, folder):
    begin = BEGINS[number % len(BEGINS)]
    added = added_by(folder)
    a_year_later = (datetime.fromisoformat(begin) + timedelta(days=365)).date().isoformat()
    said = (folder / "said.txt").read_text().splitlines()
    for alarm in json.loads((folder / "drift.json").read_text())["alarms"]:
        meter = alarm["output"].removesuffix("_daily_kWh")
        raised = alarm.get("days", {}) or {}
        # A change that has not begun, or that this meter does not show, has no true cost.
        if meter not in PER_KWH or (raised.get("raised") or alarm["month"]) < begin[:7]:
            continue
        price = PER_KWH[meter]
        true_year = price * sum_of(added[meter], begin, a_year_later)
        true_so_far = price * sum_of(added[meter], begin, month_after(alarm["month"]) + "-01")
        key = (raised.get("raised") or alarm["month"])
        sentence = next((line for line in said if key in line and meter.split("_")[0] in line.lower()), "")
        yield {"number": number, "change": CHANGES[number % len(CHANGES)], "meter": meter,
               "raised": key, "year": amount(sentence, "a year"), "true_year": true_year,
               "so_far": amount(sentence, "so far"), "true_so_far": true_so_far}


def is_near(told, true):
    return told is not None and abs(told - true) <= 0.25 * abs(true)


def main():
    with tempfile.TemporaryDirectory() as scratch:
        top = Path(os.environ.get("COSTS_DIR", scratch))
        with ThreadPoolExecutor(JOBS) as pool:
            folders = list(pool.map(lambda i: make_and_follow(i, top / str(i)), range(BUILDINGS)))
        rows = []
        for number, folder in enumerate(folders):
            if isinstance(folder, str):
                print(f"building {number}: {folder}", file=sys.stderr)
            else:
                rows += alarms_of(number, folder)
    print("| building | change | meter | alarm | a year | true | so far | true |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- |")
    shown = lambda value: "–" if value is None else f"{value:,.0f}"
    for row in rows:
        print("| " + " | ".join([str(row["number"]), row["change"], row["meter"], row["raised"],
                                 *(shown(row[k]) for k in ("year", "true_year", "so_far", "true_so_far"))]) + " |")
    print(f"\nwithin 25 %, a year: {binomial(sum(is_near(r['year'], r['true_year']) for r in rows), len(rows))}")
    print(f"within 25 %, so far: {binomial(sum(is_near(r['so_far'], r['true_so_far']) for r in rows), len(rows))}")
    ended = datetime.now(timezone.utc).date()
    print(f"{len(rows)} alarms of {BUILDINGS} buildings, {ended}")


main()
