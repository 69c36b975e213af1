"""Checks an export by what Psych-DS 0.4 asks of a data set: python3 psych_ds.py EXPORT. dataset_description.json is JSON-LD of
a schema.org Dataset with name, description and variableMeasured; data files lie in data/, their names are pairs
keyword-value, values of letters and digits, and end in _data.csv; each has a header of unique names, rows of its length, and
no column that variableMeasured does not name. Prints what is wrong and exits with 1 if anything is."""
import csv
import json
import os
import re
import sys

KEYWORDS = {"study", "site", "subject", "session", "task", "condition", "trial", "stimulus", "description"}
faults, files = [], 0
description = json.load(open(os.path.join(sys.argv[1], "dataset_description.json"), encoding="utf-8"))
if "schema.org" not in description.get("@context", "") or description.get("@type") != "Dataset":
    faults.append("no schema.org Dataset")
faults += ["no " + key for key in ("name", "description") if not description.get(key)]
known = {variable if isinstance(variable, str) else variable["name"] for variable in description["variableMeasured"]}
for name in sorted(os.listdir(os.path.join(sys.argv[1], "data"))):
    if not re.fullmatch(r"([a-z]+-[a-zA-Z0-9]+_)+data\.csv", name):
        faults.append("data/%s is no name" % name)
    if not {part.split("-")[0] for part in name.split("_")[:-1]} <= KEYWORDS:
        faults.append("data/%s has other keywords" % name)
    with open(os.path.join(sys.argv[1], "data", name), newline="", encoding="utf-8") as file:
        lines = list(csv.reader(file))
    files += 1
    if len(set(lines[0])) != len(lines[0]) or any(len(line) != len(lines[0]) for line in lines):
        faults.append("data/%s is no table" % name)
    faults += ["data/%s: %s is not told" % (name, column) for column in lines[0] if column not in known]
print("\n".join(faults))
print("%d files, %d variables" % (files, len(known)))
sys.exit(1 if faults or files < 5 else 0)
