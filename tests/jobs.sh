# Checks as jobs, and a table of what came of them; CI and ./dev check-all share them. Sourced, at the root of the tree.

only_names= chosen= page=  # every job, no page
names=() seconds=() verdicts=() counts=()
passed=0 failed=0

# The sum of one job's log: tests passed, tests failed. A job that runs no test counts as one.
count_tests() {
    local log=$1 status=$2 pattern='tests passed, ([0-9]+) tests? failed out of ([0-9]+)' line ok=0 bad=0
    while IFS= read -r line; do
        if [[ $line =~ $pattern ]]; then
            bad=$((bad + BASH_REMATCH[1]))
            ok=$((ok + BASH_REMATCH[2] - BASH_REMATCH[1]))
        fi
    done <"$log"
    if ((status == 0 && ok + bad == 0)); then ok=1; fi
    if ((status != 0 && bad == 0)); then bad=1; fi
    passed=$((passed + ok))
    failed=$((failed + bad))
    counts+=("$ok / $bad")
}

# job NAME COMMAND...: runs it if its name has the word `chosen`; with `only_names` takes its name alone.
job() {
    local name=$1 began=$SECONDS status=0
    shift
    if [[ -n $only_names ]]; then known+=("$name"); return; fi
    if [[ $name != *"$chosen"* ]]; then return; fi
    printf '\n######## %s\n' "$name"
    local log commit
    commit=$(git rev-parse --short HEAD 2>/dev/null) || commit='no commit'
    log=$(mktemp)
    "$@" </dev/null 2>&1 | tee "$log" || status=1
    count_tests "$log" "$status"
    rm -f "$log"
    names+=("$name")
    seconds+=($((SECONDS - began)))
    if ((status == 0)); then verdicts+=(ok); else verdicts+=(FAILED); fi
    if [[ -n $page ]]; then keep_result "$commit"; fi
}

# every_job FUZZ_SECONDS: all that CI runs. Its limit is 90 minutes on a machine that may be half as fast as ours: of the
# sanitizers it has the fuzzers, which read what nobody vouches for; the rest is among the checks without limit.
every_job() {
    job 'g++, assertions, all tests, warnings are errors' env PASSUNG_PRESET=ci ./dev test
    job 'demo study (./dev run)' env -u DISPLAY -u WAYLAND_DISPLAY PASSUNG_PRESET=ci ./dev run
    job 'fuzzers' ./dev fuzz-check "$1"
    job 'lint of what changed' env PASSUNG_LINT_MINUTES="${PASSUNG_LINT_MINUTES:-1}" ./dev lint
}

table() {
    local i
    printf '\n%-50s %8s %10s  %s\n' job minutes 'ok / bad' result
    for i in "${!names[@]}"; do
        printf '%-50s %5d:%02d %10s  %s\n' "${names[i]}" $((seconds[i] / 60)) $((seconds[i] % 60)) "${counts[i]}" "${verdicts[i]}"
    done
    printf '%-50s %5d:%02d\n\n' 'all' $((SECONDS / 60)) $((SECONDS % 60))
    printf '%d passed, %d failed\n' "$passed" "$failed"
    ((failed == 0))
}

# The page's row of a check, nothing if it has none.
row_of() {
    if [[ -f $page ]]; then awk -v start="| $1 | " 'index($0, start) == 1' "$page"; fi
}

# keep_result COMMIT: the page with the row of the job that just ended in place of its earlier one. Rows of other jobs stay
# as they are; a job without a row says so; rows of jobs that are no more go.
keep_result() {
    local commit=$1 name row text
    if [[ -n $(git status --porcelain -- . ":!$page" 2>/dev/null) ]]; then commit+=' with changes'; fi
    text=$(
        printf '# Checked\n\n'
        printf 'Every check without a limit of time, each with the commit that it read: `./dev check-all [WORD]` runs those\n'
        printf 'whose name has the word and writes their rows.\n\n'
        printf '| check | commit | date | minutes | passed / failed | result |\n|---|---|---|---|---|---|\n'
        for name in "${known[@]}"; do
            if [[ $name == "${names[-1]}" ]]; then
                row="| $name | $commit | $(date +%F) | $(((seconds[-1] + 30) / 60)) | ${counts[-1]} | ${verdicts[-1]} |"
            else
                row=$(row_of "$name")
            fi
            printf '%s\n' "${row:-| $name |  |  |  |  | not yet run at this length |}"
        done
    )
    printf '%s\n' "$text" >"$page"
}

# check_jobs PAGE WORD JOBS: runs those jobs of the function JOBS whose name has the word, writes each one's row when it ends.
check_jobs() {
    local known=() only_names=1 chosen=$2 page=$1
    "$3"
    only_names=
    if ! printf '%s\n' "${known[@]}" | grep -qF -- "$chosen"; then
        printf "no check's name has the word %s; there are:\n" "$chosen" >&2
        printf '  %s\n' "${known[@]}" >&2
        return 2
    fi
    "$3"
    table
}
