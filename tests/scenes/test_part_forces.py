"""Forces on parts of surfaces: parts that make up a surface have the force of their solid, and water at rest pushes on one end of a
box by rho g d^2/2."""
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from scene_xml import xml  # noqa: E402
from simulation import attempt, column, simulate, table  # noqa: E402

COUPLINGS = ("mixed face", "flux")
THIRDS = [{"Expression": ".31 - x"}, {"Expression": "x >= .31 ? .72 - y : -1"}, {"Expression": "min(x - .31, y - .72) + 1e-12"}]


def solids_in(dim, soft):
    """A free ball, a slab that is driven through the fluid; a soft body, and a sheet that is held at an end."""
    middle = (.5,) * (dim - 2)
    solids = {
        "Ball": {"Type": "rigid body", "Geometry": {"Shape": "ball", "Radius": .14}, "Position": (.3, .7, *middle), "Density": 1.3},
        "Slab": {"Type": "rigid body", "Geometry": {"Shape": "box", "Size": (.3, .12, .3)[:dim]}, "Position": (.7, .72, *middle),
                 "Motion": {"Type": "constant velocity"}, "Velocity": (.1, .05, 0.)[:dim],
                 "Angular Velocity": .7 if dim == 2 else (0., 0., .7)}}
    if soft:
        solids["Soft"] = {"Type": "deformable body", "Geometry": {"Shape": "box", "Size": (.3, .2, .3)[:dim], "Mesh Spacing": .1},
                          "Position": (.28, .25, *middle), "Density": 1.2,
                          "Material": {"Type": "st venant-kirchhoff", "Young's Modulus": 200., "Poisson's Ratio": .3}}
    return solids


def halves(dim, x):
    return [{"Upper": (x, 9., 9.)[:dim]}, {"Lower": (x, -9., -9.)[:dim]}]


def observed(solid, parts):
    return {f"{solid} {number}": {"Type": "force", "Solid": solid, **part} for number, part in enumerate(parts)}


def scene(dim, solids, observers, coupling, cells=None, more=None, **fluid):
    return xml("Scene", {
        "Dimension": dim, "Domain": {"Upper": (1.,) * dim, "Cells": (cells or (32 if dim == 2 else 16),) * dim},
        "Fluid": {"Density": 1., "Gravity": (.3, -2., .1)[:dim], **fluid}, "Solids": solids, "Coupling": {"Type": coupling},
        "Observers": observers, "Solver": {"Tolerance": 1e-11}, "Output": {"Frames": False},
        "Time": {"End": 9., "Fixed Step": .02}, **(more or {})})


def run(text, *options, ranks=1):
    """Tables of a run by name."""
    with tempfile.TemporaryDirectory() as name:
        (Path(name) / "scene.xml").write_text(text)
        output = Path(name) / "output"
        simulate(Path(name) / "scene.xml", output, *options, ranks=ranks)
        return {file.stem: table(file) for file in output.glob("*.csv")}


def forces(rows):
    return [name for name in ("fx", "fy", "fz") if name in rows[0]]


def torques(rows):
    return [name for name in ("tx", "ty", "tz") if name in rows[0]]


class PartsOfASurface(unittest.TestCase):
    def assert_sum(self, tables, solid, n_parts, names_of, tolerance=1e-11):
        """None of the parts has all of it."""
        whole = [row for row in tables["bodies"] if row["name"] == solid]
        parts = [tables[f"{solid} {number}"] for number in range(n_parts)]
        largest = max(max(map(abs, column(part, name))) for part in parts for name in names_of(whole))
        self.assertGreater(largest, 1e-5)
        for name in names_of(whole):
            for force, *of_parts in zip(column(whole, name), *(column(part, name) for part in parts)):
                self.assertLess(abs(sum(of_parts) - force), tolerance * largest, (solid, name))
        for part in parts:
            self.assertEqual(len(part), len(whole))
            self.assertGreater(max(max(map(abs, column(part, name))) for name in names_of(whole)), 1e-3 * largest)

    def check(self, dim, coupling, soft, ranks=1, steps=4, **more):
        observers = {**observed("Ball", THIRDS), **observed("Slab", halves(dim, .71))}
        if soft:
            observers.update(observed("Soft", halves(dim, .27)))
        tables = run(scene(dim, solids_in(dim, soft), observers, coupling, **more), "--steps", steps, ranks=ranks)
        for solid, n_parts in (("Ball", 3), ("Slab", 2)):
            self.assert_sum(tables, solid, n_parts, forces)
            self.assert_sum(tables, solid, n_parts, torques)
        if soft:
            self.assert_sum(tables, "Soft", 2, forces)

    def test_parts_add_up_in_the_plane(self):
        """In steps of two kicks and, with soft bodies, of the paper; pressure, friction, lumped fluid."""
        for coupling in COUPLINGS:
            for soft, ranks, viscosity in ((False, 1, .01), (False, 2, 0.), (True, 1, .01), (True, 2, .01)):
                with self.subTest(coupling=coupling, soft=soft, ranks=ranks):
                    self.check(2, coupling, soft, ranks, Viscosity=viscosity)

    def test_parts_add_up_in_space(self):
        for coupling in COUPLINGS:
            with self.subTest(coupling=coupling):
                self.check(3, coupling, True, 2, steps=2, Viscosity=.01)

    def hydrostatic_error(self, coupling, cells, level, draft, middle):
        """Error of the force on either half of a fixed box in water at rest, by rho g d^2 / 2."""
        density, gravity = 1000., 9.81
        box = {"Type": "rigid body", "Geometry": {"Shape": "box", "Size": (.25 if middle == .5 else .33, 2 * draft)},
               "Position": (middle, level), "Motion": {"Type": "static"}}
        tables = run(scene(2, {"Box": box}, observed("Box", halves(2, middle)), coupling, cells, Density=density,
                           Gravity=(0., -gravity), **{"Free Surface": {"Liquid": {"Pool": {"Type": "level", "Height": level}}}}),
                     "--steps", 2)
        wanted = density * gravity * draft**2 / 2
        errors = [abs(float(tables[f"Box {k}"][-1]["fx"]) / (wanted if k == 0 else -wanted) - 1) for k in (0, 1)]
        return max(errors)

    def test_water_at_rest_on_the_end_of_a_box(self):
        """Mixed faces know the depth d of the box to half a cell, fluxes see its corner; at faces of the grid both are exact."""
        for coupling, order in zip(COUPLINGS, (1, 2)):
            for cells in (24, 48):
                with self.subTest(coupling=coupling, cells=cells):
                    bound = (1 / cells / .27) ** order
                    self.assertLess(self.hydrostatic_error(coupling, cells, .613, .27, .507), bound if order == 1 else .25 * bound)
            with self.subTest(coupling=coupling):
                self.assertLess(self.hydrostatic_error(coupling, 32, .625, .25, .5), 1e-9)

    def test_sheets_joints_and_a_surface_of_water(self):
        """A sheet of cloth that is held at an end, a bar on a hinge, a ball that floats: buoyancy that the grid does not see is in it."""
        solids = {"Sheet": {"Type": "cloth", "Geometry": {"Shape": "sheet", "Size": (.3, 0.), "Normal": "y", "Mesh Spacing": .03},
                            "Position": (.27, .3), "Young's Modulus": 1e4, "Thickness": .002, "Surface Density": 20.,
                            "Pinned": {"End": {"Lower": (-.151, -.01), "Upper": (-.14, .01)}}},
                  "Bar": {"Type": "rigid body", "Geometry": {"Shape": "box", "Size": (.3, .07)}, "Density": 1500., "Position": (.7, .3)},
                  "Ball": {"Type": "rigid body", "Geometry": {"Shape": "ball", "Radius": .12}, "Density": 600., "Position": (.4, .71),
                           "Velocity": (.2, 0.)}}
        joints = {"Hinge": {"Type": "hinge", "Solids": ("space", "Bar"), "Point": (.6, .3)}}
        observers = {**observed("Sheet", halves(2, .27)), **observed("Bar", halves(2, .68)), **observed("Ball", THIRDS)}
        water = {"Density": 1000., "Gravity": (0., -9.81), "Free Surface": {"Liquid": {"Pool": {"Type": "level", "Height": .7}}}}
        for coupling in COUPLINGS:
            for chosen in (("Sheet", "Bar", "Ball"), ("Bar", "Ball")):
                with self.subTest(coupling=coupling, chosen=chosen):
                    looked = {name: one for name, one in observers.items() if one["Solid"] in chosen}
                    tables = run(scene(2, {name: solids[name] for name in chosen}, looked, coupling, more={"Joints": joints}, **water),
                                 "--steps", 4)
                    for solid in chosen:
                        self.assert_sum(tables, solid, 3 if solid == "Ball" else 2, forces)
                        if solid != "Sheet":
                            self.assert_sum(tables, solid, 3 if solid == "Ball" else 2, torques)

    def test_a_restarted_run_knows_the_parts(self):
        """Places are those of the first start; the ball has turned and gone on since."""
        text = scene(2, solids_in(2, False), observed("Ball", THIRDS), "flux", Viscosity=.01, more={
            "Output": {"Frames": False, "Checkpoints": {"Interval": .04}}})
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            (folder / "scene.xml").write_text(text)
            simulate(folder / "scene.xml", folder / "output", "--steps", 4)
            whole = [table(folder / f"output/Ball {k}.csv") for k in range(3)]
            simulate(folder / "scene.xml", folder / "output", "--steps", 4, "--restart", folder / "output/checkpoint-000002.h5")
            self.assertEqual(whole, [table(folder / f"output/Ball {k}.csv") for k in range(3)])

    def test_messages(self):
        for part, words in (({"Solid": "Bal"}, 'did you mean "Ball"'), ({"Expression": "x - 3"}, "no part of the surface"),
                            ({"Lower": (.5, .5), "Upper": (.4, .9)}, "has nothing in it"), ({"Expression": "x - q"}, "q")):
            with self.subTest(words), tempfile.TemporaryDirectory() as name:
                file = Path(name) / "scene.xml"
                file.write_text(scene(2, solids_in(2, False), {"bow": {"Type": "force", "Solid": "Ball", **part}}, "flux"))
                result = attempt(file, Path(name) / "output", "--validate")
                self.assertEqual(result.returncode, 2, result.stdout)
                self.assertIn(words, result.stdout)


if __name__ == "__main__":
    unittest.main()
