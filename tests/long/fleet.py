"""A fleet of simulated sites on one machine, measured and killed. See fleet.sh."""
import json
import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time

build, out = map(pathlib.Path, sys.argv[1:3])
RECALD = build / "daemon/recald"
SIM = build / "simulators/recald-sim"
LOAD = build / "tests/long/fleet_load"
POSTGRES = pathlib.Path("/usr/lib/postgresql/15/bin")
SITES = int(os.environ.get("SITES", "1000"))
SECONDS = int(os.environ.get("SECONDS", "120"))
KILLS = int(os.environ.get("KILLS", "100"))
CALCULATED = 12
WORKERS = 4
MONTH = "2024-11"
DB_PORT, BROKER_PORT, WEB_PORT = 15433, 11885, 18091

as_postgres = ["setpriv", "--reuid=postgres", "--regid=postgres", "--clear-groups"] if os.geteuid() == 0 else []
started = []


def run(*command, **options):
    return subprocess.run([str(word) for word in command], check=True, capture_output=True, text=True, **options).stdout


def start(*command, log, **options):
    process = subprocess.Popen([str(word) for word in command], stdout=open(log, "a"), stderr=subprocess.STDOUT, **options)
    started.append(process)
    return process


def stop(process, how=signal.SIGTERM):
    if process.poll() is None:
        process.send_signal(how)
    process.wait()


def wait_until(what, is_so, seconds=1800.0):
    end = time.monotonic() + seconds
    while not is_so():
        if time.monotonic() > end:
            raise SystemExit(f"timed out waiting for: {what}")
        time.sleep(0.5)


class Fleet:
    def __init__(self, place):
        self.place = place
        self.data = pathlib.Path(run(*as_postgres, "mktemp", "-d", cwd="/").strip())
        run(*as_postgres, POSTGRES / "initdb", "-D", self.data, "-U", "recald", "-A", "trust", cwd="/")
        self.database = self.database_up()
        run(POSTGRES / "createdb", "-h", "127.0.0.1", "-p", DB_PORT, "-U", "recald", "fleet")
        (place / "mosquitto.conf").write_text(
            f"listener {BROKER_PORT} 127.0.0.1\nallow_anonymous true\n" + ("user root\n" if os.geteuid() == 0 else ""))
        self.broker = start("mosquitto", "-c", place / "mosquitto.conf", log=place / "mosquitto.log")
        (place / "fleet.toml").write_text(
            f'[record]\nurl = "postgresql://recald@127.0.0.1:{DB_PORT}/fleet"\n'
            f'[mqtt]\nurl = "mqtt://127.0.0.1:{BROKER_PORT}"\n[http]\nlisten = "127.0.0.1:{WEB_PORT}"\n')
        run(RECALD, "fleet", "init", place / "fleet.toml")

    def database_up(self):
        process = start(*as_postgres, POSTGRES / "postgres", "-D", self.data, "-p", DB_PORT, "-k", self.data, "-h", "127.0.0.1",
                        log=self.place / "database.log", cwd="/")
        wait_until("PostgreSQL", lambda: subprocess.run(
            [POSTGRES / "pg_isready", "-h", "127.0.0.1", "-p", str(DB_PORT)], capture_output=True).returncode == 0, 60)
        return process

    def ask(self, statement):
        return run(POSTGRES / "psql", "-h", "127.0.0.1", "-p", DB_PORT, "-U", "recald", "fleet", "-Atc", statement).strip()

    def worker(self, jobs):
        return start(RECALD, "worker", self.place / "fleet.toml", "--jobs", jobs, log=self.place / "worker.log",
                     start_new_session=True)

    def close(self):
        for process in reversed(started):
            if process is not self.database:
                stop(process)
        stop(self.database, signal.SIGINT)
        shutil.rmtree(self.data, ignore_errors=True)


def template(place):
    """A site whose store has two years of three meters, with their months closed."""
    site = place / "template"
    site.mkdir()
    (site / "office.toml").write_text('[building]\nuse = "office"\n')
    run(SIM, "building", "--scenario", site / "office.toml", "--out", site, "--years", "2", "--start", "2023",
        "--seed", "5", "--no-faults")
    model = (site / "site.toml").read_text()
    model = model[model.index("[[model]]"):]
    meters = "".join(f'[[meter]]\nid = "{one}"\nsource = "http"\nutility = "{one}"\nrated_kW = 2000\n'
                     for one in ("electricity", "chilled_water", "heating"))
    head = ('[site]\nid = "ID"\ntimezone = "America/New_York"\nlatitude_deg = 39.17\nlongitude_deg = -76.68\naltitude_m = 45\n'
            'watermark = "6h"\n[http]\nlisten = "127.0.0.1:0"\n[recalibration]\nschedule = "never"\n'
            '[weather]\nfile = "weather.csv"\n')
    text = head + meters + model
    (site / "fleet.toml").write_text(text.replace("ID", "template"))
    lines = (site / "readings.csv").read_text().splitlines(keepends=True)
    (site / "past.csv").write_text("".join(line for line in lines if line < "2024-12-01T05" or line.startswith("time")))
    run(RECALD, "import", site / "fleet.toml", site / "past.csv", "--reason", "readings of the old system")
    daemon = start(RECALD, "run", site / "fleet.toml", "--clock", f"2024-12-01T05:00:00Z@{int(time.time())}x3600", log=site / "run.log")
    try:
        wait_until("months", lambda: run(RECALD, "export", site / "fleet.toml", "--months").count(f"\n{MONTH},") == 3, 120)
    finally:
        stop(daemon)
    return site, text


def register(fleet, site, text, count):
    files = []
    for i in range(1, count + 1):
        file = site / f"fleet-{i:04}.toml"
        file.write_text(text.replace('"ID"', f'"fleet-{i:04}"'))
        files.append(file)
    run(RECALD, "fleet", "add", fleet.place / "fleet.toml", *files, "--use", "office", "--calibrate-from", MONTH)


def load(site, sites, at_once, seconds):
    return json.loads(run(LOAD, site / "fleet.toml", "127.0.0.1", BROKER_PORT, "", "", sites, at_once, seconds))


def size_bytes(fleet):
    return int(fleet.ask("SELECT pg_database_size('fleet')"))


def ingest_rates(place, site, text):
    """Intervals a second, by the number of workers that take them in."""
    rates = []
    for workers in (1, 2, 4):
        folder = place / f"ingest-{workers}"
        folder.mkdir()
        fleet = Fleet(folder)
        try:
            register(fleet, site, text, SITES)
            empty = size_bytes(fleet)
            running = [fleet.worker(0) for _ in range(workers)]
            rate = load(site, SITES, 64, SECONDS)
            rate["workers"] = workers
            rate["bytes_an_interval"] = (size_bytes(fleet) - empty) / max(rate["entries"], 1)
            rates.append(rate)
            for process in running:
                stop(process)
        finally:
            fleet.close()
            started.clear()
    return rates


def calculated(place, site, text):
    """Jobs of a dozen sites: how long they take, and that kills change no byte of them."""
    folder = place / "calculated"
    folder.mkdir()
    fleet = Fleet(folder)
    try:
        register(fleet, site, text, CALCULATED)
        taking = fleet.worker(0)
        entries = load(site, CALCULATED, CALCULATED, 0)
        stop(taking)

        def left():
            return int(fleet.ask("SELECT count(*) FROM job WHERE state IN ('waiting', 'running')"))

        def sums():
            return dict(line.split("|") for line in fleet.ask(
                "SELECT DISTINCT ON (s.id) s.id, r.sha256 FROM result r JOIN site s ON s.number = r.site "
                "ORDER BY s.id, r.number DESC").splitlines())

        # Undisturbed, on both cores.
        assert left() == CALCULATED, left()
        before = size_bytes(fleet)
        begin = time.monotonic()
        pair = [fleet.worker(1) for _ in range(2)]
        wait_until("the first results", lambda: left() == 0)
        alone_s = time.monotonic() - begin
        for process in pair:
            stop(process)
        result_bytes = (size_bytes(fleet) - before) / CALCULATED
        reference = sums()
        assert len(reference) == CALCULATED, reference

        # Killed, two of four at a time.
        chance = random.Random(1)
        kills = rounds = different = aside = 0
        workers = [fleet.worker(1) for _ in range(WORKERS)]
        while kills < KILLS:
            run(RECALD, "fleet", "rerun", folder / "fleet.toml", "--yes")
            rounds += 1
            while left() > 0:
                time.sleep(chance.uniform(1.0, 8.0))
                if kills < KILLS and left() > 0:
                    for i in chance.sample(range(WORKERS), 2):
                        os.killpg(workers[i].pid, signal.SIGKILL)
                        workers[i].wait()
                        workers[i] = fleet.worker(1)
                        kills += 1
                    # A lease of five minutes would have run out by itself; a kill is no try of the job's fault here.
                    fleet.ask("UPDATE job SET lease_until = now(), tries = 1 WHERE state = 'running' AND worker NOT IN ("
                              + ",".join(f"'{os.uname().nodename}/{one.pid}/1'" for one in workers) + ")")
                    fleet.ask("UPDATE job SET not_before = now() WHERE state = 'waiting'")
            different += sum(1 for site_id, sha in sums().items() if reference[site_id] != sha)
            aside += int(fleet.ask("SELECT count(*) FROM job WHERE state = 'set_aside'"))
        for process in workers:
            stop(process)
        return {"sites": CALCULATED, "entries": entries, "two_workers_s": alone_s,
                "jobs_a_second": CALCULATED / alone_s, "result_bytes": result_bytes, "kills": kills, "rounds": rounds,
                "results_compared": rounds * CALCULATED, "different": different, "set_aside": aside}
    finally:
        fleet.close()
        started.clear()


def away(place, site, text):
    """PostgreSQL is killed and away for a minute, and the broker wiped, while sites send."""
    folder = place / "away"
    folder.mkdir()
    fleet = Fleet(folder)
    try:
        register(fleet, site, text, 4)
        workers = [fleet.worker(0) for _ in range(2)]
        sending = subprocess.Popen([str(word) for word in (LOAD, site / "fleet.toml", "127.0.0.1", BROKER_PORT, "", "", 4, 4, 0)],
                                   stdout=subprocess.PIPE, text=True)
        wait_until("some intervals", lambda: int(fleet.ask("SELECT count(*) FROM interval")) > 20_000)
        stop(fleet.database, signal.SIGQUIT)
        time.sleep(60)
        stop(fleet.broker, signal.SIGKILL)
        fleet.database = fleet.database_up()
        fleet.broker = start("mosquitto", "-c", folder / "mosquitto.conf", log=folder / "mosquitto.log")
        told = json.loads(sending.communicate(timeout=1800)[0])
        there = int(fleet.ask("SELECT count(*) FROM interval")) + int(fleet.ask("SELECT count(*) FROM month"))
        for process in workers:
            stop(process)
        return {"told": told, "in_the_record": there, "expected": 4 * told["entries_a_site"]}
    finally:
        fleet.close()
        started.clear()


def main():
    out.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        place = pathlib.Path(folder)
        site, text = template(place)
        for name, part in (("away", away), ("calculated", calculated), ("ingest", ingest_rates)):
            file = out / f"{name}.json"
            if not file.exists():
                result = part(place, site, text)
                file.write_text(json.dumps(result, indent=2) + "\n")
            print(f"{name}: {file.read_text()}", flush=True)


main()
