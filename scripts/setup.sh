#!/usr/bin/env bash
# Makes this machine ready: a C compiler (METIS is compiled), Python, and .venv with gmsh, meshio, vtk and jsonschema in
# fixed versions. Run it as often as you like, from anywhere: what is there already is left alone.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

requirements=scripts/requirements.txt
stamp=.venv/installed.txt # a copy of the requirements, written when all of them are in
problem=/dev/null

# What the gmsh wheel links to; a desktop has it, a server or container may not.
libraries=(libglu1-mesa libgl1 libxrender1 libxcursor1 libxft2 libxinerama1 libxfixes3 libxext6 libx11-6
           libfontconfig1 libgomp1)

say() { echo "setup: $*" >&2; }

give_up() { say "$*"; exit 1; }

# install_debian REASON PACKAGE...
install_debian() {
  local reason=$1 as_root=()
  shift
  command -v apt-get >/dev/null ||
    give_up "$reason Install what this system calls: $*. Then run scripts/setup.sh again."
  if [ "$(id -u)" != 0 ]; then
    command -v sudo >/dev/null || give_up "$reason Ask an administrator for: apt-get install $*"
    as_root=(sudo)
  fi
  say "$reason Installing $*."
  "${as_root[@]}" apt-get -qq update >&2 || say "apt-get update failed; trying with the package lists that are here."
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -qq install --no-install-recommends "$@" >&2 ||
    give_up "apt-get could not install $*. Its own message stands above."
}

gmsh_version() { # the wheel's command is a Python script whose first line names no particular Python
  .venv/bin/python .venv/bin/gmsh -version 2>&1 | tail -n 1
}

gmsh_runs() { [[ "$(gmsh_version)" =~ ^[0-9]+\.[0-9]+\.[0-9]+ ]]; }

command -v cc >/dev/null || install_debian "There is no C compiler." build-essential

if ! python3 -c 'import venv, ensurepip' 2>"$problem"; then
  install_debian "There is no Python 3 that can make virtual environments." python3 python3-venv
fi

if ! cmp -s "$requirements" "$stamp" || ! .venv/bin/python -c '' 2>"$problem"; then
  say "Putting gmsh, meshio and vtk into .venv; this takes a minute."
  python3 -m venv --clear .venv
  .venv/bin/python -m pip install --quiet --disable-pip-version-check -r "$requirements" ||
    give_up "pip could not install $requirements. Its own message stands above; is there a network?"
  cp "$requirements" "$stamp"
fi

gmsh_runs || install_debian "gmsh lacks shared libraries." "${libraries[@]}"
gmsh_runs || give_up "gmsh still does not run: $(gmsh_version)"

say "gmsh $(gmsh_version) runs, and meshio and vtk are installed, in .venv."
say "A C compiler is ready: $(command -v cc)."
if command -v cargo >/dev/null; then
  say "Rust is ready: $(cargo --version)."
else
  say "Rust is missing: install it from https://rustup.rs, then run make."
fi
