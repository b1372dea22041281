#!/bin/sh
# Each fuzz target for a minute.
exec sh "$(dirname "$0")/../fuzz/run.sh" 60
