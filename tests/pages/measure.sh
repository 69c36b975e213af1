#!/usr/bin/env bash
# measure.sh ROOT PROGRAMS [WORD]: runs the commands of docs/measured.csv whose rows have a pattern (only those in whose
# id, section or command WORD occurs) and writes the figures that they print into the table, with commit, date and machine.
# PROGRAMS is the folder of the built program. Rows without a pattern keep their figure and its date: what they need
# takes hours, a screen or an eye.
set -euo pipefail
here=$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")
root=$(readlink -f -- "$1") programs=$(readlink -f -- "$2") word=${3:-}
table=$root/docs/measured.csv
export LC_ALL=C PATH=$programs:$PATH

commit=$(git -C "$root" rev-parse --short=7 HEAD)
if ! git -C "$root" diff --quiet HEAD -- core devices study analysis ui tests; then
    printf 'measure: the tree has changes that no commit has: a figure must be measurable again\n' >&2
    exit 1
fi
machine="$(nproc) cores of $(sed -n 's/^model name[^:]*: *//p' /proc/cpuinfo | head -n 1)"

# Commands run beside their own results, and find the tree by the names that a reader types.
work=$root/build/measure
rm -rf -- "$work"
mkdir -p -- "$work"
ln -s -- "$root/dev" "$work/dev"
ln -s -- "$root/protocols" "$work/protocols"

# rows: number of the line, command, pattern
rows=$(awk -v WORD="$word" -f "$here/csv.awk" -f /dev/stdin "$table" <<'AWK'
FNR > 1 && value("pattern") != "" && index(value("id") " " value("section") " " value("command"), WORD) {
    print FNR "\t" value("command") "\t" value("pattern")
}
AWK
)
if [[ -z $rows ]]; then
    printf 'measure: no row with a pattern has this word: %s\n' "$word" >&2
    exit 1
fi

failures=0
output=$work/output.txt
last_command=
: >"$work/figures"
while IFS=$'\t' read -r line command pattern; do
    if [[ $command != "$last_command" ]]; then
        printf '==> %s\n' "$command"
        # Missed marks end some commands with 1: what counts is what they print.
        (cd -- "$work" && bash -c "$command") >"$output" 2>&1 </dev/null || true
        last_command=$command
    fi
    figure=$(sed -nE "s~.*$pattern.*~\1~p" "$output" | tail -n 1)
    if [[ -z $figure ]]; then
        printf 'docs/measured.csv:%s: the command prints nothing like: %s\n' "$line" "$pattern" >&2
        tail -n 5 "$output" >&2
        failures=$((failures + 1))
    else
        printf '    line %s: %s\n' "$line" "$figure"
        printf '%s\t%s\n' "$line" "$figure" >>"$work/figures"
    fi
done < <(sort -s -t $'\t' -k 2,2 <<<"$rows")

awk -v COMMIT="$commit" -v DATE="$(date +%F)" -v MACHINE="$machine" -v FIGURES="$work/figures" \
    -f "$here/csv.awk" -f /dev/stdin "$table" >"$work/measured.csv" <<'AWK'
BEGIN { while ((getline line < FIGURES) > 0) { split(line, parts, "\t"); figure[parts[1]] = parts[2] } }
{
    if (FNR in figure) {
        field[column["figure"]] = figure[FNR]
        field[column["commit"]] = COMMIT
        field[column["date"]] = DATE
        field[column["machine"]] = MACHINE
    }
    for (i = 1; i <= column_count; i++) printf "%s%s", quotedField(field[i]), i < column_count ? "," : "\n"
}
AWK
mv -- "$work/measured.csv" "$table"
exit $((failures > 0))
