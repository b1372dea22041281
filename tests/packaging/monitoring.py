"""Rules by promtool; then the daemon is scraped, and each query of the dashboard and the rules is asked."""
import datetime
import json
import pathlib
import re
import shutil
import socket
import subprocess
import sys
import tempfile
import time
import urllib.parse
import urllib.request

recald, programs, monitoring, rule_tests = (pathlib.Path(argument) for argument in sys.argv[1:])
WAIT_S = 60

SITE = """[site]
id = "tower"
timezone = "America/Chicago"
[http]
listen = "127.0.0.1:{port}"
[[meter]]
id = "chw"
utility = "chilled_water"
source = "http"
"""


def free_port():
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


def asked(url, body=None):
    request = urllib.request.Request(url, body, {"Content-Type": "application/json"})
    with urllib.request.urlopen(request, timeout=10) as answer:
        return json.load(answer)


def eventually(what, ask):
    for _ in range(WAIT_S * 4):
        try:
            if answer := ask():
                return answer
        except OSError:
            pass  # not up yet
        time.sleep(0.25)
    sys.exit(f"waited for {WAIT_S} s: {what}")


def end(process):
    process.terminate()
    process.wait(timeout=30)


folder = pathlib.Path(tempfile.mkdtemp())
rules = monitoring / "recald-alerts.yml"
shutil.copy(rules, folder)
shutil.copy(rule_tests, folder)
for arguments in (["check", "rules", rules.name], ["test", "rules", rule_tests.name]):
    subprocess.run([programs / "promtool", *arguments], cwd=folder, check=True)

port, prometheus_port = free_port(), free_port()
(folder / "site.toml").write_text(SITE.format(port=port))
(folder / "prometheus.yml").write_text(json.dumps({
    "rule_files": [rules.name],
    "global": {"evaluation_interval": "1s"},
    "scrape_configs": [{"job_name": "recald", "scrape_interval": "1s",
                        "static_configs": [{"targets": [f"127.0.0.1:{port}"]}]}]}))
daemon = subprocess.Popen([recald, "run", folder / "site.toml"])
prometheus = subprocess.Popen([programs / "prometheus", "--config.file=prometheus.yml", "--storage.tsdb.path=data",
                               f"--web.listen-address=127.0.0.1:{prometheus_port}", "--log.level=error"], cwd=folder)
try:
    start = datetime.datetime.now(datetime.timezone.utc) - datetime.timedelta(hours=2)
    reading = json.dumps({"meter": "chw", "unit": "kWh", "readings": [
        {"time": start.strftime("%Y-%m-%dT%H:00:00Z"), "value": 15.0}]}).encode()
    eventually("the daemon takes a reading", lambda: asked(f"http://127.0.0.1:{port}/api/v1/readings", reading))

    def result(query):
        answer = asked(f"http://127.0.0.1:{prometheus_port}/api/v1/query?" + urllib.parse.urlencode({"query": query}))
        return answer["data"]["result"]

    value = eventually("Prometheus has the reading", lambda: result("recald_interval_mean_kilowatts"))
    assert float(value[0]["value"][1]) == 60.0, value
    assert value[0]["metric"]["meter"] == "chw" and value[0]["metric"]["utility"] == "chilled_water", value

    dashboard = json.loads((monitoring / "recald-grafana.json").read_text())
    queries = [target["expr"] for panel in dashboard["panels"] for target in panel["targets"]]
    queries = [re.sub(r"\$\w+", ".*", query) for query in queries]
    assert len(queries) >= 10, queries
    for query in queries:
        result(query)  # a query that Prometheus cannot read is an error
    assert result(queries[0].split(" unless ")[0].replace("recald_power", "recald_interval_mean")), "nothing to draw"

    # Every metric that is asked for is one that the daemon documents.
    documented = (monitoring / "../../gateway/serve/README.md").read_text()
    for name in sorted(set(re.findall(r"recald_\w+", " ".join(queries) + rules.read_text()))):
        base = re.sub(r"_(bucket|count|sum)$", "", name)
        assert base in documented, f"{name} is not among the metrics of daemon/gateway/serve/README.md"

    def healths():
        groups = asked(f"http://127.0.0.1:{prometheus_port}/api/v1/rules")["data"]["groups"]
        found = [rule["health"] for group in groups for rule in group["rules"]]
        return found if found and "unknown" not in found else None

    found = eventually("all rules are evaluated", healths)
    assert set(found) == {"ok"}, found
finally:
    end(prometheus)
    end(daemon)
    shutil.rmtree(folder)
print("rules, dashboard and a scraped daemon agree")
