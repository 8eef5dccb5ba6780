"""Messages of tools/set-up before it installs and after, with stand-ins for apt-get, dpkg-query and sudo: nothing is installed."""
import os
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

TOOLS = Path(__file__).resolve().parents[2] / "tools"
# Messages in the form of apt-get 2.6.
APT_SAYS = """Reading package lists...
Building dependency tree...
The following NEW packages will be installed:
  cmake cmake-data ninja-build
0 upgraded, 37 newly installed, 0 to remove and 126 not upgraded.
Need to get 12.5 MB/241 MB of archives.
After this operation, 620 MB of additional disk space will be used.
'http://deb.debian.org/debian/pool/main/c/cmake/cmake_3.25.1-1_amd64.deb' cmake_3.25.1-1_amd64.deb 8692172 MD5Sum:0123
"""
STAND_INS = {
    "nproc": "echo 4",
    "sudo": '[[ $1 == -n ]] && exit 0; exec "$@"',
    "dpkg-query": 'for name in "$@"; do grep -qxF -- "$name" "$FOLDER/missing" || echo "installed $name"; done',
    "apt-get": """echo "$*" >> "$FOLDER/calls"
case "$*" in
  *--print-uris*) cat "$FOLDER/says"; exit 0 ;;
  *update*) exit 0 ;;
esac
# Output of packages' scripts must never find a pipe that is full.
if [[ ! -f /proc/$$/fd/1 ]]; then echo "E: I/O error"; exit 100; fi
echo "dlstatus:1:20.5:Retrieving file 1 of 37" >&3
echo "Unpacking cmake ..."
echo "pmstatus:cmake:50.0:Unpacking cmake" >&3
if [[ -f $FOLDER/fails ]]; then echo "E: no space left"; exit 100; fi""",
}


class SetUp(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        for name, text in STAND_INS.items():
            path = self.folder / "bin" / name
            path.parent.mkdir(exist_ok=True)
            path.write_text(f"#!/bin/bash\n{text}\n")
            path.chmod(0o755)
        (self.folder / "tree/tools").mkdir(parents=True)
        for name in ("set-up", "build-functions.sh"):
            shutil.copy(TOOLS / name, self.folder / "tree/tools" / name)
        self.write("says", APT_SAYS)
        self.write("missing", "cmake\nninja-build\n")

    def write(self, name, text):
        (self.folder / name).write_text(text)

    def set_up(self, *arguments):
        environment = {**os.environ, "PATH": f"{self.folder / 'bin'}:{os.environ['PATH']}", "FOLDER": str(self.folder)}
        return subprocess.run([self.folder / "tree/tools/set-up", *arguments], env=environment, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE)

    def calls(self):
        path = self.folder / "calls"
        return path.read_text().splitlines() if path.exists() else []

    def core_minutes(self):
        lines = (TOOLS / "build-functions.sh").read_text().splitlines()
        return [int(line.partition("=")[2]) for line in lines if line.startswith("core_minutes_of_")]

    def test_says_what_it_would_do(self):
        result = self.set_up("--plan")
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        programs, tests = self.core_minutes()
        self.assertEqual(result.stdout.splitlines(), [
            "2 Debian packages are missing to build, run and test Lockstep:",
            "  cmake ninja-build",
            "With what they need apt-get installs 37 packages: 12.5 MB to fetch, 620 MB on the disk.",
            f"The first build takes about {1 + programs // 4} min for ./run, {1 + (programs + tests) // 4} min for ./check"
            " on 4 cores like those of 2026; later ones are short."])
        self.assertTrue(all("--print-uris" in call for call in self.calls()))

    def test_says_it_before_it_does_it_and_then_what_is_next(self):
        result = self.set_up()
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        said = [result.stdout.index(words) for words in ("2 Debian packages", "12.5 MB", "The first build", "Installed in", "Next:", "./run  ")]
        self.assertEqual(said, sorted(said))
        update, plan, install = self.calls()
        self.assertIn("update", update)
        self.assertIn("--print-uris", plan)
        self.assertTrue(install.endswith("--no-install-recommends cmake ninja-build"), install)
        self.assertNotIn("status:", result.stdout)
        self.assertIn("Unpacking cmake", (self.folder / "tree/build/set-up.log").read_text())

    def test_on_the_way_to_a_build_it_gives_no_advice(self):
        self.assertNotIn("Next", self.set_up("--go-on").stdout)

    def test_other_uses_have_their_own_advice(self):
        self.assertIn("tools/make-manual", self.set_up("--manual").stdout)
        self.assertIn("tools/render", self.set_up("--paraview").stdout)

    def test_nothing_is_missing(self):
        self.write("missing", "")
        self.assertEqual(self.set_up("--go-on").stdout, "")
        self.assertRegex(self.set_up().stdout, r"^All \d+ packages are there\.\nNext:\n")
        self.assertEqual(self.calls(), [])

    def test_apt_does_not_know_the_sizes(self):
        self.write("says", "E: Unable to locate package cmake\n")
        result = self.set_up("--plan")
        self.assertEqual(result.returncode, 0)
        self.assertNotIn("apt-get installs", result.stdout)

    def test_what_is_built_is_not_built_for_the_first_time(self):
        (self.folder / "tree/build/release").mkdir(parents=True)
        (self.folder / "tree/build/release/.ninja_log").write_text("")
        self.assertNotIn("first build", self.set_up("--plan").stdout)

    def test_says_how_far_apt_is_and_how_long_it_will_take(self):
        """The time that is left is that of the stage, as fast as until now: 30 s for half of it, 30 s to go."""
        said = subprocess.run(["bash", "-c", f"root={self.folder}; source {TOOLS / 'build-functions.sh'}; show_packages"], text=True,
                              stdout=subprocess.PIPE, check=True, input="""0 dlstatus:1:0.0000:Retrieving file 1 of 9
5 dlstatus:2:20.0000:Retrieving file 2 of 9
12 dlstatus:2:25.0000:Retrieving file 2 of 9
20 pmstatus:dpkg-exec:0.0000:Running dpkg
23 pmstatus:cmake:0.0000:Preparing cmake
50 pmstatus:cmake:50.0000:Unpacking cmake
55 pmerror:cmake:51.0000:a word
70 pmstatus:cmake:83.3333:Configuring cmake
71 pmstatus:cmake:99.0000:Configuring cmake
""").stdout
        self.assertEqual(said.splitlines(), ["  fetched 25 %, about 0:36 to go, then they are installed",
                                             "  installed 0 %",
                                             "  installed 50 %, about 0:30 to go",
                                             "  installed 83 %, about 0:10 to go"])

    def test_lines_bear_their_seconds(self):
        said = subprocess.run(["bash", "-c", f"root={self.folder}; source {TOOLS / 'build-functions.sh'}; "
                               "{ echo one; sleep 1.1; echo two; } | with_seconds"], text=True, stdout=subprocess.PIPE, check=True).stdout
        self.assertRegex(said, r"^0 one\n[1-9]\d* two\n$")

    def test_no_package_is_named_twice(self):
        names = self.set_up("--list", "--paraview", "--browser", "--manual").stdout.split()
        self.assertEqual(sorted(names), sorted(set(names)))

    def test_apt_fails(self):
        self.write("fails", "")
        result = self.set_up()
        self.assertEqual(result.returncode, 4)
        self.assertIn("E: no space left", result.stderr)
        self.assertNotIn("status:", result.stderr)
        self.assertNotIn("Next", result.stdout)


if __name__ == "__main__":
    unittest.main()
