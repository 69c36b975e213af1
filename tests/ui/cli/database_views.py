"""Compares the views of a database with the tables of its export: python3 database_views.py DATABASE EXPORT.
Prints what differs and exits with 1 if anything does; at the end how many cells were compared."""
import csv
import math
import os
import sqlite3
import sys

database = sqlite3.connect("file:%s?mode=ro" % sys.argv[1], uri=True)
database.row_factory = sqlite3.Row
faults, compared = [], 0

# What an export has and SQL has not: docs of study/store/SCHEMA.md say the same.
ONLY_EXPORTED = {"scale_label", "class", "scale_formula", "log10_estimate", "reference", "sigma", "sigma_low",
                 "sigma_high", "jnd75"}


def table(name):
    path = os.path.join(sys.argv[2], name)
    if not os.path.exists(path):
        return None
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def rows(view):
    return [dict(row) for row in database.execute("SELECT * FROM " + view)]


def same(value, cell, tolerance=0.0):
    if value is None or value == "":
        return cell == "NA"
    if isinstance(value, float) and cell != "NA":
        return math.isclose(value, float(cell), rel_tol=tolerance, abs_tol=0.0)
    return str(value) == cell


def compare(view, csv_name, key, left_out=()):
    global compared
    exported = table(csv_name)
    found = rows(view)
    if exported is None:
        if found:
            faults.append("%s has rows, %s is not there" % (view, csv_name))
        return
    by_key = {}
    for row in found:
        by_key.setdefault(tuple("NA" if row[k] is None else str(row[k]).removesuffix(".0") for k in key),
                          []).append(row)
    if len(found) != len(exported):
        faults.append("%s has %d rows, %s %d" % (view, len(found), csv_name, len(exported)))
    for line in exported:
        place = tuple(line[k] for k in key)
        if not by_key.get(place):
            faults.append("%s lacks %s" % (view, place))
            continue
        row = by_key[place].pop(0)
        for name, cell in line.items():
            if name in left_out:
                continue
            if name not in row:
                faults.append("%s lacks the column %s" % (view, name))
                return
            compared += 1
            if not same(row[name], cell):
                faults.append("%s %s %s: %r, exported %s" % (view, place, name, row[name], cell))


def compare_cells():
    """A row of v_cells for each measure; the table has columns for each."""
    global compared
    key = ("participant_id", "protocol_sha256", "session", "block_index", "condition")
    exported = table("cells_long.csv")
    found = {}
    for row in rows("v_cells"):
        found.setdefault(tuple(str(row[k]) for k in key), {})[row["measure"]] = row
    if set(found) != {tuple(line[k] for k in key) for line in exported}:
        faults.append("v_cells has other cells than cells_long.csv")
        return
    for line in exported:
        place = tuple(line[k] for k in key)
        of_measure = found[place]
        for name, cell in line.items():
            measure, _, what = name.rpartition(".")
            if name == "restricted_to_s":
                measure, what = "time_s", name
            row = of_measure.get(measure) if measure else next(iter(of_measure.values()))
            if row is None:
                faults.append("v_cells lacks the measure " + measure)
                return
            value = row[what]
            # A cell whose trials cannot have the measure has no values of it.
            if what == "n" and cell == "NA":
                cell = "0"
            compared += 1
            # Sums are taken in another order.
            if not same(value, cell, 1e-12):
                faults.append("v_cells %s %s: %r, exported %s" % (place, name, value, cell))


def compare_document():
    """Every column of every view is told, and in the words of the codebook."""
    global compared
    told = {(row["view_name"], row["column_name"]): row for row in rows("column_doc")}
    files = {"trials.csv": "v_trials", "events.csv": "v_events", "questionnaire_scores.csv": "v_scores",
             "thresholds.csv": "v_thresholds"}
    for view in list(files.values()) + ["v_cells"]:
        columns = [column[1] for column in database.execute("PRAGMA table_info(%s)" % view)]
        if columns != [name for v, name in told if v == view] and set(columns) != {n for v, n in told if v == view}:
            faults.append("column_doc tells other columns of %s than it has" % view)
    for line in table("codebook.csv"):
        row = told.get((files.get(line["file"]), line["column"]))
        if row is None or line["column"] in ("protocol_sha256", "group", "condition"):
            continue  # the label says more where a file of the export is meant
        for name in ("label", "unit", "formula", "formula_version"):
            compared += 1
            if str(row[name]) != line[name]:
                faults.append("column_doc %s %s: %r, codebook %s" % (line["column"], name, row[name], line[name]))


compare("v_trials", "trials.csv", ("participant_id", "session", "trial_index", "attempt_no"))
compare_cells()
compare("v_scores", "questionnaire_scores.csv",
        ("participant_id", "session", "questionnaire", "moment", "block_index", "trial_index", "condition", "scale",
         "completed_utc"), ONLY_EXPORTED)
compare("v_events", "events.csv", ("participant_id", "session", "t_s", "event", "source", "payload_json"))
compare("v_thresholds", "thresholds.csv", ("participant_id", "session", "condition", "staircase", "track"),
        ONLY_EXPORTED)
compare_document()
print("\n".join(faults[:20]))
print("compared %d cells, %d differ" % (compared, len(faults)))
sys.exit(1 if faults else 0)
