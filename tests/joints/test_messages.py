"""What joints cannot do, and what a run says then."""
import tempfile
import unittest
from pathlib import Path

from jointed_scene import joint, simulation, tank, unseen_box, vacuum, xml


def message(scene):
    """Of a run that fails: exit code and text."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "scene.xml"
        file.write_text(xml("Scene", scene))
        result = simulation.attempt(file, Path(folder) / "output")
        return result.returncode, " ".join(result.stdout.split())


def motor(**target):
    return {"Control": "prescribed", "Target": target}


class Messages(unittest.TestCase):
    def test_a_loop_that_motors_pull_apart(self):
        """A square of four links of which three motors turn as they please."""
        places = {"A": (.5, 0.), "B": (1., .5), "C": (.5, 1.), "D": (0., .5)}
        solids = {name: {**unseen_box(place, 0.), "Orientation": 0. if name in "AC" else 1.5707963}
                  for name, place in places.items()}
        corners = {"AB": (1., 0.), "BC": (1., 1.), "CD": (0., 1.), "DA": (0., 0.)}
        joints = {name: joint("hinge", tuple(name), corner) for name, corner in corners.items()}
        for name, amplitude in (("AB", .5), ("BC", .4), ("CD", .3)):
            joints[name].update(motor(Type="sinusoid", Amplitude=amplitude, Frequency=.5))
        joints["tail"] = joint("weld", ("A", "E"), (.5, -.1))  # in no loop
        solids["E"] = unseen_box((.5, -.2), 0.)
        code, text = message(vacuum(solids, joints, .02, 1.))
        self.assertEqual(code, 3, text)
        for part in ("\"AB\"", "\"BC\"", "\"CD\"", "\"DA\"", "loop that cannot close", "a gap of"):
            self.assertIn(part, text)
        self.assertNotIn("tail", text)

    def test_a_motor_that_shrinks_closed_fluid(self):
        """A piston across a closed tank."""
        piston = {"Type": "rigid body", "Geometry": {"Shape": "box", "Size": (.1, 1.2)}, "Density": 1000., "Position": (.4, .5)}
        push = {"Push": joint("slider", ("space", "Piston"), (.4, .5), Axis=(1., 0.),
                              **motor(Type="sinusoid", Amplitude=.05, Frequency=1.))}
        code, text = message(tank({"Piston": piston}, push, "flux"))
        self.assertEqual(code, 2, text)
        for part in ("cells of fluid are closed in", "the motor \"Push\"", "Open a side of the domain"):
            self.assertIn(part, text)


if __name__ == "__main__":
    unittest.main()
