"""Meters of an export: what they are called, what they measured, how it is written, and what is missing of it."""
import dataclasses

from loads import Clock, Load
from tables import Number

# Watt-hours of a unit and the decimals that write a whole watt-hour, or enough of one.
ENERGY_UNITS = {"kWh": (1000, 3), "Wh": (1, 0), "MWh": (1e6, 6), "GJ": (1e6 / 3.6, 6), "therm": (29307.107, 6),
                "MMBtu": (293071.07, 8)}
POWER_UNITS = {"kW": (1000, 3), "W": (1, 0), "MW": (1e6, 6)}
VOLUME_UNITS = {"m³": (1000, 3), "m3": (1000, 3), "CCF": (2831.6847, 6)}  # litres
GAP_WORDS = ["", "", "-", "n/a", "NaN", "null", "---", "#N/A", "No data"]


def number_of(amount, unit, seconds, decimals=None):
    """Thousandths of an interval (Wh, litres) in that unit."""
    if unit in POWER_UNITS:
        size, usual = POWER_UNITS[unit]
        return Number(amount * 3600 / seconds / size, usual if decimals is None else decimals)
    size, usual = (ENERGY_UNITS.get(unit) or VOLUME_UNITS[unit])
    return Number(amount / size, usual if decimals is None else decimals)


@dataclasses.dataclass
class MeterTruth:
    """What must come out of one meter."""
    labels: list                   # texts of the export that name it
    load: Load
    utilities: tuple = ("electricity",)
    missing: set = dataclasses.field(default_factory=set)  # indices of the load's intervals that the file has not
    required: bool = True
    has_shape: bool = True         # the file tells each interval, so that peaks and their hours can be compared
    is_volume: bool = False        # of gas: energies up to a factor
    slack_kWh: float = 0.0         # what coarse readings leave open in a month
    from_instant: int = None       # figures before it may be missing

    def months(self, zone):
        load = self.load
        found = []
        for name, begin, end in Clock(zone, load.begin, load.end).complete_months(load.begin, load.end):
            span = range((begin - load.begin) // load.step, (end - load.begin) // load.step)
            lost = [i for i in self.missing if i in span]
            found.append(Month(name, begin, end, load.total(begin, end), len(lost) / len(span),
                               sum(load.amounts[i] for i in lost) / 1000, begin >= (self.from_instant or begin)))
        return found


@dataclasses.dataclass
class Month:
    """A complete local month; of gas by volume, cubic metres in the place of kWh."""
    name: str
    begin: int
    end: int
    energy: float
    missing_share: float
    missing_energy: float
    is_asked_for: bool


@dataclasses.dataclass
class Meter:
    """A meter and its column of a file, an entry for each interval of its load."""
    label: str
    load: Load
    unit: str = "kWh"
    utility: str = "electricity"
    register: list = None          # readings in Wh at the ends of intervals, one more than the load has
    decimals: int = None
    missing: set = dataclasses.field(default_factory=set)
    flags: list = None
    gap_cell: str = ""
    zero_cells: set = dataclasses.field(default_factory=set)  # of those that are missing
    slack_kWh: float = 0.0
    has_shape: bool = True
    written: Load = None           # what the file has of the load, where that differs

    def __post_init__(self):
        self.written = self.load

    def cell(self, index):
        """Of an interval; of a register, its reading number index."""
        if index in self.missing:
            return Number(0.0, 3) if index in self.zero_cells else self.gap_cell
        if self.register:
            return number_of(self.register[index], self.unit, 3600, self.decimals)
        return number_of(self.written.amounts[index], self.unit, self.load.step, self.decimals)

    def truth(self, labels=None, required=True):
        utilities = {"heating": ("heating",), "gas": ("gas",), "water": ("water",)}.get(self.utility, ("electricity",))
        # A reading that is missing costs a register nothing but the shape.
        lost = set() if self.register else {i for i in self.missing if i < len(self.load.amounts)}
        return MeterTruth(labels or [self.label], self.load, utilities, lost, required,
                          self.has_shape and not (self.register and self.missing), self.unit in VOLUME_UNITS,
                          self.slack_kWh)


def draw_gaps(rng, count, per_day):
    """Some stretches, from an interval to half a day; a few per cent at the most."""
    gaps = set()
    for _ in range(rng.randint(1, 6)):
        length = rng.choice([1, 1, 2, 4, per_day // 8, per_day // 2])
        first = rng.randrange(1, count - length - 1)
        gaps.update(range(first, first + max(1, length)))
    return gaps if len(gaps) < 0.05 * count else set()


def make_register(rng, meter, clock, kinds):
    """Turns amounts into readings; returns the traits that it got."""
    load = meter.load
    kind = rng.choices(list(kinds), list(kinds.values()))[0]
    first = rng.choice([0, rng.randrange(10**5, 10**8), rng.randrange(10**7, 10**9)])
    readings = load.register(first)
    traits = {"register"}
    if kind == "wraps":
        modulus = 10**8 if readings[-1] - first < 9 * 10**7 else 10**9  # of five or six digits of kWh
        over = rng.randrange(len(readings) // 4, len(readings) - 10)
        first = modulus - (readings[over] - readings[0])
        readings = [reading % modulus for reading in load.register(first)]
    elif kind == "exchanged":
        at = rng.randrange(len(readings) // 4, len(readings) * 3 // 4)
        fresh = rng.choice([0, rng.randrange(10**3, 10**8)])
        readings = readings[:at] + [fresh + reading - readings[at] for reading in readings[at:]]
        meter.slack_kWh += 2 * max(load.amounts) / 1000
        meter.has_shape = False
    elif kind in ("zeroed daily", "zeroed monthly"):
        spans = clock.days(load.begin, load.end) if kind == "zeroed daily" else month_spans(clock, load)
        readings = [0]
        for _, begin, end in spans:
            since = 0
            for i in range((begin - load.begin) // load.step, (end - load.begin) // load.step):
                since += load.amounts[i]
                readings.append(since)
    elif kind == "coarse":
        resolution = rng.choice([100, 1000])
        if sum(load.amounts) > 200 * resolution * len(load.amounts) / 96:
            readings = [reading // resolution * resolution for reading in readings]
            usual = number_of(0, meter.unit, 3600).decimals  # write a whole watt-hour
            meter.decimals = max(0, usual - (2 if resolution == 100 else 3))
            meter.slack_kWh += 2 * resolution / 1000
            meter.has_shape = False
    if kind != "plain":
        traits.add(f"register {kind}")
    meter.register = readings
    return traits


def month_spans(clock, load):
    spans = list(clock.days(load.begin, load.end))
    months = {}
    for date, begin, end in spans:
        months.setdefault((date.year, date.month), [begin, end])[1] = end
    return [(None, begin, end) for begin, end in months.values()]
