#!/usr/bin/env bash
# ./dev faults [N | all]: plants faults, one at a time, in copies of the sources of input guard, output stage, passivity and
# solver, and says which of those that change an output of differential.cpp are found by the rooms' tests.
#   N       of all faults (200, about 20 minutes of two processors), drawn by PASSUNG_FAULT_SEED (1), two thirds of them in
#           the stages that keep people safe
# Everything lies in build/faults; the tree itself is never changed. Results: build/faults/results.tsv. Fails below the marks.
set -euo pipefail
cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/../.."

safety=(core/tick/{input_guard,output_stage,passivity}.{cpp,h})
solver=(core/motion/{active_set,constrained_motion,friction,friction_balance,friction_patch}.{cpp,h})
safety_mark=95 solver_mark=85  # percent
known=tests/faults/survivors.tsv
limit=120  # seconds: what takes longer than this is found, since it hangs

count=${1:-200}
[[ $count == all || $count =~ ^[1-9][0-9]*$ ]] || { printf 'faults: a number of faults, or all\n' >&2; exit 2; }
seed=${PASSUNG_FAULT_SEED:-1}
out=build/faults
workers=$(nproc)
mkdir -p $out

# The core once, without faults; what the planted rooms stand on. Each step says itself that it failed: where a caller
# asks whether a function did, bash goes on after a command of it that did not.
build_core() {
    cmake -S . -B $out/core -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_FLAGS_RELEASE=-O1 \
        -DPASSUNG_PROGRAM=OFF -DPASSUNG_TESTS=OFF -DPASSUNG_TICK_ONE_PIECE=ON &&
        cmake --build $out/core -j "$workers" &&
        cmake --install $out/core --prefix $out/installed &&
        c++ -std=c++20 -O1 tests/faults/faults.cpp -o $out/planter
}

# A worker's own copy, built without faults; what is newer than before is copied, so that little is built again. It is
# built twice: in pieces, of which a fault in a source compiles one, and each room whole, for faults in headers, which
# most pieces include.
build_worker() {
    local tree=$out/$1/tree
    mkdir -p $tree
    copy_changed "$tree" &&
        configure "$1" pieces OFF &&
        cmake --build "$out/$1/pieces" -j 1 &&
        "$out/$1/pieces/differential" >"$out/$1/as_it_stands.txt" || return 1
    grep -q $'\.h\t' "$out/$1/faults.tsv" || return 0
    configure "$1" whole ON &&
        cmake --build "$out/$1/whole" -j 1 --target differential &&
        "$out/$1/whole/differential" | cmp - "$out/$1/as_it_stands.txt"
}

# configure WORKER BUILD ONE_PIECE
configure() {
    cmake -S tests/faults -B "$out/$1/$2" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_FLAGS_RELEASE=-O1 \
        -DCMAKE_PREFIX_PATH="$PWD/$out/installed" -DTREE="$PWD/$out/$1/tree" -DONE_PIECE="$3"
}

# Copies the sources that differ.
copy_changed() {
    local file
    while IFS= read -r file; do
        cmp -s "$file" "$1/$file" && continue
        mkdir -p "$1/${file%/*}"
        cp "$file" "$1/$file"
    done < <(find core tests/core tests/support tests/faults -type f)
}

# tests_find WORKER BUILD PART: true if a test fails, falls or hangs.
tests_find() {
    cmake --build "$out/$1/$2" -j 1 --target "$3_tests" >"$out/$1/log.txt" 2>&1 || return 0
    ! PASSUNG_NO_CACHE=1 timeout $limit "$out/$1/$2/$3_tests" --gtest_brief=1 --gtest_fail_fast >"$out/$1/log.txt" 2>&1
}

# judge WORKER PART FILE: prints what became of one fault.
judge() {
    local worker=$1 part=$2 build=pieces
    if [[ $3 == *.h ]]; then build=whole; fi
    if ! cmake --build "$out/$worker/$build" -j 1 --target differential >"$out/$worker/log.txt" 2>&1; then
        printf 'no program'
    elif timeout $limit "$out/$worker/$build/differential" >"$out/$worker/with_fault.txt" 2>/dev/null &&
        cmp -s "$out/$worker/as_it_stands.txt" "$out/$worker/with_fault.txt"; then
        printf 'no output'
    elif tests_find "$worker" "$build" "$part"; then
        printf 'found'
    else
        printf 'survived'
    fi
}

# Plants the faults of a list, one after the other; whole files stand again at the end.
work() {
    local worker=$1 part file line place length text shown last=
    while IFS=$'\t' read -r part file line place length text shown; do
        if [[ -n $last && $last != "$file" ]]; then cp "$last" "$out/$worker/tree/$last"; fi
        last=$file
        # An empty column: what stands there is left out.
        if [[ $text == '∅' ]]; then text=; fi
        $out/planter plant "$file" "$out/$worker/tree/$file" "$place" "$length" "$text"
        printf '%s\t%s\t%s\t%s\t%s\n' "$(judge "$worker" "$part" "$file")" "$part" "$file" "$line" "$shown"
    done <"$out/$worker/faults.tsv" >"$out/$worker/results.tsv"
    if [[ -n $last ]]; then cp "$last" "$out/$worker/tree/$last"; fi
}

faults_of() {
    local part=$1
    shift
    $out/planter list . "$@" | awk -F '\t' -v OFS='\t' -v part="$part" '{ if ($5 == "") $5 = "∅"; print part, $0 }'
}

# draw NUMBER: so many lines of the input, the same for the same seed, in their order.
draw() {
    if [[ $1 == all ]]; then cat; return; fi
    awk -v seed="$seed" 'BEGIN { srand(seed) } { printf "%.9f\t%d\t%s\n", rand(), NR, $0 }' |
        sort -k1,1 | awk -v n="$1" "NR <= n" | sort -t $'\t' -k2,2n | cut -f 3-
}

began=$SECONDS
printf '==> the core without faults ... '
build_core >$out/core.log 2>&1 || { tail -n 40 $out/core.log >&2; exit 1; }
printf 'done (%d s)\n' $((SECONDS - began))

if [[ $count == all ]]; then safe=all unsafe=all; else safe=$(((2 * count + 2) / 3)) unsafe=$((count / 3)); fi
{ faults_of safety "${safety[@]}" | draw "$safe"; faults_of solver "${solver[@]}" | draw "$unsafe"; } >$out/faults.tsv
{ faults_of safety "${safety[@]}"; faults_of solver "${solver[@]}"; } >$out/all.tsv
total=$(wc -l <$out/faults.tsv)
printf '==> %d faults of %d\n' "$total" "$(wc -l <$out/all.tsv)"
for ((w = 0; w < workers; ++w)); do
    mkdir -p $out/$w
    # Headers last: a header that stands again is newer than every piece that includes it.
    awk -F '\t' -v n="$workers" -v w="$w" '
        NR % n != w { next }
        $2 ~ /\.h$/ { headers = headers $0 "\n"; next }
        { print }
        END { printf "%s", headers }' $out/faults.tsv >$out/$w/faults.tsv
    { build_worker $w >$out/$w/build.log 2>&1 && work $w; } &
done
status=0
for job in $(jobs -p); do wait "$job" || status=1; done
((status == 0)) || { tail -n 20 $out/*/build.log >&2; exit 1; }
for ((w = 0; w < workers; ++w)); do
    # Whatever happened, the copies are whole again and do what the tree does.
    cmp -s $out/0/as_it_stands.txt $out/$w/as_it_stands.txt || { printf 'faults: two builds differ\n' >&2; exit 1; }
done
cat $out/[0-9]*/results.tsv | sort -t $'\t' -k3,3 -k4,4n >$out/results.tsv

# A known survivor whose line has changed says nothing any more.
awk -F '\t' 'NR == FNR { there[$2 FS $7]; next } FNR > 1 && !($1 FS $2 in there) { print FILENAME ":" FNR ": no such fault any more" }' \
    $out/all.tsv $known

printf '==> survivors (⟦what stands → what was planted⟧); those of %s have a reason there\n' $known
awk -F '\t' '$1 == "survived" { print $3 "\t" $5 "\t" $4 }' $out/results.tsv |
    while IFS=$'\t' read -r file shown line; do
        reason=$(awk -F '\t' -v file="$file" -v shown="$shown" '$1 == file && $2 == shown { print $3 }' $known | head -n 1)
        printf '%s:%s: %s\n    %s\n' "$file" "$line" "$shown" "${reason:-NEW: no test finds it and no reason is given}"
    done
printf '%-8s %8s %12s %14s %8s %10s %s\n' part planted 'no program' 'no output' found survived share
for part in safety solver; do
    mark=${part}_mark
    awk -F '\t' -v part=$part -v mark="${!mark}" '
        $2 == part { ++n; ++of[$1] }
        END {
            changed = of["found"] + of["survived"]
            share = changed ? 100 * of["found"] / changed : 100
            printf "%-8s %8d %12d %14d %8d %10d %.1f %% (mark %d %%)\n", part, n, of["no program"], of["no output"],
                of["found"], of["survived"], share, mark
            exit share < mark
        }' $out/results.tsv || status=1
done
printf '==> %d s; all faults with what became of them: %s\n' $((SECONDS - began)) $out/results.tsv
exit $status
