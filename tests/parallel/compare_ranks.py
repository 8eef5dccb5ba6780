#!/usr/bin/env python3
"""Runs a scene on several numbers of ranks and compares the histories column by column.

compare_ranks.py MPIEXEC SIMULATE SCENE OUTPUT --ranks 1 2 4 --steps 20 --tolerance 1e-8 [--set ...]

Two histories agree if in every column the largest difference is at most `tolerance` times the column's largest
value; what is no number agrees with nothing. Numbers that are round-off themselves (errors, residuals, iteration counts) are reported, not compared.
"""
import argparse
import csv
import math
import subprocess
import sys

NOT_COMPARED = {"wall_seconds", "name", "momentum_error", "angular_momentum_error", "max_divergence",
                "s1_iterations", "f2_iterations", "s2_iterations", "viscous_iterations",
                "lumping_torque_error_x", "lumping_torque_error_y", "lumping_torque_error_z", "s1_residual", "f2_residual", "s2_residual",
                "contact_residual", "incompatibility", "f2_incompatibility"}


def table(path):
    with open(path) as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def largest(values):
    """NaN if any of them is, wherever it stands; `max` gives that of a list only if it is the first."""
    values = list(values)
    return math.nan if any(map(math.isnan, values)) else max(values)


def differences(one, other):
    """Largest difference of each column over the column's largest value."""
    found = {}
    for column in one[0]:
        if column in NOT_COMPARED:
            continue
        scale = largest(abs(float(row[column])) for row in one)
        apart = largest(abs(float(a[column]) - float(b[column])) for a, b in zip(one, other))
        found[column] = 0 if apart == 0 else apart / scale if scale != 0 else math.inf
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("mpiexec")
    parser.add_argument("simulate")
    parser.add_argument("scene")
    parser.add_argument("output")
    parser.add_argument("--ranks", type=int, nargs="+", default=[1, 2, 4])
    parser.add_argument("--steps", default="20")
    parser.add_argument("--tolerance", type=float, default=1e-8)
    parser.add_argument("--iterations", type=float, default=0,
                        help="part by which iteration counts may differ (incomplete factorisations); 0: by 2")
    parser.add_argument("--set", action="append", default=[])
    arguments = parser.parse_args()
    results = {}
    for ranks in arguments.ranks:
        folder = f"{arguments.output}/ranks-{ranks}"
        command = [arguments.mpiexec, "--oversubscribe", "-np", str(ranks), arguments.simulate,
                   arguments.scene, "--output", folder, "--steps", arguments.steps, "--quiet"]
        for setting in arguments.set:
            command += ["--set", setting]
        code = subprocess.run(command).returncode
        if code != 0:
            sys.exit(f"{ranks} ranks ended with exit code {code}")
        results[ranks] = {name: table(f"{folder}/{name}.csv") for name in ("history", "bodies")}
    reference, failures = results[arguments.ranks[0]], []
    print("largest residual of S2: %s, momentum error: %s" % tuple(
        largest(float(row[c]) for r in results.values() for row in r["history"])
        for c in ("s2_residual", "momentum_error")))
    for ranks in arguments.ranks[1:]:
        for name, one in reference.items():
            other = results[ranks][name]
            if len(one) != len(other):
                failures.append(f"{name}.csv has {len(other)} rows on {ranks} ranks instead of {len(one)}")
                continue
            for column, difference in differences(one, other).items():
                print(f"{ranks} ranks, {name}.csv, {column}: {difference:.1e}")
                if not difference <= arguments.tolerance:
                    failures.append(f"{name}.csv, {column}: differs by {difference:.1e} on {ranks} ranks")
        for column in ("s1_iterations", "f2_iterations", "s2_iterations"):
            apart = max(abs(int(a[column]) - int(b[column]))
                        for a, b in zip(reference["history"], results[ranks]["history"]))
            most = max(int(row[column]) for row in reference["history"])
            if apart > max(2, arguments.iterations * most):
                failures.append(f"{column} differs by {apart} on {ranks} ranks")
    for row in (row for r in results.values() for row in r["history"]):
        if not (float(row["momentum_error"]) <= 1e-10 and float(row["angular_momentum_error"]) <= 1e-10):
            failures.append(f"momentum error {row['momentum_error']} in step {row['step']}")
    sys.exit("\n".join(failures) if failures else 0)


if __name__ == "__main__":
    main()
