"""Messages of tools/watch about real runs that go on, end, fail and are killed. Usage: test_watch.py SIMULATE SCENE"""
import contextlib
import json
import signal
import subprocess
import sys
import tempfile
import time
import unittest
import urllib.error
import urllib.request
import zlib
from pathlib import Path

import numpy

TOOLS = Path(__file__).resolve().parents[2] / "tools"
INFLOW = "Domain/Sides/x lower/"  # into a tank without a way out: the first step cannot be


class Watch(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name) / "run"

    def command(self, *arguments):
        return [SIMULATE, SCENE, "--output", str(self.folder), "--quiet", "--set", "Domain/Cells={32, 32}", *arguments]

    def run_to_end(self, *arguments):
        return subprocess.run(self.command(*arguments), stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL).returncode

    @contextlib.contextmanager
    def running(self, *arguments):
        process = subprocess.Popen(self.command(*arguments), stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
        try:
            yield process
        finally:
            process.kill()
            process.wait()

    @contextlib.contextmanager
    def watched(self):
        """The address of the page."""
        process = subprocess.Popen([TOOLS / "watch", self.folder, "--port", "0", "--every", "0.1"], text=True,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        try:
            line = process.stdout.readline()
            yield process.stdout.readline().strip() if line.startswith("Waiting") else line.strip()
        finally:
            process.send_signal(signal.SIGINT)
            self.assertEqual((process.wait(20), process.stderr.read()), (0, ""))
            process.stdout.close()
            process.stderr.close()

    def get(self, address):
        with urllib.request.urlopen(address, timeout=60) as answer:
            return answer.read()

    def run_at(self, address):
        (run,) = json.loads(self.get(address + "runs.json"))["runs"]
        return run, dict(run["facts"])

    def wait_for(self, address, condition):
        end = time.monotonic() + 120
        while True:
            run, facts = self.run_at(address)
            if condition(run, facts):
                return run, facts
            self.assertLess(time.monotonic(), end, facts)
            time.sleep(0.05)

    def test_a_run_grows_and_is_killed(self):
        with self.watched_from_before() as (address, process):
            def n_steps(run):
                return run["tables"].get("history.csv", {"n": 0})["n"]

            first, facts = self.wait_for(address, lambda run, _: n_steps(run) > 2)
            self.assertEqual(facts["state"], "running")
            self.assertRegex(facts["progress"], r"^\d+% of 2 s, \d+ s left at the speed of the last \d+ steps$")
            later, _ = self.wait_for(address, lambda run, _: n_steps(run) > n_steps(first) and len(run["frames"]) > len(first["frames"]))
            # Frames that were there are not packed anew.
            self.assertEqual(later["frames"][:len(first["frames"])], first["frames"])
            table = later["tables"]["history.csv"]
            values = numpy.frombuffer(zlib.decompress(self.get(f"{address}blobs/{table['blob']}")), "<f4")
            numpy.testing.assert_array_equal(values[:table["n"]], numpy.arange(1, table["n"] + 1))
            points = later["frames"][-1]["surfaces"][0]["points"]
            self.assertEqual(len(zlib.decompress(self.get(f"{address}blobs/{points['blob']}"))), 6 * points["n"])
            process.kill()
            process.wait()
            _, facts = self.wait_for(address, lambda _, facts: facts["state"] != "running")
            self.assertEqual(facts["state"], "killed: ended without a word")
            self.assertRegex(facts["progress"], r"^\d+% of 2 s$")

    @contextlib.contextmanager
    def watched_from_before(self):
        """The watcher is started first and waits."""
        watcher = subprocess.Popen([TOOLS / "watch", self.folder, "--port", "0"], text=True, stdout=subprocess.PIPE)
        try:
            self.assertEqual(watcher.stdout.readline().strip(), f"Waiting for a run in {self.folder} ...")
            with self.running() as process:
                yield watcher.stdout.readline().strip(), process
        finally:
            watcher.kill()
            watcher.wait()
            watcher.stdout.close()

    def test_stopped_by_a_signal(self):
        with self.running() as process, self.watched() as address:
            self.wait_for(address, lambda run, _: run["tables"].get("history.csv", {"n": 0})["n"] > 2)
            process.send_signal(signal.SIGTERM)
            process.wait()
            self.wait_for(address, lambda _, facts: facts["state"] == "stopped by a signal")

    def test_done_and_begun_again(self):
        self.assertEqual(self.run_to_end("--steps", "3"), 0)
        with self.watched() as address:
            run, facts = self.run_at(address)
            self.assertEqual(facts["state"], "done")
            self.assertNotIn("progress", facts)
            for name in ("machine", "command", "Lockstep", "wall time"):
                self.assertIn(name, facts)
            # A run of other cells in the same folder has frames at the same times.
            self.assertEqual(self.run_to_end("--steps", "2", "--set", "Domain/Cells={24, 24}"), 0)
            again, _ = self.wait_for(address, lambda run, _: run["tables"]["history.csv"]["n"] == 2)
            self.assertEqual([run["frames"][0]["box"]["cells"], again["frames"][0]["box"]["cells"]], [[32, 32, 1], [24, 24, 1]])

    def test_failed(self):
        sides = [f"{INFLOW}Type=inflow", f"{INFLOW}Velocity={{min(t, 1), 0}}"]
        self.assertEqual(self.run_to_end(*(word for side in sides for word in ("--set", side))), 3)
        with self.watched() as address:
            _, facts = self.run_at(address)
            self.assertRegex(facts["state"], r"^failed: .*x lower")

    def test_page_and_what_is_not_there(self):
        self.assertEqual(self.run_to_end("--steps", "1"), 0)
        with self.watched() as address:
            page = self.get(address).decode()
            self.assertIn('"refresh":0.1', page)
            self.assertNotIn('"blobs":{', page)
            with self.assertRaises(urllib.error.HTTPError) as raised:
                self.get(address + "../../etc/passwd")
            self.assertEqual(raised.exception.code, 404)

    def test_only_for_pages_of_this_machine(self):
        """A page of elsewhere whose name is pointed at this machine sends that name as the host."""
        self.assertEqual(self.run_to_end("--steps", "1"), 0)
        with self.watched() as address:
            for host, code in (("localhost:1", 200), ("evil.example:8765", 403), ("127.0.0.1.evil.example:8765", 403)):
                request = urllib.request.Request(address + "runs.json", headers={"Host": host})
                try:
                    with urllib.request.urlopen(request, timeout=60) as answer:
                        found = answer.status
                except urllib.error.HTTPError as error:
                    found = error.code
                    error.close()
                self.assertEqual(found, code, host)


if __name__ == "__main__":
    SIMULATE, SCENE = sys.argv[1:3]
    del sys.argv[1:3]
    unittest.main()
