"""Exports of American and Australian portals, and the standards Green Button (ESPI) and NEM12."""
import datetime

from export import Export
from loads import Clock, DAY
from meters import Meter, draw_gaps
from portals_europe import intervals, text_export, thinned
from tables import Habits, Moment, Number

ZONES = ["America/New_York", "America/Chicago", "America/Denver", "America/Los_Angeles"]
MINUTE = datetime.timedelta(minutes=1)


def whole_day(date):
    return datetime.datetime.combine(date, datetime.time())


def opower(d):
    """Lines of name and address; TYPE, DATE, START TIME, END TIME: an hour ends at :59."""
    step = d.rng.choice([900, 1800, 3600])
    clock, begin, end = d.span(d.rng.choice(ZONES), step)
    meter = Meter("USAGE", d.load(clock, begin, end, step, quantum=10), decimals=2)
    given = Meter("EXPORT", d.load(clock, begin, end, step, "solar", quantum=10), decimals=2) if d.chance(0.25, "feed-in") else None
    left_out, _ = thinned(d, meter)
    if given:
        titles, labels = ["IMPORT (kWh)", "EXPORT (kWh)", "NOTES"], ["IMPORT"]
        given.missing |= left_out
    else:
        titles = d.rng.choice([["USAGE", "UNITS", "COST", "NOTES"], ["USAGE (kWh)", "COST", "NOTES"]])
        labels = ["USAGE", "Electric usage"]
    rows = [["Name", "JANE DOE"], ["Address", "1 MAIN ST, SPRINGFIELD 62701"], ["Account Number", d.digits(10)],
            ["Service", "Service 1"], [], ["TYPE", "DATE", "START TIME", "END TIME"] + titles]
    form = d.rng.choice(["%Y-%m-%d", "%Y-%m-%d", "%-m/%-d/%Y"])
    for i, t, _ in intervals(meter, left_out):
        wall = clock.local(t)
        last = wall + datetime.timedelta(seconds=step) - MINUTE
        cost = f"${meter.load.amounts[i] * 0.00031:.2f}"
        rest = {"USAGE": [meter.cell(i), "kWh", cost, ""], "USAGE (kWh)": [meter.cell(i), cost, ""]}.get(titles[0])
        rows.append(["Electric usage", Moment(wall, form), f"{wall:%H:%M}", f"{last:%H:%M}"] +
                    (rest or [meter.cell(i), given.cell(i), ""]))
    d.traits |= {"lines above the header", "columns that are no meters"}
    truths = [meter.truth(labels)] + ([given.truth(["EXPORT"])] if given else [])
    return text_export("US Opower (PG&E, ComEd)", clock.zone, "electric_usage_interval_data.csv", rows, Habits(), d, truths)


def edison(d):
    """Lines above, and a period in a cell or two."""
    clock, begin, end = d.span("America/Los_Angeles", 3600)
    meter = Meter("Usage", d.load(clock, begin, end, 3600, quantum=10), decimals=d.rng.choice([2, 3]))
    rows = [["Energy Usage Information"], ["For location: 1 Main St"], [], ["Meter Reading Information"],
            ["Type of readings: Electricity"], [], ["Detailed Usage"], [f"Start date: {clock.local(begin):%Y-%m-%d %H:%M:%S}"], []]
    step = datetime.timedelta(hours=1)
    if d.chance(0.5):
        rows.append(["Energy consumption time period", "Usage(Real energy in kilowatt-hours)", "Reading quality"])
        for i, t, _ in intervals(meter):
            wall = clock.local(t)
            rows.append([f"{wall:%Y-%m-%d %H:%M:%S} to {wall + step:%Y-%m-%d %H:%M:%S}", meter.cell(i), ""])
        d.traits |= {"stamps: from–to cell", "lines above the header"}
        return text_export("US SCE", clock.zone, "SCE_Usage.csv", rows, Habits(quotes_all=d.chance(0.5)), d,
                           [meter.truth(["Usage", "Real energy"])])
    received = Meter("Received", d.load(clock, begin, end, 3600, "solar", quantum=10), decimals=2)
    rows[-1:] = [["Date", "Energy Consumption time Period Start", "Energy Consumption time Period End",
                  "Delivered (kWh)", "Received (kWh)"]]
    for i, t, _ in intervals(meter):
        wall = clock.local(t)
        rows.append([f"{wall:%m/%d/%Y} ", f"{wall:%m/%d/%Y %I:%M%p} ", f"{wall + step:%m/%d/%Y %I:%M%p} ", meter.cell(i), received.cell(i)])
    d.traits |= {"feed-in", "lines above the header"}
    return text_export("US SCE", clock.zone, "SCE_Usage.csv", rows, Habits(quotes_all=True), d,
                       [meter.truth(["Delivered"]), received.truth()])


def san_diego(d):
    """Consumption, generation, and the net of both."""
    clock, begin, end = d.span("America/Los_Angeles", 900)
    taken, made = d.load(clock, begin, end, 900, "house"), d.load(clock, begin, end, 900, "solar")
    net = type(taken)(begin, 900, [a - b for a, b in zip(taken.amounts, made.amounts)])
    number = d.digits(8)
    rows = [["Name", "JANE DOE"], ["Address", "1 MAIN ST"], ["Account Number", d.digits(10)], ["Disclaimer", "not for billing"],
            ["Title", "Detailed usage"], ["Resource", "Electricity"], ["Meter Number", number], ["Reading Start",
             f"{clock.local(begin):%-m/%-d/%Y}"], ["Reading End", f"{clock.local(end - 1):%-m/%-d/%Y}"], ["UOM", "kWh"], [],
            ["Meter Number", "Date", "Start Time", "Duration", "Consumption", "Generation", "Net"]]
    for i, t in enumerate(range(begin, end, 900)):
        wall = clock.local(t)
        rows.append([number, f"{wall:%-m/%-d/%Y}", f"{wall:%-I:%M %p}", "15"] +
                    [Number(load.amounts[i] / 1000, 4) for load in (taken, made, net)])
    d.traits |= {"feed-in", "unit: above", "lines above the header"}
    truths = [Meter("Consumption", taken).truth(), Meter("Generation", made).truth(), Meter("Net", net).truth(required=False)]
    truths[2].has_shape = False
    return text_export("US SDG&E", clock.zone, "Electric_15_Minute.csv", rows, Habits(), d, truths)


def smart_meter_texas(d):
    clock, begin, end = d.span("America/Chicago", 900)
    meter = Meter("Consumption", d.load(clock, begin, end, 900))
    given = Meter("Surplus Generation", d.load(clock, begin, end, 900, "solar")) if d.chance(0.3, "feed-in") else None
    left_out, marks = thinned(d, meter, ("A", "E", ""))
    if given:
        given.missing |= left_out
    point = "'1044372000" + d.digits(7)
    rows = [["ESIID", "USAGE_DATE", "REVISION_DATE", "USAGE_START_TIME", "USAGE_END_TIME", "USAGE_KWH", "ESTIMATED_ACTUAL",
             "CONSUMPTION_SURPLUSGENERATION"]]
    for m in [meter] + [given] * (given is not None):
        for i, t, _ in intervals(meter, left_out):
            wall = clock.local(t)
            rows.append([point, f"{wall:%m/%d/%Y}", f"{wall + datetime.timedelta(days=2):%m/%d/%Y} 05:12:44", f" {wall:%H:%M}",
                         f" {wall + 15 * MINUTE:%H:%M}", m.cell(i), marks[i], m.label])
    if given:
        d.traits.add("one after another")
    return text_export("US Smart Meter Texas", clock.zone, "IntervalData.csv", rows, Habits(), d,
                       [m.truth([m.label, "USAGE", point]) for m in (meter, given) if m])


def cooperative(d):
    """From and to in one cell, the unit in words."""
    clock, begin, end = d.span(d.rng.choice(ZONES), 3600)
    meter = Meter("Usage", d.load(clock, begin, end, 3600))
    rows = [[" Usage Information"], [" Energy consumption time period", "Usage(Real energy in kilowatt-hours)", "Events occurred"]]
    for i, t, _ in intervals(meter):
        wall = clock.local(t)
        rows.append([f" {wall:%Y-%m-%d %H:%M} to {wall + 60 * MINUTE:%Y-%m-%d %H:%M}", meter.cell(i), "", ""])
    d.traits.add("stamps: from–to cell")
    return text_export("US cooperative", clock.zone, "usage.csv", rows, Habits(), d, [meter.truth(["Usage", "Real energy"])])


def american_columns(d):
    """A row a day, 24 or 96 columns with hour endings, and the sum of the day in a column."""
    step = d.rng.choice([900, 3600])
    clock, begin, end = d.span(d.rng.choice(ZONES), step)
    meter = Meter("kWh", d.load(clock, begin, end, step))
    per_day = DAY // step
    titles = ([f"Hr {n}" for n in range(1, 25)] if step == 3600 and d.chance(0.5) else
              [f"{n * step // 3600:02d}{n * step // 60 % 60:02d}" for n in range(1, per_day + 1)])
    number = d.digits(9)
    rows = [["Meter ID", "Date", "UOM"] + titles + ["Daily Total"]]
    hour = 3600 // step
    for date, first, last in clock.days(begin, end):
        values = [meter.cell((t - begin) // step) for t in range(first, last, step)]
        total = sum(value.value for value in values)
        two = 2 * hour if len(values) < per_day else hour
        if len(values) < per_day:
            values[two:two] = [""] * hour
        elif len(values) > per_day:
            values = values[:two] + [Number(a.value + b.value, 3) for a, b in zip(values[two:2 * two], values[2 * two:3 * two])] + values[3 * two:]
            meter.has_shape = False
        rows.append([number, Moment(whole_day(date), "%m/%d/%Y"), "kWh"] + values + [Number(total, 3)])
    d.traits.add("a row a day")
    return text_export("US 24/96 columns", clock.zone, "interval.csv", rows, Habits(), d, [meter.truth([number, "kWh", "interval"])])


def gas_utility(d):
    clock, begin, end = d.span(d.rng.choice(ZONES), 3600)
    unit = d.rng.choice(["therm", "CCF", "MMBtu"])
    meter = Meter("Natural Gas", d.load(clock, begin, end, 3600, "office"), unit, "gas", decimals=6)
    rows = [["Date", "Hour Ending", f"Natural Gas ({unit}{'s' if unit == 'therm' else ''})", "Cost ($)"]]
    for i, t, _ in intervals(meter):
        rows.append([f"{clock.local(t):%m/%d/%Y}", str(clock.local(t).hour + 1), meter.cell(i), Number(meter.load.amounts[i] * 5e-5, 4)])
    d.traits |= {"gas", "columns that are no meters", "stamps: hour numbers"}
    return text_export("US gas", clock.zone, "gas.csv", rows, Habits(), d, [meter.truth()])


def green_button(d):
    """ESPI: blocks of readings, one or more flows; reactive energy may stand beside."""
    rng = d.rng
    step = rng.choice([900, 1800, 3600])
    clock, begin, end = d.span(rng.choice(ZONES + ["America/Toronto"]), step)
    power_of_ten, uom = rng.choice([(0, 72), (0, 72), (-3, 72), (0, 38)])
    meters = [(Meter("Electricity", d.load(clock, begin, end, step), "W" if uom == 38 else "Wh"), uom, power_of_ten, 1, 0)]
    if d.chance(0.25, "feed-in"):
        meters.append((Meter("Export", d.load(clock, begin, end, step, "solar"), "Wh"), 72, 0, 19, 0))
    reactive = d.chance(0.2, "reactive energy beside")
    if d.chance(0.15, "gas"):
        meters = [(Meter("Gas", d.load(clock, begin, end, step, "office"), "therm", "gas"), 169, -6, 1, 1)]
    flagged = {}
    main = meters[0][0]
    if d.chance(0.25, "quality flags"):
        flagged = dict.fromkeys(draw_gaps(rng, len(main.load.amounts), DAY // step), rng.choice([8, 9, 14]))
    if d.chance(0.15, "rows missing"):
        main.missing |= draw_gaps(rng, len(main.load.amounts), DAY // step)
    own = 'xmlns="http://naesb.org/espi"'
    base = "/espi/1_1/resource/Subscription/9/UsagePoint"
    out = ['<?xml version="1.0" encoding="UTF-8"?>\n<feed xmlns="http://www.w3.org/2005/Atom"><title>Usage</title>']
    channels = meters + ([(meters[0][0], 73, 0, 1, 0)] if reactive else [])
    for number, (meter, unit, power, flow, kind) in enumerate(channels, 1):
        point = f"{base}/{1 if kind == 0 else 2}"
        reading = f"{point}/MeterReading/{number}"
        if number == 1:
            out.append(f'<entry><link rel="self" href="{point}"/><title>{meter.label}</title><content><UsagePoint {own}>'
                       f"<ServiceCategory><kind>{kind}</kind></ServiceCategory></UsagePoint></content></entry>")
        title = "Reactive" if unit == 73 else meter.label
        out.append(f'<entry><link rel="self" href="{reading}"/><link rel="up" href="{point}/MeterReading"/><link rel="related" '
                   f'href="/espi/1_1/resource/ReadingType/{number}"/><title>{title}</title><content><MeterReading {own}/>'
                   "</content></entry>")
        out.append(f'<entry><link rel="self" href="/espi/1_1/resource/ReadingType/{number}"/><content><ReadingType {own}>'
                   f"<accumulationBehaviour>{12 if unit == 38 else 4}</accumulationBehaviour><commodity>{7 if kind else 1}</commodity>"
                   f"<flowDirection>{flow}</flowDirection><intervalLength>{step}</intervalLength>"
                   f"<powerOfTenMultiplier>{power}</powerOfTenMultiplier><uom>{unit}</uom></ReadingType></content></entry>")
        for date, first, last in clock.days(begin, end):
            out.append(f'<entry><link rel="self" href="{reading}/IntervalBlock/{date:%Y%m%d}"/><link rel="up" href="{reading}/'
                       f'IntervalBlock"/><content><IntervalBlock {own}><interval><duration>{last - first}</duration><start>{first}'
                       "</start></interval>")
            for t in range(first, last, step):
                i = (t - begin) // step
                if i in meter.missing:
                    continue
                value = round(meter.cell(i).value * 10 ** -power * (0.3 if unit == 73 else 1))
                quality = f"<ReadingQuality><quality>{flagged[i]}</quality></ReadingQuality>" if i in flagged and meter is main else ""
                out.append(f"<IntervalReading>{quality}<timePeriod><duration>{step}</duration><start>{t}</start></timePeriod>"
                           f"<value>{value}</value></IntervalReading>")
            out.append("</IntervalBlock></content></entry>\n")
    out.append("</feed>")
    return Export("Green Button", clock.zone, {"feed.xml": "".join(out).encode()},
                  [[meter.truth([meter.label, f"MeterReading {number}"]) for number, (meter, *_) in enumerate(meters, 1)]], d.traits)


def nem12(d):
    """Records 200 and 300: a day in a row, always by standard time; 400 has the quality of parts of a day."""
    rng = d.rng
    zone = rng.choice(["Australia/Sydney", "Australia/Melbourne", "Australia/Brisbane"])
    step = rng.choice([300, 900, 1800])
    clock, begin, end = d.span(zone, 1800, fixed=True, months=2 if step == 300 else None)
    standard = Clock("Etc/GMT-10", begin, end)
    unit = rng.choice(["KWH", "KWH", "kWh", "WH"])
    meters = [Meter("E1", d.load(clock, begin, end, step), "Wh" if unit == "WH" else "kWh")]
    if d.chance(0.4, "feed-in"):
        meters.append(Meter("B1", d.load(clock, begin, end, step, "solar"), meters[0].unit))
    nmi = "6" + d.digits(9)
    configuration = "".join(m.label for m in meters)
    rows = [["100", "NEM12", f"{standard.local(end):%Y%m%d%H%M}", "MDP1", "RETAIL1"]]
    for meter in meters:
        rows.append(["200", nmi, configuration, meter.label, meter.label, "N1", d.digits(8), unit, str(step // 60), ""])
        for date, first, last in standard.days(begin, end):
            values = [meter.cell((t - begin) // step) for t in range(first, last, step)]
            estimated = d.rng.random() < 0.02
            quality = "V" if estimated else "A"
            rows.append(["300", f"{date:%Y%m%d}"] + values + [quality, "", "", f"{date:%Y%m%d}120000", ""])
            if estimated:
                half = len(values) // 2
                rows += [["400", "1", str(half), "A", "", ""], ["400", str(half + 1), str(len(values)), "E52", "", ""]]
    rows.append(["900"])
    d.traits |= {"a row a day", "winter time all year"}
    return text_export("AU NEM12", zone, f"NEM12_{nmi}.csv", rows, Habits(newline="\r\n"), d,
                       [m.truth([m.label, nmi + " " + m.label]) for m in meters])


PORTALS = [opower, opower, edison, san_diego, smart_meter_texas, cooperative, american_columns, gas_utility, green_button,
           green_button, nem12, nem12]
