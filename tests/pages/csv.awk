# Rows of comma-separated values, where a field that holds a comma or a quote stands in quotes.

# Splits `line` into field[1] ...; returns how many there are.
function splitRow(line, field,    n, at, c, quoted, text) {
    n = 1
    text = ""
    for (at = 1; at <= length(line); at++) {
        c = substr(line, at, 1)
        if (quoted && c == "\"" && substr(line, at + 1, 1) == "\"") {
            text = text c
            at++
        } else if (c == "\"") {
            quoted = !quoted
        } else if (c == "," && !quoted) {
            field[n++] = text
            text = ""
        } else {
            text = text c
        }
    }
    field[n] = text
    return n
}

function quotedField(text) {
    if (text !~ /[",]/) return text
    gsub(/"/, "\"\"", text)
    return "\"" text "\""
}

# Names the columns by the first row: column["figure"] is its number.
FNR == 1 {
    column_count = splitRow($0, field)
    for (i = 1; i <= column_count; i++) column[field[i]] = i
}
FNR > 1 {
    if (splitRow($0, field) != column_count) {
        print FILENAME ":" FNR ": " column_count " columns are needed" > "/dev/stderr"
        broken = 1
    }
}
function value(name) { return field[column[name]] }
