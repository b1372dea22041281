"""What devices and programs write: trend logs, databases, home automation, inverters, notebooks."""
import datetime
import json

from export import Export
from loads import Load
from meters import Meter, draw_gaps, make_register
from portals_europe import HOUR, intervals, text_export
from portals_overseas import ZONES
from stamps import SUFFIXES
from tables import Habits, Moment, Number, delimited, workbook

EUROPE = ["Europe/Berlin", "Europe/Amsterdam", "Europe/Paris", "Europe/Madrid", "Europe/Rome", "Europe/Stockholm"]


def instant(t):
    return datetime.datetime(1970, 1, 1) + datetime.timedelta(seconds=t)


def niagara_history(d):
    clock, begin, end = d.span(d.rng.choice(ZONES), 900)
    winter, summer = SUFFIXES[clock.zone]
    meter = Meter("Value", d.load(clock, begin, end, 900), d.rng.choice(["kWh", "kW"]))
    title = d.rng.choice(["Value (kW-hr)", "Value (kWh)"]) if meter.unit == "kWh" else "Value (kW)"
    lost = draw_gaps(d.rng, len(meter.load.amounts), 96) if d.chance(0.3, "quality flags") else set()
    meter.missing |= lost
    rows = [["Timestamp", "Trend Flags", "Status", title]]
    for i, _, e in intervals(meter):
        stamp = f"{clock.local(e):%d-%b-%y %I:%M:%S %p} {winter if clock.offset(e) == clock.winter else summer}"
        rows.append([stamp, "{ }", "{null}" if i in lost else "{ok}", "null" if i in lost else meter.cell(i)])
    d.traits.add("stamps: zone suffix")
    return text_export("BMS Niagara", clock.zone, "history.csv", rows, Habits(), d, [meter.truth(["Value", "history"])])


def trend_log(d):
    """Date, time, points; a second or some late."""
    clock, begin, end = d.span(d.rng.choice(ZONES + ["Europe/London"]), 900)
    names = d.rng.sample(["main_kw", "ahu1_kw", "chiller_plant", "lifts"], d.rng.choice([1, 2]))
    meters = [Meter(name, d.load(clock, begin, end, 900), "kW") for name in names]
    form = "%m/%d/%Y" if clock.zone.startswith("America") else "%d/%m/%Y"
    late = d.rng.choice([0, 1, 1, 2, "some"])
    if late:
        d.traits.add("stamps: seconds beside")
    head = [["#" + m.label + " (kW)" for m in meters]] if d.chance(0.5) else [[m.label + "\n(kW)" for m in meters]]
    if "\n" in head[0][0]:
        d.traits.add("unit: line break")
    rows = [["Date", "Time"] + head[0] + ["OAT (°F)"]]
    for i, _, e in intervals(meters[0]):
        wall = clock.local(e) + datetime.timedelta(seconds=d.rng.randint(0, 20) if late == "some" else late)
        rows.append([Moment(wall, form), f"{wall:%I:%M:%S %p}"] + [m.cell(i) for m in meters] + [Number(50 + i % 37, 1)])
    d.traits.add("columns that are no meters")
    return text_export("BMS trend log", clock.zone, "trend.csv", rows, Habits(), d, [m.truth() for m in meters])


def influx(d):
    """Annotated CSV: a table a series, the unit in the field."""
    clock, begin, end = d.span(d.rng.choice(EUROPE), 900)
    unit = d.rng.choice(["kW", "W", "kWh"])
    names = d.rng.sample(["main", "workshop", "kitchen"], d.rng.choice([1, 2]))
    meters = [Meter(name, d.load(clock, begin, end, 900), unit) for name in names]
    rows = [["#group", "false", "false", "true", "true", "false", "false", "true", "true"],
            ["#datatype", "string", "long", "dateTime:RFC3339", "dateTime:RFC3339", "dateTime:RFC3339", "double", "string", "string"],
            ["#default", "last", "", "", "", "", "", "", ""],
            ["", "result", "table", "_start", "_stop", "_time", "_value", "_field", "entity_id"]]
    form = "%Y-%m-%dT%H:%M:%SZ"
    ends = d.chance(0.7)  # as aggregateWindow() writes unless it is told otherwise
    for table, meter in enumerate(meters):
        for i, t, e in intervals(meter):
            rows.append(["", "", str(table), f"{instant(begin):{form}}", f"{instant(end):{form}}", f"{instant(e if ends else t):{form}}",
                         meter.cell(i), unit, meter.label])
    if len(meters) > 1:
        d.traits.add("one after another")
    d.traits.add("unit: type column")
    return text_export("InfluxDB annotated CSV", clock.zone, "query.csv", rows, Habits(newline="\r\n"), d, [m.truth() for m in meters])


def home_assistant_history(d):
    """A register, logged when it changes, some seconds after the minute; unavailable now and then."""
    clock, begin, end = d.span(d.rng.choice(EUROPE), 300, months=1.1)
    load = d.load(clock, begin, end, 300, d.rng.choice(["house", "office", "lighting"]), mean_kW=d.rng.uniform(1, 20))
    title = "sensor.meter_total_kwh"
    readings = load.register(d.rng.randrange(10**6, 10**8))
    rows, last = [["entity_id", "state", "last_changed"]], None
    for i, reading in enumerate(readings):
        t = begin + 300 * i
        shown = f"{reading // 10 * 10 / 1000:.2f}"
        if shown == last and 0 < i < len(readings) - 1:
            continue
        last = shown
        if d.rng.random() < 0.003:
            rows.append([title, d.rng.choice(["unavailable", "unknown"]), f"{instant(t + 20):%Y-%m-%dT%H:%M:%S}.120Z"])
        rows.append([title, shown, f"{instant(t):%Y-%m-%dT%H:%M:%S}.{d.rng.randint(0, 999):03d}Z"])
    truth = Meter(title, load).truth()
    truth.has_shape, truth.slack_kWh = False, 0.05
    d.traits |= {"register", "logged on change"}
    return text_export("Home Assistant history", clock.zone, "history.csv", rows, Habits(), d, [truth])


def home_assistant_energy(d):
    """The energy dashboard's download: a row a source, a column an hour."""
    clock, begin, end = d.span(d.rng.choice(EUROPE), 3600, months=d.rng.choice([1.1, 2]))
    meters = [Meter("sensor.grid_in", d.load(clock, begin, end, 3600)), Meter("sensor.grid_out", d.load(clock, begin, end, 3600, "solar"))]
    kinds = ["grid_consumption", "grid_return"]
    rows = [["entity_id", "type", "unit"] + [f"{instant(t):%Y-%m-%dT%H:%M:%S}.000Z" for t in range(begin, end, 3600)]]
    for meter, kind in zip(meters, kinds):
        rows.append([meter.label, kind, "kWh"] + [meter.cell(i) for i, _, _ in intervals(meter)])
    d.traits |= {"a column a time", "feed-in"}
    return text_export("Home Assistant energy", clock.zone, "energy.csv", rows, Habits(), d, [m.truth() for m in meters])


def emoncms(d):
    clock, begin, end = d.span(d.rng.choice(EUROPE + ["Europe/London"]), 600, months=1.1)
    meters = [Meter(name, d.load(clock, begin, end, 600), "W") for name in d.rng.sample(["use", "cooker", "lights"], d.rng.choice([1, 2]))]
    rows = [["Timestamp (UTC)"] + [f"{m.label} (W)" for m in meters]]
    for i, t, _ in intervals(meters[0]):
        rows.append([str(t)] + [m.cell(i) for m in meters])
    d.traits.add("stamps: unix")
    return text_export("emoncms", clock.zone, "feeds.csv", rows, Habits(), d, [m.truth() for m in meters])


def grafana(d):
    """Series joined by time, the unit in each cell; perhaps a line for a spreadsheet above."""
    clock, begin, end = d.span(d.rng.choice(EUROPE + ZONES), 1800)
    unit = d.rng.choice(["kW", "kWh", "W"])
    meters = [Meter(name, d.load(clock, begin, end, 1800), unit) for name in d.rng.sample(["Main", "AHU", "Lifts"], d.rng.choice([1, 2, 3]))]
    rows = [["sep=,"]] if d.chance(0.3, "lines above the header") else []
    rows.append(["Time"] + [m.label for m in meters])
    for i, t, _ in intervals(meters[0]):
        cells = [Number(m.cell(i).value, m.cell(i).decimals, unit) for m in meters]
        rows.append([Moment(clock.local(t), "%Y-%m-%d %H:%M:%S")] + cells)
    d.traits.add("unit: cell")
    habits = Habits(space=d.rng.choice([" ", " ", "\u00a0"]), trims_zeros=True)
    if rows[0] == ["sep=,"]:
        text = b"sep=,\n" + delimited(rows[1:], habits)
        return Export("Grafana", clock.zone, {"panel.csv": text}, [[m.truth() for m in meters]], d.traits)
    return text_export("Grafana", clock.zone, "panel.csv", rows, habits, d, [m.truth() for m in meters])


def notebook(d):
    """A data frame whose index has no name."""
    clock, begin, end = d.span(d.rng.choice(EUROPE), 900)
    meters = [Meter(f"{name}_kWh", d.load(clock, begin, end, 900)) for name in d.rng.sample(["main", "ahu", "lifts"], d.rng.choice([1, 2]))]
    rows = [[""] + [m.label for m in meters]]
    for i, t, _ in intervals(meters[0]):
        rows.append([clock.local(t).strftime("%Y-%m-%d %H:%M:%S") + f"+0{clock.offset(t) // 3600}:00"] + [m.cell(i) for m in meters])
    d.traits.add("time has no header")
    return text_export("pandas", clock.zone, "df.csv", rows, Habits(), d, [m.truth() for m in meters])


def inverter(d):
    """A row of units below the header; production and use."""
    clock, begin, end = d.span(d.rng.choice(["Europe/Berlin", "Europe/Vienna", "Europe/Zurich"]), 900)
    meters = [Meter("PV Produktion", d.load(clock, begin, end, 900, "solar"), "Wh"),
              Meter("Verbrauch", d.load(clock, begin, end, 900, "house"), "Wh")]
    rows = [["Datum und Uhrzeit"] + [m.label for m in meters], ["[dd.MM.yyyy HH:mm]", "[Wh]", "[Wh]"]]
    for i, t, _ in intervals(meters[0]):
        rows.append([Moment(clock.local(t), "%d.%m.%Y %H:%M")] + [m.cell(i) for m in meters])
    d.traits |= {"unit: units row", "feed-in"}
    return text_export("inverter portal", clock.zone, "solarweb.csv", rows, Habits(d.rng.choice(";,")), d, [m.truth() for m in meters])


def energy_manager(d):
    """Counters that begin anew at midnight, and a power beside the energy of one load."""
    clock, begin, end = d.span(d.rng.choice(EUROPE), 900)
    meter = Meter("today_import_kwh", d.load(clock, begin, end, 900))
    d.traits |= make_register(d.rng, meter, clock, {"zeroed daily": 1})
    rows = [["time", meter.label] + ["battery_soc_pct"]]
    for i in range(1, len(meter.register)):
        t = begin + 900 * i
        rows.append([f"{instant(t):%Y-%m-%dT%H:%M:%S}+00:00", meter.cell(i), str(20 + i % 70)])
    d.traits.add("columns that are no meters")
    return text_export("energy manager", clock.zone, "today.csv", rows, Habits(), d, [meter.truth()])


def energy_and_power(d):
    """kWh and kW of the same load are one meter."""
    clock, begin, end = d.span(d.rng.choice(ZONES + EUROPE), 900)
    load = d.load(clock, begin, end, 900)
    energy, power = Meter("Main", load, "kWh"), Meter("Main", load, "kW")
    rows = [["Time", "Main energy (kWh)", "Main demand (kW)", "Power factor"]]
    for i, t, _ in intervals(energy):
        rows.append([Moment(clock.local(t), "%Y-%m-%d %H:%M"), energy.cell(i), power.cell(i), Number(0.9 + i % 9 / 100, 2)])
    d.traits |= {"kW beside kWh", "columns that are no meters"}
    return text_export("kW beside kWh", clock.zone, "main.csv", rows, Habits(), d, [energy.truth(["Main energy", "Main demand"])])


def three_phases(d):
    """L1 to L3 of one load, each with its voltage."""
    clock, begin, end = d.span(d.rng.choice(EUROPE), 900)
    whole = d.load(clock, begin, end, 900, d.rng.choice(["office", "house", "process"]))
    shares = [d.rng.uniform(0.25, 0.4) for _ in range(2)]
    parts = [[round(a * share) for a in whole.amounts] for share in shares]
    parts.append([a - b - c for a, b, c in zip(whole.amounts, *parts)])
    unit = d.rng.choice(["kW", "W", "kWh"])
    meters = [Meter(f"L{n}", Load(begin, 900, part), unit) for n, part in enumerate(parts, 1)]
    rows = [["Time"] + [f"{m.label} ({unit})" for m in meters] + [f"U{n} (V)" for n in (1, 2, 3)]]
    for i, t, _ in intervals(meters[0]):
        rows.append([Moment(clock.local(t), "%Y-%m-%d %H:%M")] + [m.cell(i) for m in meters] + [Number(229 + (i + n) % 5, 1) for n in range(3)])
    d.traits |= {"L1 to L3", "columns that are no meters"}
    return text_export("three phases", clock.zone, "phases.csv", rows, Habits(), d, [Meter("L", whole).truth(["L1", "L2", "L3"])],
                       [m.truth() for m in meters])


def workbook_of_sheets(d):
    """A summary, days and hours of one meter, a sheet each."""
    clock, begin, end = d.span("Europe/Amsterdam", 3600)
    meter = Meter("Verbruik", d.load(clock, begin, end, 3600))
    days = [["Datum", "Verbruik (kWh)"]]
    for date, first, last in clock.days(begin, end):
        days.append([Moment(datetime.datetime.combine(date, datetime.time()), "%Y-%m-%d"), Number(meter.load.total(first, last), 3)])
    hours = [["Datum", "Verbruik (kWh)"]] + [[Moment(clock.local(t), "%Y-%m-%d %H:%M"), meter.cell(i)] for i, t, _ in intervals(meter)]
    info = [["P1 monitor"], ["Export", f"{clock.local(end):%d-%m-%Y}"]]
    sheets = {"info": info, "dag": days, "uur": hours} if d.chance(0.6) else {"dag": days, "uur": hours}
    d.traits |= {"xlsx", "days before hours"}
    return Export("workbook of days and hours", clock.zone, {"history.xlsx": workbook(sheets)}, [[meter.truth()]], d.traits)


def days_then_hours(d):
    """Old days have one value, newer ones an hour each."""
    clock, begin, end = d.span(d.rng.choice(EUROPE), 3600, months=4)
    meter = Meter("Verbruik", d.load(clock, begin, end, 3600))
    change = clock.midnight((clock.local(begin) + 45 * 24 * HOUR).date())
    rows = [["Datum", "Verbruik (kWh)"]]
    for _, first, last in clock.days(begin, change):
        rows.append([Moment(clock.local(first), "%d-%m-%Y %H:%M"), Number(meter.load.total(first, last), 3)])
    rows += [[Moment(clock.local(t), "%d-%m-%Y %H:%M"), meter.cell(i)] for i, t, _ in intervals(meter) if t >= change]
    truth = meter.truth()
    truth.from_instant, truth.has_shape = change, False
    d.traits |= {"days before hours", "interval changes"}
    return text_export("days, then hours", clock.zone, "historie.csv", rows, Habits(";", ","), d, [truth])


def ten_seconds(d):
    """A logger's powers, six a minute."""
    clock, begin, end = d.span(d.rng.choice(EUROPE), 60, days=33)
    meter = Meter("Main", d.load(clock, begin, end, 60, "house", mean_kW=d.rng.uniform(1, 9)), "kW")
    lines = ["time,Main (kW)"]
    for i, t, _ in intervals(meter):
        value = f"{meter.load.amounts[i] * 60 / 1000:.3f}"
        lines += [f"{instant(t + k):%Y-%m-%dT%H:%M:%SZ},{value}" for k in range(0, 60, 10)]
    d.traits.add("10-second data")
    return Export("10-second logger", clock.zone, {"logger.csv": ("\n".join(lines) + "\n").encode()}, [[meter.truth()]], d.traits)


def json_list(d):
    """A list of readings, with the unit in it."""
    clock, begin, end = d.span("Europe/London", 1800, months=2)
    meter = Meter("electricity", d.load(clock, begin, end, 1800))
    if d.chance(0.5):
        feed = {"resource": "/electricity/consumption/1", "unit": "kWh", "granularity": "halfhour", "values": [
            {"timestamp": f"{clock.local(t):%Y-%m-%d %H:%M}", "value": meter.load.amounts[i] / 1000} for i, t, _ in intervals(meter)]}
    else:
        feed = [{"start": f"{instant(t):%Y-%m-%dT%H:%M:%SZ}", "end": f"{instant(e):%Y-%m-%dT%H:%M:%SZ}",
                 "electricity_kWh": meter.load.amounts[i] / 1000} for i, t, e in intervals(meter)]
    d.traits.add("JSON")
    return Export("JSON list", clock.zone, {"readings.json": json.dumps(feed).encode()}, [[meter.truth(["electricity", "value"])]], d.traits)


def heat_meters(d):
    """Registers of heat in MWh or GJ, read each hour."""
    clock, begin, end = d.span(d.rng.choice(["Europe/Copenhagen", "Europe/Stockholm", "Europe/Berlin"]), 3600)
    name = {"Europe/Copenhagen": "Fjernvarme", "Europe/Stockholm": "Fjärrvärme", "Europe/Berlin": "Wärmemenge"}[clock.zone]
    meter = Meter(name, d.load(clock, begin, end, 3600, "office"), d.rng.choice(["MWh", "GJ", "kWh"]), "heating")
    make_register(d.rng, meter, clock, {"plain": 1})
    rows = [["Zeit", f"{name} ({meter.unit})", "Volumen (m³)", "Vorlauf (°C)"]]
    for i, reading in enumerate(meter.register):
        rows.append([Moment(clock.local(begin + 3600 * i), "%d.%m.%Y %H:%M"), meter.cell(i), Number(reading / 40000, 3), Number(70 + i % 5, 1)])

    d.traits |= {"heat", "register", "columns that are no meters"}
    return text_export("heat meter", clock.zone, "waerme.csv", rows, Habits(";", ","), d, [meter.truth()])


PROGRAMS = [niagara_history, trend_log, influx, home_assistant_history, home_assistant_energy, emoncms, grafana, notebook, inverter,
            energy_manager, energy_and_power, three_phases, workbook_of_sheets, days_then_hours, json_list, heat_meters]
