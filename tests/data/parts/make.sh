#!/bin/sh
# Makes the parts of this folder anew, by openscad 2021.01 with MCAD (Debian: openscad, openscad-mcad).
set -e
cd "$(dirname "$0")"
scad() { file=$1; from=$2; shift 2; openscad -q --export-format binstl -o "$file.stl" "$@" "$from.scad"; }
for d in 4 8 12 16; do
    chamfer=$([ $d = 4 ] && echo 0.25 || echo 0.5)
    scad round_$d peg -D size=$d -D chamfer=$chamfer
    scad round_${d}_hole hole -D size=$d -D play=0.05
done
for d in 4 8 16; do
    chamfer=$([ $d = 4 ] && echo 0.25 || echo 0.5)
    other=$((d * 3 / 4))
    scad rect_$d peg -D 'kind="rect"' -D size=$d -D other=$other -D chamfer=$chamfer
    scad rect_${d}_hole hole -D 'kind="rect"' -D size=$d -D other=$other -D play=0.05
done
for kind in d rect; do
    name=$([ $kind = d ] && echo d || echo square)
    scad ${name}_8 peg -D "kind=\"$kind\""
    scad ${name}_8_hole hole -D "kind=\"$kind\"" -D play=0.1
    scad ${name}_8_hole_small hole -D "kind=\"$kind\"" -D play=-0.05
done
scad gear gear
scad gear_gap gear -D half=1
scad bolt thread
scad nut thread -D nut=true -D play=0.2 -D low=-2 -D high=2
