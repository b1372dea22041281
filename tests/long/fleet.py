"""A fleet of simulated sites on one machine, measured and killed. See fleet.sh."""
import csv
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
AWAY_S = int(os.environ.get("AWAY_S", "3600"))
CALCULATED = 12
BESIDE_POISON = 24
POISON_TIME_MAX_S = 60
WORKERS = 4
MONTH = "2024-11"
DB_PORT, BROKER_PORT, WEB_PORT = 15433, 11885, 18091

as_postgres = ["setpriv", "--reuid=postgres", "--regid=postgres", "--clear-groups"] if os.geteuid() == 0 else []
started = []


def run(*command, **options):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, **options)
    if done.returncode != 0:
        raise SystemExit(f"{command} ended with {done.returncode}: {done.stdout}{done.stderr}")
    return done.stdout


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
    """A database, a broker and the record; `address` is one more that the broker has."""

    def __init__(self, place, address="", worker_keys=""):
        self.place = place
        place.mkdir()
        self.data = pathlib.Path(run(*as_postgres, "mktemp", "-d", cwd="/").strip())
        run(*as_postgres, POSTGRES / "initdb", "-D", self.data, "-U", "recald", "-A", "trust", cwd="/")
        self.database = self.database_up()
        run(POSTGRES / "createdb", "-h", "127.0.0.1", "-p", DB_PORT, "-U", "recald", "fleet")
        (place / "mosquitto.conf").write_text(
            f"listener {BROKER_PORT} 127.0.0.1\n" + (f"listener {BROKER_PORT} {address}\n" if address else "")
            + "allow_anonymous true\n" + ("user root\n" if os.geteuid() == 0 else ""))
        self.broker_up()
        (place / "fleet.toml").write_text(
            f'[record]\nurl = "postgresql://recald@127.0.0.1:{DB_PORT}/fleet"\n'
            f'[mqtt]\nurl = "mqtt://127.0.0.1:{BROKER_PORT}"\n[http]\nlisten = "127.0.0.1:{WEB_PORT}"\n'
            f'[worker]\n{worker_keys}\n')
        run(RECALD, "fleet", "init", place / "fleet.toml")

    def broker_up(self):
        self.broker = start("mosquitto", "-c", self.place / "mosquitto.conf", log=self.place / "mosquitto.log")

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

    def jobs_left(self):
        return int(self.ask("SELECT count(*) FROM job WHERE state IN ('waiting', 'running')"))

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for process in reversed(started):
            if process is not self.database:
                stop(process)
        stop(self.database, signal.SIGINT)
        shutil.rmtree(self.data, ignore_errors=True)
        started.clear()


HEAD = """[site]
id = "ID"
timezone = "America/New_York"
latitude_deg = 39.17
longitude_deg = -76.68
altitude_m = 45
watermark = "6h"
[recalibration]
schedule = "never"
[weather]
file = "weather.csv"
"""
METERS = (("electricity", 420), ("chilled_water", 1270), ("heating", 1050))


def building(site, seed):
    """Two years of an office. @return the model's part of its site file"""
    site.mkdir()
    (site / "office.toml").write_text('[building]\nuse = "office"\n')
    run(SIM, "building", "--scenario", site / "office.toml", "--out", site, "--years", "2", "--start", "2023",
        "--seed", seed, "--no-faults")
    model = (site / "site.toml").read_text()
    return model[model.index("[[model]]"):]


def keep_past(site, until):
    lines = (site / "readings.csv").read_text().splitlines(keepends=True)
    (site / "past.csv").write_text("".join(line for line in lines if line < until or line.startswith("time")))


def template(place):
    """A site whose store has two years of three meters, with their months closed."""
    site = place / "template"
    model = building(site, 5)
    meters = "".join(f'[[meter]]\nid = "{one}"\nsource = "http"\nutility = "{one}"\nrated_kW = 2000\n' for one, _ in METERS)
    text = HEAD + '[http]\nlisten = "127.0.0.1:0"\n' + meters + model
    (site / "fleet.toml").write_text(text.replace("ID", "template"))
    keep_past(site, "2024-12-01T05")
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
        with Fleet(place / f"ingest-{workers}") as fleet:
            begin = time.monotonic()
            register(fleet, site, text, SITES)
            register_s = time.monotonic() - begin
            empty = size_bytes(fleet)
            running = [fleet.worker(0) for _ in range(workers)]
            rate = load(site, SITES, 64, SECONDS)
            rate["workers"] = workers
            rate["register_s"] = register_s
            rate["bytes_an_interval"] = (size_bytes(fleet) - empty) / max(rate["entries"], 1)
            rates.append(rate)
            for process in running:
                stop(process)
    return rates


def results_of(fleet):
    """The SHA-256 of each site's newest result."""
    return dict(line.split("|") for line in fleet.ask(
        "SELECT DISTINCT ON (s.id) s.id, r.sha256 FROM result r JOIN site s ON s.number = r.site "
        "ORDER BY s.id, r.number DESC").splitlines())


def take_in(fleet, site, text, count):
    register(fleet, site, text, count)
    taking = fleet.worker(0)
    told = load(site, count, min(count, 12), 0)
    stop(taking)
    assert fleet.jobs_left() == count, fleet.jobs_left()
    return told


def calculate(fleet, workers):
    """Seconds until no job is left."""
    begin = time.monotonic()
    running = [fleet.worker(1) for _ in range(workers)]
    wait_until("the jobs", lambda: fleet.jobs_left() == 0)
    wall_s = time.monotonic() - begin
    for process in running:
        stop(process)
    return wall_s


def calculated(place, site, text):
    """Jobs of a dozen sites: how long they take, and that kills change no byte of them."""
    with Fleet(place / "calculated") as fleet:
        entries = take_in(fleet, site, text, CALCULATED)

        # Undisturbed, on both cores.
        before = size_bytes(fleet)
        alone_s = calculate(fleet, 2)
        result_bytes = (size_bytes(fleet) - before) / CALCULATED
        reference = results_of(fleet)
        assert len(reference) == CALCULATED, reference

        # Killed, two of four at a time.
        chance = random.Random(1)
        kills = rounds = different = aside = 0
        workers = [fleet.worker(1) for _ in range(WORKERS)]
        while kills < KILLS:
            run(RECALD, "fleet", "rerun", fleet.place / "fleet.toml", "--yes")
            rounds += 1
            while fleet.jobs_left() > 0:
                time.sleep(chance.uniform(1.0, 8.0))
                if kills < KILLS and fleet.jobs_left() > 0:
                    kills += 1
                    for i in chance.sample(range(WORKERS), 2):
                        os.killpg(workers[i].pid, signal.SIGKILL)
                        workers[i].wait()
                        workers[i] = fleet.worker(1)
                    # A lease of five minutes would have run out by itself; a kill is no try of the job's fault here.
                    fleet.ask("UPDATE job SET lease_until = now(), tries = 1 WHERE state = 'running' AND worker NOT IN ("
                              + ",".join(f"'{os.uname().nodename}/{one.pid}/1'" for one in workers) + ")")
                    fleet.ask("UPDATE job SET not_before = now() WHERE state = 'waiting'")
            different += sum(1 for site_id, sha in results_of(fleet).items() if reference[site_id] != sha)
            aside += int(fleet.ask("SELECT count(*) FROM job WHERE state = 'set_aside'"))
        for process in workers:
            stop(process)
        return {"sites": CALCULATED, "entries": entries, "two_workers_s": alone_s,
                "jobs_a_second": CALCULATED / alone_s, "result_bytes": result_bytes, "kills_of_two": kills, "rounds": rounds,
                "results_compared": rounds * CALCULATED, "different": different, "set_aside": aside}


def processes_of(site_id):
    """The processes that calculate a job of a site."""
    found = []
    for entry in pathlib.Path("/proc").iterdir():
        try:
            words = (entry / "cmdline").read_bytes().split(b"\0") if entry.name.isdigit() else []
            if b"--do" not in words:
                continue
            job = json.loads((pathlib.Path(words[words.index(b"--do") + 1].decode()) / "job.json").read_text())
        except (OSError, ValueError):
            continue  # it has just ended
        if job["site"] == site_id:
            found.append(int(entry.name))
    return found


def poison(place, site, text):
    """Two dozen sites beside one whose job never ends, and beside one whose job is killed each time."""
    told = {"sites": BESIDE_POISON, "time_max_s": POISON_TIME_MAX_S}
    with Fleet(place / "poison", worker_keys=f'time_max = "{POISON_TIME_MAX_S}s"') as fleet:
        take_in(fleet, site, text, BESIDE_POISON + 1)
        poisoned = f"fleet-{BESIDE_POISON + 1:04}"
        number = fleet.ask(f"SELECT number FROM site WHERE id = '{poisoned}'")

        def others_left():
            return int(fleet.ask(f"SELECT count(*) FROM job WHERE state IN ('waiting', 'running') AND site <> {number}"))

        def row():
            return fleet.ask(f"SELECT state, tries, reason FROM job WHERE site = {number}").split("|")

        calculate(fleet, WORKERS)  # all of them, undisturbed; this one also fills the caches
        for name, how in (("well", None), ("endless", signal.SIGSTOP), ("killed", signal.SIGKILL)):
            # First in the queue.
            fleet.ask("UPDATE job SET state = 'waiting', tries = 0, not_before = now(), asked = now()")
            fleet.ask(f"UPDATE job SET asked = now() - interval '1 hour' WHERE site = {number}")
            begin = time.monotonic()
            running = [fleet.worker(1) for _ in range(WORKERS)]
            others_s = None
            while others_s is None or (how and row()[0] != "set_aside"):
                for process in processes_of(poisoned) if how else []:
                    try:
                        os.kill(process, how)
                    except ProcessLookupError:
                        pass
                if others_s is None and others_left() == 0:
                    others_s = time.monotonic() - begin
                if others_s is not None:
                    fleet.ask(f"UPDATE job SET not_before = now() WHERE site = {number} AND state = 'waiting'")
                time.sleep(0.1)
            told[name] = {"others_s": others_s, "poison": row()}
            for process in running:
                stop(process)
    return told


GATEWAYS = ("north", "east", "wrong")
RATE = 60
SERVERS, FIELD = "10.231.0.1", "10.231.0.2"
NAMESPACE = "recald-fleet"


def gateway_site(place, name, number):
    site = place / name
    model = building(site, 40 + number)
    port = 11600 + number
    bus = f'[fleet]\nurl = "mqtt://{SERVERS}:{BROKER_PORT}"\n[bus.plant]\ntype = "tcp"\nhost = "127.0.0.1"\nport = {port}\n'
    meters, devices = "", f"[[endpoint]]\nport = {port}\n"
    for unit, (one, rated_kW) in enumerate(METERS, start=1):
        meters += (f'[[meter]]\nid = "{one}"\nsource = "modbus"\nutility = "{one}"\nbus = "plant"\nunit = {unit}\n'
                   f'map = "abb-b23"\nrated_kW = {rated_kW}\npoll = "5m"\n')
        devices += (f'[[endpoint.device]]\nunit = {unit}\nlayout = "abb-b23"\nrecording = "readings.csv"\nmeter = "{one}"\n'
                    f"start_kWh = 81234\n")
    (site / f"{name}.toml").write_text(HEAD.replace("ID", name) + bus + meters + model)
    (site / "meters.toml").write_text(devices)
    keep_past(site, "2024-11-29T05:00:00Z")
    run(RECALD, "import", site / f"{name}.toml", site / "past.csv", "--reason", "readings of the old system")
    return site


def difference(fleet, site):
    """Intervals of a gateway's store that the record has not, or otherwise, up to the newest that it has of all of its
    meters. @return (compared, different)"""
    file = site / f"{site.name}.toml"
    run(RECALD, "export", file, "--out", site / "intervals.csv")
    there = {}
    for line in fleet.ask(
            "SELECT DISTINCT ON (m.id, i.t_start) m.id, to_char(i.t_start AT TIME ZONE 'UTC', 'YYYY-MM-DD\"T\"HH24:MI:SS\"Z\"'), "
            "i.mean_kw FROM interval i JOIN site s ON s.number = i.site JOIN meter m ON m.site = i.site AND m.number = i.meter "
            f"WHERE s.id = '{site.name}' ORDER BY m.id, i.t_start, i.seq DESC").splitlines():
        meter, start_time, mean = line.split("|")
        there[(meter, start_time)] = mean
    until = min(max(at for meter, at in there if meter == one) for one, _ in METERS)
    compared = wrong = 0
    for row in csv.DictReader((site / "intervals.csv").open()):
        if row["timestamp"] > until:
            continue
        compared += 1
        mean, here = there.get((row["meter"], row["timestamp"])), row["value"]
        if mean is None or (here == "") != (mean == ""):
            wrong += 1
        elif here != "":
            wrong += abs(float(mean) - float(here)) > 1e-9 * abs(float(here))
    return compared, wrong


def hour(place, _site, _text):
    """Three real gateways behind a network: PostgreSQL is away for an hour, the network is cut for ten minutes, and one
    gateway's clock is wrong all the time."""
    run("ip", "netns", "add", NAMESPACE)
    try:
        run("ip", "link", "add", "recald0", "type", "veth", "peer", "name", "recald1", "netns", NAMESPACE)
        run("ip", "addr", "add", f"{SERVERS}/30", "dev", "recald0")
        run("ip", "link", "set", "recald0", "up")
        inside = ("ip", "netns", "exec", NAMESPACE)
        run(*inside, "ip", "addr", "add", f"{FIELD}/30", "dev", "recald1")
        run(*inside, "ip", "link", "set", "lo", "up")

        def link(state):
            run(*inside, "ip", "link", "set", "recald1", state)

        link("up")
        wait_until("the network", lambda: subprocess.run((*inside, "ping", "-c1", "-W1", SERVERS), capture_output=True).returncode == 0
                   if shutil.which("ping") else True, 30)
        return hour_behind(place, inside, link)
    finally:
        subprocess.run(("ip", "netns", "del", NAMESPACE), check=False)
        subprocess.run(("ip", "link", "del", "recald0"), check=False, capture_output=True)


def hour_behind(place, inside, link):
    with Fleet(place / "hour", address=SERVERS) as fleet:
        now = int(time.time())
        sites = {name: gateway_site(place, name, number) for number, name in enumerate(GATEWAYS, start=1)}
        # Meters and gateways run an hour a minute, so that November is closed within the hour.
        clock = f"2024-11-29T05:00:00Z@{now}x{RATE}"
        clocks = {"north": clock, "east": clock, "wrong": f"2027-03-01T05:00:00Z@{now}x{RATE}"}
        gateways = {}
        for name, site in sites.items():
            run(RECALD, "fleet", "add", fleet.place / "fleet.toml", site / f"{name}.toml", "--use", "office",
                "--calibrate-from", MONTH)
            start(*inside, SIM, "meters", "meters.toml", "--clock", clock, log=site / "meters.log", cwd=site)
            gateways[name] = start(*inside, RECALD, "run", site / f"{name}.toml", "--clock", clocks[name], log=site / "recald.log")
        workers = [fleet.worker(1) for _ in range(2)]

        def count(what="interval", where="true"):
            return int(fleet.ask(f"SELECT count(*) FROM {what} WHERE {where}"))

        def all_is_told():
            before = count()
            time.sleep(20)
            return before > 500_000 and count() - before < 100

        wait_until("the past of all gateways", all_is_told)
        before_hour = count()
        stop(fleet.database, signal.SIGQUIT)
        away = time.monotonic()
        time.sleep(AWAY_S / 2)
        link("down")  # also from the broker, in the middle of it
        time.sleep(AWAY_S / 6)
        link("up")
        time.sleep(max(0.0, AWAY_S - (time.monotonic() - away)))
        fleet.database = fleet.database_up()
        back = time.monotonic()

        def newest_lag_s():
            """How far the record is behind the slower of the right clocks, in seconds of the world."""
            at = float(fleet.ask("SELECT extract(epoch FROM min(newest)) FROM site WHERE id <> 'wrong'"))
            virtual_now = 1732856400 + (time.time() - now) * RATE  # 2024-11-29T05:00:00Z
            return (virtual_now - at) / RATE

        wait_until("the hour's readings", lambda: newest_lag_s() < 120)
        caught_up_s = time.monotonic() - back
        after_hour = count()
        # The network alone.
        link("down")
        time.sleep(AWAY_S / 6)
        at_cut = count()
        link("up")
        healed = time.monotonic()
        wait_until("readings after the cut", lambda: count() > at_cut + 20)
        first_after_cut_s = time.monotonic() - healed
        wait_until("the cut's readings", lambda: newest_lag_s() < 120)
        months_close = AWAY_S >= 3600
        wait_until("the calibrations", lambda: fleet.jobs_left() == 0 and
                   (not months_close or count("job", "state = 'done'") >= 2))
        portfolio = start(RECALD, "fleet", "serve", fleet.place / "fleet.toml", log=fleet.place / "serve.log")
        address = f"http://127.0.0.1:{WEB_PORT}"
        wait_until("the page", lambda: subprocess.run(("curl", "-fs", f"{address}/readyz"), capture_output=True).returncode == 0, 30)
        seen = {one["id"]: {"feed": one["feed"], "accepted": one["accepted"]}
                for one in json.loads(run("curl", "-fs", f"{address}/api/v1/portfolio"))["sites"]}
        stop(portfolio)
        for name in sites:
            stop(gateways[name])
        time.sleep(5)
        told = {"away_s": AWAY_S, "intervals_before": before_hour, "intervals_of_the_hour": after_hour - before_hour,
                "caught_up_s": caught_up_s, "cut_s": AWAY_S / 6, "first_after_cut_s": first_after_cut_s,
                "portfolio": seen, "jobs": fleet.ask("SELECT s.id, j.month, j.state, j.reason FROM job j JOIN site s "
                                                     "ON s.number = j.site ORDER BY j.number").splitlines()}
        for name, site in sites.items():
            compared, different = difference(fleet, site)
            told[name] = {"compared": compared, "missing_or_different": different}
        for process in workers:
            stop(process)
        return told


def pages(place, site, text):
    """How long pages and leases take with many sites that have two years of results each, which are copies of a few."""
    return [pages_of(place, site, text, count) for count in (SITES, 10 * SITES)]


def pages_of(place, site, text, count):
    with Fleet(place / f"pages-{count}") as fleet:
        take_in(fleet, site, text, 4)
        calculate(fleet, 2)
        fleet.ask("INSERT INTO site (id, version, added, heard, newest) "
                  f"SELECT 'copy-' || i, 1, now(), now(), now() FROM generate_series(1, {count - 4}) i")
        fleet.ask("INSERT INTO site_version SELECT s.number, 1, v.sha256, v.description, now(), v.by "
                  "FROM site s, site_version v WHERE v.site = 1 AND v.number = 1 AND s.id LIKE 'copy-%'")
        fleet.ask("INSERT INTO job (site, version, kind, month, until_seq, now, input_sha256, asked_by, state) "
                  "SELECT s.number, s.version, 'calibration', to_char(date '2023-01-01' + make_interval(months => m), 'YYYY-MM'), m, "
                  "now(), md5(s.id || '/' || m), 'month', CASE WHEN s.number % 50 = 0 THEN 'failed' ELSE 'done' END "
                  "FROM site s, generate_series(0, 23) m")
        fleet.ask("INSERT INTO result (site, job, kind, month, at, accepted, named, message, summary, sha256) "
                  "SELECT j.site, j.number, j.kind, j.month, now(), true, false, r.message, r.summary, r.sha256 "
                  "FROM job j JOIN result r ON r.number = 1 + j.number % 4 WHERE j.state = 'done' AND j.number > 4")
        fleet.ask("ANALYZE")
        serve = start(RECALD, "fleet", "serve", fleet.place / "fleet.toml", log=fleet.place / "serve.log")
        address = f"http://127.0.0.1:{WEB_PORT}"
        wait_until("the page", lambda: subprocess.run(("curl", "-fs", f"{address}/readyz"), capture_output=True).returncode == 0, 30)
        told = {"sites": count, "jobs": int(fleet.ask("SELECT count(*) FROM job"))}
        for path in ("/", "/sites/copy-500", "/rerun", "/metrics", "/readyz", "/api/v1/portfolio"):
            words = [run("curl", "-fs", "-o", fleet.place / "page", "-w", "%{time_total} %{size_download}", address + path).split()
                     for _ in range(5)]
            told[path] = {"seconds": sorted(float(one[0]) for one in words)[2], "bytes": int(words[0][1])}
        stop(serve)
        fleet.ask("UPDATE job SET state = 'waiting' WHERE month = '2024-12'")
        told["lease"] = {"waiting": fleet.jobs_left(), **json.loads(
            run(build / "tests/long/fleet_lease", f"postgresql://recald@127.0.0.1:{DB_PORT}/fleet", 200))}
        return told


def away(place, site, text):
    """PostgreSQL is killed and away for a minute, and the broker wiped, while sites send."""
    with Fleet(place / "away") as fleet:
        register(fleet, site, text, 4)
        workers = [fleet.worker(0) for _ in range(2)]
        sending = subprocess.Popen([str(word) for word in (LOAD, site / "fleet.toml", "127.0.0.1", BROKER_PORT, "", "", 4, 4, 0)],
                                   stdout=subprocess.PIPE, text=True)
        wait_until("some intervals", lambda: int(fleet.ask("SELECT count(*) FROM interval")) > 20_000)
        stop(fleet.database, signal.SIGQUIT)
        time.sleep(60)
        stop(fleet.broker, signal.SIGKILL)
        fleet.database = fleet.database_up()
        fleet.broker_up()
        told = json.loads(sending.communicate(timeout=1800)[0])
        there = int(fleet.ask("SELECT count(*) FROM interval")) + int(fleet.ask("SELECT count(*) FROM month"))
        for process in workers:
            stop(process)
        return {"told": told, "in_the_record": there, "expected": 4 * told["entries_a_site"]}


PARTS = {"away": away, "calculated": calculated, "poison": poison, "pages": pages, "ingest": ingest_rates, "hour": hour}


def main():
    signal.signal(signal.SIGTERM, lambda *_: sys.exit("ended"))  # what was started is stopped
    out.mkdir(parents=True, exist_ok=True)
    wanted = os.environ.get("PARTS", " ".join(PARTS)).split()
    with tempfile.TemporaryDirectory() as folder:
        place = pathlib.Path(folder)
        site, text = template(place)
        for name in wanted:
            file = out / f"{name}.json"
            if not file.exists():
                result = PARTS[name](place, site, text)
                file.write_text(json.dumps(result, indent=2) + "\n")
            print(f"{name}: {file.read_text()}", flush=True)


main()
