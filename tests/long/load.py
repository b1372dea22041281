"""Load of many meters on one daemon: see load.sh. Prints figures; judges nothing."""
import http.client
import json
import os
import re
import signal
import socket
import sqlite3
import struct
import subprocess
import sys
import tempfile
import threading
import time
import urllib.request
from pathlib import Path

TCP_ENDPOINTS = int(os.environ.get("ENDPOINTS", 250))
LINES = int(os.environ.get("LINES", 8))
UNITS = int(os.environ.get("UNITS", 4))
REQUESTS_PER_S = float(os.environ.get("REQUESTS", 0))
REGISTER_READS_PER_S = float(os.environ.get("REGISTER_READS", 0))
HOSTILE = int(os.environ.get("HOSTILE", 0))
CALIBRATES = os.environ.get("CALIBRATE") == "1"
# A boundary a minute, so that ten minutes have ten of them; but years of minutes are many.
INTERVAL_S = 300 if CALIBRATES else 60
TICK = os.sysconf("SC_CLK_TCK")

PLAN = f"""
[[endpoint]]
repeat = {TCP_ENDPOINTS}
[[endpoint.device]]
unit = 1
repeat = {UNITS}
layout = "abb-b23"
load_kW = 60
""" + (f"""
[[endpoint]]
type = "rtu"
link = "line"
repeat = {LINES}
[[endpoint.device]]
unit = 1
repeat = {UNITS}
layout = "abb-b23"
load_kW = 60
""" if LINES else "")

# Eight fields in two reads. The simulated device holds 0 where its makers have voltages and
# currents, so these serve as an identity that never changes.
MAP = """
source = "load script: the fields of a B23 that a dashboard would show"
base = 0
fc = 3
order = "ABCD"
energy = ["energy_import"]
power = "power"
identity = ["voltage_1", "voltage_2", "voltage_3", "current_1", "current_2", "current_3"]
register.energy_import = { at = 0x5000, type = "u64", scale = 0.01, unit = "kWh" }
register.power = { at = 0x5B14, type = "i32", scale = 0.01, unit = "W" }
register.voltage_1 = { at = 0x5B00, type = "u32" }
register.voltage_2 = { at = 0x5B02, type = "u32" }
register.voltage_3 = { at = 0x5B04, type = "u32" }
register.current_1 = { at = 0x5B0C, type = "u32" }
register.current_2 = { at = 0x5B0E, type = "u32" }
register.current_3 = { at = 0x5B10, type = "u32" }
"""


def site(addresses, head, rest):
    """The site file: a bus for each address, UNITS meters on each, and what else it has."""
    text = head + """
[http]
listen = "127.0.0.1:0"
""" + ("""[modbus]
listen = "127.0.0.1:0"
""" if REGISTER_READS_PER_S else "")
    meters = ""
    for number, address in enumerate(addresses):
        host, _, port = address.rpartition(":")
        where = (f'type = "tcp"\nhost = "{host}"\nport = {port}' if host
                 else f'type = "rtu"\nport = "{address}"\nbaud = 115200')
        text += f"[bus.b{number}]\n{where}\n"
        for unit in range(1, UNITS + 1):
            meters += (f'[[meter]]\nid = "b{number}-u{unit}"\nsource = "modbus"\n'
                       f'utility = "electricity"\nbus = "b{number}"\nunit = {unit}\n'
                       f'map = "eight-fields.toml"\nrated_kW = 400\npoll = "10s"\n')
    return text + meters + rest


def building(folder, build):
    """A building to calibrate, told in a site file of its own: its head and the rest of it.

    The laboratory of the simulators, metered until now and then no more.
    """
    year = time.gmtime().tm_year
    subprocess.run([f"{build}/simulators/recald-sim", "building", "--out", folder / "building",
                    "--seed", "1", "--start", str(year - 2), "--years", "3"],
                   check=True, stdout=subprocess.DEVNULL)
    now = time.strftime("%Y-%m-%dT%H:%M", time.gmtime())
    rows = (folder / "building" / "readings.csv").read_text().splitlines(keepends=True)
    (folder / "readings.csv").write_text("".join(rows[:1] + [row for row in rows[1:] if row < now]))
    (folder / "building" / "weather.csv").rename(folder / "weather.csv")
    text = (folder / "building" / "site.toml").read_text()
    text = re.sub(r'file = "readings.csv"\nstamps = "start"', 'source = "http"\ninterval = "15m"', text)
    head, rest = re.split(r"\n(?=\[weather\])", text, maxsplit=1)
    return re.sub(r'interval = "\w+"', f'interval = "{INTERVAL_S // 60}m"', head), rest


def calibrations(port):
    return json.loads(fetch(f"http://127.0.0.1:{port}/api/v1/calibrations"))["calibrations"]


class Recalibrating(threading.Thread):
    """Asks for a calibration whenever none is under way."""

    def __init__(self, port):
        super().__init__(daemon=True)
        self.port = port
        self.goes_on = True

    def run(self):
        while self.goes_on:
            if not any(job["state"] in ("waiting", "running") for job in calibrations(self.port)):
                urllib.request.urlopen(urllib.request.Request(
                    f"http://127.0.0.1:{self.port}/api/v1/calibrations", data=b"{}",
                    headers={"Content-Type": "application/json"}), timeout=30).read()
            time.sleep(1)


def wait_for(path, pattern, process, seconds=60):
    """The first match in a growing file; None where the process ends or time runs out."""
    for _ in range(seconds * 10):
        found = re.search(pattern, path.read_text())
        if found or process.poll() is not None:
            return found
        time.sleep(0.1)
    return None


def cpu_s(pid):
    fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / TICK


def memory_MiB(pid, name):
    status = Path(f"/proc/{pid}/status").read_text()
    return int(re.search(rf"^{name}:\s+(\d+) kB", status, re.M).group(1)) / 1024


def quantile_bound(buckets, share):
    """The upper edge of the histogram bucket in which the quantile lies, summed over all buses."""
    total = buckets.get("+Inf", 0)
    edges = sorted((float(edge), count) for edge, count in buckets.items() if edge != "+Inf")
    return next((edge for edge, count in edges if total and count >= share * total), None)


def shares(buckets):
    """How many of the polls are within each edge that matters, as text."""
    total = buckets.get("+Inf", 0)
    return ", ".join(f"{edge} s {100 * buckets[edge] / total:.2f} %"
                     for edge in ("0.025", "0.05", "0.1", "0.25", "0.5") if edge in buckets)


def print_lateness(metrics):
    """Lateness by kind of bus: the first TCP_ENDPOINTS buses are TCP, the rest lines."""
    line = re.compile(r'recald_poll_lateness_seconds_bucket\{(.*)\} (\S+)')
    by_kind = {"tcp": {}, "lines": {}}
    for labels, value in line.findall(metrics):
        bus = re.search(r'bus="b(\d+)"', labels)
        edge = re.search(r'le="([^"]+)"', labels).group(1)
        kind = "lines" if bus and int(bus.group(1)) >= TCP_ENDPOINTS else "tcp"
        by_kind[kind][edge] = by_kind[kind].get(edge, 0) + float(value)
    for kind, buckets in by_kind.items():
        if buckets:
            print(f"poll lateness, {kind}: p50 <= {quantile_bound(buckets, 0.5)} s, "
                  f"p99 <= {quantile_bound(buckets, 0.99)} s of {buckets.get('+Inf', 0):.0f} polls; "
                  f"within {shares(buckets)}")
        else:
            print(f"poll lateness, {kind}: not in /metrics")


def fetch(url):
    try:
        with urllib.request.urlopen(url, timeout=30) as reply:
            return reply.read().decode()
    except OSError as error:
        return f"no metrics: {error}"


class Asking(threading.Thread):
    """Asks the API so many times a second over one connection, the meters and an interval list."""

    def __init__(self, port):
        super().__init__(daemon=True)
        self.connection = http.client.HTTPConnection("127.0.0.1", port, timeout=30)
        self.waits_s = []
        self.wrong = 0
        self.goes_on = True

    def run(self):
        begin = time.monotonic()
        while self.goes_on:
            due = begin + len(self.waits_s) / REQUESTS_PER_S
            time.sleep(max(0.0, due - time.monotonic()))
            asked = time.monotonic()
            path = ("/api/v1/meters/b0-u1", "/healthz",
                    "/api/v1/intervals?meter=b0-u1&limit=20")[len(self.waits_s) % 3]
            self.connection.request("GET", path)
            reply = self.connection.getresponse()
            reply.read()
            self.wrong += reply.status != 200
            self.waits_s.append(time.monotonic() - asked)

    def print_figures(self, elapsed_s):
        print_waits(f"requests, {self.wrong} refused", self.waits_s, elapsed_s)


def print_waits(what, waits_s, elapsed_s):
    waits = sorted(waits_s) or [float("nan")]
    print(f"{what}: {len(waits_s) / elapsed_s:.0f} a second, answered within "
          f"{1e3 * waits[len(waits) // 2]:.2f} ms (half), "
          f"{1e3 * waits[int(0.99 * (len(waits) - 1))]:.2f} ms (99 %), {1e3 * waits[-1]:.1f} ms (all)")


class ReadingRegisters(threading.Thread):
    """Reads 125 registers so many times a second over one connection, as a BMS would."""

    def __init__(self, port):
        super().__init__(daemon=True)
        self.socket = socket.create_connection(("127.0.0.1", port), timeout=30)
        self.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self.waits_s = []
        self.goes_on = True

    def run(self):
        begin = time.monotonic()
        while self.goes_on:
            number = len(self.waits_s)
            time.sleep(max(0.0, begin + number / REGISTER_READS_PER_S - time.monotonic()))
            asked = time.monotonic()
            self.socket.sendall(struct.pack(">HHHBBHH", number % 65536, 0, 6, 1, 4,
                                            125 * (number % 10), 125))
            reply = b""
            while len(reply) < 9 + 250:
                reply += self.socket.recv(1024)
                assert reply, "the connection was closed"
            assert reply[:2] == struct.pack(">H", number % 65536) and reply[7:9] == b"\x04\xfa"
            self.waits_s.append(time.monotonic() - asked)


class Hostile(threading.Thread):
    """HOSTILE clients that hold what they can get, in turns of some seconds: a refused body that goes on, half a
    body, a large answer that is not read, pages one after the other. /healthz beside them on connections of its own."""

    KINDS = (b"POST /x HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Type: text/plain\r\nContent-Length: 1000000\r\n\r\n",
             b"POST /api/v1/readings HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Type: application/json\r\n"
             b"Content-Length: 1000\r\n\r\n{",
             b"GET /charts.js HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n",
             b"GET /meters/b0-u1 HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n" * 20)
    STAYS_S = 9.0

    def __init__(self, port):
        super().__init__(daemon=True)
        self.port = port
        self.held = []
        self.opened = 0
        self.waits_s = []
        self.wrong = 0
        self.goes_on = True

    def open_one(self):
        client = socket.create_connection(("127.0.0.1", self.port), timeout=2)
        client.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 2048)
        client.sendall(self.KINDS[self.opened % len(self.KINDS)])
        self.opened += 1
        return time.monotonic(), client

    def ask_health(self):
        asked = time.monotonic()
        try:
            with urllib.request.urlopen(f"http://127.0.0.1:{self.port}/healthz", timeout=30) as reply:
                self.wrong += reply.status != 200
        except OSError:
            self.wrong += 1
        self.waits_s.append(time.monotonic() - asked)

    def run(self):
        while self.goes_on:
            gone = [one for one in self.held if time.monotonic() - one[0] > self.STAYS_S]
            self.held = [one for one in self.held if one not in gone]
            for _, client in gone:
                client.close()
            while len(self.held) < HOSTILE:
                try:
                    self.held.append(self.open_one())
                except OSError:
                    break
            self.ask_health()
            time.sleep(0.2)


def print_intervals(store, meters, first, last):
    """Of the slots between two boundaries, how many are stored and how many of them `ok` (0)."""
    db = sqlite3.connect(f"file:{store}?mode=ro", uri=True)
    slots = (last - first) // INTERVAL_S
    latest = ("SELECT meter, t_start, max(revision), validity FROM interval "
              "JOIN meter ON number = meter AND id GLOB 'b*-u*' "
              "WHERE t_start >= ? AND t_start < ? GROUP BY meter, t_start")
    counts = dict(db.execute(f"SELECT validity, count(*) FROM ({latest}) GROUP BY validity",
                             (first, last)))
    ok = counts.get(0, 0)
    print(f"slots of {INTERVAL_S} s over {slots} boundaries: expected {meters * slots}, "
          f"stored {sum(counts.values())}, ok {ok}, missed {meters * slots - ok}")
    print("by validity (0 ok, 1 missing, 2 filled, 3 scaled, 4 suspect):", counts)


def main(build, minutes):
    folder = Path(tempfile.mkdtemp(prefix="recald-load-"))
    (folder / "plan.toml").write_text(PLAN)
    (folder / "eight-fields.toml").write_text(MAP)
    said_by_sim, said_by_daemon = folder / "sim.txt", folder / "daemon.txt"
    with open(said_by_sim, "w") as out:
        sim = subprocess.Popen([f"{build}/simulators/recald-sim", "meters", folder / "plan.toml"],
                               stdout=out, stderr=subprocess.STDOUT)
    daemon = None
    try:
        if not wait_for(said_by_sim, "ready: ", sim):
            sys.exit(f"the simulated devices did not start: {said_by_sim.read_text()}")
        addresses = re.findall(r"listening on (\S+): ", said_by_sim.read_text())
        head = f'[site]\nid = "load"\ntimezone = "UTC"\ninterval = "{INTERVAL_S // 60}m"\n'
        rest = ""
        if CALIBRATES:
            head, rest = building(folder, build)
        (folder / "site.toml").write_text(site(addresses, head, rest))
        if CALIBRATES:
            subprocess.run([f"{build}/daemon/recald", "import", folder / "site.toml",
                            folder / "readings.csv", "--reason", "load"], check=True)
        with open(said_by_daemon, "w") as out:
            daemon = subprocess.Popen([f"{build}/daemon/recald", "run", folder / "site.toml"],
                                      stdout=out, stderr=subprocess.STDOUT)
        if not wait_for(said_by_daemon, "event=started", daemon):
            sys.exit(f"the daemon did not start: {said_by_daemon.read_text()}")
        listening = wait_for(said_by_daemon, r"event=listening .*port=(\d+)", daemon, seconds=5)
        print(f"{len(addresses)} endpoints, {len(addresses) * UNITS} meters, {minutes:g} minutes; "
              f"files in {folder}", flush=True)

        time.sleep(INTERVAL_S)  # until every meter has a first sample
        first = int(-(-time.time() // INTERVAL_S)) * INTERVAL_S
        begin, begin_s, sim_begin_s = time.time(), cpu_s(daemon.pid), cpu_s(sim.pid)
        resident = []
        asking = Asking(int(listening.group(1))) if listening and REQUESTS_PER_S else None
        if asking:
            asking.start()
        registers = None
        if REGISTER_READS_PER_S:
            port = wait_for(said_by_daemon, r"event=listening_modbus .*port=(\d+)", daemon)
            registers = ReadingRegisters(int(port.group(1)))
            registers.start()
        recalibrating = Recalibrating(listening.group(1)) if listening and CALIBRATES else None
        if recalibrating:
            recalibrating.start()
        hostile = Hostile(int(listening.group(1))) if listening and HOSTILE else None
        if hostile:
            hostile.start()
        while time.time() < begin + 60 * minutes:
            time.sleep(5)
            if daemon.poll() is not None:
                sys.exit(f"the daemon ended: {said_by_daemon.read_text()[-2000:]}")
            resident.append(memory_MiB(daemon.pid, "VmRSS"))
        elapsed_s = time.time() - begin
        if asking:
            asking.goes_on = False
            asking.join()
            asking.print_figures(elapsed_s)
        if hostile:
            hostile.goes_on = False
            hostile.join()
            print_waits(f"/healthz beside {HOSTILE} hostile clients ({hostile.opened} connections), "
                        f"{hostile.wrong} refused", hostile.waits_s, elapsed_s)
        if registers:
            registers.goes_on = False
            registers.join()
            print_waits("register reads", registers.waits_s, elapsed_s)
        if recalibrating:
            recalibrating.goes_on = False
            recalibrating.join()
            states = [job["state"] for job in calibrations(listening.group(1))]
            print("calibrations:", {state: states.count(state) for state in set(states)})
        last = int(time.time() // INTERVAL_S) * INTERVAL_S
        print(f"daemon: {100 * (cpu_s(daemon.pid) - begin_s) / elapsed_s:.1f} % of a core, "
              f"resident {resident[-1]:.1f} MiB at the end, "
              f"{memory_MiB(daemon.pid, 'VmHWM'):.1f} MiB at most")
        print(f"devices: {100 * (cpu_s(sim.pid) - sim_begin_s) / elapsed_s:.1f} % of a core, "
              f"resident {memory_MiB(sim.pid, 'VmRSS'):.1f} MiB; load average "
              f"{os.getloadavg()[0]:.1f} on {os.cpu_count()} cores")
        print_lateness(fetch(f"http://127.0.0.1:{listening.group(1)}/metrics") if listening else "")
        time.sleep(15)  # the last boundary's reads and its commit
        daemon.send_signal(signal.SIGTERM)
        print(f"daemon ended with {daemon.wait()}")
        print_intervals(folder / "site.db", len(addresses) * UNITS, first, last)
    finally:
        for process in (daemon, sim):
            if process and process.poll() is None:
                process.send_signal(signal.SIGTERM)
                process.wait()
    print("devices saw:", said_by_sim.read_text().splitlines()[-1])


if __name__ == "__main__":
    main(sys.argv[1], float(sys.argv[2]))
