"""The ways in which files write when an interval was: a column or several, by several clocks."""
import dataclasses
import datetime
from typing import Callable

from tables import Moment
from words import word

SECOND = datetime.timedelta(seconds=1)
# Short names that both halves of the year have there.
SUFFIXES = {"America/New_York": ("EST", "EDT"), "America/Chicago": ("CST", "CDT"), "America/Denver": ("MST", "MDT"),
            "America/Los_Angeles": ("PST", "PDT"), "Europe/Berlin": ("MEZ", "MESZ"), "Europe/Paris": ("CET", "CEST"),
            "Europe/Amsterdam": ("CET", "CEST"), "Europe/Madrid": ("CET", "CEST"), "Europe/Rome": ("CET", "CEST"),
            "Europe/Stockholm": ("CET", "CEST"), "Europe/London": ("GMT", "BST")}


@dataclasses.dataclass
class Stamps:
    """Titles of the columns, and the cells of an interval."""
    kind: str
    titles: list
    cells: Callable       # (begin, end) -> cells
    of_walls: Callable = None  # (wall of the begin, wall of the end) -> cells, where a naive local clock is written


def whole_day_end(wall, date_format, separator, time_format="%H:%M"):
    """An end at midnight belongs to the day before, as 24:00."""
    if wall.time() == datetime.time():
        return (wall - SECOND).strftime(date_format) + separator + time_format.replace("%H", "24").replace(
            "%M", "00").replace("%S", "00")
    return wall.strftime(date_format + separator + time_format)


def clock_format(rng, zone):
    """Of the time of a day."""
    if zone.startswith("America") and rng.random() < 0.5:
        return rng.choice(["%I:%M %p", "%-I:%M %p", "%I:%M:%S %p"])
    return rng.choice(["%H:%M", "%H:%M", "%H:%M:%S"])


def one_column(rng, place, clock, step, shift=0, title=None):
    """Starts or ends in one column, by the clock on the wall."""
    zone, language, _, formats = place
    form = rng.choice(formats) + " " + clock_format(rng, zone)
    if rng.random() < 0.1:
        form = rng.choice(["%Y-%m-%dT%H:%M:%S", "%Y%m%d%H%M", "%Y-%m-%d %H:%M:%S.000"])
    ends = rng.random() < 0.4
    moved = datetime.timedelta(seconds=shift)

    def of_walls(begin, end):
        return [Moment((end if ends else begin) + moved, form)]
    def cells(begin, end):
        return of_walls(clock.local(begin), clock.local(end))
    return Stamps("ends" if ends else "starts", [title or word(rng, language, "time")], cells, of_walls)


def date_and_clock(rng, place, clock, step):
    zone, language, _, formats = place
    date_form, clock_form = rng.choice(formats), clock_format(rng, zone)
    ends = rng.random() < 0.4

    def of_walls(begin, end):
        wall = end if ends else begin
        return [Moment(wall, date_form), wall.strftime(clock_form)]
    def cells(begin, end):
        return of_walls(clock.local(begin), clock.local(end))
    titles = [word(rng, language, "date"), word(rng, language, "clock")]
    return Stamps("date and clock", titles if titles[0] != titles[1] else [titles[0], titles[0] + " 2"], cells, of_walls)


def with_offset(rng, place, clock, step):
    ends = rng.random() < 0.3
    colon = rng.random() < 0.8
    separator = rng.choice("T ")

    def cells(begin, end):
        t = end if ends else begin
        hours, minutes = divmod(abs(clock.offset(t)) // 60, 60)
        sign = "+" if clock.offset(t) >= 0 else "-"
        return [clock.local(t).strftime(f"%Y-%m-%d{separator}%H:%M:%S") + f"{sign}{hours:02d}{':' if colon else ''}{minutes:02d}"]
    return Stamps("offsets", [word(rng, place[1], "time")], cells)


def utc(rng, place, clock, step):
    ends = rng.random() < 0.3
    title, form = rng.choice([("timestamp_utc", "%Y-%m-%d %H:%M:%S"), ("Time (UTC)", "%Y-%m-%d %H:%M"),
                              ("timestamp", "%Y-%m-%dT%H:%M:%SZ"), ("time", "%Y-%m-%dT%H:%M:%S.000Z"),
                              ("datetime", "%Y-%m-%d %H:%M:%S UTC")])

    def cells(begin, end):
        return [(datetime.datetime(1970, 1, 1) + SECOND * (end if ends else begin)).strftime(form)]
    return Stamps("UTC", [title], cells)


def unix(rng, place, clock, step):
    factor = rng.choice([1, 1, 1000])
    return Stamps("unix", [rng.choice(["timestamp", "time", "unixtime", "epoch"])],
                  lambda begin, end: [str(begin * factor)])


def suffix(rng, place, clock, step):
    zone, language, _, formats = place
    winter, summer = SUFFIXES[zone]
    form = rng.choice(formats) + " " + clock_format(rng, zone)
    ends = rng.random() < 0.4

    def cells(begin, end):
        t = end if ends else begin
        return [clock.local(t).strftime(form) + " " + (winter if clock.offset(t) == clock.winter else summer)]
    return Stamps("zone suffix", [word(rng, language, "time")], cells)


def from_to_cell(rng, place, clock, step):
    form = rng.choice(place[3]) + " %H:%M"
    between = rng.choice([" to ", " - ", " – ", " bis "] if place[1] == "de" else [" to ", " - ", " – "])

    def of_walls(begin, end):
        return [begin.strftime(form) + between + end.strftime(form)]
    def cells(begin, end):
        wall = clock.local(begin)
        return of_walls(wall, wall + SECOND * (end - begin))
    return Stamps("from–to cell", [word(rng, place[1], "period")], cells, of_walls)


def from_to_columns(rng, place, clock, step):
    zone, language, _, formats = place
    form = rng.choice(formats) + " " + clock_format(rng, zone)

    def of_walls(begin, end):
        return [Moment(begin, form), Moment(end, form)]
    def cells(begin, end):
        wall = clock.local(begin)
        return of_walls(wall, wall + SECOND * (end - begin))
    return Stamps("from, to", [word(rng, language, "start"), word(rng, language, "end")], cells, of_walls)


def date_from_to(rng, place, clock, step):
    zone, language, _, formats = place
    date_form = rng.choice(formats)
    last_minute = 60 if rng.random() < 0.3 else 0  # 00:00 to 00:59

    def of_walls(begin, end):
        return [Moment(begin, date_form), begin.strftime("%H:%M"), (end - last_minute * SECOND).strftime("%H:%M")]
    def cells(begin, end):
        wall = clock.local(begin)
        return of_walls(wall, wall + SECOND * (end - begin))
    return Stamps("date, from, to", [word(rng, language, "date"), word(rng, language, "start"), word(rng, language, "end")],
                  cells, of_walls)


def hour_numbers(rng, place, clock, step):
    """1 to 24 by the clock on the wall, or counted through days of 23 and 25 hours; half-hours to 48 or 50."""
    date_form = rng.choice(place[3])
    form = rng.choice(["{}", "{}", "{:02d}", "H{:02d}", "{:02d}:00"]) if step == 3600 else "{}"
    counted = rng.random() < 0.5 or step != 3600

    def number(begin):
        wall = clock.local(begin)
        if counted:
            return (begin - clock.midnight(wall.date())) // step + 1
        return wall.hour + 1
    def cells(begin, end):
        return [Moment(clock.local(begin), date_form), form.format(number(begin))]
    title = word(rng, place[1], "clock") if step == 3600 else "Settlement Period"
    return Stamps("hour numbers", [word(rng, place[1], "date"), title], cells)


def ends_at_24(rng, place, clock, step):
    form = rng.choice(place[3])
    apart = rng.random() < 0.5

    def of_walls(begin, end):
        text = whole_day_end(end, form, "|")
        return text.split("|") if apart else [text.replace("|", " ")]
    def cells(begin, end):
        wall = clock.local(begin)
        return of_walls(wall, wall + SECOND * (end - begin))
    titles = [word(rng, place[1], "date"), word(rng, place[1], "end")] if apart else [word(rng, place[1], "time")]
    return Stamps("24:00", titles, cells, of_walls)


def winter_time(rng, place, clock, step, says_so):
    """A clock that is never put forward; the header says so, or both changes of the year do."""
    zone, language, _, formats = place
    form = rng.choice(formats) + " %H:%M"
    hours = clock.winter // 3600
    title = word(rng, language, "time")
    if says_so:  # "CET" would be said of a clock that is changed, too
        title += f" ({rng.choice([f'UTC{hours:+d}', f'GMT{hours:+d}', 'Winterzeit' if language == 'de' else 'standard time'])})"

    def cells(begin, end):
        return [Moment(datetime.datetime(1970, 1, 1) + SECOND * (begin + clock.winter), form)]
    return Stamps("winter time", [title], cells)


def beside_the_grid(rng, place, clock, step):
    """A second late or early, or some seconds at random: when a logger got round to it."""
    constant = rng.choice([1, -1, 0, 0])
    form = rng.choice(place[3]) + " %H:%M:%S"

    def of_walls(begin, end):
        return [Moment(end + SECOND * (constant or rng.randint(0, 40)), form)]
    def cells(begin, end):
        return of_walls(clock.local(begin), clock.local(end))
    return Stamps("seconds beside", [word(rng, place[1], "time")], cells, of_walls)


def draw_stamps(rng, place, clock, step, register):
    """Registers are read at an instant, so they have no beginnings and no numbers of hours."""
    zone = place[0]
    kinds = [(one_column, 30), (date_and_clock, 14), (with_offset, 8), (utc, 8), (unix, 4), (beside_the_grid, 5)]
    if not register:
        kinds += [(from_to_cell, 5), (from_to_columns, 7), (date_from_to, 6), (ends_at_24, 7)]
        if step >= 1800:
            kinds += [(hour_numbers, 7)]
    if zone in SUFFIXES:
        kinds += [(suffix, 5)]
    pick = rng.choices([kind for kind, _ in kinds], [weight for _, weight in kinds])[0]
    return pick(rng, place, clock, step)
