"""Masked effects on measured buildings: derives the site files, and prints what came of them.

    masked_effects.py derive OUT   one folder a variant under OUT/SITE/, site.toml in it
    masked_effects.py table OUT    table of all OUT/*/*/diagnosis.json

A variant is a complete site file of ours with one term taken out, or with another's weather. Where
that needs other readings or other weather than the data have, they are written beside the site
file; they are measured by others and stay out of the project. RECALD_DATA names the data.
"""
import csv
import dataclasses
import datetime
import json
import math
import os
import pathlib
import re
import sys
import zoneinfo

import held_hours
from held_hours import instant_of

DATA = pathlib.Path(os.environ["RECALD_DATA"])
HERE = pathlib.Path(__file__).parent
SITE_FILES = {"hillside": HERE / "real/hillside.toml",
              "b25": HERE / "../../daemon/examples/cambridge-b25.toml",
              "b40": HERE / "real/b40.toml"}
WEATHER_COLUMNS = ["dry_bulb_C", "rel_humidity_pct", "wind_speed_m_s", "wind_dir_deg", "ghi_W_m2"]


# What is done to a site file (text -> text).

def without_holidays(text, _folder):
    """The calendar of whoever set the model up and forgot public holidays."""
    return replace_once(r"(?ms)^holidays = \[.*?^\]\n", "", text)


def with_clock_of(zone):
    """Another zone's clock rule; the readings' instants stay right."""
    line = f'timezone = "{zone}"'
    return lambda text, _folder: replace_once(r'(?m)^timezone = "[^"]*"', line, text)


def with_value(key, value):
    return lambda text, _folder: replace_once(rf"(?m)^{key} = \S+", f"{key} = {value}", text)


def all_of(*edits):
    def apply(text, folder):
        for edit in edits:
            text = edit(text, folder)
        return text
    return apply


def with_plant_off_at_night(text, folder):
    """The usual timetable of an office where the plant in truth never stops."""
    return all_of(with_value("outdoor_air_unoccupied_fraction", 0), with_value("occupied_from", 7),
                  with_value("occupied_to", 19), with_value("heating_unoccupied_C", 16),
                  with_value("cooling_unoccupied_C", 28))(text, folder)


def with_winter_clock_logger(text, folder):
    """A logger that ignores daylight saving although its stamps are read as local time: from spring
    to autumn each reading stands an hour early."""
    zone = zoneinfo.ZoneInfo(re.search(r'timezone = "([^"]*)"', text)[1])
    source = data_file(re.search(r'file = "([^"]*meters.csv)"', text)[1])
    with source.open() as old, (folder / "meters.csv").open("w") as new:
        rows = csv.reader(old)
        writer = csv.writer(new, lineterminator="\n")
        writer.writerow(next(rows))
        for stamp, *rest in rows:
            instant = instant_of(stamp)
            instant -= instant.astimezone(zone).dst() or datetime.timedelta()
            writer.writerow([instant.strftime("%Y-%m-%dT%H:%M:%SZ"), *rest])
    return re.sub(r'file = "[^"]*meters.csv"', 'file = "meters.csv"', text)


def with_weather_of(epw):
    """A typical year of another place."""
    weather = f'[weather]\nfile = "$RECALD_DATA/weather/{epw}"\nformat = "epw"\n'
    table_of_it = r"(?ms)^\[weather\].*?^(?=\[\[)"
    return lambda text, _folder: replace_once(table_of_it, weather + "\n", text)


def with_wind_of_another_year(text, folder):
    """Wind of the same station 364 days off; temperature, humidity and sun stay right."""
    rows = read_weather(data_file(re.search(r'file = "([^"]*weather.csv)"', text)[1]))
    winds = {instant: row["wind_speed_m_s"] for instant, row in rows}
    year = datetime.timedelta(days=364)
    for instant, row in rows:
        row["wind_speed_m_s"] = winds.get(instant + year) or winds.get(instant - year) or ""
    return use_weather(rows, text, folder)


def with_assumed_sky(text, folder):
    """For a sensor of temperature alone: three quarters of a cloudless sky (Haurwitz 1945), 60 %
    humidity, 3 m/s. The same every day, so that nothing about them can be learnt."""
    latitude = number(text, "latitude_deg")
    longitude = number(text, "longitude_deg")
    rows = read_weather(data_file(re.search(r'file = "([^"]*weather.csv)"', text)[1]))
    for instant, row in rows:
        cos_zenith = sun_height(instant + datetime.timedelta(minutes=30), latitude, longitude)
        sun_W_m2 = 0.0
        if cos_zenith > 0.02:
            sun_W_m2 = 0.75 * 1098.0 * cos_zenith * math.exp(-0.057 / cos_zenith)
        row.update(rel_humidity_pct="60", wind_speed_m_s="3", wind_dir_deg="270",
                   ghi_W_m2=f"{sun_W_m2:.0f}")
    return use_weather(rows, text, folder)


# What these need.

def replace_once(pattern, replacement, text):
    changed, count = re.subn(pattern, replacement, text, count=1)
    if count == 0:
        sys.exit(f"masked_effects: no match for {pattern}")
    return changed


def data_file(path):
    return pathlib.Path(path.replace("$RECALD_DATA", str(DATA)))


def number(text, key):
    return float(re.search(rf"(?m)^{key} = (\S+)", text)[1])


def read_weather(path):
    with path.open() as file:
        return [(instant_of(row["timestamp"]), row) for row in csv.DictReader(file)]


def use_weather(rows, text, folder):
    with (folder / "weather.csv").open("w") as file:
        writer = csv.DictWriter(file, ["timestamp", *WEATHER_COLUMNS], extrasaction="ignore",
                                lineterminator="\n")
        writer.writeheader()
        writer.writerows(row for _, row in rows)
    return re.sub(r'file = "[^"]*weather.csv"', 'file = "weather.csv"', text)


def sun_height(instant, latitude_deg, longitude_deg):
    """Cosine of the zenith angle; declination after Cooper (1969), no equation of time."""
    day = instant.timetuple().tm_yday
    declination = math.radians(23.45) * math.sin(2.0 * math.pi * (284 + day) / 365.0)
    solar_hour = instant.hour + instant.minute / 60.0 + longitude_deg / 15.0
    hour_angle = math.radians(15.0 * (solar_hour - 12.0))
    latitude = math.radians(latitude_deg)
    return (math.sin(latitude) * math.sin(declination)
            + math.cos(latitude) * math.cos(declination) * math.cos(hour_angle))


# The study.

@dataclasses.dataclass
class Variant:
    name: str
    edit: object
    sought: tuple = ()  # Effects any of which would be a right name; none: no name is right.
    weather_name_is_wrong: bool = False


def unchanged(text, _folder):
    return text


CHICAGO = with_weather_of("USA_IL_Chicago-OHare.Intl.AP.725300_TMY3.epw")
WEATHER_NAMES = ("wind_infiltration", "stack_infiltration", "solar_gain_change", "ground_coupling",
                 "thermal_mass", "economiser_changeover", "economiser_failed", "deep_drying",
                 "humidifier", "supply_reset_missing", "outdoor_air_amount", "damper_stuck_open",
                 "heat_pump_defrost")

VARIANTS = {
    "hillside": [
        Variant("complete", with_assumed_sky),
        Variant("no holidays", all_of(with_assumed_sky, without_holidays), ("missing_holidays",)),
        Variant("clock without summer time",
                all_of(with_assumed_sky, with_clock_of("Pacific/Pitcairn")), ("dst_misapplied",)),
        Variant("logger without summer time", all_of(with_assumed_sky, with_winter_clock_logger),
                ("dst_misapplied",)),
        Variant("weather of Chicago", CHICAGO, weather_name_is_wrong=True),
    ],
    "b25": [
        Variant("complete", unchanged),
        Variant("no holidays", without_holidays, ("missing_holidays",)),
        Variant("clock without summer time", with_clock_of("Atlantic/Reykjavik"),
                ("dst_misapplied",)),
        Variant("logger without summer time", with_winter_clock_logger, ("dst_misapplied",)),
        Variant("wind of another year", with_wind_of_another_year, weather_name_is_wrong=True),
        Variant("weather of Chicago", CHICAGO, weather_name_is_wrong=True),
    ],
    "b40": [
        Variant("complete", unchanged),
        Variant("plant off at night", with_plant_off_at_night,
                ("round_the_clock_zone", "night_setback_missing", "damper_stuck_open")),
        Variant("no holidays", without_holidays, ("missing_holidays",)),
        Variant("logger without summer time", with_winter_clock_logger, ("dst_misapplied",)),
        Variant("wind of another year", with_wind_of_another_year, weather_name_is_wrong=True),
        Variant("weather of Chicago", CHICAGO, weather_name_is_wrong=True),
    ],
}


def folder_of(out, site, variant):
    return out / site / variant.name.replace(" ", "-")


def derive(out):
    for site, variants in VARIANTS.items():
        text = SITE_FILES[site].read_text()
        for variant in variants:
            folder = folder_of(out, site, variant)
            folder.mkdir(parents=True, exist_ok=True)
            (folder / "site.toml").write_text(variant.edit(text, folder))


def percent(value):
    return "-" if value is None else f"{100.0 * value:.1f}"


def worth(out, site, variant):
    """What the term is worth on months that nothing was learnt from, without the program's help."""
    if not variant.sought:
        return ""
    complete = held_hours.Site(folder_of(out, site, VARIANTS[site][0]), DATA)
    masked = held_hours.Site(folder_of(out, site, variant), DATA)
    return "; ".join(f"{meter} {term.rmse_without_kW:.1f} -> {term.rmse_with_kW:.1f} kW "
                     f"({term.better} of {term.months})"
                     for meter, term in held_hours.worth_of_term(complete, masked).items()
                     if term.months > 0)  # else the term is about the plant, not the calendar


def held(diagnosis):
    """Of the model before anything is added, on the months kept back."""
    change = (diagnosis["gap"] or {}).get("hourly")
    return change["before"] if change else diagnosis.get("held_fit", {})


def gap(diagnosis):
    after = ((diagnosis["gap"] or {}).get("hourly") or {}).get("after", {})
    words = []
    for meter, before in held(diagnosis).items():
        change = f" -> {percent(after[meter]['cvrmse_daily'])}" if meter in after else ""
        words.append(f"{meter} {percent(before['cvrmse_daily'])}{change} %")
    return "; ".join(words)


def names(diagnosis):
    def label(candidate):
        meter = candidate.get("meter")
        return candidate["effect"] + (f" ({meter})" if meter else "")
    return ", ".join(f"{label(c)} {100.0 * c['probability']:.0f} %"
                     for c in diagnosis["candidates"][:3])


def verdict(variant, diagnosis):
    tried = [addition["effect"] for addition in diagnosis["additions"]]
    if variant.weather_name_is_wrong:
        return "WRONG" if any(name in WEATHER_NAMES for name in diagnosis["added"]) else "right"
    if not variant.sought:
        return "named something" if diagnosis["added"] else "nothing named"
    if not any(name in variant.sought for name in tried):
        return "not named"
    return "named, then taken back" if diagnosis["not_confirmed"] else "named"


def load(out, site, variant):
    path = folder_of(out, site, variant) / "diagnosis.json"
    return json.loads(path.read_text()) if path.exists() else None


def row(out, site, variant):
    head = [site, variant.name, worth(out, site, variant)]
    diagnosis = load(out, site, variant)
    if diagnosis is None:
        return [*head, "failed", "", "", "", "", ""]
    outcome = diagnosis["outcome"]
    if diagnosis["not_confirmed"]:
        outcome += ", taken back: " + ", ".join(a["effect"] for a in diagnosis["additions"])
    fit = "; ".join(f"{meter} {percent(figures['cvrmse_daily'])} %"
                    for meter, figures in diagnosis["base_fit"].items())
    return [*head, outcome, names(diagnosis), verdict(variant, diagnosis), fit, gap(diagnosis),
            f"{diagnosis['wall_s']:.0f}"]


def table(out):
    print("Worth: RMSE of hours without -> with the term on held months, and in how many of them it is")
    print("better, from calendar, clock and temperature alone. Fit and gap: CV(RMSE) of days by the")
    print("diagnosis, on months fitted, and on months kept back, before -> after.\n")
    print("| site | masked | worth | outcome | top three | verdict | fit | gap | s |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- | --- |")
    for site, variants in VARIANTS.items():
        for variant in variants:
            print("| " + " | ".join(row(out, site, variant)) + " |")


def main():
    command, out = sys.argv[1:]
    {"derive": derive, "table": table}[command](pathlib.Path(out))


if __name__ == "__main__":
    main()
