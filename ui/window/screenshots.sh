#!/usr/bin/env bash
# screenshots.sh PROGRAM: takes the pictures of this room under an X server without a screen; PROGRAM: ui_window_pictures.
set -euo pipefail

here=$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")
home=$(mktemp -d)
trap 'rm -rf -- "$home"' EXIT
mkdir -p "$here/pictures"
rm -f -- "$here/pictures/"*.png
export LIBGL_ALWAYS_SOFTWARE=1 PASSUNG_PICTURES=$here/pictures XDG_RUNTIME_DIR=$home
xvfb-run -a -s '-screen 0 1600x1000x24 +extension GLX' "$1"
