# Checks as jobs, and a table of what came of them; CI and ./dev check-all share them. Sourced, at the root of the tree.

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

# job NAME COMMAND...
job() {
    local name=$1 began=$SECONDS status=0
    shift
    printf '\n######## %s\n' "$name"
    local log
    log=$(mktemp)
    "$@" </dev/null 2>&1 | tee "$log" || status=1
    count_tests "$log" "$status"
    rm -f "$log"
    names+=("$name")
    seconds+=($((SECONDS - began)))
    if ((status == 0)); then verdicts+=(ok); else verdicts+=(FAILED); fi
}

# every_job FUZZ_SECONDS: all that CI runs.
every_job() {
    job 'g++, assertions, all tests, warnings are errors' env PASSUNG_PRESET=ci ./dev test
    job 'an edit in a kernel to its tests' edit_to_tests core/motion/constrained_motion.cpp core/motion
    job 'demo study (./dev run), its build from nothing' env -u DISPLAY -u WAYLAND_DISPLAY ./dev run
    job 'clang, ASan, UBSan: files, data, program' ./dev asan-check
    job 'fuzzers' ./dev fuzz-check "$1"
    job 'TSan: threads' ./dev tsan-check
    job 'lint of the last commit' ./dev lint
}

# edit_to_tests FILE ROOM: what somebody waits who changed FILE.
edit_to_tests() {
    touch "$1"
    env PASSUNG_PRESET=ci ./dev room "$2"
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

# The table as a page that is kept with the sources.
checked_page() {
    local i
    printf '# Checked\n\nEvery check, without a limit of time: `./dev check-all` wrote this page at `%s`, %s.\n\n' \
        "$(git rev-parse --short HEAD)" "$(date +%F)"
    printf '| check | minutes | passed / failed | result |\n|---|---|---|---|\n'
    for i in "${!names[@]}"; do
        printf '| %s | %d | %s | %s |\n' "${names[i]}" $(((seconds[i] + 30) / 60)) "${counts[i]}" "${verdicts[i]}"
    done
}
