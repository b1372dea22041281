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


def cut_readings(folder, cut, month):
    """The site as it was when that month began."""
    with open(folder / "readings.csv") as lines, open(cut / "readings.csv", "w") as kept:
        kept.writelines(line for line in lines if not line[:1].isdigit() or line[:7] < month)
    site = (folder / "site.toml").read_text()
    (cut / "site.toml").write_text(site.replace('"weather.csv"', '"../weather.csv"'))


def drift(site, out):
    """@return what went wrong, or nothing."""
    done = subprocess.run([BUILD / "daemon/recald", "drift", site, "--out", out, "--threads", "1"],
                          capture_output=True, text=True)
    (out / "said.txt").write_text(done.stdout)
    return done.stderr.strip().splitlines()[-1] if done.returncode != 0 else None


def make_and_follow(number, folder):
    """Follows a building to the record's end, and to the month that raised the first alarm of its change.
    @return the folder, or what went wrong."""
    if not (folder / "drift.json").exists():
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "scenario.toml").write_text(
            f'[building]\nuse = "{USES[(number // 7) % len(USES)]}"\n'
            f'[period]\nstart = 2020\nyears = 4\nstep = "15m"\n'
            f'[[effect]]\nname = "{CHANGES[number % len(CHANGES)]}"\nfrom = "{begin_of(number)}"\n')
        made = subprocess.run([BUILD / "simulators/recald-sim", "building", "--scenario",
                               folder / "scenario.toml", "--seed", str(SEED + number), "--twin", "--out",
                               folder], capture_output=True, text=True)
        if made.returncode != 0:
            return made.stderr.strip()
        with open(folder / "site.toml", "a") as site:
            site.write('\n[tariff]\ncurrency = "EUR"\n')
            for utility, price in PER_KWH.items():
                site.write(f"[tariff.{utility}]\nper_kWh = {price}\n")
        wrong = drift(folder / "site.toml", folder)
        if wrong:
            return wrong
    months = [alarm["month"] for alarm in json.loads((folder / "drift.json").read_text())["alarms"]
              if raised_on(alarm) >= begin_of(number)[:7]]
    raised = folder / "raised"
    if months and not (raised / "drift.json").exists():
        raised.mkdir(exist_ok=True)
        cut_readings(folder, raised, month_after(min(months)))
        return drift(raised / "site.toml", raised) or folder
    return folder


def begin_of(number):
    return BEGINS[number % len(BEGINS)]


def raised_on(alarm):
    return (alarm.get("days") or {}).get("raised") or alarm["month"]


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


def amount(sentence, pattern):
    """EUR, negative where it saves; None where nothing is said of it."""
    found = re.search(rf"[Ii]t (costs|saves) about ([\d,]+) EUR {pattern}", sentence)
    if not found:
        return None
    value = float(found[2].replace(",", ""))
    return value if found[1] == "costs" else -value


def alarms_of(number, folder, last_month):
    """@param folder  Of drift.json and what was said; footprints stand in the building's."""
    begin = begin_of(number)
    added = added_by(folder if (folder / "footprint.csv").exists() else folder.parent)
    a_year_later = (datetime.fromisoformat(begin) + timedelta(days=365)).date().isoformat()
    said = (folder / "said.txt").read_text().splitlines()
    for alarm in json.loads((folder / "drift.json").read_text())["alarms"]:
        meter = alarm["output"].removesuffix("_daily_kWh")
        key = raised_on(alarm)
        # A change that has not begun has no true cost.
        if meter not in PER_KWH or key < begin[:7]:
            continue
        price = PER_KWH[meter]
        sentence = next((line for line in said if key in line and meter.split("_")[0] in line.lower()), "")
        yield {"number": number, "change": CHANGES[number % len(CHANGES)], "meter": meter, "raised": key,
               "year": amount(sentence, "a year"),
               "true_year": price * sum_of(added[meter], begin, a_year_later),
               "so_far": amount(sentence, "(so far|from)"),
               "true_so_far": price * sum_of(added[meter], begin, month_after(last_month) + "-01")}


def is_near(told, true):
    return told is not None and abs(told - true) <= 0.25 * abs(true)


def print_table(title, rows):
    print(f"\n{title}\n\n| building | change | meter | alarm | a year | true | so far | true |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- |")
    shown = lambda value: "–" if value is None else f"{value:,.0f}"
    for row in rows:
        print("| " + " | ".join([str(row["number"]), row["change"], row["meter"], row["raised"],
                                 *(shown(row[k]) for k in ("year", "true_year", "so_far", "true_so_far"))]) + " |")
    print(f"\nwithin 25 %, a year: {binomial(sum(is_near(r['year'], r['true_year']) for r in rows), len(rows))}")
    print(f"within 25 %, so far: {binomial(sum(is_near(r['so_far'], r['true_so_far']) for r in rows), len(rows))}")


def main():
    with tempfile.TemporaryDirectory() as scratch:
        top = Path(os.environ.get("COSTS_DIR", scratch))
        with ThreadPoolExecutor(JOBS) as pool:
            folders = list(pool.map(lambda i: make_and_follow(i, top / str(i)), range(BUILDINGS)))
        raised, later = [], []
        for number, folder in enumerate(folders):
            if isinstance(folder, str):
                print(f"building {number}: {folder}", file=sys.stderr)
                continue
            later += alarms_of(number, folder, "2023-12")
            if (folder / "raised/drift.json").exists():
                months = json.loads((folder / "raised/drift.json").read_text())["months"]
                raised += alarms_of(number, folder / "raised", months[-1])
    print_table("In the month that raised the first alarm of the change", raised)
    print_table("At the end of 2023, one to two years later", later)
    print(f"\n{len(raised)} and {len(later)} alarms of {BUILDINGS} buildings, {datetime.now(timezone.utc).date()}")


main()
