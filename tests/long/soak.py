"""A long life of one daemon: see soak.sh. Prints figures; judges that nothing is lost."""
import datetime
import json
import re
import signal
import sqlite3
import subprocess
import sys
import tempfile
import time
import urllib.error
import urllib.request
from pathlib import Path

BUILD, MONTHS, MINUTES = Path(sys.argv[1]), int(sys.argv[2]), float(sys.argv[3])
FIRST_YEAR = 2024  # no daemon believes an earlier clock
PORT = 18090
PUSH_S = 0.5  # real seconds between two rounds of pushes
BATCH = 2000  # readings of one push, well below 1 MiB


def instant(text):
    return datetime.datetime.strptime(text, "%Y-%m-%dT%H:%M:%SZ").replace(
        tzinfo=datetime.timezone.utc).timestamp()


def made_site(folder):
    """The laboratory of the simulators; its meters' readings are pushed."""
    subprocess.run([f"{BUILD}/simulators/recald-sim", "building", "--out", folder, "--seed", "1",
                    "--no-faults", "--start", str(FIRST_YEAR), "--years", str(MONTHS // 12 + 2)],
                   check=True, stdout=subprocess.DEVNULL)
    text = (folder / "site.toml").read_text()
    text = re.sub(r'file = "readings.csv"\nstamps = "start"', 'source = "http"\ninterval = "15m"', text)
    # Few are kept, so that within this life old ones go.
    (folder / "soak.toml").write_text(text + f'\n[http]\nlisten = "127.0.0.1:{PORT}"\n'
                                      '[store]\nresults_kept = 6\nevent_days = 400\n')
    readings = {}
    with open(folder / "readings.csv") as rows:
        next(rows)
        for row in rows:
            stamp, meter, value, unit = row.rstrip("\n").split(",")[:4]
            readings.setdefault((meter, unit), []).append((stamp, value))
    return readings


def ask(path, body=None):
    request = urllib.request.Request(f"http://127.0.0.1:{PORT}{path}", data=body,
                                     headers={"Content-Type": "application/json"})
    with urllib.request.urlopen(request, timeout=60) as answer:
        return json.loads(answer.read())


def push(meter, unit, readings):
    body = {"meter": meter, "unit": unit,
            "readings": [{"time": stamp, "value": float(value) if value else None}
                         for stamp, value in readings]}
    return ask("/api/v1/readings", json.dumps(body).encode())


class Held:
    """What the daemon holds now."""

    def __init__(self, process, folder):
        status = Path(f"/proc/{process.pid}/status").read_text()
        self.memory_MiB = int(re.search(r"VmRSS:\s+(\d+)", status).group(1)) / 1024
        self.descriptors = len(list(Path(f"/proc/{process.pid}/fd").iterdir()))
        files = [file for file in folder.rglob("*") if file.is_file()]
        self.files = len(files)
        self.results = len(list((folder / "soak-results").glob("*")))
        self.store_MiB = (folder / "soak.db").stat().st_size / 2**20
        self.other_MiB = sum(file.stat().st_size for file in files
                             if file.parent.name.startswith("calibration-")) / 2**20
        with sqlite3.connect(f"file:{folder / 'soak.db'}?mode=ro", uri=True) as store:
            self.rows = {table: store.execute(f"SELECT count(*) FROM {table}").fetchone()[0]
                         for table in ("interval", "month", "event", "job", "forecast", "sample")}

    def print(self, month):
        rows = ", ".join(f"{count} {table}" for table, count in self.rows.items())
        print(f"month {month:3}: {self.memory_MiB:5.1f} MiB of memory, {self.descriptors} descriptors, "
              f"store {self.store_MiB:.1f} MiB, {self.results} results of {self.other_MiB:.1f} MiB, "
              f"{self.files} files; rows: {rows}", flush=True)


def main():
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        readings = made_site(folder)
        start = f"{FIRST_YEAR}-01-01T06:00:00Z"
        speed = MONTHS * 30.44 * 86400 / (MINUTES * 60)
        anchor = int(time.time())
        with open(folder / "log.txt", "w") as log:
            process = subprocess.Popen([f"{BUILD}/daemon/recald", "run", folder / "soak.toml", "--clock",
                                        f"{start}@{anchor}x{speed}"], stderr=log)
        try:
            live(process, folder, readings, lambda: instant(start) + (time.time() - anchor) * speed)
        finally:
            process.send_signal(signal.SIGTERM)
            code = process.wait(timeout=120)
        log = (folder / "log.txt").read_text()
        months = log.count("event=month_closed")
        print(f"ended with {code}; {months} months closed, {log.count('state=done')} jobs done, "
              f"{log.count('state=failed')} failed, {log.count(' error ')} errors in the log")
        for line in sorted({line.split("state=failed", 1)[1].strip() for line in log.splitlines()
                            if "state=failed" in line}):
            print("failed:", line)
        verified = subprocess.run([f"{BUILD}/daemon/recald", "verify", folder / "soak.toml"],
                                  capture_output=True, text=True)
        print("verify:", (verified.stdout + verified.stderr).strip())
        return code or verified.returncode


def live(process, folder, readings, now):
    sent = {key: 0 for key in readings}
    taken = 0
    begun = now()
    told = 0
    while process.poll() is None:
        time.sleep(PUSH_S)
        until = datetime.datetime.fromtimestamp(now() - 900, datetime.timezone.utc).strftime(
            "%Y-%m-%dT%H:%M:%SZ")
        for (meter, unit), all_readings in readings.items():
            due = []
            while sent[meter, unit] < len(all_readings) and all_readings[sent[meter, unit]][0] < until:
                due.append(all_readings[sent[meter, unit]])
                sent[meter, unit] += 1
            for first in range(0, len(due), BATCH):
                try:
                    taken += push(meter, unit, due[first:first + BATCH])["stored"]
                except urllib.error.HTTPError as refusal:
                    raise RuntimeError(f"{meter}: {refusal.read().decode()}") from refusal
                except urllib.error.URLError:
                    sent[meter, unit] -= len(due) - first  # not up yet: again in the next round
                    break
        month = int((now() - begun) / (30.44 * 86400))
        if month >= told:
            Held(process, folder).print(month)
            told = month + 10
        if month >= MONTHS:
            Held(process, folder).print(month)
            print(f"{taken} readings were taken")
            return


sys.exit(main())
