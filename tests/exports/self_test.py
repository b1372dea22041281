"""Whether the generator's files say what its truths say: simple ones are read again by a few lines that share nothing with it.

    python3 self_test.py [SEED [COUNT OF EACH FORMAT]]
"""
import csv
import datetime
import io
import json
import sys
import zoneinfo
from xml.etree import ElementTree

import devices
import portals_europe
import portals_overseas
from export import Draw


def sums_by_month(pairs, zone):
    """(instant of the start, kWh) -> kWh by local month."""
    months = {}
    for t, energy in pairs:
        month = f"{datetime.datetime.fromtimestamp(t, zoneinfo.ZoneInfo(zone)):%Y-%m}"
        months[month] = months.get(month, 0.0) + energy
    return months


def utc(text):
    return datetime.datetime.fromisoformat(text.replace("Z", "+00:00")).timestamp()


def table(export, delimiter, encoding="utf-8-sig"):
    (content,) = export.files.values()
    return list(csv.reader(io.StringIO(content.decode(encoding), newline=""), delimiter=delimiter))


def comma(text):
    return float(text.replace(",", "."))


def datahub(export):
    rows = [row for row in table(export, ";")[1:] if row[7] != "MISSING"]
    return {0: [(utc(row[5]), comma(row[6])) for row in rows]}


def supplier(export):
    rows = table(export, ",")
    return {0: [(utc(row[3].strip()), float(row[0])) for row in rows[1:]]} if "kwh" in rows[0][0].lower() else {}


def tibber(export):
    feed = json.loads(next(iter(export.files.values())))
    if isinstance(feed, dict):
        feed = feed["data"]["viewer"]["homes"][0]["consumption"]["nodes"]
    return {0: [(utc(node["from"]), node["consumption"]) for node in feed]}


def danish(export):
    """Local stamps: whoever counts hours from the first midnight needs no clock, unless rows are missing."""
    rows = table(export, ";")[1:]
    if "rows missing" in export.traits:
        return {}
    first = datetime.datetime.strptime(rows[0][1], "%d-%m-%Y %H:%M:%S").replace(tzinfo=zoneinfo.ZoneInfo(export.zone)).timestamp()
    return {0: [(first + 3600 * i, comma(row[3])) for i, row in enumerate(rows)]}


def emoncms(export):
    rows = table(export, ",")
    return {column: [(int(row[0]), float(row[column + 1]) / 6000) for row in rows[1:]] for column in range(len(rows[0]) - 1)}


def frame(export):
    rows = table(export, ",")
    return {column: [(utc(row[0]), float(row[column + 1])) for row in rows[1:]] for column in range(len(rows[0]) - 1)}


def nem12(export):
    """Days of standard time, UTC+10."""
    channels, factor, step = {}, 1.0, 0
    for row in table(export, ","):
        if row[0] == "200":
            factor, step = (0.001 if row[7].upper() == "WH" else 1.0), int(row[8]) * 60
            current = channels.setdefault(len(channels), [])
        elif row[0] == "300":
            midnight = datetime.datetime.strptime(row[1] + "+1000", "%Y%m%d%z").timestamp()
            current += [(midnight + i * step, float(value) * factor) for i, value in enumerate(row[2:2 + 86400 // step])]
    return channels


def green_button(export):
    """By reading type: watt-hours, or watts for the length of the interval."""
    if "gas" in export.traits:
        return {}
    root = ElementTree.fromstring(next(iter(export.files.values())))
    espi, atom = "{http://naesb.org/espi}", "{http://www.w3.org/2005/Atom}"
    types, channels = [], {}
    for entry in root.iter(atom + "entry"):
        link = entry.find(f"{atom}link[@rel='self']").get("href")
        kind = entry.find(f".//{espi}ReadingType")
        if kind is not None:
            types.append((int(kind.find(espi + "uom").text), int(kind.find(espi + "powerOfTenMultiplier").text)))
        uom, power = types[-1] if types else (0, 0)
        for reading in entry.iter(espi + "IntervalReading"):
            duration, start = (int(reading.find(f"{espi}timePeriod/{espi}{name}").text) for name in ("duration", "start"))
            energy = int(reading.find(espi + "value").text) * 10**power / 1000 * (duration / 3600 if uom == 38 else 1)
            if uom != 73:
                channels.setdefault(int(link.split("MeterReading/")[1].split("/")[0]) - 1, []).append((start, energy))
    return channels


def texas(export):
    rows = table(export, ",")[1:]
    if "rows missing" in export.traits:
        return {}
    labels = list(dict.fromkeys(row[7] for row in rows))
    first = datetime.datetime.strptime(rows[0][1] + rows[0][3], "%m/%d/%Y %H:%M").replace(tzinfo=zoneinfo.ZoneInfo(export.zone)).timestamp()
    return {number: [(first + 900 * i, float(row[5])) for i, row in enumerate(row for row in rows if row[7] == label)]
            for number, label in enumerate(labels)}


READERS = {portals_europe.fingrid: datahub, portals_europe.british_supplier: supplier, portals_europe.tibber: tibber,
           portals_europe.eloverblik: danish, portals_overseas.green_button: green_button, portals_overseas.nem12: nem12,
           portals_overseas.smart_meter_texas: texas, devices.emoncms: emoncms, devices.notebook: frame}


def check(export, reader):
    """Months that were compared, and what differs."""
    compared, wrong = 0, []
    for number, pairs in reader(export).items():
        truth, sums = export.truths[0][number], sums_by_month(pairs, export.zone)
        for month in truth.months(export.zone):
            expected = month.energy - month.missing_energy
            compared += 1
            if abs(sums.get(month.name, 0.0) - expected) > 1e-5 * expected + 0.002:
                wrong.append(f"{truth.labels[0]} {month.name}: {sums.get(month.name)}, truth {expected}")
    return compared, wrong


def main():
    seed = int(sys.argv[1]) if len(sys.argv) > 1 else 1
    count = int(sys.argv[2]) if len(sys.argv) > 2 else 4
    months, failed = 0, False
    for make, reader in READERS.items():
        found = 0
        for number in range(count):
            export = make(Draw(seed, number))
            compared, wrong = check(export, reader)
            found += compared
            for line in wrong:
                failed = True
                print(f"{export.kind}, number {number} of seed {seed}: {line}")
        failed = failed or not found
        months += found
    print(f"{months} months of {len(READERS)} formats read again{'' if failed else ': as the truth says'}")
    sys.exit(failed)


if __name__ == "__main__":
    main()
