"""Loads of which everything is known: whole watt-hours (or litres) of each interval, and what they come to in a month."""
import bisect
import datetime
import math
import zoneinfo

EPOCH = datetime.datetime(1970, 1, 1)
DAY = 86400


class Clock:
    """Wall clock of a zone between two instants (seconds since 1970)."""

    def __init__(self, zone, begin, end):
        self.zone = zone
        info = zoneinfo.ZoneInfo(zone)

        def offset_at(t):
            return int(datetime.datetime.fromtimestamp(t, info).utcoffset().total_seconds())

        self.since, self.offsets = [begin - 3 * DAY], [offset_at(begin - 3 * DAY)]
        for t in range(begin - 3 * DAY, end + 3 * DAY, 1800):
            if offset_at(t) != self.offsets[-1]:
                self.since.append(t)
                self.offsets.append(offset_at(t))
        self.winter = min(self.offsets) if len(self.offsets) > 1 else self.offsets[0]

    def offset(self, t):
        return self.offsets[bisect.bisect_right(self.since, t) - 1]

    def local(self, t):
        return EPOCH + datetime.timedelta(seconds=t + self.offset(t))

    def instant(self, wall):
        """Of a wall time that occurs once."""
        seconds = int((wall - EPOCH).total_seconds())
        for offset in self.offsets:
            if self.offset(seconds - offset) == offset:
                return seconds - offset
        return seconds - self.winter

    def midnight(self, date):
        return self.instant(datetime.datetime.combine(date, datetime.time()))

    def changes(self):
        """Instants at which the clock is put forward or back, with by how many seconds."""
        return [(t, after - before) for t, before, after in
                zip(self.since[1:], self.offsets, self.offsets[1:])]

    def days(self, begin, end):
        """(date, begin, end) of each local day from begin to end."""
        date = self.local(begin).date()
        while self.midnight(date) < end:
            following = date + datetime.timedelta(days=1)
            yield date, max(begin, self.midnight(date)), min(end, self.midnight(following))
            date = following

    def complete_months(self, begin, end):
        """('YYYY-MM', begin, end) of each local month that lies wholly between."""
        first = self.local(begin).date().replace(day=1)
        while True:
            following = (first + datetime.timedelta(days=32)).replace(day=1)
            if self.midnight(following) > end:
                return
            if self.midnight(first) >= begin:
                yield f"{first:%Y-%m}", self.midnight(first), self.midnight(following)
            first = following


class Load:
    """amounts[i] thousandths (Wh, or litres) from begin + i * step on, for step seconds."""

    def __init__(self, begin, step, amounts):
        self.begin, self.step, self.amounts = begin, step, amounts
        self.end = begin + step * len(amounts)

    def total(self, begin, end):
        """In kWh (or m3)."""
        return sum(self.amounts[(begin - self.begin) // self.step:(end - self.begin) // self.step]) / 1000

    def block(self, begin, seconds):
        """Mean kW of a block, or None where the load does not cover it."""
        if begin < self.begin or begin + seconds > self.end or (begin - self.begin) % self.step:
            return None
        return self.total(begin, begin + seconds) * 3600 / seconds

    def peak(self, begin, end, seconds):
        return max(self.block(t, seconds) for t in range(begin, end - seconds + 1, seconds))

    def coarser(self, factor):
        sums = [sum(self.amounts[i:i + factor]) for i in range(0, len(self.amounts), factor)]
        return Load(self.begin, self.step * factor, sums)

    def register(self, first):
        """Readings in thousandths at begin, begin + step, …, end."""
        readings = [first]
        for amount in self.amounts:
            readings.append(readings[-1] + amount)
        return readings

    def plus(self, other):
        return Load(self.begin, self.step, [a + b for a, b in zip(self.amounts, other.amounts)])


def office(hour, weekday):
    return 0.25 if weekday > 4 or not 6 <= hour < 20 else 0.6 + 0.4 * math.sin(math.pi * (hour - 6) / 14)


def house(hour, weekday):
    return 0.2 + 0.5 * math.exp(-(hour - 7.5) ** 2 / 3) + 0.8 * math.exp(-(hour - 19) ** 2 / 8) + 0.05 * (weekday > 4)


def process(hour, weekday):
    return 0.9 if weekday < 6 else 0.75


def lighting(hour, weekday):
    return 0.0 if hour >= 22 or hour < 6 else 0.8


def night_storage(hour, weekday):
    return 1.0 if hour >= 22 or hour < 6 else 0.0


def solar(hour, weekday):
    return max(0.0, math.sin(math.pi * (hour - 5.5) / 14.5)) ** 1.5 if 5.5 <= hour <= 20 else 0.0


PROFILES = {"office": office, "house": house, "process": process, "lighting": lighting, "night storage": night_storage,
            "solar": solar}


def draw_load(rng, clock, begin, end, step, shape, mean_kW, quantum=1):
    """A load of that shape; amounts are whole multiples of the quantum (Wh), as a file with few decimals has them."""
    table = [PROFILES[shape]((h + 0.5) % 24, h // 24) for h in range(7 * 24)]
    scale = mean_kW * 1000 * step / 3600 / (sum(table) / len(table)) / quantum
    season, phase = rng.uniform(0, 0.3), rng.uniform(0, 365)
    spread = 0.5 if shape in ("house", "solar") else 0.12
    amounts = []
    day, level = None, 1.0
    for t in range(begin, end, step):
        wall = t + clock.offset(t)
        if wall // DAY != day:
            day = wall // DAY
            level = (1 + season * math.cos((day - phase) / 58.1)) * rng.uniform(0.9, 1.1)
            if shape == "solar":
                level *= rng.choice([0.2, 0.6, 1.0, 1.1])
        part = table[(day + 3) % 7 * 24 + wall // 3600 % 24]
        amounts.append(quantum * round(scale * part * level * rng.uniform(1 - spread, 1 + spread)))
    return Load(begin, step, amounts)


def electric_car(rng, load, kW):
    """Two evenings a week, three hours at that power: far above what the house draws else."""
    amounts = list(load.amounts)
    for t in range(load.begin + 19 * 3600, load.end - 4 * 3600, DAY):
        if rng.random() < 2 / 7:
            first = (t - load.begin) // load.step
            for i in range(first, first + 3 * 3600 // load.step):
                amounts[i] += round(kW * 1000 * load.step / 3600)
    return Load(load.begin, load.step, amounts)
