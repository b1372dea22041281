"""Export number N of a seed.

    python3 generate.py SEED NUMBER FOLDER      writes its files, and the truth as truth.txt
"""
import pathlib
import sys

import devices
import portals_europe
import portals_overseas
from export import Draw
from plain_table import PlainTable, undecided_table


def make_export(seed, number):
    """Half of them are tables of any program, the others follow a portal, a standard or a device."""
    d = Draw(seed, number)
    roll = d.rng.random()
    if roll < 0.5:
        return PlainTable(d).export()
    if roll < 0.53:
        return undecided_table(d)
    if roll < 0.54:
        return devices.ten_seconds(d)
    return d.rng.choice(portals_europe.PORTALS + portals_overseas.PORTALS + devices.PROGRAMS)(d)


def write_files(export, folder):
    folder.mkdir(parents=True, exist_ok=True)
    for name, content in export.files.items():
        (folder / name).write_bytes(content)
    lines = [f"{export.kind}; {', '.join(sorted(export.traits))}",
             f"recald init {' '.join(export.files)} --timezone {export.zone} --out site"]
    if export.undecided:
        lines.append(f"undecided: {export.undecided} {export.answers}")
    for number, truths in enumerate(export.truths, 1):
        for truth in truths:
            lines.append(f"{'or ' if number > 1 else ''}{truth.labels} {'/'.join(truth.utilities)}"
                         f"{'' if truth.required else ', may be left out'}")
            for month in truth.months(export.zone):
                lines.append(f"  {month.name} {month.energy:.3f} {'m3' if truth.is_volume else 'kWh'}, missing {month.missing_share:.2%}")
    (folder / "truth.txt").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    write_files(make_export(int(sys.argv[1]), int(sys.argv[2])), pathlib.Path(sys.argv[3]))
