"""Tables as any program may write them: everything about them is drawn."""
import datetime

from export import Export
from loads import DAY, Load, electric_car
from meters import GAP_WORDS, Meter, draw_gaps, make_register, number_of
from stamps import date_and_clock, draw_stamps, winter_time
from tables import Habits, Number, delimited, workbook
from words import PLACES, WORDS, word

REGISTER_KINDS = {"plain": 5, "wraps": 1, "exchanged": 1, "zeroed daily": 1.2, "zeroed monthly": 0.6, "coarse": 1.5}


def draw_habits(d, place):
    rng = d.rng
    decimal = place[2] if rng.random() < 0.8 else "."
    habits = Habits(decimal=decimal, newline=rng.choice(["\n", "\r\n"]), trims_zeros=rng.random() < 0.15,
                    quotes_all=rng.random() < 0.12)
    # "1.234" is a thousand where people write a decimal comma, unless other cells have other numbers of digits.
    habits.trims_zeros |= decimal != place[2]
    habits.delimiter = rng.choices([";", ",", "\t", "|"], [6, 1 if decimal == "," else 9, 1, 0.5])[0]
    habits.encoding = rng.choices(["utf-8", "utf-8-sig", "cp1252", "utf-16"], [6, 3, 1.5, 0.7])[0]
    if habits.encoding == "cp1252" and place[1] == "pl":
        habits.encoding = "cp1250"
    if habits.encoding.startswith("utf") and d.chance(0.03, "narrow space"):
        habits.space = "\u202f"
    if habits.encoding != "utf-8":
        d.traits.add(habits.encoding)
    return habits


def title_of(name, unit, style):
    return {"(": f"{name} ({unit})", "[": f"{name} [{unit}]", " ": f"{name} {unit}", "_": f"{name}_{unit}",
            "in": f"{name} in {unit}", "#": f"#{name} ({unit})", "\n": f"{name}\n({unit})", "alone": unit, "none": name}[style]


def corrupted(row):
    """What a first download has: an estimate."""
    return [Number(cell.value * 0.8, cell.decimals, cell.suffix) if isinstance(cell, Number) else cell for cell in row]


class PlainTable:
    """Draws one: place and clock, meters, what is missing, layout, then rows and files."""

    def __init__(self, d):
        self.d, rng = d, d.rng
        self.place = rng.choice(PLACES)
        self.zone, self.language = self.place[:2]
        self.words = WORDS[self.language]
        self.step = rng.choices([900, 1800, 3600, 300, 600], [6, 3, 6, 0.7, 0.5])[0]
        self.quantity = rng.choices(["energy", "power", "register"], [5, 2.5, 2.5])[0]
        self.draw_clock()
        self.meters = self.draw_meters()
        self.undecided = "unit" if d.chance(0.05) else ""
        self.layout = rng.choices(["wide", "long", "file each"], [8, 3, 1.5] if len(self.meters) > 1 else [8, 1, 0])[0]
        self.habits = draw_habits(d, self.place)
        is_sheet = self.layout == "wide" and d.chance(0.13, "xlsx")
        self.sheet = rng.choice(["Sheet1", "Data", "Export"]) if is_sheet else None
        if self.quantity == "register":
            self.draw_registers()
        self.flag_titles, self.others, self.dropped, self.spring = [], [], set(), {}
        self.has_24_hours_a_day = False
        if self.layout == "wide":
            self.damage()
            self.spend_clock_changes()
            # A price and a cost would tell the unit.
            if not self.undecided and rng.random() < 0.3:
                self.others = self.draw_other_columns()
        self.change = self.draw_change_of_interval()
        self.unit_way = self.place_unit()

    def export(self):
        files = {"wide": self.wide_files, "long": self.long_files, "file each": self.files_of_meters}[self.layout]()
        answers = {"--unit": self.meters[0].unit} if self.undecided else {}
        return Export(f"table: {self.layout}, {self.quantity}", self.zone, files, [[meter.truth() for meter in self.meters]],
                      self.d.traits, self.undecided, answers)

    def word(self, key):
        return word(self.d.rng, self.language, key)

    def draw_clock(self):
        """A clock that is never changed is one whose header says so, or whose file has both changes of a year."""
        d = self.d
        fixed = self.quantity != "register" and d.chance(0.06, "winter time all year")
        says_so = d.rng.random() < 0.6
        if fixed and not says_so:
            self.step = 3600
        months = 1.1 if self.step < 900 else 12 if fixed and not says_so else None
        self.clock, self.begin, self.end = d.span(self.zone, self.step, fixed=fixed, months=months)
        self.stamps = (winter_time(d.rng, self.place, self.clock, self.step, says_so) if fixed
                       else draw_stamps(d.rng, self.place, self.clock, self.step, self.quantity == "register"))
        d.traits.add("stamps: " + self.stamps.kind)

    def draw_load(self, shape=None):
        return self.d.load(self.clock, self.begin, self.end, self.step, shape)

    def draw_meters(self):
        """One to four, each with a use; now and then gas, heat or feed-in among them."""
        d, rng = self.d, self.d.rng
        unit = rng.choices(*{"energy": (["kWh", "Wh", "MWh"], [8, 1.5, 0.7]), "power": (["kW", "W", "MW"], [8, 2, 0.4]),
                             "register": (["kWh", "Wh", "MWh"], [8, 1, 1])}[self.quantity])[0]
        count = rng.choices([1, 2, 3, 4], [5, 3, 1, 1])[0]
        names = rng.sample(self.words["uses"], count)
        if count == 1:
            quantity = self.word(self.quantity)
            names = [rng.choice([quantity, names[0], f"{names[0]} {quantity}"])]
        meters = []
        for name in names:
            load = self.draw_load()
            if self.step >= 900 and d.chance(0.04, "a car is charged"):
                load = electric_car(rng, load, max(11, 25 * sum(load.amounts) / len(load.amounts) / 1000 * 3600 / self.step))
            meters.append(Meter(name, load, unit))
        if self.quantity != "power" and rng.random() < 0.15:
            utility = rng.choice(["gas", "heating"])
            other = rng.choice([unit, "MWh", "GJ"] + ["m³"] * (utility == "gas"))
            meters.append(Meter(self.word(utility), self.draw_load("office"), other, utility))
            d.traits.add("gas" if utility == "gas" else "heat")
        if self.quantity == "energy" and d.chance(0.08, "feed-in"):
            meters.append(Meter(self.word("export"), self.draw_load("solar"), unit))
        return meters

    def draw_registers(self):
        kinds = {"plain": 1} if self.layout == "file each" else REGISTER_KINDS
        for meter in self.meters:
            self.d.traits |= make_register(self.d.rng, meter, self.clock, kinds)
        # Without decimals "1.234" would be a number of either kind.
        has_decimals = all(meter.unit != "Wh" and meter.decimals != 0 for meter in self.meters)
        if has_decimals and self.d.chance(0.1, "thousands separator"):
            self.habits.thousands = "." if self.habits.decimal == "," else self.d.rng.choice(",,'")

    def damage(self):
        """Gaps, and flags in a column of their own."""
        d, rng = self.d, self.d.rng
        count, per_day = len(self.meters[0].load.amounts), DAY // self.step
        if d.chance(0.12, "rows missing"):
            self.dropped = draw_gaps(rng, count, per_day)
            for meter in self.meters:
                meter.missing |= self.dropped
        if d.chance(0.12, "blank cells or words"):
            for meter in rng.sample(self.meters, rng.randint(1, len(self.meters))):
                meter.missing |= draw_gaps(rng, count, per_day)
                meter.gap_cell = rng.choice(GAP_WORDS)
        if self.quantity == "register" or len(self.meters) > 1 or not d.chance(0.14, "quality flags"):
            return
        meter, flags = self.meters[0], self.words["flags"]
        self.flag_titles = [self.word("status")]
        meter.flags = [flags["good"]] * count
        for i in draw_gaps(rng, count, per_day):
            meter.flags[i] = flags["estimated"]
        if rng.random() < 0.6:
            lost = draw_gaps(rng, count, per_day) - meter.missing
            for i in lost:
                meter.flags[i] = flags["missing"]
            meter.missing |= lost
            if bool(lost) and d.chance(0.5, "zero flagged as missing"):
                meter.zero_cells = lost

    def spend_clock_changes(self):
        """Tables of 24 hours a day: the hour that spring skips is blank or zero, autumn's two hours are added."""
        d, step, clock = self.d, self.step, self.clock
        if self.stamps.of_walls is None or self.quantity == "register":
            return
        changes = [(t, by) for t, by in clock.changes() if self.begin + 3600 < t < self.end - 3600]
        forward, back = [t for t, by in changes if by == 3600], [t for t, by in changes if by == -3600]
        if forward and d.chance(0.25, "skipped hour written"):
            self.has_24_hours_a_day = True
            blank = d.rng.choice(["", Number(0.0, 3)])
            for t in forward:
                walls = [clock.local(t - 1) + datetime.timedelta(seconds=1 + k) for k in range(0, 3601, step)]
                self.spring[t] = [self.stamps.of_walls(*pair) + [blank] * len(self.meters) for pair in zip(walls, walls[1:])]
        if back and self.quantity == "energy" and not self.dropped and d.chance(0.12, "doubled hour summed"):
            self.has_24_hours_a_day = True
            hour = 3600 // step
            for first in ((t - self.begin) // step for t in back):
                self.dropped.update(range(first, first + hour))
                for meter in self.meters:
                    amounts = list(meter.written.amounts)
                    for i in range(first, first + hour):
                        amounts[i - hour] += amounts[i]
                    meter.written, meter.has_shape = Load(self.begin, step, amounts), False

    def draw_other_columns(self):
        """Columns that are no meters: title and cell of an interval, the constant ones drawn once."""
        rng, meter = self.d.rng, self.meters[0]
        price, lengths = rng.uniform(0.08, 0.4), {"serial": 8, "point": 18, "contract": 7}
        columns = []
        for kind in rng.sample([*lengths, "cost", "price", "tariff", "temperature", "index"], rng.choice([1, 1, 2, 3])):
            if kind in lengths:
                text = rng.choice(["", "", "1EMH", "0000"]) + self.d.digits(lengths[kind])
                cell = lambda i, t, text=text: text
            elif kind == "cost":
                cell = lambda i, t: Number(meter.load.amounts[i] / 1000 * price, 4)
            elif kind == "price":
                cell = lambda i, t: Number(price * (1.4 if 7 <= t // 3600 % 24 < 20 else 1), 4)
            elif kind == "tariff":
                names = rng.choice([("HT", "NT"), ("1", "2"), ("Peak", "Off-peak"), ("HP", "HC")])
                cell = lambda i, t, names=names: names[0 if 7 <= t // 3600 % 24 < 22 else 1]
            elif kind == "temperature":
                cell = lambda i, t: Number(12 + 8 * ((t // 3600 * 7919) % 101) / 101, 1)
            else:
                cell = lambda i, t: str(i + 1)
            columns.append((self.word(kind), cell))
        self.d.traits.add("columns that are no meters")
        return columns

    def draw_change_of_interval(self):
        """An instant before which a row is an hour, now and then; else the beginning."""
        damaged = self.dropped or any(meter.missing or meter.flags for meter in self.meters)
        if (self.layout != "wide" or self.quantity == "register" or damaged or self.step not in (900, 1800) or
                self.stamps.kind == "hour numbers" or not self.d.chance(0.06, "interval changes")):
            return self.begin
        for meter in self.meters:
            meter.has_shape = False
        return self.clock.midnight(self.clock.local(self.begin + self.d.rng.randint(10, 40) * DAY).date())

    def place_unit(self):
        """Where the unit is told: header, row, above, cell, column; nowhere if that is undecided."""
        same = len({meter.unit for meter in self.meters}) == 1
        ways = {"header": 8, "above": 1.2 * same}
        if self.layout == "wide":
            ways |= {"units row": 1.5, "second header row": 0.8, "line break": 0.6, "cell": 0 if self.sheet else 0.8}
        elif self.layout == "long":
            ways = {"column": 5, "header": 2 * same, "above": same}
        way = "nowhere" if self.undecided else self.d.rng.choices(list(ways), list(ways.values()))[0]
        if way != "header":
            self.d.traits.add("unit: " + way)
        return way

    def lines_above(self):
        """Whose, of when, and perhaps a date or the unit."""
        rng, words, unit = self.d.rng, self.words, self.meters[0].unit
        if self.unit_way != "above" and rng.random() < 0.75:
            return []
        first, last = (self.clock.local(t).strftime(self.place[3][0]) for t in (self.begin, self.end - 1))
        lines = [[words["title"][0]], [words["customer"][0], "Schmidt & Co"], [words["contract"][0], self.d.digits(8)],
                 [words["period"][0], first, last], [words["date"][0], last], [self.word("point"), self.d.digits(11)], []]
        chosen = rng.sample(lines, rng.randint(1, 5))
        if self.unit_way == "above":
            line = rng.choice([[f"{self.word('unit')}: {unit}"], [self.word("unit"), unit]])
            chosen.insert(rng.randint(0, len(chosen)), line)
        self.d.traits.add("lines above the header")
        return chosen

    def wide_files(self):
        """A column a meter."""
        rng, way, meters = self.d.rng, self.unit_way, self.meters
        style = {"line break": "\n", "second header row": "(", "header": rng.choice("(((([[[  __#") if rng.random() < 0.9 else
                 "alone" if len(meters) == 1 else "in"}.get(way, "none")
        times = list(self.stamps.titles)
        if len(times) == 1 and self.stamps.kind not in ("winter time", "UTC") and self.d.chance(0.06, "time has no header"):
            times = [""]
        behind = self.flag_titles + [title for title, _ in self.others]
        header = [times + [title_of(meter.label, meter.unit, style) for meter in meters] + behind]
        if way == "units row":
            header.append([""] * len(times) + [meter.unit for meter in meters] + [""] * len(behind))
        elif way == "second header row":
            header.insert(0, [""] * len(times) + [rng.choice(["Building A", "Site 1"])] + [""] * (len(meters) - 1 + len(behind)))
        footer = []
        if self.quantity == "energy" and self.d.chance(0.07, "sum below"):
            sums = [number_of(sum(meter.load.amounts), meter.unit, 3600) for meter in meters]
            footer = [[self.word("total")] + [""] * (len(times) - 1) + sums]
        rows = self.wide_rows(meters, self.others)
        if way == "cell":
            rows = [(t, [Number(cell.value, cell.decimals, meters[column - len(times)].unit)
                         if isinstance(cell, Number) and 0 <= column - len(times) < len(meters) else cell
                         for column, cell in enumerate(row)]) for t, row in rows]
        return self.split(self.lines_above() + header, rows, footer)

    def wide_rows(self, meters, others):
        """[(instant, row)], hours before the change of the interval."""
        rows, load, of_hour = [], meters[0].load, max(1, 3600 // self.step)
        for i in range(len(meters[0].register or load.amounts)):
            t = load.begin + i * self.step
            rows += [(t, row + [""] * (len(self.flag_titles) + len(others))) for row in self.spring.get(t, [])]
            if i in self.dropped or (t < self.change and i % of_hour):
                continue
            if t < self.change:
                until, cells = t + 3600, [number_of(sum(m.load.amounts[i:i + of_hour]), m.unit, 3600) for m in meters]
            else:
                until, cells = t if meters[0].register else t + self.step, [meter.cell(i) for meter in meters]
            flags = [meters[0].flags[i]] if self.flag_titles else []
            if self.has_24_hours_a_day:
                wall = self.clock.local(t)
                stamps = self.stamps.of_walls(wall, wall + datetime.timedelta(seconds=until - t))
            else:
                stamps = self.stamps.cells(t, until)
            rows.append((t, stamps + cells + flags +
                         [cell(min(i, len(load.amounts) - 1), t) for _, cell in others]))
        return rows

    def long_files(self):
        """A row a meter, with its name; meters take turns, or come one after another."""
        way, unit = self.unit_way, self.meters[0].unit
        value = self.word(self.quantity) if way != "nowhere" or self.d.chance(0.5) else "Value"
        with_unit = way == "column"
        header = [self.stamps.titles + [self.word("meter"), title_of(value, unit, "(" if way == "header" else "none")] +
                  [self.word("unit")] * with_unit]
        self.d.traits.add("a row a meter")
        in_turn = len(self.meters) > 1 and self.d.chance(0.5, "one after another")
        turns = [[meter] for meter in self.meters] if in_turn else [self.meters]
        rows = []
        for group in turns:
            for i in range(len(group[0].register or group[0].load.amounts)):
                t = self.begin + i * self.step
                cells = self.stamps.cells(t, t if group[0].register else t + self.step)
                rows += [(t, cells + [meter.label, meter.cell(i)] + [meter.unit] * with_unit) for meter in group]
        return self.split(self.lines_above() + header, rows, [])

    def files_of_meters(self):
        self.d.traits.add("a file a meter")
        title, lines = self.word(self.quantity), self.lines_above()
        style = "(" if self.unit_way == "header" else "none"
        files = {}
        for meter in self.meters:
            # "Sähkönkulutus" is of electricity; the first word of each language is of anything.
            name = title if meter.utility == "electricity" else self.words[self.quantity][0]
            header = lines + [self.stamps.titles + [title_of(name, meter.unit, style)]]
            rows = [row for _, row in self.wide_rows([meter], [])]
            files[meter.label.replace(" ", "_") + ".csv"] = delimited(header + rows, self.habits)
        return files

    def split(self, header, rows, footer):
        """One file, one a month, or downloads that overlap; of a correction the later file has the right values."""
        d, rng = self.d, self.d.rng
        in_turn = "one after another" in d.traits
        order = -1 if not in_turn and d.chance(0.12, "newest first") else 1
        name, ending = rng.choice(["export", "data", "Lastgang", "usage"]), ".xlsx" if self.sheet else rng.choice([".csv", ".csv", ".txt"])

        def one(some):
            table = header + [row for _, row in some[::order]] + footer
            return workbook({self.sheet: table}) if self.sheet else delimited(table, self.habits)
        whole = in_turn or footer or self.step < 900
        way = "whole" if whole else rng.choices(["whole", "months", "overlap"], [76, 12, 12])[0]
        if way == "whole":
            return {name + ending: one(rows)}
        d.traits.add("a file a month" if way == "months" else "downloads overlap")
        parts = {}
        for t, row in rows:
            parts.setdefault(f"{self.clock.local(t):%Y-%m}", []).append((t, row))
        last = max(parts)
        if len(parts) > 1 and len(parts[last]) == len(self.meters if self.layout == "long" else [0]):
            parts[max(parts.keys() - {last})] += parts.pop(last)  # a register's reading at the end of the last month
        corrected = way == "overlap" and self.quantity != "register" and d.chance(0.4, "later file corrects")
        labels, files = sorted(parts), {}
        for label, following in zip(labels, labels[1:] + [None]):
            part = list(parts[label])
            if way == "overlap" and following:
                until = parts[following][0][0] + rng.randint(1, 3) * DAY
                ahead = [(t, row) for t, row in parts[following] if t < until]
                part += [(t, corrupted(row)) for t, row in ahead] if corrected else ahead
            files[f"{name}_{label}{ending}"] = one(part)
        return files


def undecided_table(d):
    """Nothing in it settles one thing: in which order a date is, which of two rows is whose, or by which clock it goes."""
    rng = d.rng
    what = rng.choice(["date order", "rows", "clock"])
    habits = Habits()
    if what == "date order":
        place = ("America/Toronto", "en", ".", ["%d/%m/%Y"])
        clock, begin, _ = d.span(place[0], 900)
        while True:
            wall = clock.local(begin)
            if wall.day <= 12 and wall.day != wall.month:
                break
            begin = clock.midnight((wall + datetime.timedelta(days=1)).date())
        # No stamp on a second date, as the one that follows would tell days from months.
        end = clock.midnight((clock.local(begin) + datetime.timedelta(hours=26)).date()) - 900
        right = "dd/mm/yyyy"
        answers = {"--date-order": right, "--time-format": right, "--time_format": right}
    else:
        place = rng.choice([p for p in PLACES if p[0].startswith("America" if what == "clock" else "")])
        clock, begin, end = d.span(place[0], 3600, months=12 if what == "clock" else 2)
        answers = {"--timezone": place[0]} if what == "clock" else {}
    step = 900 if what == "date order" else 3600
    stamps = date_and_clock(rng, place, clock, step)
    meters = [Meter("Main", d.load(clock, begin, end, step, "office"), "kWh")]
    if what == "rows":
        meters.append(Meter("Other", d.load(clock, begin, end, step, "house"), "kWh"))
    rows = []
    for i in range(len(meters[0].load.amounts)):
        t = begin + i * step
        rows += [stamps.cells(t, t + step) + [meter.cell(i)] for meter in meters]
    files = {"export.csv": delimited([stamps.titles + ["Consumption (kWh)"]] + rows, habits)}
    zone = "Europe/Berlin" if what == "clock" else place[0]
    return Export("table: undecided", zone, files, [[meter.truth(["Consumption"]) for meter in meters]], d.traits, what, answers)
