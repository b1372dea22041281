#!/bin/sh
# Runs a Python script in an environment of python_environment.sh: FOLDER SCRIPT. Without the environment it says SKIPPED.
[ -f "$1/installed" ] || {
  echo "SKIPPED: what $(basename "$2") needs is not installed"
  exit
}
exec "$1/bin/python" "$2"
