# Debian packages that recald is built with, and how to get them. Sourced by the scripts.
#
# install_packages NAME…  installs what is missing and says so; root or sudo. Node and npm may be
# there already in another version than Debian's, which a plain install would fight with.

BUILD_PACKAGES="g++ cmake ninja-build libeigen3-dev libboost-dev libhowardhinnant-date-dev tzdata
  libexpected-dev libmodbus-dev libtomlplusplus-dev libcli11-dev nlohmann-json3-dev libfmt-dev
  libspdlog-dev libsqlite3-dev libssl-dev libsystemd-dev zlib1g-dev libzip-dev libpugixml-dev
  libcurl4-openssl-dev libmosquitto-dev libsnappy-dev libpq-dev"
# To make packages (daemon/packaging), and to check them.
PACKAGING_PACKAGES="git python3 debhelper mmdebstrap crossbuild-essential-arm64 qemu-user-static umoci lintian crun"

# What tests/run.sh needs besides.
TEST_PACKAGES="libgtest-dev libgmock-dev libbenchmark-dev mbpoll python3-pymodbus python3-aiosmtpd python3-venv
  python3-serial python3-serial-asyncio curl mosquitto mosquitto-clients postgresql-15"

# What its --surroundings need besides: browsers, other people's programs, fuzzing, and what makes and checks packages.
SURROUNDINGS_PACKAGES="chromium r-base-core r-cran-posterior clang clang-format libclang-rt-14-dev systemd prometheus
  influxdb jq binutils $PACKAGING_PACKAGES"

# Those of BUILD_PACKAGES that have headers, a line each.
dev_packages() {
  # shellcheck disable=SC2086  # a list of words
  printf '%s\n' $BUILD_PACKAGES | grep -e '-dev$'
}

is_installed() {
  dpkg-query -W -f='${Status}' "$1" 2>/dev/null | grep -q '^install ok installed'
}

install_packages() {
  missing=
  for package in "$@"; do
    is_installed "$package" || missing="$missing $package"
  done
  command -v node >/dev/null 2>&1 || missing="$missing nodejs"
  command -v npm >/dev/null 2>&1 || missing="$missing npm"
  [ -n "$missing" ] || return 0
  as_root=
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null 2>&1 || {
      echo "These Debian packages are missing:$missing" >&2
      echo "Install them, or run this script as root or with sudo at hand." >&2
      return 1
    }
    as_root=sudo
  fi
  echo "Installing Debian packages:$missing"
  # Nobody asked for a database that runs from now on.
  own_clusters=/etc/postgresql-common/createcluster.d/recald.conf
  case $missing in
    *postgresql*)
      $as_root mkdir -p "${own_clusters%/*}"
      echo 'create_main_cluster = false' | $as_root tee "$own_clusters" >/dev/null
      ;;
  esac
  log=$(mktemp)
  # shellcheck disable=SC2086  # a list of words
  if ! { $as_root apt-get update -q &&
    DEBIAN_FRONTEND=noninteractive $as_root apt-get install -y -q --no-install-recommends $missing; } \
    >"$log" 2>&1; then
    tail -n 20 "$log" >&2
    echo "Installing the packages failed; the last lines of apt-get are above." >&2
    return 1
  fi
  $as_root rm -f "$log" "$own_clusters"
}

# build_jobs: compilers at a time, as many as there are cores and three gigabytes of free memory for
# each: files are compiled together.
build_jobs() {
  cores=$(nproc)
  memory=$(awk '/^MemAvailable:/ { print int($2 / 3000000) }' /proc/meminfo)
  [ "$memory" -ge 1 ] || memory=1
  if [ "$memory" -lt "$cores" ]; then echo "$memory"; else echo "$cores"; fi
}
