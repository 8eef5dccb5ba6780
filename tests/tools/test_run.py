"""Messages of ./run and the arguments it passes on, in a tree of its own with stand-ins for the set-up, the build and the program."""
import os
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


class Run(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.tree = Path(folder.name).resolve() / "tree"
        self.write("tools/build-functions.sh", 'build() { echo "builds $*"; }')
        self.write("tools/set-up", "#!/bin/bash\n[[ $* == --go-on ]]")
        self.write("build/release/drivers/simulate", '#!/bin/bash\nprintf "<%s>" "$@"\nexit 3')
        self.write("build/release/drivers/converge", '#!/bin/bash\nprintf "converge <%s>" "$@"\nexit 4')
        self.write("xml-params/scenes/buoyant-spheres-water.xml", "")
        self.write("rise.xml", '<!-- how fast -->\n<ParameterList name="Study">\n</ParameterList>')
        self.write("my scene.xml", "")
        shutil.copy(ROOT / "run", self.tree / "run")

    def write(self, name, text):
        path = self.tree / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text + "\n")
        path.chmod(0o755)

    def run_it(self, *arguments, folder="."):
        result = subprocess.run([self.tree / "run", *arguments], cwd=self.tree / folder, text=True, stdout=subprocess.PIPE,
                                stderr=subprocess.PIPE, env={**os.environ, "LOCKSTEP_RANKS": "1"})
        return result.returncode, result.stdout, result.stderr

    def test_in_a_tree_that_never_ran(self):
        code, said, complained = self.run_it()
        self.assertEqual((code, complained), (3, ""))   # the program's own code
        self.assertIn("Into output/buoyant-spheres-water;", said)
        self.assertIn(f"<{self.tree}/xml-params/scenes/buoyant-spheres-water.xml>", said)
        self.assertIn(f"<--output><{self.tree}/output/buoyant-spheres-water>", said)
        self.assertIn("builds release simulate\n", said)   # a scene needs no other program

    def test_a_scene_of_ones_own_from_elsewhere(self):
        code, said, _ = self.run_it("../my scene.xml", "--steps", "3", folder="tools")
        self.assertEqual(code, 3)
        self.assertIn("Into ../output/my scene;", said)
        self.assertIn(f"<../my scene.xml><--steps><3><--output><{self.tree}/output/my scene>", said)

    def test_where_the_user_says_or_nothing_is_written(self):
        for arguments in (["--output", "there"], ["--output=there"], ["--validate"]):
            code, said, _ = self.run_it(*arguments)
            self.assertEqual(code, 3)
            self.assertNotIn("Into", said)

    def test_a_study(self):
        code, said, complained = self.run_it("rise.xml", "--jobs", "2")
        self.assertEqual((code, complained), (4, ""))
        self.assertIn("builds release simulate converge\n", said)
        self.assertIn("Into output/rise: table.md", said)
        self.assertIn(f"converge <rise.xml>converge <--jobs>converge <2>converge <--output>converge <{self.tree}/output/rise>", said)

    def test_no_such_scene(self):
        code, _, complained = self.run_it("none.xml")
        self.assertEqual(code, 2)
        self.assertIn("there is no scene file 'none.xml'", complained)


if __name__ == "__main__":
    unittest.main()
