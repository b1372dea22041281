"""Figures of what each hidden effect does to the meters. See footprints.sh.

footprints.py RECALD_SIM OUT                  each effect where it is visible, a week of each use, and a README.md
footprints.py --twins POPULATION OUT          each case of a blind population made with --twins, of either world
"""
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import textwrap
import zoneinfo

import matplotlib
import pandas as pd

matplotlib.use("svg")
# Same figures, same bytes; text stays text.
matplotlib.rcParams.update({"svg.hashsalt": "recald", "svg.fonttype": "none", "font.size": 8, "axes.spines.top": False, "axes.spines.right": False,
                            "path.simplify_threshold": 1.0})  # fmt: skip
import matplotlib.pyplot as plt  # noqa: E402

YEAR = 2022
INTERVAL_H = 0.25
NOTHING_KW = 0.001  # No building's meter resolves a watt.
KW_OF = {"kW": 1.0, "ton": 3.516853, "kWh": 1 / INTERVAL_H, "kBtu": 0.293071 / INTERVAL_H, "therm": 29.3071 / INTERVAL_H}
# Distinguishable with colour blindness: Okabe, Ito (2008), Color Universal Design.
COLOURS = {"electricity": "#4d4d4d", "chilled_water": "#0072b2"}
HEAT = "#d55e00"
# Effects that need another building than a plain office in the mixed climate: plant, weather or people.
SHOWN_IN = {
    "cooking": {"plant": {"heating": "boiler"}}, "deep_drying": {"climate": "hot-humid"}, "ground_coupling": {"climate": "cold"},
    "humidifier": {"climate": "cold"}, "irrigation_pumps": {"climate": "hot-dry"}, "night_purge": {"climate": "hot-dry"},
    "open_windows": {"climate": "marine"}, "semester_calendar": {"use": "laboratory"}, "snow_melting": {"climate": "cold"},
    "stack_infiltration": {"climate": "cold"}, "swimming_pool": {"use": "school"},
}  # fmt: skip
NEEDS = {"skylight": {"climate": "cold", "skylight_share": 0.3}, "heat pump": {"plant": {"heating": "heat_pump"}},
         "chiller": {"plant": {"cooling": "chiller"}}, "fuel": {"plant": {"heating": "boiler"}}, "economiser": {"climate": "marine"}}  # fmt: skip
DATES = {"vacancy": {"from": f"{YEAR}-02-01", "to": f"{YEAR}-10-31"}}  # People come back.
USES = ["office", "laboratory", "school", "shop", "hotel", "clinic", "warehouse", "restaurant", "gym"]
WEEKS = {"January": "2022-01-24", "August": "2022-08-22"}  # Without holidays; all uses work.


def toml(value):
    return json.dumps(value)  # Texts and numbers are written alike.


def scenario(building, effect=None):
    plant = building.get("plant", {})
    lines = ["[building]", f"use = {toml(building.get('use', 'office'))}"]
    lines += [f"skylight_share = {building['skylight_share']}"] if "skylight_share" in building else []
    lines += ["[climate]", f"name = {toml(building.get('climate', 'mixed'))}", "[period]", f"start = {YEAR}", "years = 1", 'step = "15m"', "[meters]", 'care = "perfect"']
    lines += ["[plant]", *(f"{key} = {toml(value)}" for key, value in plant.items())] if plant else []
    if effect:
        lines += ["[[effect]]", *(f"{key} = {toml(value)}" for key, value in effect.items())]
    return "\n".join(lines) + "\n"


def simulated(sim, folder, building, effect=None):
    (folder / "scenario.toml").write_text(scenario(building, effect))
    command = [sim, "building", "--scenario", folder / "scenario.toml", "--out", folder, "--twin"]
    ended = subprocess.run(command, capture_output=True, text=True, check=False)
    return ended.stderr if ended.returncode else None


class Feed:
    """A building without its effects, and what they add, by meter in kW on the local clock."""

    def __init__(self, folder, plain="twin_readings.csv"):
        site = (folder / "site.toml").read_text()
        self.zone = zoneinfo.ZoneInfo(re.search(r'timezone = "(.*?)"', site)[1])
        self.building = site.partition("\n\n")[0].replace("# ", "").replace("\n", " ").split(". Numbers")[0]
        self.plain_kW, self.added_kW = self.read(folder / plain), self.read(folder / "footprint.csv")
        weather = pd.read_csv(folder / "weather.csv", index_col="timestamp", parse_dates=True)
        self.outdoor_C = weather["dry_bulb_C"].tz_convert(self.zone)

    def read(self, file):
        table = pd.read_csv(file, parse_dates=["timestamp"])
        table["kW"] = table["value"] * table["unit"].map(KW_OF)
        return table.pivot(index="timestamp", columns="meter", values="kW").tz_convert(self.zone)

    def changed(self):
        return [meter for meter in self.added_kW if self.added_kW[meter].abs().max() > NOTHING_KW]

    def shares(self):
        """Meter -> "+5.0 %" of the year."""
        return {meter: share_text(self.added_kW[meter].sum() / self.plain_kW[meter].sum()) if meter in self.changed() else "unchanged" for meter in self.added_kW}


def share_text(share):
    percent = 100 * share
    text = f"{percent:+.{2 if abs(percent) < 1 else 1}f}".replace("-", "−")
    return ("±0" if float(text.replace("−", "-")) == 0 else text) + " %"


def words(meter):
    return meter.replace("_", " ")


def save(figure, file):
    figure.savefig(file, metadata={"Date": None, "Creator": None})
    plt.close(figure)


def draw_effect(feed, title, sentence, details, active, file):
    """Mean days of both half-years, months, and means by outdoor temperature, of the hours in which the effect is active."""
    figure, axes = plt.subplots(2, 3, figsize=(10, 5.2), layout="constrained")
    figure.suptitle(f"{title}\n" + textwrap.fill(f"{sentence} {details}", 150), x=0.01, ha="left", fontsize=9)
    added = feed.added_kW[active(feed.added_kW.index)]
    local, weekend = added.index, added.index.day_of_week >= 5
    summer, hour = (local.month >= 4) & (local.month <= 9), local.hour
    working = ~weekend & (hour >= 8) & (hour < 18)
    outdoor = feed.outdoor_C.reindex(local).interpolate().round(0) // 2.5 * 2.5
    for meter in feed.changed():
        colour = COLOURS.get(meter, HEAT)
        for axis, half in ((axes[0][0], ~summer), (axes[0][1], summer)):
            for days, style in ((~weekend, "-"), (weekend, "--")):
                added.loc[half & days, meter].groupby(hour[half & days]).mean().plot(ax=axis, color=colour, linestyle=style)
        for axis, hours in ((axes[1][0], working), (axes[1][1], ~working)):
            by = added.loc[hours, meter].groupby(outdoor[hours].values)
            by.mean()[by.size() >= 8].plot(ax=axis, color=colour)  # Two hours at least.
        months = feed.added_kW[meter].groupby(feed.added_kW.index.month).sum()
        plain = feed.plain_kW[meter].groupby(feed.plain_kW.index.month).sum().mean()
        place = feed.changed().index(meter) - (len(feed.changed()) - 1) / 2
        axes[0][2].bar(months.index + 0.25 * place, 100 * months / plain, width=0.25, color=colour)
    captions = ["Mean day, October to March, kW", "April to September, kW (dashed: weekend)", "By month, % of a mean month",
                "By outdoor °C, Monday to Friday 8 to 18 h, kW", "By outdoor °C, other hours, kW"]  # fmt: skip
    for axis, caption in zip(axes.flat, captions):
        axis.set_title(caption, loc="left", fontsize=8)
        axis.axhline(0, color="0.6", linewidth=0.6, zorder=0)
        axis.set_xlabel("")
    for line, (meter, share) in enumerate(feed.shares().items()):
        axes[1][2].text(0, 0.9 - 0.13 * line, f"{words(meter)} {share} of the year", color=COLOURS.get(meter, HEAT), weight="bold")
    axes[1][2].text(0, 0.2, textwrap.fill(feed.building, 50), va="top", fontsize=7, color="0.4")
    axes[1][2].axis("off")
    save(figure, file)


def draw_weeks(feed, use, file):
    figure, axes = plt.subplots(2, 2, figsize=(10, 4.4), layout="constrained", sharex="col", height_ratios=[1, 2])
    figure.suptitle(textwrap.fill(feed.building, 150), x=0.01, ha="left", fontsize=9)
    for (above, below), (month, monday) in zip(axes.T, WEEKS.items()):
        first = pd.Timestamp(monday, tz=feed.zone)
        week = slice(first, first + pd.Timedelta(days=7))
        days = (feed.plain_kW[week].index - first) / pd.Timedelta(days=1)
        above.plot(days[::4], feed.outdoor_C[week].resample("1h").mean()[: len(days[::4])], color="#009e73")
        above.set_title(f"A week in {month}: outdoors, °C", loc="left", fontsize=8)
        for meter in feed.plain_kW:
            below.plot(days[::4], feed.plain_kW[week][meter].to_numpy()[::4], color=COLOURS.get(meter, HEAT), label=words(meter))
        below.set_title("Meters, kW", loc="left", fontsize=8)
        below.set_xticks([day + 0.5 for day in range(7)], ["Mon", "Tue", "Wed", "Thu", "Fri", "Sat", "Sun"])
    axes[1][1].legend(frameon=False)
    save(figure, file)


def effects_of(sim):
    """Id, class, title, sentence, strength and needs of each, as the simulator explains them."""
    text = subprocess.run([sim, "building", "--list-effects"], capture_output=True, text=True, check=True).stdout
    pattern = r"^(\w+) \((\w+)\): (.*)\n  (.*)\n  strength .* typically (\S+) \((.*)\)(?:\n  needs: (.*))?"
    return re.findall(pattern, text, re.MULTILINE)


def building_for(effect, needs):
    found = [building for need, building in NEEDS.items() if need in needs]
    return found[0] if found else SHOWN_IN.get(effect, {})


def draw_all(sim, out):
    out.mkdir(parents=True, exist_ok=True)
    listed = ["# Footprints of the hidden effects\n", "Made by `sh tests/run.sh --long footprints`.\n", "## Buildings without effects\n"]
    group_before = None
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        for use in USES:
            if refused := simulated(sim, folder, {"use": use}):
                sys.exit(f"week of a {use}: {refused}")
            draw_weeks(Feed(folder), use, out / f"week_{use}.svg")
            listed.append(f"![A week in winter and one in summer: {use}](week_{use}.svg)\n")
        for effect, group, title, sentence, strength, unit, needs in effects_of(sim):
            building, given = building_for(effect, needs), {"name": effect} | DATES.get(effect, {})
            while refused := simulated(sim, folder, building, given):
                missing = [key for key in ("from", "meter") if f"give {key}" in refused and key not in given]
                if not missing:
                    sys.exit(f"{effect}: {refused}")
                given |= {missing[0]: {"from": f"{YEAR}-04-01", "meter": "electricity"}[missing[0]]}
            start, end = (pd.Timestamp(given.get(key, day)).date() for key, day in (("from", f"{YEAR}-01-01"), ("to", f"{YEAR}-12-31")))
            feed = Feed(folder)
            dates = "".join(f" {key} {given[key]}" for key in ("from", "to") if key in given)
            draw_effect(feed, title, sentence, f"Strength {strength}: {unit}{dates}.", lambda index: (index.date >= start) & (index.date <= end), out / f"{effect}.svg")
            if group != group_before:
                listed.append(f"## {words(group)}\n")
                group_before = group
            listed.append(f"![{title}: {', '.join(f'{words(meter)} {share}' for meter, share in feed.shares().items())}]({effect}.svg)\n")
    (out / "README.md").write_text("\n".join(listed))
    print(f"{len(listed) - 3} lines of figures in {out}")


def draw_twins(population, out):
    out.mkdir(parents=True, exist_ok=True)
    for twin in sorted((population / "twins").iterdir()):
        answer = json.loads((population / "answers" / f"{twin.name}.json").read_text())
        if answer["effects"]:
            hidden = ", ".join(f"{effect['effect']} {effect['strength']:.3g} ({effect['unit']})" for effect in answer["effects"])
            draw_effect(Feed(twin, plain="readings.csv"), twin.name, hidden, "", lambda index: index == index, out / f"{twin.name}.svg")


def main():
    if sys.argv[1] == "--twins":
        draw_twins(pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3]))
    else:
        draw_all(sys.argv[1], pathlib.Path(sys.argv[2]))


if __name__ == "__main__":
    main()
