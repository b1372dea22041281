"""Exports of European portals: columns, clocks and units as each of them writes them."""
import datetime
import json

from export import Export
from loads import DAY
from meters import Meter, draw_gaps
from stamps import whole_day_end
from tables import Habits, Moment, Number, delimited

SEMICOLON = Habits(";", ",", newline="\r\n", encoding="utf-8-sig")
HOUR = datetime.timedelta(hours=1)


def text_export(kind, zone, name, rows, habits, d, *alternatives):
    return Export(kind, zone, {name: delimited(rows, habits)}, list(alternatives), d.traits)


def thinned(d, meter, flags=None):
    """Rows that a portal does not have, or marks: (indices of rows that are left out, flag of each interval)."""
    count, per_day = len(meter.load.amounts), DAY // meter.load.step
    good, estimated, missing = flags or ("", "", "")
    marks = [good] * count
    left_out = set()
    if d.chance(0.15, "rows missing"):
        left_out = draw_gaps(d.rng, count, per_day)
        meter.missing |= left_out
    if estimated and d.chance(0.3, "quality flags"):
        for i in draw_gaps(d.rng, count, per_day):
            marks[i] = estimated
    if missing and d.chance(0.2, "quality flags"):
        lost = draw_gaps(d.rng, count, per_day) - meter.missing
        meter.missing |= lost
        if d.chance(0.6, "zero flagged as missing"):
            meter.zero_cells = lost
        for i in lost:
            marks[i] = missing
    return left_out, marks


def intervals(meter, left_out=()):
    load = meter.load
    return [(i, load.begin + i * load.step, load.begin + (i + 1) * load.step)
            for i in range(len(load.amounts)) if i not in left_out]


def spanish_hour(d, clock):
    """01:00 to 24:00 by the clock on the wall, or counted through the day to 23 or 25."""
    counted = d.chance(0.5)

    def hour(begin):
        wall = clock.local(begin)
        return (begin - clock.midnight(wall.date())) // 3600 + 1 if counted else wall.hour + 1
    return hour


def datadis(d):
    clock, begin, end = d.span("Europe/Madrid", 3600)
    meter = Meter("consumo", d.load(clock, begin, end, 3600))
    left_out, marks = thinned(d, meter, ("Real", "Estimada", ""))
    hour, point = spanish_hour(d, clock), "ES00" + d.digits(16) + "XX"
    surplus = Meter("energiaVertida", d.load(clock, begin, end, 3600, "solar")) if d.chance(0.3, "feed-in") else None
    rows = [["cups", "fecha", "hora", "consumo_kWh", "metodoObtencion"] + (["energiaVertida_kWh"] if surplus else [])]
    for i, t, _ in intervals(meter, left_out):
        row = [point, Moment(clock.local(t), "%Y/%m/%d"), f"{hour(t):02d}:00", meter.cell(i), marks[i]]
        rows.append(row + ([surplus.cell(i)] if surplus else []))
    if surplus:
        surplus.missing |= left_out
    habits = Habits(";", ",", trims_zeros=d.chance(0.5))
    return text_export("ES Datadis", clock.zone, "datadis.csv", rows, habits, d,
                       [m.truth() for m in (meter, surplus) if m])


def e_distribucion(d):
    clock, begin, end = d.span("Europe/Madrid", 3600)
    meter = Meter("AE", d.load(clock, begin, end, 3600))
    left_out, marks = thinned(d, meter, ("R", "E", ""))
    hour, point = spanish_hour(d, clock), "ES0031" + d.digits(14) + "JN0F"
    wide = d.chance(0.5)
    rows = [["CUPS", "Fecha", "Hora", "AE_kWh"] + (["AS_KWh", "AE_AUTOCONS_kWh"] if wide else []) + ["REAL/ESTIMADO"]]
    for i, t, _ in intervals(meter, left_out):
        zeros = [Number(0.0, 3)] * 2 if wide else []
        rows.append([point, Moment(clock.local(t), "%d/%m/%Y"), str(hour(t)), meter.cell(i)] + zeros + [marks[i]])
    truths = [meter.truth()]
    if wide:
        nothing = d.load(clock, begin, end, 3600, "process", mean_kW=0.0)
        truths += [Meter("AS", nothing).truth(required=False), Meter("AE_AUTOCONS", nothing).truth(required=False)]
    return text_export("ES e-distribución", clock.zone, "cch.csv", rows, SEMICOLON, d, truths)


def enedis_curve(d):
    """Mean power of half-hours, the unit above the table; older years have hours."""
    clock, begin, end = d.span("Europe/Paris", 1800, months=3)
    load = d.load(clock, begin, end, 1800)
    meter = Meter("Consommation", load, "W")
    point = d.digits(14)
    head = [["Identifiant PRM", "Type de donnees", "Date de debut", "Date de fin", "Grandeur physique", "Grandeur metier",
             "Etape metier", "Unite", "Pas en minutes"],
            [point, "Courbe de charge", Moment(clock.local(begin), "%d/%m/%Y"), Moment(clock.local(end), "%d/%m/%Y"),
             "Energie active", "Consommation", "Comptage Brut", "W", ""], ["Horodate", "Valeur"]]
    change = begin
    if d.chance(0.3, "interval changes"):
        change = clock.midnight((clock.local(begin) + 40 * 24 * HOUR).date())
    hours = load.coarser(2)
    rows = [(t, round(hours.total(t, t + 3600) * 1000), 3600) for t in range(begin, change, 3600)]
    rows += [(t, round(load.total(t, t + 1800) * 2000), 1800) for t in range(change, end, 1800)]

    def stamp(t):
        offset = clock.offset(t) // 3600
        return clock.local(t).strftime("%Y-%m-%dT%H:%M:%S") + f"+{offset:02d}:00"
    rows = head + [[stamp(t + step), str(watts)] for t, watts, step in rows]
    truth = meter.truth(["Consommation", "Valeur", "Enedis", "courbe", point])
    truth.has_shape = change == begin
    return text_export("FR Enedis", clock.zone, "Enedis_CDC.csv", rows, SEMICOLON, d, [truth])


def enedis_json(d):
    clock, begin, end = d.span("Europe/Paris", 1800, months=2)
    meter = Meter("Consommation", d.load(clock, begin, end, 1800), "W")
    readings = [{"value": str(2 * meter.load.amounts[i]), "date": f"{clock.local(e):%Y-%m-%d %H:%M:%S}",
                 "interval_length": "PT30M", "measure_type": "B"} for i, _, e in intervals(meter)]
    point = d.digits(14)
    feed = {"meter_reading": {"usage_point_id": point, "start": f"{clock.local(begin):%Y-%m-%d}",
                              "end": f"{clock.local(end):%Y-%m-%d}", "quality": "BRUT", "reading_type": {
                                  "measurement_kind": "power", "unit": "W", "aggregate": "average"},
                              "interval_reading": readings}}
    d.traits.add("JSON")
    return Export("FR Enedis JSON", clock.zone, {"load_curve.json": json.dumps(feed).encode()},
                  [[meter.truth(["Consommation", point])]], d.traits)


def off_peak_registers(d):
    """Two registers of one load that take turns, HP by day and HC by night."""
    clock, begin, end = d.span("Europe/Paris", 1800)
    load = d.load(clock, begin, end, 1800)
    day, night = split_by_tariff(load, clock)
    rows = [["Date", "Heure", "Index HP (kWh)", "Index HC (kWh)"]]
    first = [d.rng.randrange(10**6, 10**8) for _ in "ab"]
    for i, readings in enumerate(zip(day.register(first[0]), night.register(first[1]))):
        wall = clock.local(begin + i * 1800)
        rows.append([Moment(wall, "%d/%m/%Y"), wall.strftime("%H:%M")] + [Number(r / 1000, 3) for r in readings])
    d.traits.add("registers take turns")
    whole = Meter("Index", load).truth(["Index", "HP", "HC"])
    return text_export("FR HP/HC", clock.zone, "index.csv", rows, Habits(";", ","), d, [whole],
                       [Meter("Index HP", day).truth(), Meter("Index HC", night).truth()])


def split_by_tariff(load, clock):
    by_day = [7 <= clock.local(load.begin + i * load.step).hour < 22 for i in range(len(load.amounts))]
    return (type(load)(load.begin, load.step, [a if peak else 0 for a, peak in zip(load.amounts, by_day)]),
            type(load)(load.begin, load.step, [0 if peak else a for a, peak in zip(load.amounts, by_day)]))


def german_grid(d):
    """Datum; Zeit von; Zeit bis; the value's title has an OBIS code now and then."""
    clock, begin, end = d.span(d.rng.choice(["Europe/Berlin", "Europe/Vienna"]), 900)
    unit = d.rng.choice(["kWh", "kWh", "kW"])
    meter = Meter("Verbrauch", d.load(clock, begin, end, 900), unit)
    left_out, marks = thinned(d, meter, ("W", "E", "F"))
    title = d.rng.choice(["Verbrauch [{}]", "1-1:1.29.0 ({})", "Wirkarbeit Bezug ({})", "Verbrauch in {}"]).format(unit)
    rows = [["Lastgang"], ["Zählpunkt", "AT00" + d.digits(29)], []] if d.chance(0.5, "lines above the header") else []
    rows.append(["Datum", "Zeit von", "Zeit bis", title, "Status"])
    at_24 = d.chance(0.4, "24:00")
    for i, t, _ in intervals(meter, left_out):
        wall = clock.local(t)
        until = (wall + HOUR / 4).strftime("%H:%M") if not at_24 else whole_day_end(wall + HOUR / 4, "", "")
        rows.append([Moment(wall, "%d.%m.%Y"), wall.strftime("%H:%M"), until, meter.cell(i), marks[i]])
    habits = Habits(";", ",", encoding=d.rng.choice(["utf-8", "cp1252", "utf-8-sig"]), newline="\r\n")
    return text_export("DE/AT grid operator", clock.zone, "Lastgang.csv", rows, habits, d,
                       [meter.truth(["Verbrauch", "Lastgang", "1-1:1.29.0", "Wirkarbeit Bezug"])])


def german_obis(d):
    """Import and export in turns of rows, told apart by an OBIS code."""
    clock, begin, end = d.span("Europe/Berlin", 900)
    drawn = Meter("1-1:1.29.0", d.load(clock, begin, end, 900))
    fed = Meter("1-1:2.29.0", d.load(clock, begin, end, 900, "solar"))
    point = "DE00" + d.digits(29)
    rows = [["Messlokation", "OBIS", "Zeitstempel bis", "Wert", "Einheit", "Status"]]
    one_after_another = d.chance(0.5, "one after another")
    for group in ([[drawn], [fed]] if one_after_another else [[drawn, fed]]):
        for i, _, e in intervals(drawn):
            rows += [[point, m.label, Moment(clock.local(e), "%d.%m.%Y %H:%M"), m.cell(i), "kWh", "W"] for m in group]
    d.traits |= {"feed-in", "a row a meter"}
    return text_export("DE OBIS rows", clock.zone, "messwerte.csv", rows, Habits(";", ","), d, [drawn.truth(), fed.truth()])


def british_supplier(d):
    clock, begin, end = d.span("Europe/London", 1800)
    gas = d.chance(0.3, "gas")
    unit = d.rng.choice(["m³", "kWh"]) if gas else "kWh"
    meter = Meter("Gas consumption" if gas else "Consumption", d.load(clock, begin, end, 1800), unit, "gas" if gas else "electricity")
    title = f"Gas consumption ({unit})" if gas else "Consumption (kwh)"
    left_out, _ = thinned(d, meter)

    def stamp(t):
        return clock.local(t).strftime("%Y-%m-%dT%H:%M:%S") + ("+01:00" if clock.offset(t) else "+00:00")
    rows = [[title, " Estimated Cost Inc. Tax (p)", " Standing Charge Inc. Tax (p)", " Start", " End"]]
    for i, t, e in intervals(meter, left_out):
        standing = " 47.85" if clock.local(t).time() == datetime.time() else " "
        rows.append([meter.cell(i), f" {meter.load.amounts[i] * 0.0245:.6f}", standing, " " + stamp(t), " " + stamp(e)])
    d.traits.add("columns that are no meters")
    return text_export("UK supplier", clock.zone, "consumption.csv", rows, Habits(), d, [meter.truth([meter.label])])


def british_half_hours(d):
    """A row a day: 48 columns, and two more in autumn."""
    clock, begin, end = d.span("Europe/London", 1800, months=d.rng.choice([3, 6, 12]))
    meter = Meter("Electricity", d.load(clock, begin, end, 1800))
    point, serial = d.digits(13), "E21" + d.digits(7)
    titles = d.rng.choice([[f"HH{n:02d}" for n in range(1, 51)],
                           [f"{n // 2:02d}:{n % 2 * 30:02d}" for n in range(1, 48)] + ["00:00"]])
    rows = [["MPAN", "Meter Serial", "Units", "Date"] + titles]
    for date, first, last in clock.days(begin, end):
        values = [meter.cell((t - begin) // 1800) for t in range(first, last, 1800)]
        if len(titles) == 48 and len(values) == 46:
            values[2:2] = ["", ""]
        elif len(titles) == 48 and len(values) == 50:
            values = values[:2] + [Number(a.value + b.value, 3) for a, b in zip(values[2:4], values[4:6])] + values[6:]
            meter.has_shape = False
        rows.append([point, serial, "kWh", Moment(datetime.datetime.combine(date, datetime.time()), "%d/%m/%Y")] +
                    values + [""] * (len(titles) - len(values)))
    d.traits.add("a row a day")
    return text_export("UK 48 columns", clock.zone, "hh.csv", rows, Habits(), d, [meter.truth(["Electricity", point, "hh", "AI"])])


def irish_network(d):
    """Newest first; kW or kWh in the type of the row, import and export taking turns."""
    clock, begin, end = d.span("Europe/Dublin", 1800)
    unit = d.rng.choice(["kW", "kWh"])
    meters = [Meter(f"Active Import Interval ({unit})", d.load(clock, begin, end, 1800), unit)]
    if d.chance(0.4, "feed-in"):
        meters.append(Meter(f"Active Export Interval ({unit})", d.load(clock, begin, end, 1800, "solar"), unit))
    point, serial = d.digits(11), d.digits(18)
    rows = []
    for i, _, e in intervals(meters[0]):
        rows += [[point, serial, m.cell(i), m.label, Moment(clock.local(e), "%d-%m-%Y %H:%M")] for m in meters]
    rows = [["MPRN", "Meter Serial Number", "Read Value", "Read Type", "Read Date and End Time"]] + rows[::-1]
    d.traits |= {"newest first", "unit: type column"}
    return text_export("IE ESB", clock.zone, f"HDF_{point}.csv", rows, Habits(), d, [m.truth([m.label, point]) for m in meters])


def fluvius(d):
    """From and to, tariffs taking turns, import and export."""
    clock, begin, end = d.span("Europe/Brussels", 900, months=2)
    bought = d.load(clock, begin, end, 900)
    sold = d.load(clock, begin, end, 900, "solar") if d.chance(0.6, "feed-in") else None
    parts = {"Afname": split_by_tariff(bought, clock)} | ({"Injectie": split_by_tariff(sold, clock)} if sold else {})
    ean = f"5414{d.digits(14)}"
    rows = [["Van (datum)", "Van (tijdstip)", "Tot (datum)", "Tot (tijdstip)", "EAN-code", "Meter", "Metertype", "Register",
             "Volume", "Eenheid", "Validatiestatus"]]
    for i in range(len(bought.amounts)):
        wall = clock.local(begin + i * 900)
        to = wall + HOUR / 4
        tariff = "Dag" if 7 <= wall.hour < 22 else "Nacht"
        for name, (day, night) in parts.items():
            rows.append([Moment(wall, "%d-%m-%Y"), f"{wall:%H:%M:%S}", Moment(to, "%d-%m-%Y"), f"{to:%H:%M:%S}", ean,
                         "1SAG3100042174", "Digitale meter", f"{name} {tariff}",
                         Number((day.amounts[i] + night.amounts[i]) / 1000, 3), "kWh", "Uitgelezen"])
    d.traits |= {"registers take turns", "a row a meter"}
    whole = [Meter("Afname", bought).truth()] + ([Meter("Injectie", sold).truth()] if sold else [])
    apart = [Meter(f"{name} {tariff}", load).truth() for name, loads in parts.items()
             for tariff, load in zip(("Dag", "Nacht"), loads)]
    export = text_export("BE Fluvius", clock.zone, "Verbruikshistoriek.csv", rows, SEMICOLON, d, whole, apart)
    if d.chance(0.5):  # a formula, so that a spreadsheet keeps all digits
        export.files = {name: content.replace(ean.encode(), f'="{ean}"'.encode()) for name, content in export.files.items()}
    return export


def dutch_tariff_registers(d):
    """HomeWizard and P1 readers: four registers, of two tariffs each way."""
    clock, begin, end = d.span("Europe/Amsterdam", 900)
    bought, sold = d.load(clock, begin, end, 900), d.load(clock, begin, end, 900, "solar")
    loads = [*split_by_tariff(bought, clock), *split_by_tariff(sold, clock)]
    names = d.rng.choice([["Import T1 kWh", "Import T2 kWh", "Export T1 kWh", "Export T2 kWh"],
                          ["Meterstand T1 (kWh)", "Meterstand T2 (kWh)", "Teruglevering T1 (kWh)", "Teruglevering T2 (kWh)"]])
    columns = [load.register(d.rng.randrange(10**6, 10**8)) for load in loads]
    rows = [["time"] + names]
    for i in range(len(bought.amounts) + 1):
        rows.append([Moment(clock.local(begin + i * 900), "%Y-%m-%d %H:%M")] + [Number(c[i] / 1000, 3) for c in columns])
    d.traits |= {"registers take turns", "register", "feed-in"}
    whole = [Meter(names[0], bought).truth([names[0], "import", "afname"]), Meter(names[2], sold).truth([names[2], "export"])]
    return text_export("NL T1/T2", clock.zone, "p1.csv", rows, Habits(), d, whole,
                       [Meter(name, load).truth() for name, load in zip(names, loads)])


def dutch_meters_in_turn(d):
    """One meter after another, electricity and gas."""
    clock, begin, end = d.span("Europe/Amsterdam", 3600)
    power = Meter("Elektriciteit", d.load(clock, begin, end, 3600))
    gas = Meter("Gas", d.load(clock, begin, end, 3600, "office", mean_kW=2), "m3", "gas")
    rows = [["Datum", "EAN", "Verbruik", "Eenheid", "Type", "Piek"]]
    for meter in (power, gas):
        ean = "8716" + d.digits(14)
        for i, t, _ in intervals(meter):
            stamp = clock.local(t).strftime("%Y-%m-%dT%H:%M:%S") + f"+0{clock.offset(t) // 3600}:00"
            rows.append([stamp, ean, meter.cell(i), meter.unit, meter.label, "true" if 7 <= clock.local(t).hour < 22 else "false"])
    d.traits |= {"one after another", "gas", "a row a meter"}
    return text_export("NL supplier", clock.zone, "verbruik.csv", rows, Habits(quotes_all=True, trims_zeros=True), d,
                       [power.truth(), gas.truth()])


def eloverblik(d):
    clock, begin, end = d.span("Europe/Copenhagen", 3600)
    meter = Meter("MålepunktsID", d.load(clock, begin, end, 3600))
    left_out, marks = thinned(d, meter, ("Målt", "Estimeret", ""))
    point = "571313" + d.digits(12)
    rows = [["MålepunktsID", "Fra_dato", "Til_dato", "Mængde", "Måleenhed", "Kvalitet", "Type"]]
    for i, t, e in intervals(meter, left_out):
        rows.append([point, Moment(clock.local(t), "%d-%m-%Y %H:%M:%S"), Moment(clock.local(e), "%d-%m-%Y %H:%M:%S"),
                     meter.cell(i), "KWH", marks[i], "Tidsserie"])
    return text_export("DK Eloverblik", clock.zone, "MeteringPoints.csv", rows, SEMICOLON, d, [meter.truth([point, "Mængde"])])


def fingrid(d):
    step = d.rng.choice([900, 3600])
    clock, begin, end = d.span("Europe/Helsinki", step)
    meter = Meter("BN01", d.load(clock, begin, end, step))
    left_out, marks = thinned(d, meter, ("OK", "ESTIMATED", "MISSING"))
    meter.decimals = 6
    point = "6430069" + d.digits(11)
    rows = [["Mittauspisteen tunnus", "Tuotteen tyyppi", "Resoluutio", "Yksikkötyyppi", "Lukeman tyyppi", "Alkuaika", "Määrä",
             "Laatu"]]
    for i, t, _ in intervals(meter, left_out):
        stamp = datetime.datetime(1970, 1, 1) + datetime.timedelta(seconds=t)
        rows.append([point, "8716867000030", "PT15M" if step == 900 else "PT1H", "kWh", "BN01", f"{stamp:%Y-%m-%dT%H:%M:%SZ}",
                     meter.cell(i), marks[i]])
    return text_export("FI Datahub", clock.zone, "consumption.csv", rows, Habits(";", ",", encoding="utf-8-sig"), d,
                       [meter.truth([point, "Määrä", "BN01"])])


def swedish_hours(d):
    clock, begin, end = d.span("Europe/Stockholm", 3600)
    meter = Meter("Förbrukning", d.load(clock, begin, end, 3600))
    left_out, _ = thinned(d, meter)
    rows = [["Anläggnings-ID", "735999" + d.digits(12)], []]
    rows.append(["Datum", "Förbrukning (kWh)", "Temperatur (°C)", "Kostnad (kr)"])
    for i, t, _ in intervals(meter, left_out):
        rows.append([Moment(clock.local(t), "%Y-%m-%d %H:%M"), meter.cell(i), Number(5 + t // 3600 % 13, 1),
                     Number(meter.load.amounts[i] * 0.0011, 2)])
    d.traits |= {"lines above the header", "columns that are no meters"}
    return text_export("SE supplier", clock.zone, "timvarden.csv", rows, SEMICOLON, d, [meter.truth()])


def tibber(d):
    clock, begin, end = d.span("Europe/Stockholm", 3600, months=2)
    meter = Meter("consumption", d.load(clock, begin, end, 3600))

    def stamp(t):
        return clock.local(t).strftime("%Y-%m-%dT%H:%M:%S.000") + f"+0{clock.offset(t) // 3600}:00"
    nodes = [{"from": stamp(t), "to": stamp(e), "cost": round(meter.load.amounts[i] * 0.0009, 4), "unitPrice": 0.9,
              "consumption": meter.load.amounts[i] / 1000, "consumptionUnit": "kWh"} for i, t, e in intervals(meter)]
    feed = nodes if d.chance(0.4) else {"data": {"viewer": {"homes": [{"consumption": {"nodes": nodes}}]}}}
    d.traits |= {"JSON", "columns that are no meters"}
    return Export("SE Tibber JSON", clock.zone, {"consumption.json": json.dumps(feed).encode()}, [[meter.truth()]], d.traits)


def tauron(d):
    """Hours to 24:00, taken and given in rows of their own."""
    clock, begin, end = d.span("Europe/Warsaw", 3600, months=d.rng.choice([2, 4, 6]))
    meters = [Meter("pobór", d.load(clock, begin, end, 3600))]
    if d.chance(0.5, "feed-in"):
        meters.append(Meter("oddanie", d.load(clock, begin, end, 3600, "solar")))
    one_after_another = d.chance(0.5, "one after another")
    rows = [["Data", "Wartość kWh", "Rodzaj"]]
    for group in ([[m] for m in meters] if one_after_another else [meters]):
        for i, t, _ in intervals(meters[0]):
            stamp = whole_day_end(clock.local(t) + HOUR, "%Y-%m-%d", " ", "%-H:%M")
            rows += [[stamp.replace("%-H", "24"), m.cell(i), m.label] for m in group]
    d.traits |= {"24:00", "a row a meter"}
    return text_export("PL Tauron", clock.zone, "dane.csv", rows, Habits(";", ",", encoding="utf-8-sig"), d,
                       [m.truth([m.label, "Wartość"] if len(meters) == 1 else [m.label]) for m in meters])


def polish_hour_numbers(d):
    """Hours 1 to 24, the second of autumn's doubled ones is 2A or comes twice."""
    clock, begin, end = d.span("Europe/Warsaw", 3600, months=d.rng.choice([2, 4, 12]))
    drawn = Meter("Energia pobrana", d.load(clock, begin, end, 3600))
    fed = Meter("Energia oddana", d.load(clock, begin, end, 3600, "solar"))
    again = d.rng.choice(["3A", "3"])
    back = {t for t, by in clock.changes() if by < 0}
    rows = [["Data", "Godzina", "Energia pobrana [kWh]", "Energia oddana [kWh]"]]
    for i, t, _ in intervals(drawn):
        wall = clock.local(t)
        rows.append([Moment(wall, "%Y-%m-%d"), again if t in back else str(wall.hour + 1), drawn.cell(i), fed.cell(i)])
    d.traits |= {"stamps: hour numbers", "feed-in"}
    return text_export("PL hour numbers", clock.zone, "odczyty.csv", rows, Habits(";", ","), d, [drawn.truth(), fed.truth()])


def italian_quarters(d):
    """A row a day, 96 columns; autumn's second hour is added to the first, or has four columns of its own."""
    clock, begin, end = d.span("Europe/Rome", 900, months=d.rng.choice([2, 3, 6]))
    meter = Meter("Consumo", d.load(clock, begin, end, 900))
    hundred = d.chance(0.4)
    spans = [f"{n // 4:02d}:{n % 4 * 15:02d}-{(n + 1) // 4:02d}:{(n + 1) % 4 * 15:02d}" for n in range(96)]
    rows = [["POD", "IT001E" + d.digits(8)], ["Energia attiva prelevata (kWh)"], []]
    rows.append(["Giorno"] + ([str(n) for n in range(1, 101)] if hundred else spans))
    for date, first, last in clock.days(begin, end):
        values = [meter.cell((t - begin) // 900) for t in range(first, last, 900)]
        if not hundred and len(values) == 92:
            values[8:8] = [""] * 4
        elif not hundred and len(values) == 100:
            values = values[:8] + [Number(a.value + b.value, 3) for a, b in zip(values[8:12], values[12:16])] + values[16:]
            meter.has_shape = False
        rows.append([Moment(datetime.datetime.combine(date, datetime.time()), "%d/%m/%Y")] + values + [""] * (100 * hundred - len(values)))
    d.traits |= {"a row a day", "unit: above", "lines above the header"}
    return text_export("IT 96 columns", clock.zone, "curva.csv", rows, Habits(";", ","), d,
                       [meter.truth(["Energia attiva prelevata", "Consumo", "curva"])])


def e_redes(d):
    clock, begin, end = d.span("Europe/Lisbon", 900)
    meter = Meter("Consumo registado, Ativa", d.load(clock, begin, end, 900), "kW")
    left_out, marks = thinned(d, meter, ("Real", "Estimado", ""))
    last = clock.local(end - 1)
    rows = [["CPE", "PT0002" + d.digits(12) + "XX"], ["Data de inicio", Moment(clock.local(begin), "%Y-%m-%d")],
            ["Data de fim", Moment(last, "%Y-%m-%d")], [],
            ["Contador", "Data", "Hora", "Consumo registado, Ativa (kW)", "Estado"]]
    serial = "0000" + d.digits(11)
    at_24 = d.chance(0.5, "24:00")
    for i, t, e in intervals(meter, left_out):
        day, time = whole_day_end(clock.local(e), "%Y/%m/%d", "|").split("|") if at_24 else (
            f"{clock.local(e):%Y/%m/%d}", f"{clock.local(e):%H:%M}")
        rows.append([serial, day, time, meter.cell(i), marks[i]])
    d.traits.add("lines above the header")
    return text_export("PT E-REDES", clock.zone, "leituras.csv", rows, Habits(";", d.rng.choice(".,"), trims_zeros=True), d, [meter.truth()])


PORTALS = [datadis, e_distribucion, enedis_curve, enedis_json, off_peak_registers, german_grid, german_obis, british_supplier,
           british_half_hours, irish_network, fluvius, dutch_tariff_registers, dutch_meters_in_turn, eloverblik, fingrid,
           swedish_hours, tibber, tauron, polish_hour_numbers, italian_quarters, e_redes]
