"""Mistakes in files in YAML: each is told with file and line, all in one run, and no damage breaks the programs."""
import random
import subprocess
import tempfile
import unittest
from pathlib import Path

from program import CONVERGE, SIMULATE, SOLVE, simulate

SCENE = """Dimension: 2
Domain:
  Upper: [1, 2]
  Cells: [12, 24]
Fluid:
  Density: 1000
  Viscosity: 0.5
  Gravity: [0, -9.8]
Constants:
  R: 0.3
Solids:
  Ball:
    Type: rigid body
    Geometry:
      Shape: ball
      Radius: "[R]"
    Density: 500
    Position: [0.5, 0.5]
Solver:
  File: solver.yaml
Time:
  End: 0.5
  Fixed Step: 0.01
"""
SOLVER = "Type: schur-cg\nTolerance: 1e-8\nPressure Inverse:\n  Type: Multigrid\n"
STUDY = """Scene: scene.yaml
Set: Time/Steps=1; Output/Frames=false
Ladder:
  Name: step
  Values: [0.01]
Quantities:
  speed:
    Expression: Ball.vy
"""
N_DAMAGED = 50


def cut(rng, text):
    return text[:rng.randrange(1, len(text))]


def flip_byte(rng, text):
    at = rng.randrange(len(text))
    return text[:at] + chr(rng.randrange(1, 256)) + text[at + 1:]


def insert_mark(rng, text):
    at = rng.randrange(len(text))
    return text[:at] + rng.choice(["{", "}", "[", "]", ":", ": ", "- ", "&a ", "*a", "!t ", "|", ">", "%", "@", "`", "\"", "'", "\t", "\n", "---\n", "? "]) + text[at:]


def double_line(rng, text):
    lines = text.splitlines(keepends=True)
    at = rng.randrange(len(lines))
    return "".join(lines[:at + 1] + lines[at:])


def drop_line(rng, text):
    lines = text.splitlines(keepends=True)
    del lines[rng.randrange(len(lines))]
    return "".join(lines)


def indent_line(rng, text):
    lines = text.splitlines(keepends=True)
    lines[rng.randrange(len(lines))] = " " * rng.randrange(1, 6) + rng.choice(lines)
    return "".join(lines)


def swap_lines(rng, text):
    lines = text.splitlines(keepends=True)
    one, other = rng.sample(range(len(lines)), 2)
    lines[one], lines[other] = lines[other], lines[one]
    return "".join(lines)


MUTATORS = [cut, flip_byte, insert_mark, double_line, drop_line, indent_line, swap_lines]


class YamlErrors(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = Path(scratch.name)

    def validate(self, scene=SCENE, solver=SOLVER, raw=False):
        (self.folder / "scene.yaml").write_text(scene, encoding="latin-1" if raw else "utf-8")
        (self.folder / "solver.yaml").write_text(solver)
        return subprocess.run([SIMULATE, "scene.yaml", "--validate"], cwd=self.folder, capture_output=True, text=True, timeout=120)

    def refused(self, *expected, **files):
        result = self.validate(**files)
        self.assertEqual(result.returncode, 2, result.stderr + result.stdout)
        self.assertEqual(result.stderr.count("lockstep: "), 1, result.stderr)
        for text in expected:
            self.assertIn(text, result.stderr)

    def test_the_scene_is_good(self):
        self.assertEqual(self.validate().returncode, 0, self.validate().stderr)

    def test_names_types_and_bounds(self):
        for old, new, *expected in [
                ("Density: 500", "Densty: 500", "scene.yaml, line 17: in \"Solids/Ball\", \"Densty\" is not a parameter. Did you mean \"Density\""),
                ("Viscosity", "Viskosity", "scene.yaml, line 7: in \"Fluid\"", "Did you mean \"Viscosity\""),
                ("Solids:", "Solid:", "scene.yaml, line 11: at the top level, \"Solid\"", "Did you mean \"Solids\""),
                ("Density: 500", "Density: light", "scene.yaml, line 17: in \"Solids/Ball\", \"Density\" is \"light\", which is not a number (type \"double\")."),
                ("Density: 500", "Density: \"500\"", "line 17", "take the quotes away"),
                ("Density: 500", "Density: -500", "scene.yaml, line 17", "but must be greater than 0"),
                ("[12, 24]", "[12, 24.5]", "scene.yaml, line 4", "component 2 is \"24.5\", which is not an integer"),
                ("[12, 24]", "12", "scene.yaml, line 4", "an array is written in brackets: [1, 2, 3]"),
                ("[12, 24]", "[12, 24, 1]", "scene.yaml, line 4", "has 3 components"),
                ("Radius: \"[R]\"", "Radius: [R]", "scene.yaml, line 16", "a formula in brackets is written in quotes"),
                ("Radius: \"[R]\"", "Radius: \"[r]\"", "scene.yaml, line 16", "Did you mean \"R\""),
                ("R: 0.3", "R: \"[2*\"", "scene.yaml, line 10", "\"R\""),
                ("Type: rigid body", "Type: rigid bodi", "scene.yaml, line 13", "did you mean \"rigid body\""),
                ("Dimension: 2", "Dimension: two", "scene.yaml, line 1", "\"Dimension\" is \"two\", which is not an integer"),
                ("Dimension: 2", "Dimension: 4", "scene.yaml, line 1", "it must be 2 or 3"),
                ("Dimension: 2\n", "", "\"Dimension\" (int) is required"),
                ("Fluid:\n", "Fluid: water\n", "well-formed YAML"),
                ("Density: 1000", "Density: 1000\n  Density: 1001", "scene.yaml, line 7", "given twice, first in scene.yaml, line 6"),
                ("Time:\n", "Output:\n  Frames: no\nTime:\n", "scene.yaml, line 22", "a bool is written true or false"),
                ("  File: solver.yaml", "  File: no.yaml", "Cannot read \"no.yaml\"", "a YAML parameter file")]:
            with self.subTest(new):
                self.refused(*expected, scene=SCENE.replace(old, new, 1))

    def test_all_mistakes_in_one_run(self):
        scene = SCENE.replace("Viscosity: 0.5", "Viscosity: thick").replace("Position", "Positon").replace("End: 0.5", "End: \"0.5\"")
        self.refused("There are 3 mistakes", "scene.yaml, line 7", "scene.yaml, line 18", "scene.yaml, line 22", "\"Position\"", scene=scene)

    def test_solver_files(self):
        for old, new, *expected in [("Tolerance", "Tolerence", "solver.yaml, line 2: in \"Solver/Strategy\"", "Did you mean \"Tolerance\""),
                                    ("1e-8", "small", "solver.yaml, line 2", "is \"small\", which is not a number"),
                                    ("1e-8", "\"[eps]\"", "solver.yaml, line 2", "is the string \"[eps]\""),
                                    ("Multigrid", "Multigrd", "Did you mean \"Multigrid\""),
                                    ("Type: schur-cg\n", "Type: a\nType: b\n", "solver.yaml, line 2", "given twice")]:
            with self.subTest(new):
                self.refused(*expected, solver=SOLVER.replace(old, new, 1))

    def test_included_files(self):
        (self.folder / "preset.yaml").write_text("Fluid:\n  Densty: 3\n")
        self.refused("preset.yaml, line 2: in \"Fluid\", \"Densty\"", scene="Include: preset.yaml\n" + SCENE)
        (self.folder / "preset.yaml").write_text("Fluid:\n  Density: 3\n Viscosity: 1\n")
        self.refused("what it includes: preset.yaml, line 3", "well-formed YAML", scene="Include: preset.yaml\n" + SCENE)
        self.refused("\"Include\" must be a string", scene="Include: {a: 1}\n" + SCENE)

    def test_xml_says_xml_still(self):
        result = simulate(self.folder, "--validate", scene="Dimension: 2\n")  # in scene.xml
        self.assertEqual(result.returncode, 2)
        self.assertIn("well-formed XML", result.stderr)

    def test_studies(self):
        self.validate()
        for old, new, *expected in [("Ladder", "Lader", "study.yaml, line 3", "Did you mean \"Ladder\""),
                                    ("[0.01]", "0.01", "study.yaml, line 5", "an array is written in brackets"),
                                    ("Ball.vy", "Bal.vy", "Did you mean \"Ball.vy\""),
                                    ("scene.yaml", "gone.yaml", "gone.yaml")]:
            with self.subTest(new):
                (self.folder / "study.yaml").write_text(STUDY.replace(old, new, 1))
                result = subprocess.run([CONVERGE, "study.yaml", "--output", "results"], cwd=self.folder, capture_output=True, text=True)
                self.assertEqual(result.returncode, 2, result.stderr)
                for text in expected:
                    self.assertIn(text, result.stderr)
                self.assertFalse((self.folder / "results").exists(), "nothing may have run")

    def test_solve(self):
        self.validate()
        ran = subprocess.run([SIMULATE, "scene.yaml", "--steps", "1", "--dump-system", "1:S2", "system.h5", "--quiet"],
                             cwd=self.folder, capture_output=True, text=True)
        self.assertEqual(ran.returncode, 0, ran.stderr)
        for text, code, expected in [(SOLVER, 0, "solver"), ("Tolerance: 1e-9\nStrategy:\n  Type: direct\n", 0, "solver"),
                                     (SOLVER.replace("1e-8", "tiny"), 2, "solver.yaml, line 2"),
                                     ("Tolerance: tiny\nStrategy:\n  Type: direct\n", 2, "solver.yaml, line 1"),
                                     ("Type: dirct\n", 2, "did you mean \"direct\"")]:
            with self.subTest(text):
                (self.folder / "solver.yaml").write_text(text)
                result = subprocess.run([SOLVE, "system.h5", "solver.yaml"], cwd=self.folder, capture_output=True, text=True)
                self.assertEqual(result.returncode, code, result.stderr)
                self.assertIn(expected, result.stdout + result.stderr)

    def test_damaged_files(self):
        n_refused = 0
        for seed in range(N_DAMAGED):
            rng = random.Random(f"yaml {seed}")
            text = MUTATORS[seed % len(MUTATORS)](rng, SCENE)
            with self.subTest(seed=seed, text=text):
                result = self.validate(scene=text, raw=True)
                self.assertIn(result.returncode, (0, 2), result.stderr)  # some damage is none: a line less
                if result.returncode == 0:
                    continue
                n_refused += 1
                self.assertEqual(result.stderr.count("lockstep: "), 1, result.stderr)
                self.assertNotIn("Please report", result.stderr)
                self.assertNotIn("terminate", result.stderr)
        self.assertGreater(n_refused, N_DAMAGED // 2)


if __name__ == "__main__":
    unittest.main()
