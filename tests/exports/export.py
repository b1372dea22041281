"""An export: its files, the command line of a user, and the truth."""
import dataclasses
import datetime
import random

from loads import Clock, DAY, draw_load


@dataclasses.dataclass
class Export:
    kind: str                        # of format: a portal's name, or what the table is like
    zone: str                        # as the user tells it
    files: dict                      # name -> bytes, in the order of the command line
    truths: list                     # alternatives, each a list of MeterTruth: a load in parts may come whole or in parts
    traits: set = dataclasses.field(default_factory=set)
    undecided: str = ""              # what nothing in it settles: unit, date order, rows, clock
    answers: dict = dataclasses.field(default_factory=dict)  # option -> value that settles it


class Draw:
    """Random numbers of one export, and what its parts draw alike."""

    def __init__(self, seed, number):
        self.rng = random.Random(f"{seed}/{number}")
        self.traits = set()

    def chance(self, probability, trait=None):
        happens = self.rng.random() < probability
        if happens and trait:
            self.traits.add(trait)
        return happens

    def span(self, zone, step, days=None, fixed=False, months=None):
        """Clock and whole local days, some years ago: with both changes of the clock, one, or none."""
        rng = self.rng
        first = datetime.date(rng.randint(2020, 2024), rng.randint(1, 12), 1 if rng.random() < 0.8 else rng.randint(2, 28))
        if months is None:
            months = rng.choice({900: [2, 2, 3, 4], 1800: [2, 3, 4, 6]}.get(step, [2, 3, 5, 8, 12]))
        if (days or months * 30) < 62:
            first = first.replace(day=1)
        last = first + datetime.timedelta(days=days or round(30.5 * months) + rng.choice([0, 1, 5]))
        wide = Clock(zone, seconds(first) - 30 * DAY, seconds(last) + 30 * DAY)
        begin, end = wide.midnight(first), wide.midnight(last)
        clock = Clock(zone, begin, end)
        clock.winter = min(Clock(zone, begin, begin + 370 * DAY).offsets)
        if fixed:  # days of the clock that is never changed
            begin, end = begin + clock.offset(begin) - clock.winter, end + clock.offset(end) - clock.winter
        return clock, begin, end

    def load(self, clock, begin, end, step, shape=None, quantum=1, mean_kW=None):
        rng = self.rng
        shape = shape or rng.choices(["office", "house", "process", "lighting", "night storage", "solar"],
                                     [4, 4, 1, 1.5, 0.7, 0.8])[0]
        if shape in ("lighting", "night storage", "solar"):
            self.traits.add("at rest for hours")
        usual = rng.uniform(0.3, 3) if shape in ("house", "solar") else 10 ** rng.uniform(0.3, 2.5)
        return draw_load(rng, clock, begin, end, step, shape, usual if mean_kW is None else mean_kW, quantum)

    def digits(self, count):
        return "".join(self.rng.choice("0123456789") for _ in range(count))


def seconds(date):
    return (date - datetime.date(1970, 1, 1)).days * DAY


