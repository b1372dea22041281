# small_site DIR: a site with two months of hourly readings of one meter. Sourced by the tests.
small_site() {
  mkdir -p "$1"
  cat >"$1/site.toml" <<'END'
[site]
id = "tower"
timezone = "America/Chicago"
[[meter]]
id = "main"
utility = "electricity"
file = "readings.csv"
stamps = "start"
END
  awk 'BEGIN {
    print "timestamp,meter,value,unit"
    for (day = 1; day <= 61; ++day)
      for (hour = 0; hour < 24; ++hour)
        printf "2023-%02d-%02dT%02d:00:00-06:00,main,%.1f,kWh\n",
          day <= 31 ? 1 : day <= 59 ? 2 : 3, day <= 31 ? day : day <= 59 ? day - 31 : day - 59, hour,
          40 + 10 * (hour > 7 && hour < 19) + day / 10
  }' >"$1/readings.csv"
}
