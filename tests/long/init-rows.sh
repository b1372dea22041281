#!/bin/sh
# sh tests/run.sh --long init-rows: ten million rows through `recald init` in bounded memory.
exec python3 "$(dirname "$0")/init_rows.py" "$1/daemon/recald"
