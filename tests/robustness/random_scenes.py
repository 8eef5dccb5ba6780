#!/usr/bin/python3
"""Random valid scenes and what must hold for them.

  tests/robustness/random_scenes.py --seeds 0-39 --quick            as ./check does, with more seeds (CMakeLists.txt)
  tests/robustness/random_scenes.py --seeds 0-199,1000-1099,2000-2099,3000-3099,4000-4099,5000-5099,8000-8099,9000-9099,10000-10099 --quick --keep output/random --log output/random.jsonl --report docs/results/robustness.md
  tests/robustness/random_scenes.py --seeds 7000-7299 --ranks 1 2 3 4 --log output/seams.jsonl --report docs/results/robustness.md
  tests/robustness/random_scenes.py --print 17                      the scene of a seed

Each seed runs on 1, 2 and 3 ranks, again from a checkpoint, with its axes turned, and once with a tiny step for the
energy of the start.
Prints a line for each failing seed; with --keep its scene stays in DIR/SEED. Seeds that are known to fail stand in
known_failures.py with their reasons, which are printed, too. Exit code 1 if any other failed.
"""
import argparse
import concurrent.futures
import dataclasses
import json
import random
import re
import shutil
import sys
import tempfile
import time
from pathlib import Path

import rotated_copies
import known_failures
import report
from invariants import (Tables, check_energy, check_frames, check_restart, check_same, check_tables,
                        has_energy_bound)
from parameter_list import to_xml
from runs import program, run
from scenes import random_scene

# Reasons for which a strategy or a scene may be refused, in the program's words.
MUELU = re.compile(r"MueLu\s+cannot\s+build\s+a\s+preconditioner\s+for\s+the\s+solid\s+block")
INDEFINITE = re.compile(r"preconditioner\s+is\s+not\s+positive\s+definite")
CRUSHED = re.compile(r"elastic forces of .* are\s+not finite")
NO_MASS = re.compile(r"node without\s+mass that no mixed face sees")


class Seed:
    """The runs of one seed, in a folder of its own."""

    def __init__(self, seed, folder, seconds):
        self.scene, self.folder, self.seconds = random_scene(seed), folder, seconds
        self.failures, self.core_seconds, self.refused = [], 0, 0
        (folder / "scene.xml").write_text(self.scene.xml)
        for name, text in self.scene.files.items():
            (folder / name).write_text(text)

    def simulate(self, output, *arguments, ranks=1, scene="scene.xml"):
        """Tables of a run, or nothing if it failed."""
        result = run([program("simulate"), self.folder / scene, "--output", self.folder / output, "--quiet",
                      *arguments], self.seconds, ranks)
        self.core_seconds += result.core_seconds
        if result.code == 3 and self.may_refuse(result.errors, ranks):
            self.refused += 1
            return None
        if result.failure():
            self.failures.append(f"run {output}: {result.failure()}")
            return None
        return Tables(self.folder / output)

    def may_refuse(self, errors, ranks):
        facts = self.scene.facts
        return (ranks > 1 and facts.solid_by_muelu and MUELU.search(errors) or
                facts.pressure_by_muelu and INDEFINITE.search(errors) or
                facts.crushed and CRUSHED.search(errors) or
                facts.massless and NO_MASS.search(errors))

    def check(self, ranks):
        one = self.simulate("one")
        if not one:
            return
        self.failures += [*check_tables(self.scene, one), *check_frames(self.scene, one)]
        if has_energy_bound(self.scene):
            # Changes in such a step are near the round-off of velocities: they cannot be solved for to the scene's tolerance.
            start = self.simulate("start", "--steps", 1, "--set", f"Time/Fixed Step={1e-7 * self.scene.dt!r}",
                                  "--set", "Solver/Tolerance=1e-4")
            if start:
                self.failures += check_energy(self.scene, one, start)
        others = {n: self.simulate(f"ranks-{n}", ranks=n) for n in ranks}
        for n, other in others.items():
            if other:
                self.failures += [*self.check_same(one, other, f"ranks, {n}"), *check_tables(self.scene, other)]
        self.check_rotated_copy(one)
        self.check_restart(others)

    def check_same(self, one, other, kind):
        """Where they part, twins on one rank show what inexact solves alone make, and round-off alone."""
        density = self.scene.content["Fluid"]["Density"] * (1 + 1e-12)
        failures = list(check_same(self.scene, one, other, kind))
        for twin in ("Solver/Tolerance=3e-11", "Solver/Tolerance=1e-09", f"Fluid/Density={density!r}"):
            if not failures:
                break
            twin = self.simulate(f"twin-{twin.replace('/', '-')}", "--set", twin)
            failures = list(check_same(self.scene, one, other, kind, twin)) if twin else failures
        return failures

    def check_rotated_copy(self, one):
        """A liquid's volume is measured on triangles, whose diagonals do not turn: without its correction."""
        if not rotated_copies.has_rotated_copy(self.scene):
            return
        (self.folder / "rotated-copy.xml").write_text(to_xml("Scene", rotated_copies.rotated_copy(self.scene.content)))
        settings = ["--set", "Fluid/Free Surface/Interface/Volume Correction=none"] if self.scene.facts.liquid else []
        straight = self.simulate("uncorrected", *settings) if settings else one
        turned = self.simulate("rotated copy", *settings, scene="rotated-copy.xml")
        if straight and turned:
            self.failures += self.check_same(straight, rotated_copies.turned_back(turned), "rotated copy")

    def check_restart(self, others):
        """From a random checkpoint, on a random one of the numbers of ranks."""
        rng = random.Random(f"lockstep restart {self.scene.seed}")
        ranks = rng.choice([1, 1, 2])
        name = "one" if ranks == 1 else f"ranks-{ranks}"
        if ranks > 1 and not others.get(ranks):
            return
        step = rng.randint(1, self.scene.n_steps - 1)
        shutil.copytree(self.folder / name, self.folder / "restarted")
        again = self.simulate("restarted", "--restart", self.folder / name / f"checkpoint-{step:06}.h5", ranks=ranks)
        if again:
            self.failures += check_restart(Tables(self.folder / name), again)


def check_seed(seed, arguments):
    with tempfile.TemporaryDirectory() as folder:
        runs = Seed(seed, Path(folder), arguments.timeout)
        try:
            ranks = [n for n in arguments.ranks if n > 1]
            runs.check([ranks[seed % len(ranks)]] if arguments.quick else ranks)
        except Exception as error:  # a file that a run should have written
            runs.failures.append(f"files: {type(error).__name__} {error}")
        if runs.failures and arguments.keep:
            kept = Path(arguments.keep) / str(seed)
            shutil.rmtree(kept, ignore_errors=True)
            kept.mkdir(parents=True)
            for name in ("scene.xml", *runs.scene.files):
                shutil.copy(Path(folder) / name, kept)
            (kept / "failures.txt").write_text("\n".join(runs.failures) + "\n")
        return Result(seed, runs.failures, runs.refused, runs.core_seconds, report.build())


@dataclasses.dataclass
class Result:
    seed: int
    failures: list
    refused: int  # runs
    core_seconds: float
    build: str  # commit of the program


def lines_of(result):
    """Lines of the failures of a seed, and whether they were known."""
    reason = known_failures.reason(result.seed)
    lines = [f"seed {result.seed}: {failure}" for failure in result.failures]
    if reason:
        lines.append(f"seed {result.seed}: known: {reason}" if lines else
                     f"seed {result.seed} is in known_failures.py, and does not fail here")
    return lines


def logged(path):
    """Results of seeds that an earlier, perhaps killed, run has finished; by seed, the last ones."""
    lines = path.read_text().splitlines() if path and path.exists() else []
    return {result.seed: result for result in (Result(**json.loads(line)) for line in lines)}


def seed_list(text):
    seeds = []
    for part in text.split(","):
        first, _, last = part.partition("-")
        seeds += range(int(first), int(last or first) + 1)
    return seeds


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=seed_list, default=seed_list("0-39"), metavar="A-B,C")
    parser.add_argument("--jobs", type=int, default=1, help="seeds at a time")
    parser.add_argument("--ranks", type=int, nargs="+", default=[1, 2, 3])
    parser.add_argument("--quick", action="store_true", help="one of the other numbers of ranks, by turns")
    parser.add_argument("--timeout", type=float, default=120, help="seconds of a run")
    parser.add_argument("--keep", metavar="DIR", help="where the scenes of failing seeds go")
    parser.add_argument("--log", type=Path, metavar="FILE",
                        help="results are kept here as they come; seeds that passed in it are not run again")
    parser.add_argument("--report", metavar="FILE", help="page whose section on random scenes is written")
    parser.add_argument("--print", type=int, metavar="SEED", help="print a scene; nothing runs")
    arguments = parser.parse_args()
    if arguments.print is not None:
        sys.exit(print(random_scene(arguments.print).xml, end=""))
    if arguments.log:
        arguments.log.parent.mkdir(parents=True, exist_ok=True)
    begin, known = time.monotonic(), logged(arguments.log)
    missing = [seed for seed in arguments.seeds if seed not in known or known[seed].failures]
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        for result in pool.map(lambda seed: check_seed(seed, arguments), missing):
            known[result.seed] = result
            if arguments.log:
                with open(arguments.log, "a") as file:
                    file.write(json.dumps(dataclasses.asdict(result)) + "\n")
            print("".join(line + "\n" for line in lines_of(result)), end="", flush=True)
    results = [known[seed] for seed in arguments.seeds]
    n_failed = sum(bool(result.failures) for result in results)
    n_known = sum(bool(result.failures and known_failures.reason(result.seed)) for result in results)
    core_seconds = sum(result.core_seconds for result in results)
    print(f"{len(results)} scenes, {n_failed} failed, {n_known} of them as known, {sum(result.refused for result in results)} runs refused (ranks "
          "without unknowns, nodes without mass, closed regions, crushed elements, MueLu); "
          f"{core_seconds:.0f} s of a core, {time.monotonic() - begin:.0f} s")
    if arguments.report and all(report.family_of(seed) == "periodic seams" for seed in arguments.seeds):
        report.write_seams(Path(arguments.report), arguments.seeds, results, arguments.ranks)
    elif arguments.report:
        report.write_scenes(Path(arguments.report), arguments.seeds, results, arguments.quick)
    sys.exit(1 if n_failed > n_known else 0)


if __name__ == "__main__":
    main()
