"""Whether a term of a site file is worth seeking: how well months that were not learnt from are
foretold by nothing but the calendar, the clock and the outdoor temperature of that file.

No part of the program under study is used: by type of day and hour of the local clock a line over
the temperature is fitted to two of three months and judged on the third.
"""
import collections
import csv
import dataclasses
import datetime
import math
import pathlib
import re
import zoneinfo

KW_OF_UNIT = {"kWh": 1.0, "kW": 1.0, "kBtu/h": 0.29307107}  # readings are hourly
MOST_OF_RATED = 1.2


def instant_of(stamp):
    moment = datetime.datetime.fromisoformat(stamp.replace("Z", "+00:00"))
    return moment.astimezone(datetime.timezone.utc)


class Site:
    """What is needed of a site file: clock, holidays, months, readings and temperatures."""

    def __init__(self, folder, data):
        text = (folder / "site.toml").read_text()
        self.zone = zoneinfo.ZoneInfo(re.search(r'(?m)^timezone = "([^"]*)"', text)[1])
        listed = re.search(r"(?ms)^holidays = \[(.*?)^\]", text)
        self.holidays = set(re.findall(r'"([\d-]+)"', listed[1])) if listed else set()
        period = re.findall(r'(?:from|to) = "(\d{4}-\d{2})"', text)
        self.first_month, self.last_month = min(period), max(period)
        self.rated_kW = {block[0]: float(block[1]) for block in re.findall(
            r'(?ms)^\[\[meter\]\]\nid = "(\w+)".*?^rated_kW = (\S+)', text)}

        def path(name):
            file = re.search(rf'file = "([^"]*{name})"', text)[1]
            return folder / file.replace("$RECALD_DATA", str(data))

        self.readings = list(self.read_meters(path("meters.csv")))
        self.dry_bulb_C = dict(read_temperatures(path("weather.csv")))

    def read_meters(self, path):
        """@return (instant, meter, kW) without zeros, which mean no data, and impossible values"""
        with path.open() as file:
            for row in csv.DictReader(file):
                if not row["value"]:
                    continue
                power_kW = float(row["value"]) * KW_OF_UNIT[row["unit"]]
                if 0.0 < power_kW < MOST_OF_RATED * self.rated_kW[row["meter"]]:
                    yield instant_of(row["timestamp"]), row["meter"], power_kW

    def hours(self):
        """@return meter -> list of (month, (type of day, hour), temperature, kW)"""
        by_meter = collections.defaultdict(list)
        for instant, meter, power_kW in self.readings:
            local = instant.astimezone(self.zone)
            month = local.strftime("%Y-%m")
            dry_bulb_C = self.dry_bulb_C.get(instant)
            if not self.first_month <= month <= self.last_month or dry_bulb_C is None:
                continue
            shut = local.weekday() == 6 or local.strftime("%Y-%m-%d") in self.holidays
            day = "shut" if shut else "saturday" if local.weekday() == 5 else "work"
            by_meter[meter].append((month, (day, local.hour), dry_bulb_C, power_kW))
        return by_meter


def read_temperatures(path):
    with path.open() as file:
        for row in csv.DictReader(file):
            if row["dry_bulb_C"]:
                yield instant_of(row["timestamp"]), float(row["dry_bulb_C"])


def line_through(points):
    """Least squares. @return level and slope; slope 0 where all temperatures are alike"""
    n = len(points)
    x_mean = sum(x for x, _ in points) / n
    y_mean = sum(y for _, y in points) / n
    square = sum((x - x_mean) ** 2 for x, _ in points)
    slope = sum((x - x_mean) * (y - y_mean) for x, y in points) / square if square > 0.0 else 0.0
    return y_mean - slope * x_mean, slope


def mean_squares(hours):
    """@return held month -> mean squared error of its hours [kW2]"""
    months = sorted({hour[0] for hour in hours})
    held = set(months[2::3])
    learnt = collections.defaultdict(list)
    for month, kind, dry_bulb_C, power_kW in hours:
        if month not in held:
            learnt[kind].append((dry_bulb_C, power_kW))
    lines = {kind: line_through(points) for kind, points in learnt.items()}
    errors = collections.defaultdict(list)
    for month, kind, dry_bulb_C, power_kW in hours:
        if month in held and kind in lines:
            level, slope = lines[kind]
            errors[month].append((power_kW - level - slope * dry_bulb_C) ** 2)
    return {month: sum(values) / len(values) for month, values in errors.items()}


@dataclasses.dataclass
class Worth:
    rmse_without_kW: float
    rmse_with_kW: float
    better: int  # Held months in which the term helps,
    months: int  # of those in which it makes a difference.


def worth_of_term(with_term, without):
    """@param with_term, without: Sites that differ in the term. @return meter -> Worth"""
    result = {}
    hours_without = without.hours()
    for meter, hours in with_term.hours().items():
        right, masked = mean_squares(hours), mean_squares(hours_without[meter])
        result[meter] = Worth(math.sqrt(sum(masked.values()) / len(masked)),
                              math.sqrt(sum(right.values()) / len(right)),
                              sum(masked[month] > right[month] for month in right),
                              sum(masked[month] != right[month] for month in right))
    return result
