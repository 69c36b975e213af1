"""Ticks of a Passung database, with Python's standard library alone: ticks("study.db", attempt_id) gives lists by
column, bit for bit those of the export's samples. attempt_id: of the database's view v_trials. From the shell:
python3 passung.py study.db ATTEMPT_ID [STREAM] > ticks.csv"""
import json
import sqlite3
import struct
import sys
import zlib

FORMATS = {"float64": "d", "float32": "f", "uint32": "I", "int32": "i", "int64": "q"}


def query(database, sql, *values):
    with sqlite3.connect(database) as connection:
        connection.execute("PRAGMA query_only = ON")
        return connection.execute(sql, values).fetchall()


def column(planes, n, width, order):
    """The bytes of n values. order: how often differences were taken; None: the planes are of the values themselves."""
    words = [int.from_bytes(planes[i::n], "little") for i in range(n)]
    if order is not None:
        words = [(word >> 1) ^ -(word & 1) for word in words]
    for _ in range(order or 0):
        for i in range(1, n):
            words[i] += words[i - 1]
    return b"".join((word % (1 << 8 * width)).to_bytes(width, "little") for word in words)


def chunk(blob, n, channels, differences):
    """Lists by name. What a chunk of an older program lacks of the last columns is not in it."""
    body = zlib.decompress(blob[4:])
    widths = [struct.calcsize("<" + FORMATS[channel["type"]]) for channel in channels]
    while len(body) != n * sum(widths) + differences * len(widths):
        widths.pop()
    orders, at, columns = body, differences * len(widths), {}
    for i, width in enumerate(widths):
        values = column(body[at:at + n * width], n, width, orders[i] if differences else None)
        columns[channels[i]["name"]] = struct.unpack("<%d%s" % (n, FORMATS[channels[i]["type"]]), values)
        at += n * width
    return columns


def ticks(database, attempt_id, stream="tick"):
    """stream: "tick", of another hand "tick_hand_2" and so on; "tick_timing", "bodies" ...: see the table stream."""
    result = {"tick": []}
    for first, n, crc, blob, encoding, channels in query(
            database, "SELECT first_tick, n, crc32, data, encoding, channels_json FROM sample_chunk JOIN stream "
            "USING(stream_id) WHERE attempt_id = ? AND stream = ? ORDER BY first_tick", attempt_id, stream):
        if zlib.crc32(blob) != crc:
            raise ValueError("the chunk from tick %d is damaged" % first)
        result["tick"] += range(first, first + n)
        for name, values in chunk(blob, n, json.loads(channels), encoding.startswith("columns-v3")).items():
            result.setdefault(name, []).extend(values)
    return result


if __name__ == "__main__":
    table = ticks(sys.argv[1], int(sys.argv[2]), *sys.argv[3:])
    print(",".join(table), *(",".join(map(repr, row)) for row in zip(*table.values())), sep="\n")
