"""Scenes at the edge: flows that cannot be, flows that nearly cannot, and solves at round-off."""
import csv
import sys
import tempfile
import unittest
from pathlib import Path

from program import simulate

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from scene_xml import xml  # noqa: E402

COUPLINGS = ("mixed face", "flux")


def scene(n_cells=(16, 16), sides=None, solids=None, coupling="mixed face", step=.01, **more):
    size = (1., n_cells[1] / n_cells[0])
    return xml("Scene", {
        "Dimension": 2, "Domain": {"Upper": size, "Cells": n_cells, "Sides": sides or {}},
        "Fluid": {"Density": 1., **more.pop("fluid", {})}, "Solids": solids or {},
        "Coupling": {"Type": coupling}, "Contact": {"Type": "none"},
        "Time": {"End": 1., "Fixed Step": step, **more.pop("time", {})}, "Output": {"Frames": False}, **more})


def moved(geometry, position=(.5, .5), **motion):
    return {"Type": "rigid body", "Geometry": geometry, "Position": position,
            "Motion": {"Type": "sinusoid", "Frequency": 1., **motion}}


def box(*size):
    return {"Shape": "box", "Size": size}


def inflow(*velocity, **more):
    return {"Type": "inflow", "Velocity": velocity, **more}


class HardScenes(unittest.TestCase):
    def run_scene(self, text, *arguments, code=0):
        with tempfile.TemporaryDirectory() as folder:
            result = simulate(folder, "--quiet", *arguments, scene=text)
            self.assertEqual(result.returncode, code, result.stdout + result.stderr)
            history = Path(folder) / "output" / "history.csv"
            lines = history.read_text().splitlines() if history.exists() else []
        rows = list(csv.DictReader(line for line in lines if not line.startswith("#")))
        return rows, result.stderr

    def assert_refused(self, text, *expected, code=2):
        rows, message = self.run_scene(text, "--steps", 20, code=code)
        for part in expected:
            self.assertIn(part, message)
        self.assertEqual(len(message.strip().splitlines()), 1, message)
        return rows

    def test_impossible_from_the_start(self):
        self.assert_refused(scene(sides={"x lower": inflow(1., 0.)}),
                            'inflow "x lower" pushes in 1 m^2/s', "256 cells", "At the start")
        self.assert_refused(scene(sides={"x lower": inflow(1., 0.), "x upper": inflow(.9, 0.)}),
                            '"x upper" takes out 0.9 m^2/s', "-0.1 m^2/s")
        for coupling in COUPLINGS:
            piston = moved(box(.25, 1.4), Amplitude=(.05, 0.))
            self.assert_refused(scene(solids={"Piston": piston}, coupling=coupling), 'solid "Piston"', "closed in")

    def test_impossible_from_a_step_on(self):
        rows = self.assert_refused(scene(sides={"x lower": {**inflow(1., 0.), "Velocity": ("min(t, 1)", "0")}}),
                                   "At 0.01 s", '"x lower"', code=3)
        self.assertEqual(len(rows), 0)
        start_at_rest = {"Phase": 1.5707963267948966}
        for coupling in COUPLINGS:
            piston = moved(box(.25, 1.4), Amplitude=(.05, 0.), **start_at_rest)
            self.assert_refused(scene(solids={"Piston": piston}, coupling=coupling), 'solid "Piston"', code=3)

    def test_soft_bodies_are_no_outlet(self):
        """Nor a pinned one; but one that has open fluid behind it gives way, and so does cloth."""
        def soft(width, height, x, y, **more):
            return {"Type": "deformable body", "Geometry": {"Shape": "box", "Size": (width, height), "Mesh Spacing": .125}, "Density": 1.,
                    "Material": {"Type": "linear", "Young's Modulus": 1e3, "Poisson's Ratio": .3}, "Position": (x, y), **more}
        beam = soft(.25, .5, .5, .25, Pinned={"Foot": {"Lower": (0., -.1), "Upper": (1., .01)}})
        sheet = {"Type": "cloth", "Geometry": {"Shape": "sheet", "Size": (0., 1.), "Normal": "x"}, "Young's Modulus": 1e3,
                 "Thickness": .01, "Surface Density": 1., "Position": (.5, .5), "Time Integration": "semi-implicit"}
        stream = {"x lower": inflow(1., 0.)}
        for coupling in COUPLINGS:
            for body in (beam, soft(.5, .25, .5, .5)):
                self.assert_refused(scene(sides=stream, solids={"Beam": body, "Cloth": {**sheet, "Position": (.8, .5)}}, coupling=coupling),
                                    "At the start", 'inflow "x lower" pushes in 1 m^2/s', "could only be squeezed")
                self.run_scene(scene(sides={**stream, "x upper": {"Type": "open"}}, solids={"Beam": body}, coupling=coupling), "--steps", 2)
                self.run_scene(scene(sides={**stream, "x upper": inflow(1., 0.)}, solids={"Beam": body}, coupling=coupling), "--steps", 2)
            ramp = {"x lower": {**inflow(1., 0.), "Velocity": ("min(t, 1)", "0")}}
            self.assert_refused(scene(sides=ramp, solids={"Beam": beam}, coupling=coupling), "At 0.01 s", "could only be squeezed", code=3)
            for wall in (soft(.25, 1., .5, .5), sheet):
                self.run_scene(scene(sides={**stream, "x upper": {"Type": "open"}}, solids={"Wall": wall}, coupling=coupling), "--steps", 2)

    def test_gas_of_constant_volume_that_is_pressed(self):
        """Between a plate and water on a closed floor; with an open side below the water gives way."""
        air = {"Free Surface": {"Liquid": {"Pool": {"Type": "level", "Height": .6}}, "Trapped Air": "constant volume",
                                "Atmosphere": (.5, 1.4)}, "Density": 1000., "Gravity": (0., -9.8)}
        plate = {"Shape": "plate", "Size": (2., 2.), "Normal": "y"}
        fast, slow = ({"Piston": {**moved(plate, (.5, 1.2), Amplitude=(0., a)), "Surface Density": 1.}} for a in (.05, .015))
        self.assert_refused(scene((24, 36), solids=fast, fluid=air, step=.005), "At the start: 0.602 m^2 of gas", '("Piston")',
                            "0.314 m^2/s", '"ideal gas"')
        late = {"Piston": {**fast["Piston"], "Motion": {**fast["Piston"]["Motion"], "Phase": -1.5708}}}
        self.assert_refused(scene((24, 36), solids=late, fluid=air, step=.005), "At 0.0", '("Piston")', code=3)
        _, message = self.run_scene(scene((24, 36), solids=slow, fluid=air, step=.005), "--steps", 60, code=3)
        self.assertIn("of gas that keeps its volume", message)
        self.run_scene(scene((24, 36), {"x lower": {"Type": "open"}}, fast, fluid=air, step=.005), "--steps", 20)

    def test_possible(self):
        """All of them in a tank of no open side."""
        solids = {
            "turning": moved(box(.5, .3), **{"Angular Amplitude": .5}),
            "passing by": moved({"Shape": "ball", "Radius": .21}, Amplitude=(.13, .07)),
            "turning in the wall": moved(box(.5, .3), position=(.03, .47), **{"Angular Amplitude": .4}),
            "nearly at the wall": moved(box(.3, .3), position=(.5, .19), Amplitude=(0., .03)),
            "a shell": moved({"Shape": "plate", "Size": (.4, 0.), "Normal": "y"}, Amplitude=(.03, .05),
                             **{"Angular Amplitude": .3}),
        }
        for name, solid in solids.items():
            for coupling in COUPLINGS:
                with self.subTest(name, coupling=coupling):
                    rows, _ = self.run_scene(scene(solids={"Mover": solid}, coupling=coupling), "--steps", 30)
                    self.assertEqual(len(rows), 30)

    def test_explain_of_an_empty_tank(self):
        """A source is to fill it; until then no cell has a pressure."""
        jet = {"Shape": "ball", "Center": (.5, .8), "Radius": .1, "Liquid": True, "Velocity": (0., -1.)}
        empty = {"Free Surface": {"Interface": {"Type": "particle level set"}}, "Gravity": (0., -9.8), "Sources": {"Jet": jet}}
        with tempfile.TemporaryDirectory() as folder:
            result = simulate(folder, "--explain", scene=scene(fluid=empty, time={"End": 2.}, Output={"Frames": True}))
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertRegex(result.stdout, r"frames +about 100: every 0.02 s")
        self.assertRegex(result.stdout, r"memory so far +\d+ MB over all ranks\n")

    def test_a_solid_fills_the_whole_domain(self):
        """There is no pressure to solve for, with whatever strategy."""
        inverses = [{"Type": kind, **({"Prec Type": "RILUK"} if kind == "Ifpack2" else {})}
                    for kind in ("Direct", "Incomplete Cholesky", "MueLu", "Multigrid", "Ifpack2", "Jacobi")]
        kinds = ("schur-cg", "paper", "pressure-schur", "block-elimination", "direct")
        lists = sorted((Path(__file__).resolve().parents[2] / "xml-params/solvers").glob("*.xml"))
        solvers = [{"Strategy": {"Type": kind}} for kind in kinds] + [{"File": str(file)} for file in lists]
        solvers += [{"Strategy": {"Type": "schur-cg", "Pressure Inverse": one}} for one in inverses]
        still = {"Type": "rigid body", "Geometry": box(1.4, 1.4), "Position": (.5, .5), "Motion": {"Type": "static"}}
        free = {"Type": "rigid body", "Geometry": box(.999, .999), "Position": (.5, .5), "Density": 500.}
        for solid in (still, free):
            for solver in solvers:
                with self.subTest(solver=solver, free=solid is free):
                    rows, _ = self.run_scene(scene(solids={"Plug": solid}, Solver=solver), "--steps", 2)
                    self.assertEqual(len(rows), 2)

    def test_openings_of_one_area_balance(self):
        opening = {"Opening": {"Lower": (0., .31), "Upper": (1., .48)}}
        other = {"Opening": {"Lower": (0., .52), "Upper": (1., .69)}, "Velocity": ("6*(y - 0.52)*(0.69 - y)/0.17^2", "0")}
        sides = {"x lower": inflow(1., 0., **opening), "x upper": {**inflow(1., 0.), **other}}
        rows, _ = self.run_scene(scene(sides=sides), "--steps", 3)
        self.assertEqual(len(rows), 3)

    def test_a_disc_that_comes_to_rest_in_a_vortex(self):
        """Where all that S1 must balance vanishes, round-off ends the solve."""
        periodic = {f"{axis} {end}": {"Type": "periodic"} for axis in "xy" for end in ("lower", "upper")}
        disc = {"Type": "rigid body", "Geometry": {"Shape": "ball", "Radius": .1}, "Position": (.42, .31),
                "Density": 1.}
        text = scene((32, 32), periodic, {"Disc": disc}, step=.0125, time={"End": 2.},
                     fluid={"Order in Time": 2, "Velocity": ("sin(2*_pi*x)*cos(2*_pi*y)", "-cos(2*_pi*x)*sin(2*_pi*y)")})
        rows, _ = self.run_scene(text)
        self.assertEqual(len(rows), 160)
        self.assertLess(max(int(row["s1_iterations"]) for row in rows), 30)


if __name__ == "__main__":
    unittest.main()
