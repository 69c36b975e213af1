#!/usr/bin/env bash
# architecture.sh ROOT: draws the rooms of the tree in ROOT as SVG on standard output.
set -euo pipefail
here=$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")
cd -- "$1"
export LC_ALL=C
folders=()
for folder in core devices study analysis ui; do
    if [[ -d $folder ]]; then folders+=("$folder"); fi
done
find "${folders[@]}" \( -name '*.h' -o -name '*.cpp' \) -print0 | sort -z |
    xargs -0 awk -f "$here/architecture.awk" tests/rooms.cmake
