"""Buildings of the simulator with nothing hidden in them, by use and seed."""
import concurrent.futures
import os
import pathlib
import subprocess
import sys

CLIMATES = ["hot-humid", "hot-dry", "mixed", "cold", "marine"]


def make_building(simulator, out, use, number, seed):
    """Draws what the drawings say; the truth behind them is drawn by the simulator."""
    folder = pathlib.Path(out) / f"{use}-{seed}"
    if (folder / "site.toml").exists():
        return folder
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "scenario.toml").write_text(
        f'[building]\nuse = "{use}"\nstoreys = {1 + number % 4}\n'
        f'[climate]\nname = "{CLIMATES[number % len(CLIMATES)]}"\n')
    made = subprocess.run([simulator, "building", "--scenario", folder / "scenario.toml", "--out",
                           folder, "--years", "3", "--seed", str(seed)],
                          capture_output=True, text=True)
    if made.returncode == 0:
        return folder
    print(f"{folder.name}: {made.stderr.strip()}", file=sys.stderr)
    return None


def make_buildings(build, out, uses, count, seed):
    """`count` buildings of each use; a use's seeds follow each other from `seed` + 1000 times its place."""
    simulator = pathlib.Path(build) / "simulators/recald-sim"
    plans = [(use, i, seed + 1000 * u + i) for u, use in enumerate(uses) for i in range(count)]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        made = pool.map(lambda plan: make_building(simulator, out, *plan), plans)
        return [folder for folder in made if folder]
