"""Compares what analysis/readers/passung.py and passung.R read with the samples of an export, bit for bit:
python3 database_readers.py SOURCE DATABASE EXPORT ATTEMPT_ID... Numbers of the export are read by Python's own float(), which
rounds to the nearest; R's read.csv need not. What R reads it writes as bytes. Exits with 1 if anything differs."""
import csv
import gzip
import os
import sqlite3
import struct
import subprocess
import sys
import tempfile

source, database, export = sys.argv[1:4]
sys.path.insert(0, os.path.join(source, "analysis/readers"))
import passung  # noqa: E402

R = r"""
argument <- commandArgs(TRUE)
source(file.path(argument[1], "analysis/readers/passung.R"))
found <- ticks(argument[2], as.integer(argument[3]))
writeLines(names(found), argument[4])
writeBin(as.double(unlist(found, use.names = FALSE)), paste0(argument[4], ".bin"), endian = "little")
"""


def bits(value):
    return "NA" if value != value or value in (float("inf"), -float("inf")) else struct.pack("<d", value)


def exported(attempt):
    with sqlite3.connect("file:%s?mode=ro" % database, uri=True) as connection:
        place = connection.execute("SELECT participant_id, session, trial_index, attempt_no FROM v_trials WHERE "
                                   "attempt_id=?", (attempt,)).fetchone()
    path = os.path.join(export, "samples", "%s_%d_t%03d_a%d.csv.gz" % place)
    with gzip.open(path, "rt", newline="", encoding="utf-8") as file:
        lines = list(csv.reader(file))
    return dict(zip(lines[0], zip(*lines[1:])))


def read_by_r(attempt, folder):
    out = os.path.join(folder, "columns")
    subprocess.run(["Rscript", "--vanilla", "-e", R, source, database, str(attempt), out], check=True)
    names = open(out, encoding="utf-8").read().split()
    numbers = [value for value, in struct.iter_unpack("<d", open(out + ".bin", "rb").read())]
    rows = len(numbers) // len(names)
    return {name: numbers[i * rows:(i + 1) * rows] for i, name in enumerate(names)}


compared = 0
for attempt in map(int, sys.argv[4:]):
    truth = exported(attempt)
    with tempfile.TemporaryDirectory() as folder:
        for reader, columns in (("passung.py", passung.ticks(database, attempt)),
                                ("passung.R", read_by_r(attempt, folder))):
            if set(columns) - set(truth) or len(columns) < 40:
                sys.exit("%s has other columns than the export: %s" % (reader, sorted(set(columns) ^ set(truth))))
            for name, values in columns.items():
                cells = [text if text == "NA" else bits(float(text)) for text in truth[name]]
                if [bits(float(value)) for value in values] != cells:
                    sys.exit("%s, attempt %d: %s differs" % (reader, attempt, name))
                compared += len(cells)
print("compared %d values" % compared)
