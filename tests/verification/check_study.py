#!/usr/bin/env python3
"""Runs a part of a study and holds its table against bounds that a broken code would miss.

check_study.py CONVERGE STUDY OUTPUT [--rungs A:B] [--series REGEX]
               --expect "SERIES | QUANTITY | COLUMN | last|all|order | < | BOUND" ...

SERIES and QUANTITY are regular expressions that must match whole names. `last` looks at the last rung, `all` at
every rung, `spread` at largest minus smallest value over the matched rows. Values and errors are compared by their
size, orders with their sign. What is not a finite number holds to no bound.
"""
import argparse
import csv
import math
import operator
import re
import subprocess
import sys

RELATIONS = {"<": operator.lt, ">": operator.gt, "<=": operator.le, ">=": operator.ge}


def rows_of(table):
    with open(table) as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def selected(rows, series, quantity):
    return [r for r in rows if re.fullmatch(series, r["series"]) and re.fullmatch(quantity, r["quantity"])]


def measured(row, column):
    number = float(row[column])
    return number if column == "order" else abs(number)


def check(rows, expectation):
    """One line for each row that breaks the expectation."""
    series, quantity, column, which, relation, bound = [p.strip() for p in expectation.split(" | ")]
    matched = selected(rows, series, quantity)
    if not matched:
        return [f"no row matches: {expectation}"]
    if which == "spread":
        values = [float(r[column]) for r in matched]
        spread = max(values) - min(values) if all(map(math.isfinite, values)) else math.nan
        found = [(spread, f"spread of {column}")]
    else:
        if which == "last":
            matched = list({r["series"]: r for r in matched}.values())
        found = [(measured(r, column), f"{r['series']}, {r['quantity']}, h {r['h']}: {column}")
                 for r in matched if r[column] != ""]
        if not found:
            return [f"no value in column {column}: {expectation}"]
    return [f"{name} is {value:g}, must be {relation} {bound}" for value, name in found
            if not (math.isfinite(value) and RELATIONS[relation](value, float(bound)))]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("converge")
    parser.add_argument("study")
    parser.add_argument("output")
    parser.add_argument("--rungs")
    parser.add_argument("--series")
    parser.add_argument("--expect", action="append", required=True)
    arguments = parser.parse_args()
    command = [arguments.converge, arguments.study, "--output", arguments.output, "--fresh"]
    if arguments.rungs:
        command += ["--rungs", arguments.rungs]
    if arguments.series:
        command += ["--series", arguments.series]
    code = subprocess.run(command).returncode
    if code != 0:
        sys.exit(f"converge ended with exit code {code}")
    rows = rows_of(arguments.output + "/table.csv")
    failures = [failure for expectation in arguments.expect for failure in check(rows, expectation)]
    print("\n".join(failures) or f"{len(arguments.expect)} expectations hold over {len(rows)} rows")
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
