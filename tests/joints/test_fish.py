"""A fish of flesh on bones in a closed tank: it keeps its area, the ledger closes on 1, 2 and 4 ranks, it swims, and what
its joints do is the energy that there is."""
import sys
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import numpy as np
from jointed_scene import simulation, table

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))
from lockstep_frames import read_frames  # noqa: E402

CLOSED = ("Domain/Sides/y upper/Type=wall", "Domain/Cells={48, 24}", "Solids/Flesh/Geometry/Mesh Spacing=0.04",
          "Output/Precision=double")


def area(mesh):
    """Area of a closed curve."""
    points, ends = np.array(mesh.points()), np.array(mesh.cells())
    a, b = points[ends[:, 0]], points[ends[:, 1]]
    return abs((a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum()) / 2


def swim(ranks, end, *settings, jointed=True):
    """Tables by name, and the areas of the flesh in all frames."""
    with tempfile.TemporaryDirectory() as folder:
        output = Path(folder) / "output"
        scene = ElementTree.parse(ROOT / "xml-params/scenes/fish-2d.xml")
        if not jointed:
            scene.getroot().remove(scene.find("*[@name='Joints']"))
        scene.write(Path(folder) / "fish.xml")
        options = [part for setting in (*CLOSED, f"Time/End={end}", *settings) for part in ("--set", setting)]
        simulation.simulate(Path(folder) / "fish.xml", output, *options, ranks=ranks)
        tables = {name: table(output / f"{name}.csv") for name in ("history", "bodies", "energy", "joints") if jointed or name != "joints"}
        return tables, [area(frame["Flesh"]) for frame in read_frames(output)]


def power_defect(tables):
    """Work of the joints less the energy of the flesh and of the fluid, over the largest energy."""
    history, work, time = tables["history"], 0., 0.
    defects, energies = [], []
    of_step = {}
    for row in tables["joints"]:
        of_step[row["step"]] = of_step.get(row["step"], 0.) + row["power"]
    for row in history:
        work += of_step[row["step"]] * (row["time"] - time)
        time = row["time"]
        energies.append(row["fluid_kinetic_energy"] + row["solid_kinetic_energy"] + row["elastic_energy"])
        defects.append(work - energies[-1])
    return np.array(defects) / max(energies)


class Fish(unittest.TestCase):
    def test_it_keeps_its_area_and_the_ledger_closes(self):
        places = []
        for ranks in (1, 2, 4):
            tables, areas = swim(ranks, .12)
            self.assertLess(np.abs(np.array(areas) / areas[0] - 1).max(), 1e-3)
            self.assertLess(max(row["momentum_error"] for row in tables["history"]), 1e-10)
            self.assertLess(max(row["angular_momentum_error"] for row in tables["history"]), 1e-10)
            places.append([row["x"] for row in tables["bodies"] if row["name"] == "Flesh"][-1])
        self.assertLess(np.ptp(places), 1e-6)

    def test_joints_take_no_iterations(self):
        """Bones that nothing but flesh ties to one another need as many, but S1 is solved twice with joints."""
        def iterations(jointed):
            history = swim(1, .2, "Solids/Flesh/Velocity={0.5, 0.2}", jointed=jointed)[0]["history"]
            return [sum(row[name] for row in history) for name in ("s1_iterations", "s2_iterations")]
        jointed, free = iterations(True), iterations(False)
        self.assertGreater(free[1], 0)
        self.assertLessEqual(jointed[0], 2 * free[0])
        self.assertLessEqual(jointed[1], free[1])

    def test_sub_steps(self):
        """Explicit flesh, whose own stable step is a tenth of the step, on bones that weigh less than it, moves as
        implicit flesh does, a little softer."""
        explicit = ("Solids/Flesh/Time Integration=semi-implicit", "Solids/Flesh/Most Sub-Steps=200")
        places, energies = [], []
        for settings in (explicit, ()):
            tables, areas = swim(1, .5, *settings)
            history = tables["history"]
            self.assertEqual(len(history), 25)
            for name in ("momentum_error", "angular_momentum_error"):
                self.assertLess(max(row[name] for row in history), 1e-10)
            self.assertLess(np.abs(np.array(areas) / areas[0] - 1).max(), 4e-3)
            places.append([(row["x"], row["y"]) for row in tables["bodies"] if row["name"] == "Flesh"])
            energies.append(max(row["solid_kinetic_energy"] + row["fluid_kinetic_energy"] for row in history))
        self.assertGreater(np.ptp(np.array(places[1])[:, 1]), 1e-3)
        self.assertLess(np.abs(np.subtract(*places)).max(), 4.5e-4)
        self.assertLess(energies[0], 2 * energies[1])
        self.assertGreater(energies[0], energies[1] / 2)

    def test_it_swims(self):
        """The fish swims, and has no more energy than its joints put in. It keeps its area, as its surface pushes what it sweeps."""
        tables, areas = swim(1, 2.)
        places = [row["x"] for row in tables["bodies"] if row["name"] == "Flesh"]
        self.assertGreater(places[-1] - places[0], .01)
        self.assertLess(abs(areas[-1] / areas[0] - 1), 2e-4)
        self.assertGreater(power_defect(tables)[-1], .05)  # the water's friction

    def test_its_joints_do_the_work(self):
        """In thin air, without friction in the flesh: all of it is motion and strain."""
        defects = []
        for step in (.01, .005):
            tables, _ = swim(1, .5, "Fluid/Density=1", "Fluid/Viscosity=0", "Solids/Flesh/Viscosity=0",
                             f"Time/Fixed Step={step}")
            defects.append(np.abs(power_defect(tables)).max())
        self.assertLess(defects[1], .01)
        self.assertLess(defects[1], defects[0])

    def test_where_its_energy_goes(self):
        """Each part of the book is measured where it arises; together they are all there is, but for what is lumped on nodes in
        the thin tip of the tail. What the step takes beside frictions and transport falls with it."""
        of_steps = []
        for ranks, step in ((1, .01), (2, .01), (1, .0025)):
            tables, _ = swim(ranks, .3, f"Time/Fixed Step={step}")
            history, last = tables["history"], tables["energy"][-1]
            work = sum(row["power"] * step for row in tables["joints"])
            for name, bound in (("left", 1e-4), ("lumping", 1e-4), ("loads", 1e-12)):
                self.assertLess(abs(last[name]), bound * work, name)
            self.assertAlmostEqual(last["joints"] / work, 1, delta=1e-9)
            energy = history[-1]["fluid_kinetic_energy"] + history[-1]["solid_kinetic_energy"]
            self.assertAlmostEqual(last["kinetic_change"] / energy, 1, delta=1e-9)
            self.assertAlmostEqual(last["elastic_change"] / history[-1]["elastic_energy"], 1, delta=1e-9)
            heat = sum(row["viscous_dissipation"] * step for row in history)
            self.assertAlmostEqual(last["fluid_friction"] / heat, 1, delta=.2)
            for name, bound in (("fluid_friction", .01), ("solid_friction", .002), ("transport", 1e-4)):
                self.assertGreater(abs(last[name]), bound * work, name)
            of_steps.append({name: last[name] / work for name in ("pressure", "elasticity", "ties", "solid_friction")})
        for name in of_steps[0]:
            self.assertAlmostEqual(of_steps[0][name], of_steps[1][name], delta=1e-5)
        rest = [sum(abs(one[name]) for name in ("pressure", "elasticity", "ties")) for one in of_steps]
        self.assertLess(rest[2], .6 * rest[0])


if __name__ == "__main__":
    unittest.main()
