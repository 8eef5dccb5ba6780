"""Damaged files of systems: `solve` says what is wrong with each, with exit code 2, and never breaks."""
import concurrent.futures
import csv
import os
import random
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

import h5py
import numpy

from program import SOLVE, simulate, with_checksum, without_checksum

ROOT = Path(__file__).resolve().parents[2]
SOLVER = """<ParameterList name="direct"><Parameter name="Type" type="string" value="direct"/></ParameterList>"""
TABLES = ["A", "B transposed", "C", "pressure rhs", "solid rhs", "null space/0"]


def replaced(name, change):
    """A mutation that stores another array under this name."""
    def mutate(file):
        values = change(file[name][...])
        del file[name]
        file[name] = values
    return mutate


def without(name):
    def mutate(file):
        del file[name]
    return mutate


def with_attribute(name, value, owner="/"):
    def mutate(file):
        del file[owner].attrs[name]
        if value is not None:
            file[owner].attrs[name] = value
    return mutate


def first_set(value, column=None):
    def change(values):
        values[(0,) if column is None else (0, column)] = value
        return values
    return change


def mutations():
    """Name and what is done to an open file."""
    for table in TABLES:
        places, values = f"{table}/places", f"{table}/values"
        yield f"{table} missing", without(table)
        yield f"{values} missing", without(values)
        yield f"{values} shorter", replaced(values, lambda array: array[:-1])
        yield f"{values} empty", replaced(values, lambda array: array[:0])
        yield f"{values} nan", replaced(values, first_set(numpy.nan))
        yield f"{values} text", replaced(values, lambda array: array.astype("S8"))
        yield f"{places} flat", replaced(places, lambda array: array.reshape(-1)[:-1])
        yield f"{places} beyond", replaced(places, lambda array: first_set(10**9, 0 if array.ndim > 1 else None)(array))
    for table in ("A", "C", "B transposed"):
        yield f"{table} column", replaced(f"{table}/places", first_set(-1, 1))
    yield "no row", replaced("A/values", lambda array: 0 * array)
    yield "infinite", replaced("C/values", first_set(numpy.inf))
    yield "twice", replaced("pressure rhs/places", lambda array: 0 * array)
    yield "places of reals", replaced("A/places", lambda array: array + 0.5)
    for name in ("pressure unknowns", "solid unknowns"):
        for value in (None, -1, 4, 2**40, 2**62, "many", 2.5, numpy.array([1, 2, 3])):
            yield f"{name} {value}", with_attribute(name, value)
    for value in (None, 7, "another kind"):
        yield f"kind {value}", with_attribute("kind", value)
    yield "name", with_attribute("name", numpy.array([1.5, 2.5]))
    for value in (None, -1, 2, 10**12, "one"):
        yield f"size {value}", with_attribute("size", value, "null space")
    yield "zero null vector", replaced("null space/0/values", lambda array: 0 * array)
    # Without "lower" it is a file of an older version, whose lattice has no coefficients.
    for table in ("places", "cells", "dirichlet", "diagonal"):
        yield f"lattice {table} missing", without(f"lattice/{table}")
        yield f"lattice {table} shorter", replaced(f"lattice/{table}", lambda array: array[:-1])
    yield "lattice twice", replaced("lattice/places", lambda array: 0 * array)
    yield "lattice cell twice", replaced("lattice/cells", lambda array: 0 * array)
    yield "lattice cell beyond", replaced("lattice/cells", first_set(10**6, 0))
    yield "lattice face negative", replaced("lattice/lower", first_set(-1., 0))
    yield "lattice nan", replaced("lattice/dirichlet", first_set(numpy.nan))
    for name, values in (("unit", (None, 0., -1., numpy.inf)), ("width", (None, 0, 3, 2**20)), ("dimension", (None, 1, 4)),
                         ("cells x", (None, 0, 2**40))):
        for value in values:
            yield f"lattice {name} {value}", with_attribute(name, value, "lattice")


class Systems(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        scratch = tempfile.TemporaryDirectory()
        cls.addClassCleanup(scratch.cleanup)
        cls.folder = Path(scratch.name)
        cls.system = cls.folder / "system.h5"
        result = simulate(scratch.name, "--steps", 1, "--dump-system", "1:S2", cls.system)
        assert result.returncode == 0, result.stderr
        (cls.folder / "direct.xml").write_text(SOLVER)

    def solve(self, path, *arguments):
        return subprocess.run([SOLVE, str(path), str(self.folder / "direct.xml"), *map(str, arguments)], stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, text=True, timeout=120)

    def complaint(self, path):
        """Returns the reason why `solve` did not refuse this file as it should; empty if it did."""
        result = self.solve(path)
        good = result.returncode == 2 and result.stderr.startswith("lockstep: ")
        # A message of ours only: no stack of HDF5, no trace of MPI.
        good = good and result.stderr.count("\n") == 1 and path.name in result.stderr
        return "" if good else f"{path.name}: exit code {result.returncode}\n{result.stderr[:2000]}"

    def assert_all_refused(self, paths):
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            complaints = [text for text in pool.map(self.complaint, paths) if text]
        self.assertFalse(complaints, "\n".join(complaints))

    def mutated(self, number, mutate):
        path = self.folder / f"mutation-{number}.h5"
        path.write_bytes(without_checksum(self.system.read_bytes()))
        with h5py.File(path, "r+") as file:
            mutate(file)
        # With a checksum of its own, so that the values themselves are looked at.
        path.write_bytes(with_checksum(path.read_bytes()))
        return path

    def test_a_system_that_is_never_solved(self):
        with tempfile.TemporaryDirectory() as folder:
            result = simulate(folder, "--steps", 1, "--dump-system", "2:S2", Path(folder) / "none.h5")
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertIn("--dump-system: no step solved 2:S2", result.stdout)
            self.assertFalse((Path(folder) / "none.h5").exists())

    def test_numbers_of_solve(self):
        for words in (("--tolerance", "-1"), ("--tolerance", "nan"), ("--tolerance", "0"), ("--direct-limit", "-1")):
            with self.subTest(words=words):
                result = self.solve(self.system, *words)
                self.assertEqual(result.returncode, 2, result.stderr)
                self.assertIn(words[0], result.stderr)

    def test_good_systems(self):
        plain = self.folder / "plain.h5"
        plain.write_bytes(without_checksum(self.system.read_bytes()))
        # Cells all of whose faces are mixed leave empty rows in A.
        empty_rows = self.folder / "empty-rows.h5"
        result = simulate(self.folder, "--steps", 1, "--dump-system", "1:S2", empty_rows, "--set",
                          "Coupling/Type=mixed face", "--set", "Coupling/Mixed Rule=every cut cell", "--set", "Solids/Ball/Geometry/Radius=0.05")
        self.assertEqual(result.returncode, 0, result.stderr)
        with h5py.File(empty_rows) as file:
            places, values = file["A/places"][...], file["A/values"][...]
            n_positive = ((places[:, 0] == places[:, 1]) & (values > 0)).sum()
            self.assertLess(n_positive, file.attrs["pressure unknowns"])
        for path in (self.system, plain, empty_rows):
            result = self.solve(path)
            self.assertEqual(result.returncode, 0, result.stderr)

    def test_without_a_reference_strategies_are_compared_all_the_same(self):
        """A part of the right-hand side that no flow can have, below the tolerance asked for, above that of the reference."""
        def shifted(values):
            return values + 1e-8 * abs(values).max()
        path = self.mutated("no-reference", replaced("pressure rhs/values", shifted))
        result = self.solve(path, "--tolerance", 1e-5, "--output", self.folder / "compared")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("no errors, as there is no reference: ", result.stdout)
        row = self.compared()[-1]
        self.assertEqual(row["strategy"], "direct")
        self.assertEqual(row["error"], "")

    def compared(self):
        lines = (self.folder / "compared" / "solvers.csv").read_text().splitlines()
        return list(csv.DictReader(line for line in lines if not line.startswith("#")))

    def test_histories_are_of_true_residuals(self):
        """Each power of ten from zero: residuals below it, iterations that grow, errors that fall; the inverses really used."""
        lists = [self.folder / "direct.xml", *(ROOT / f"xml-params/solvers/{name}.xml" for name in ("schur-cg", "minres-teko"))]
        result = self.solve(ROOT / "tests/data/light-disc.h5", *lists[1:], "--history", "--repeat", 2, "--tolerance", 1e-6,
                            "--output", self.folder / "compared")
        self.assertEqual(result.returncode, 0, result.stderr)
        rows = self.compared()
        for path, inverses in zip(lists, ("C: exact", "A: Multigrid; C: exact", "A: Multigrid; C: exact")):
            own = [row for row in rows if row["file"] == str(path)]
            self.assertEqual([float(row["tolerance"]) for row in own], [.1, .01, .001, 1e-4, 1e-5, 1e-6])
            for row in own:
                self.assertLessEqual(max(float(row["pressure_residual"]), float(row["solid_residual"])), float(row["tolerance"]))
                self.assertEqual(row["inverses"], inverses)
            iterations = [int(row["iterations"]) for row in own]
            self.assertEqual(iterations, sorted(iterations))
        iterated = [float(row["error"]) for row in rows if row["strategy"] != "direct"]
        self.assertLess(iterated[5], 1e-3 * iterated[0])
        refused = self.solve(self.system, "--repeat", 0)
        self.assertEqual(refused.returncode, 2)
        self.assertIn("--repeat 0 must be at least 1", refused.stderr)

    def test_bad_solver_files_are_told_first(self):
        bad = self.folder / "bad.xml"
        bad.write_text(SOLVER.replace('"direct"/>', '"dirct"/>'))
        result = self.solve(self.system, bad, "--output", self.folder / "nothing")
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertIn("dirct", result.stderr)
        self.assertEqual(result.stdout, "")
        self.assertFalse((self.folder / "nothing").exists())

    def test_mutations(self):
        all_mutations = list(mutations())
        self.assertGreaterEqual(len(all_mutations), 60)
        names = [name for name, _ in all_mutations]
        paths = [self.mutated(number, mutate) for number, (_, mutate) in enumerate(all_mutations)]
        renamed = [path.rename(path.with_name(name.replace("/", "_") + ".h5")) for name, path in zip(names, paths)]
        self.assert_all_refused(renamed)

    def test_flipped_bytes(self):
        whole = self.system.read_bytes()
        chance = random.Random(3)
        paths = []
        for number in range(12):
            damaged = bytearray(whole)
            damaged[chance.randrange(len(whole))] ^= 1 << chance.randrange(8)
            paths.append(self.folder / f"flipped-{number}.h5")
            paths[-1].write_bytes(damaged)
        self.assert_all_refused(paths)

    def test_flipped_structure_without_checksum(self):
        """HDF5 itself may break on these; the ones it can read whole are as good as any."""
        whole = without_checksum(self.system.read_bytes())
        chance = random.Random(4)
        for number in range(12):
            damaged = bytearray(whole)
            for _ in range(20):
                damaged[chance.randrange(4096)] = chance.randrange(256)
            path = self.folder / f"structure-{number}.h5"
            path.write_bytes(damaged)
            with self.subTest(number=number):
                result = self.solve(path)
                self.assertIn(result.returncode, (0, 2), result.stderr)
                self.assertLessEqual(result.stderr.count("\n"), 1, result.stderr)

    def test_pieces_and_other_files(self):
        whole = self.system.read_bytes()
        paths = []
        for name, content in [("half.h5", whole[:len(whole) // 2]), ("nothing.h5", b""), ("text.h5", b"a system"),
                              ("longer.h5", whole + b"x"), ("line.h5", whole[:-40] + b"x" + whole[-39:]),
                              ("begin-of-line.h5", whole[:-55] + b"x" + whole[-54:])]:
            paths.append(self.folder / name)
            paths[-1].write_bytes(content)
        os.mkfifo(self.folder / "pipe.h5")
        (self.folder / "folder.h5").mkdir()
        checkpoint = shutil.copy(next((self.folder / "output").glob("checkpoint-*.h5")), self.folder / "other.h5")
        self.assert_all_refused([*paths, self.folder / "pipe.h5", self.folder / "folder.h5", Path(checkpoint),
                                 self.folder / "missing.h5"])


if __name__ == "__main__":
    if not Path(SOLVE).exists():
        raise SystemExit(f"{SOLVE} is missing; set LOCKSTEP_SOLVE to the program to test.")
    unittest.main()
