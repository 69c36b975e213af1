#!/usr/bin/env bash
# measured.sh ROOT PAGE: prints PAGE (README.md or docs/MEASURED.md) with what docs/measured.csv says between its markers.
set -euo pipefail
here=$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")
root=$1 page=$2
export LC_ALL=C
kind=measured
if [[ $page == README.md ]]; then kind=front; fi
# The table is whole before the page is begun: a broken row leaves no half page.
table=$(awk -v PAGE="$kind" -f "$here/csv.awk" -f "$here/measured.awk" "$root/docs/measured.csv")
begin='<!-- measured: ./dev measure writes what follows -->'
end='<!-- measured: end -->'
for marker in "$begin" "$end"; do
    if [[ $(grep -cxF -- "$marker" "$root/$page") -ne 1 ]]; then
        printf '%s: needs the line %s once\n' "$page" "$marker" >&2
        exit 1
    fi
done
TABLE=$table awk -v BEGIN_LINE="$begin" -v END_LINE="$end" '
    $0 == END_LINE { inside = 0 }
    !inside
    $0 == BEGIN_LINE { print ENVIRON["TABLE"]; inside = 1 }' "$root/$page"
