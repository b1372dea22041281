"""Ten million rows through `recald init`: seconds, and the largest resident memory (below 200 MB).

    python3 init_rows.py RECALD [ROWS]
"""

import datetime
import pathlib
import resource
import subprocess
import sys
import tempfile
import time


def write_rows(file, rows):
    """One meter, a row a minute."""
    start = datetime.datetime(2005, 1, 1)
    step = datetime.timedelta(minutes=1)
    with file.open("w", encoding="utf-8") as out:
        out.write("Time,Main kWh\n")
        for i in range(rows):
            out.write(f"{(start + i * step).isoformat()}Z,{i % 97}.5\n")


def main():
    recald = sys.argv[1]
    rows = int(sys.argv[2]) if len(sys.argv) > 2 else 10_000_000
    with tempfile.TemporaryDirectory() as folder:
        export = pathlib.Path(folder) / "export.csv"
        write_rows(export, rows)
        begin = time.monotonic()
        subprocess.run(
            [recald, "init", str(export), "--out", f"{folder}/site", "--timezone", "Etc/UTC"],
            check=True,
        )
        seconds = time.monotonic() - begin
        memory_mb = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024
    print(f"{rows} rows: {seconds:.1f} s, {memory_mb:.0f} MB")
    sys.exit(0 if memory_mb < 200 else 1)


main()
