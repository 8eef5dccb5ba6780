"""Tests of tools/results --stale: the pages of docs/results that are too old, and how they are made again, in small repositories with
stand-ins for what makes pages; and whether the table of pages knows those that there are."""
import contextlib
import io
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))

import result_pages  # noqa: E402
import stale_pages  # noqa: E402

SCENE = """<ParameterList name="Scene">
  <ParameterList name="Solids">
    <ParameterList name="Ball">
      <Parameter name="Type" type="string" value="{kind}"/>
      <ParameterList name="Geometry"><Parameter name="File" type="string" value="ball.obj"/></ParameterList>
    </ParameterList>
  </ParameterList>
  <ParameterList name="Contact"><Parameter name="Type" type="string" value="none"/></ParameterList>
</ParameterList>
"""
STUDY = """<ParameterList name="Study">
  <Parameter name="Scene" type="string" value="{name}-scene.xml"/>
  <ParameterList name="Series"><ParameterList name="cut"><Parameter name="Set" type="string" value="{set}"/></ParameterList></ParameterList>
</ParameterList>
"""
FILES = ["src/base/a.cpp", "packages/rigid/a.cpp", "packages/deformable/a.cpp", "packages/mac/mac.cpp", "packages/liquid/a.cpp",
         "packages/articulated/a.cpp", "packages/cutcell/a.cpp", "packages/contact/a.cpp",
         "packages/mac/CMakeLists.txt", "xml-params/studies/ball.obj", "tests/a.cpp"]
# Makes the page that it is asked for, or fails if that is "broken".
STAND_IN = """#!/bin/bash
echo "$1 $LOCKSTEP_IS_BUILT" >> made.txt
[[ $1 != slow ]] || sleep 60
[[ $1 != broken ]] || exit 3
echo "Made on some day from $(git rev-parse --short HEAD) on a machine." > "docs/results/$1.md"
"""


class Repository(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.tree = Path(folder.name).resolve() / "tree"
        self.tree.mkdir()
        self.git("init", "--quiet")
        for file in FILES:
            self.write(file, "as it was")
        self.write(".gitignore", "made.txt\nbuild\n")
        self.write("tools/results", STAND_IN)

    def git(self, *arguments):
        identity = ["-c", "user.name=A", "-c", "user.email=a@b", "-c", "commit.gpgsign=false"]
        return subprocess.run(["git", "-C", self.tree, *identity, *arguments], check=True, text=True, stdout=subprocess.PIPE).stdout.strip()

    def write(self, name, text):
        path = self.tree / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
        path.chmod(0o755)

    def study(self, name, kind="rigid body", assigned="Coupling/Type=flux"):
        self.write(f"xml-params/studies/{name}-scene.xml", SCENE.format(kind=kind))
        self.write(f"xml-params/studies/{name}.xml", STUDY.format(name=name, set=assigned))

    def commit(self):
        self.git("add", "--all")
        self.git("commit", "--quiet", "--message", "a change")
        return self.git("rev-parse", "--short", "HEAD")

    def page(self, name, commit):
        self.write(f"docs/results/{name}.md", f"Made by `tools/results {name}` on 2026-11-22 from {commit} on a machine.\n")

    def change(self, *files):
        for file in files:
            self.write(file, (self.tree / file).read_text() + "\n<!-- and something new -->")
        return self.commit()

    def stale(self):
        return {age.page.name: age.behind for age in stale_pages.stale_pages(self.tree)}


class Stale(Repository):
    def setUp(self):
        super().setUp()
        self.study("piston")
        self.page("piston", self.commit())

    def test_what_it_depends_on(self):
        self.commit()
        self.assertEqual(self.stale(), {})
        for n, file in enumerate(["src/base/a.cpp", "packages/rigid/a.cpp", "packages/mac/mac.cpp", "packages/cutcell/a.cpp",
                                  "xml-params/studies/ball.obj", "xml-params/studies/piston-scene.xml"], start=1):
            self.change(file)
            self.assertEqual(self.stale(), {"piston": n}, file)

    def test_what_it_does_not(self):
        self.change("packages/deformable/a.cpp", "packages/liquid/a.cpp", "packages/articulated/a.cpp",
                    "packages/contact/a.cpp", "packages/mac/CMakeLists.txt", "tests/a.cpp", "docs/results/piston.md")
        self.assertEqual(self.stale(), {})

    def test_what_its_series_set(self):
        self.study("wave", kind="cloth", assigned="Fluid/Free Surface/Interface/Type=level set; Joints/Pin/Type=hinge")
        self.page("wave", self.commit())
        self.commit()
        for n, file in enumerate(["packages/deformable/a.cpp", "packages/liquid/a.cpp", "packages/articulated/a.cpp"], start=1):
            self.change(file)
            self.assertEqual(self.stale(), {"wave": n}, file)
        self.change("packages/cutcell/a.cpp")  # the default coupling may be either
        self.assertEqual(self.stale(), {"wave": 4, "piston": 1})

    def test_from_a_dirty_tree(self):
        self.page("piston", self.git("rev-parse", "--short", "HEAD") + "-dirty")
        self.assertEqual(self.stale(), {"piston": 0})

    def test_commits_that_are_not_there(self):
        self.page("piston", "0123456")
        self.assertEqual(self.stale(), {"piston": 0})
        said = io.StringIO()
        with contextlib.redirect_stderr(said):
            stale_pages.say_unknown(stale_pages.stale_pages(self.tree))
        self.assertIn("does not have the commits of 1 pages ('?'), which count as stale; if it is a shallow one, `git fetch", said.getvalue())

    def test_the_oldest_comes_first(self):
        self.study("wave")
        self.page("wave", self.commit())
        os.environ["GIT_COMMITTER_DATE"] = "2001-01-01T00:00:00Z"
        self.addCleanup(os.environ.pop, "GIT_COMMITTER_DATE")
        self.page("piston", self.change("src/base/a.cpp"))
        self.change("src/base/a.cpp")
        self.assertEqual(list(self.stale().items()), [("piston", 1), ("wave", 2)])


class Remake(Repository):
    def setUp(self):
        super().setUp()
        for name in "broken", "one", "two":
            self.study(name)
        old = self.commit()
        for name in "broken", "one", "two":
            self.page(name, old)
        self.head = self.change("src/base/a.cpp")

    def remake(self, hours=1.0):
        said = io.StringIO()
        with contextlib.redirect_stdout(said):
            code = stale_pages.remake(self.tree, stale_pages.stale_pages(self.tree), hours)
        return code, said.getvalue()

    def made(self):
        return (self.tree / "made.txt").read_text().splitlines()

    def test_goes_on_after_failures_and_where_it_stopped(self):
        code, said = self.remake()
        self.assertEqual(code, 1)
        self.assertIn(f"2 pages made from {self.head}, 1 failed, 0 left", said)
        self.assertEqual(self.made(), ["broken 1", "one 1", "two 1"])   # each sees that all is built
        self.assertEqual(self.stale(), {"broken": 1})
        self.assertEqual(self.git("rev-parse", "--short", "HEAD"), self.head)   # nothing was committed
        self.remake()
        self.assertEqual(self.made()[3:], ["broken 1"])   # pages in the tree do not make it dirty

    def test_a_changed_tree(self):
        self.write("src/base/a.cpp", "changed")
        with self.assertRaisesRegex(SystemExit, "commit the changes outside of docs/results first"):
            self.remake()
        self.assertTrue(stale_pages.commit_of_tree(self.tree).endswith("-dirty"))

    def test_ends_in_time(self):
        self.study("slow")
        self.page("slow", "0123456")   # made of a commit that nobody knows: the oldest
        self.commit()
        code, said = self.remake(hours=1 / 3600)
        self.assertEqual(code, 0)
        self.assertIn("slow: no time left", said)
        self.assertEqual(self.made(), ["slow 1"])

    def test_what_took_longer_waits(self):
        self.write("docs/results/one.csv", "# title\nseries,quantity,wall_seconds,samples\na,x,3600.5,2\na,y,3600.5,2\n")
        self.assertEqual(result_pages.seconds_of(self.tree, "one"), 7201)
        self.commit()
        _, said = self.remake()
        self.assertIn("one: left: it took 7201 s last time", said)
        self.assertEqual(self.made(), ["broken 1", "two 1"])


class Table(unittest.TestCase):
    def test_every_page_is_known(self):
        for name in result_pages.names_of_pages(ROOT):
            with self.subTest(page=name):
                page = result_pages.page_of(ROOT, name)
                self.assertIsNotNone(page, "say in tools/result_pages.py how it is made")
                for words in page.commands:
                    self.assertTrue((ROOT / words[0]).exists(), words[0])
                for path in page.paths:
                    if not path.startswith(":("):
                        self.assertTrue(list(ROOT.glob(path)), path)

    def test_no_page_is_known_that_is_none(self):
        self.assertEqual(set(result_pages.TOOL_PAGES) - set(result_pages.names_of_pages(ROOT)), set())

    def test_help(self):
        said = subprocess.run([ROOT / "tools/results", "--help"], check=True, text=True, stdout=subprocess.PIPE).stdout
        self.assertIn("tools/results --stale --remake [--hours H]", said)


if __name__ == "__main__":
    unittest.main()
