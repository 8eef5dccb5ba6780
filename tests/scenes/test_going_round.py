"""Rigid bodies that go round a periodic domain: nothing tells where its seam is."""
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from scene_xml import xml  # noqa: E402
from simulation import attempt, column, histories, simulate, table  # noqa: E402

COUPLINGS = ("mixed face", "flux")
PERIODIC_X = {"x lower": {"Type": "periodic"}, "x upper": {"Type": "periodic"}}
STEP = .02


def ball(position, density=1.5, **more):
    return {"Type": "rigid body", "Geometry": {"Shape": "ball", "Radius": .13, "Mesh Spacing": .03}, "Position": position,
            **({"Density": density} if density else {}), **more}


def soft_ball(position, density=1.5, **more):
    return {"Type": "deformable body", "Geometry": {"Shape": "ball", "Radius": .13, "Mesh Spacing": .05}, "Position": position,
            "Density": density, "Material": {"Type": "neo-hookean", "Young's Modulus": 20., "Poisson's Ratio": .3}, **more}


def sheared(dim, speed):
    """Walls that shear the fluid between them; periodic along x, in space along z as well."""
    sides = {**PERIODIC_X, **{f"y {end}": {"Type": "wall", "Velocity": (sign * speed,) + (0.,) * (dim - 1)}
                              for end, sign in (("lower", -1), ("upper", 1))}}
    if dim == 3:
        sides.update({f"z {end}": {"Type": "periodic"} for end in ("lower", "upper")})
    return sides


def scene(dim, solids, coupling, cells=32, speed=.5, gravity=(0., -1., 0.), velocity=(0., 0., 0.), more=None, **fluid):
    upper = (1., .5, .5)[:dim] if dim == 2 else (1., .5, 1.)
    return xml("Scene", {
        "Dimension": dim,
        "Domain": {"Lower": (0.,) * dim, "Upper": upper, "Cells": tuple(round(cells * u) for u in upper),
                   "Sides": sheared(dim, speed)},
        "Fluid": {"Density": 1., "Viscosity": .02, "Gravity": gravity[:dim], "Velocity": velocity[:dim], **fluid},
        "Solids": solids, "Coupling": {"Type": coupling}, "Solver": {"Tolerance": 1e-11}, "Output": {"Frames": False},
        "Time": {"End": 100., "Fixed Step": STEP}, **(more or {})})


def columns_of(bodies, names, body="Ball"):
    return [column([row for row in bodies if row["name"] == body], name) for name in names]


class GoingRound(unittest.TestCase):
    def assert_same(self, one, other, tolerance):
        for here, there in zip(one, other):
            scale = max(map(abs, here)) + 1e-3
            self.assertLess(max(abs(a - b) for a, b in zip(here, there)), tolerance * scale)

    def states(self, dim, coupling, x, z=.5, steps=12, ranks=1, names=None, made=ball, **more):
        position = (x, .27, z)[:dim]
        _, bodies = histories(scene(dim, {"Ball": made(position)}, coupling, cells=32 if dim == 2 else 24, **more),
                              "--steps", steps, ranks=ranks)
        return columns_of(bodies, names or (("vx", "vy", "wz", "y") if dim == 2 else ("vx", "vy", "vz", "wz", "y")))

    def test_no_place_is_another_in_the_plane(self):
        for coupling in COUPLINGS:
            middle = self.states(2, coupling, .5)
            for x, ranks in ((1., 1), (.03125, 1), (4.5, 1), (-1., 1), (1., 2)):
                with self.subTest(coupling=coupling, x=x, ranks=ranks):
                    self.assert_same(middle, self.states(2, coupling, x, ranks=ranks), 1e-6)

    def test_no_place_is_another_for_what_is_soft(self):
        """In space a ball of few elements moves aside by 3e-7 m/s a cell farther on, seam or not."""
        for coupling in COUPLINGS:
            for dim, steps, tolerance, places in ((2, 12, 1e-6, ((1., .5, 1), (.03125, .5, 1), (-1., .5, 1), (4.5, .5, 2), (1., .5, 2))),
                                                  (3, 3, 5e-4, ((1., 0., 2),))):
                middle = self.states(dim, coupling, .5, steps=steps, made=soft_ball)
                for x, z, ranks in places:
                    with self.subTest(coupling=coupling, dim=dim, x=x, ranks=ranks):
                        self.assert_same(middle, self.states(dim, coupling, x, z, steps=steps, ranks=ranks, made=soft_ball), tolerance)

    def test_a_soft_body_in_a_stream_keeps_going(self):
        for coupling in COUPLINGS:
            with self.subTest(coupling=coupling):
                solids = {"Ball": soft_ball((.5, .25), Velocity=(1., 0.))}
                history, bodies = histories(scene(2, solids, coupling, speed=0., velocity=(1., 0.), gravity=(0., 0.), Viscosity=0.),
                                            "--steps", 120)
                x, vx, vy = columns_of(bodies, ("x", "vx", "vy"))
                self.assertGreater(x[-1], 2.8)
                self.assertLess(max(abs(v - 1) for v in vx), 1e-6)
                self.assertLess(max(map(abs, vy)), 1e-6)
                self.assertLess(max(column(history, "momentum_error")), 1e-9)

    def test_contact_with_what_is_soft_ends_at_the_seam(self):
        """The log says so; of a lone soft body there is nothing to say."""
        for others, told in (({}, 0), ({"Stone": ball((.2, .25), density=5.)}, 1)):
            with self.subTest(told=told), tempfile.TemporaryDirectory() as name:
                file = Path(name) / "scene.xml"
                file.write_text(scene(2, {"Ball": soft_ball((.85, .25), Velocity=(1., 0.)), **others}, "flux", velocity=(1., 0.),
                                      more={"Contact": {"Type": "gauss seidel"}}))
                result = attempt(file, Path(name) / "output", "--steps", 3)
                self.assertEqual(result.returncode, 0, result.stdout)
                self.assertEqual(result.stdout.count("contact does not see across such sides"), told, result.stdout)

    def test_no_place_is_another_in_space(self):
        for coupling in COUPLINGS:
            middle = self.states(3, coupling, .5, steps=4)
            for x, z, ranks in ((1., 0., 1), (1., .5, 2)):
                with self.subTest(coupling=coupling, x=x, z=z, ranks=ranks):
                    self.assert_same(middle, self.states(3, coupling, x, z, steps=4, ranks=ranks), 1e-6)

    def test_gravity_may_act_along_the_axis(self):
        for coupling in COUPLINGS:
            with self.subTest(coupling=coupling):
                middle = self.states(2, coupling, .5, gravity=(1., -.5))
                self.assert_same(middle, self.states(2, coupling, 1., gravity=(1., -.5)), 1e-6)

    def test_bodies_float_across_the_seam(self):
        """A disc, rigid or soft, falls into a pool and goes along; liquid as fractions has no random particles."""
        sides = {**PERIODIC_X, "y lower": {"Type": "wall"}, "y upper": {"Type": "open"}}
        pool = {"Interface": {"Type": "volume of fluid"}, "Liquid": {"Pool": {"Type": "level", "Height": .5}}}
        rubber = {"Material": {"Type": "neo-hookean", "Young's Modulus": 2e4}}
        for coupling, made, more in [(c, *kind) for c in COUPLINGS for kind in ((ball, {}), (soft_ball, rubber))]:
            found = []
            for x in (.5, 1.):
                text = xml("Scene", {
                    "Dimension": 2, "Domain": {"Lower": (0., 0.), "Upper": (1., 1.), "Cells": (32, 32), "Sides": sides},
                    "Fluid": {"Density": 1000., "Gravity": (0., -9.81), "Free Surface": pool},
                    "Solids": {"Ball": made((x, .55), density=500., Velocity=(.5, 0.), **more)}, "Coupling": {"Type": coupling},
                    "Solver": {"Tolerance": 1e-11}, "Output": {"Frames": False}, "Time": {"End": 100., "Fixed Step": .01}})
                history, bodies = histories(text, "--steps", 8)
                found.append([*columns_of(bodies, ("vx", "vy", "wz", "y")), column(history, "liquid_volume")])
            with self.subTest(coupling=coupling, soft=made is soft_ball):
                self.assert_same(found[0], found[1], 1e-6)

    def test_a_body_in_a_stream_keeps_going(self):
        """It and the fluid move alike: forever."""
        for coupling in COUPLINGS:
            with self.subTest(coupling=coupling):
                solids = {"Ball": ball((.5, .25), Velocity=(1., 0.))}
                history, bodies = histories(scene(2, solids, coupling, velocity=(1., 0.), gravity=(0., 0.), Viscosity=0.),
                                            "--steps", 120)
                x, vx, vy = columns_of(bodies, ("x", "vx", "vy"))
                self.assertGreater(x[-1], 2.8)  # columns go on beyond the sides
                self.assertLess(max(abs(v - 1) for v in vx), 1e-6)
                self.assertLess(max(map(abs, vy)), 1e-6)
                self.assertLess(max(column(history, "momentum_error")), 1e-9)

    def test_laps_are_alike(self):
        for coupling in COUPLINGS:
            with self.subTest(coupling=coupling):
                solids = {"Ball": ball((.5, .33), density=1.)}
                history, bodies = histories(scene(2, solids, coupling, speed=2., gravity=(0., 0.), Viscosity=.2), "--steps", 400)
                x, vx, wz = columns_of(bodies, ("x", "vx", "wz"))
                self.assertGreater(x[-1], 3.5)
                laps = [[v for at, v in zip(x, vx) if lap <= at < lap + 1] for lap in (2, 3)]
                speeds = [sum(lap) / len(lap) for lap in laps]
                self.assertAlmostEqual(speeds[1] / speeds[0], 1, delta=.03)
                self.assertLess(max(map(abs, vx)), 2.)
                self.assertLess(max(column(history, "momentum_error")), 1e-9)

    def test_bodies_meet_across_the_seam(self):
        for dim in (2, 3):
            found = []
            for seam in (.5, 1., 0.):
                at = (.27, .5)[:dim - 1]
                solids = {"Ball": ball((seam - .2, *at), density=5., Velocity=(1.,) + (0.,) * (dim - 1), Restitution=.8),
                          "Other": ball((seam + .2 + (2. if seam == 1. else 0.), *at), density=9.,
                                        Velocity=(-1.,) + (0.,) * (dim - 1), Restitution=.8)}
                _, bodies = histories(scene(dim, solids, "flux", cells=32 if dim == 2 else 24, speed=0., gravity=(0.,) * 3,
                                            more={"Contact": {"Type": "gauss seidel"}}), "--steps", 14 if dim == 2 else 9)
                found.append([v for body in ("Ball", "Other") for v in columns_of(bodies, ("vx", "vy", "y"), body)])
            self.assertLess(found[0][0][-1], 0)  # it bounced
            for other in found[1:]:
                with self.subTest(dim=dim):
                    self.assert_same(found[0], other, 1e-6)

    def test_a_body_rests_on_one_across_the_seam(self):
        """Along x it is held by a fixed body on the other side."""
        found = []
        for seam in (.5, 1.):
            solids = {"Stop": ball(((seam + .18) % 1, .25), density=0, Motion={"Type": "static"}),
                      "Ball": ball((seam - .1, .25), Locked=("y", "rotation"))}
            _, bodies = histories(scene(2, solids, "flux", speed=0., gravity=(2., 0.), Viscosity=.1,
                                        more={"Contact": {"Type": "gauss seidel"}}), "--steps", 40)
            found.append([[at - seam for at in column(bodies_of(bodies), "x")], column(bodies_of(bodies), "vx")])
        self.assert_same(found[0], found[1], 1e-5)
        self.assertLess(abs(found[1][1][-1]), 1e-3)

    def test_a_restart_goes_on_at_the_seam(self):
        for ranks in (1, 2):
            with self.subTest(ranks=ranks), tempfile.TemporaryDirectory() as name:
                folder = Path(name)
                (folder / "scene.xml").write_text(scene(2, {"Ball": ball((.97, .27), Velocity=(1., 0.))}, "flux", more={
                    "Output": {"Frames": False, "Checkpoints": {"Interval": 4 * STEP}}}))
                simulate(folder / "scene.xml", folder / "whole", "--steps", 8, ranks=ranks)
                whole = table(folder / "whole/bodies.csv")
                simulate(folder / "scene.xml", folder / "whole", "--steps", 8, "--restart",
                         folder / "whole/checkpoint-000004.h5", ranks=ranks)
                self.assertEqual(whole, table(folder / "whole/bodies.csv"))


def bodies_of(bodies, body="Ball"):
    return [row for row in bodies if row["name"] == body]


if __name__ == "__main__":
    unittest.main()
