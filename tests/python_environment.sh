#!/bin/sh
# A virtual environment in the build folder, with what a requirements file lists.
#
#   sh python_environment.sh PYTHON FOLDER REQUIREMENTS
#
# Where it cannot be installed, because there is no network, the build goes on and the tests that need it skip:
# FOLDER/installed says that all is there.
set -eu
python=$1
folder=$2
requirements=$3
[ "$folder/installed" -nt "$requirements" ] && exit 0
rm -f "$folder/installed"

# For Home Assistant uv takes three quarters of a minute, pip four and a half. It does not read pip.conf: where only an
# index that is named there can be reached, pip does the work.
with_uv() {
  "$folder/bin/python" -m pip install --quiet --disable-pip-version-check uv==0.13.9 &&
    "$folder/bin/uv" pip install --quiet --python "$folder/bin/python" --requirement "$requirements"
}
with_pip() {
  "$folder/bin/python" -m pip install --quiet --disable-pip-version-check --requirement "$requirements"
}
if "$python" -m venv --clear "$folder" && { with_uv || with_pip; }; then
  touch "$folder/installed"
else
  echo "Tests that need $(basename "$folder") will skip." >&2
fi
