# awk -v PAGE=measured|front -f csv.awk -f measured.awk docs/measured.csv: what stands between the markers of a page.

# A figure as a number: "0.6", "1/26", "1e-5".
function numberOf(text,    parts) {
    gsub(/ /, "", text)
    return split(text, parts, "/") == 2 ? parts[1] / parts[2] : text + 0
}

# Does every figure of the list keep the mark, "<= 2" or ">= 1/50"?
function isMet(figures, mark,    list, n, i, limit) {
    if (mark == "") return 1
    limit = numberOf(substr(mark, 3))
    n = split(figures, list, ",")
    for (i = 1; i <= n; i++) {
        if (mark ~ /^<=/ && numberOf(list[i]) > limit) return 0
        if (mark ~ /^>=/ && numberOf(list[i]) < limit) return 0
    }
    return 1
}

function withUnit(figure) { return value("unit") == "" ? figure : figure " " value("unit") }

function cell(text) {
    gsub(/\|/, "\\|", text)
    return text
}

FNR > 1 {
    what = value("what")
    met = isMet(value("figure"), value("mark"))
    mark = value("mark")
    sub(/^<= /, "≤ ", mark)
    sub(/^>= /, "≥ ", mark)
    rest = " | " withUnit(value("figure")) " | " (mark == "" ? "" : withUnit(mark) (met ? "" : ", **missed**")) " | `" \
        cell(value("command")) "` | `" value("commit") "`, " value("date")
    if (!(value("section") in size)) sections[++section_count] = value("section")
    machine = value("machine")
    if (!(machine in machine_number)) {
        machine_number[machine] = ++machine_count
        machines[machine_count] = machine
    }
    at = ++size[value("section")]
    rows[value("section"), at] = "| " cell(what) rest
    machine_of[value("section"), at] = machine_number[machine]

    # Among the missed ones a row that says "the same" stands without the row before, whose words it takes along.
    if (what ~ /^the same/) what = subject "; " what
    else subject = what
    if (!met) {
        missed[++missed_count] = "| " cell(what) rest
        missed_machine[missed_count] = machine_number[machine]
    }
    if (value("front") != "")
        front[++front_count] = "- **" withUnit(value("figure")) "** " value("front") (met ? "" : " (mark missed)")
    if (value("front") != "" && value("date") > newest) {
        newest = value("date")
        newest_commit = value("commit")
        newest_machine = machine
    }
}

function head() {
    print ""
    print "| what | figure | mark | measured again by | commit |"
    print "| --- | --- | --- | --- | --- |"
}

# The machine is named in each row only where there are several.
function tail(number) { return machine_count > 1 ? ", machine " number " |" : " |" }

END {
    if (broken) exit 1
    if (PAGE == "front") {
        for (i = 1; i <= front_count; i++) print front[i]
        print ""
        print "The newest is of commit `" newest_commit "`. Machine: " newest_machine "."
        exit
    }
    for (i = 1; i <= machine_count; i++) print (machine_count > 1 ? "Machine " i ": " : "Machine: ") machines[i] "."
    if (missed_count > 0) {
        print ""
        print "## Missed marks"
        head()
        for (i = 1; i <= missed_count; i++) print missed[i] tail(missed_machine[i])
    }
    for (s = 1; s <= section_count; s++) {
        print ""
        print "## " sections[s]
        head()
        for (i = 1; i <= size[sections[s]]; i++) print rows[sections[s], i] tail(machine_of[sections[s], i])
    }
}
