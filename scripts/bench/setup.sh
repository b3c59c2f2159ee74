#!/usr/bin/env bash
# Puts the peers of `make bench-peers` into .venv-bench, apart from what coralpipe itself needs. They are only run.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

requirements=scripts/bench/requirements.txt
stamp=.venv-bench/installed.txt # a copy of the requirements, written when all of them are in

cmp -s "$requirements" "$stamp" && exit
echo "setup: putting OpenSeesPy, SciPy and Kratos into .venv-bench; this takes a minute or two." >&2
python3 -m venv --clear .venv-bench
.venv-bench/bin/python -m pip install --quiet --disable-pip-version-check -r "$requirements" || {
  echo "setup: pip could not install $requirements. Its own message stands above; is there a network?" >&2
  exit 1
}
cp "$requirements" "$stamp"
