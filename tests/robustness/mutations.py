#!/usr/bin/python3
"""Damaged input files, of every kind that the programs read, and how the programs end.

  tests/robustness/mutations.py --mutations 0-299                 as ./check does
  tests/robustness/mutations.py --mutations 0-4999 --jobs 2 --keep output/mutations --report docs/results/robustness.md
  tests/robustness/mutations.py --mutations 17 --print             what that one does, and where its files are

A mutation's number decides all of it. A program must end with 0, 2, 3 or 4, in time and by no signal; with one
message of its own if not 0; with nothing written if 2; and what it wrote can be read and is finite. What damage left is
judged by readers of our own (meaning.py): a file that must be refused may not be taken in silence, nor a whole one refused.
"""
import argparse
import collections
import concurrent.futures
import dataclasses
import functools
import math
import random
import re
import shutil
import sys
import tempfile
import time
import typing
from pathlib import Path

import h5py
import numpy

import hand_written
import meaning
import mesh_files
import mutators
import report
from parameter_list import to_xml
from random_scenes import seed_list
from runs import program, read_table, run
from scenes import random_scene

SOURCE = Path(__file__).resolve().parents[2]
NOISE = re.compile(r"Unexpected failure|terminate called|HDF5-DIAG|Throw number|Assertion|Segmentation|MPI_ABORT|Please report")


@dataclasses.dataclass
class Case:
    """Files of a folder, one of which is damaged, and the command that reads it."""
    files: dict  # name -> bytes
    damaged: str
    command: list
    mutators: list
    judge: typing.Callable = None  # takes the bytes before and after, see meaning.py


def scene_files(scene):
    return {"scene.xml": scene.xml.encode(), **{name: text.encode() for name, text in scene.files.items()}}


def small_scene(solid, dimension, **lists):
    """One body in a small tank."""
    d = dimension
    return {"Dimension": d, "Domain": {"Cells": [8] * d},
            "Fluid": {"Density": 1000.0, "Gravity": [0.0, -9.8, 0.0][:d], "Viscosity": 1.0},
            "Solids": {"Body": {**solid, "Density": 700.0, "Position": [0.5] * d}},
            "Time": {"Fixed Step": 0.01, "Steps": 2}, **lists}


def ball(dimension=2):
    return small_scene({"Type": "rigid body", "Geometry": {"Shape": "ball", "Radius": 0.25}}, dimension)


def soft_ball(**lists):
    return small_scene({"Type": "deformable body", "Geometry": {"Shape": "ball", "Radius": 0.25},
                        "Material": {"Young's Modulus": 1e4}, "Time Integration": "fully-implicit"}, 2, **lists)


def scene_case(rng):
    scene = random_scene(1000 * rng.randrange(6) + rng.randrange(200))  # all kinds: full tanks, water, joints, gas...
    return Case(scene_files(scene), "scene.xml", [program("simulate"), "scene.xml", "--validate", "--quiet"], mutators.XML,
                meaning.judge_parameters)


def shipped_scene_case(rng):
    """A scene of xml-params/scenes beside the files that it names."""
    path = rng.choice(sorted((SOURCE / "xml-params/scenes").glob("*.xml")))
    text = path.read_text()
    others = [path.parent / name for name in re.findall(r'"File" type="string" value="([^"]+)"', text)]
    others += [path.parent / name for name in re.findall(r'"Include" type="string" value="([^"]+)"', text)]
    files = {other.name: other.read_bytes() for other in others}
    return Case({"scene.xml": re.sub(r'"\.\./\w+/', '"', text).encode(), **files}, "scene.xml",
                [program("simulate"), "scene.xml", "--validate", "--quiet"], mutators.XML, meaning.judge_parameters)


def hand_written_case(rng):
    """Constants, formulas, defaults, copies and an included file."""
    files = {"scene.xml": hand_written.SCENE.encode(), "base.xml": hand_written.BASE.encode()}
    return Case(files, rng.choice(["scene.xml", "base.xml", "base.xml"]),
                [program("simulate"), "scene.xml", "--validate", "--quiet"], mutators.XML,
                meaning.judge_parameters)


def run_case(rng):
    content = rng.choice([ball(), soft_ball(), {**soft_ball(), "Coupling": {"Type": "flux"}}])
    return Case({"scene.xml": to_xml("Scene", content).encode()}, "scene.xml",
                [program("simulate"), "scene.xml", "--quiet", "--output", "output"], mutators.XML,
                meaning.judge_parameters)


def solver_case(rng):
    solver = rng.choice(sorted((SOURCE / "xml-params/solvers").glob("*.xml")))
    content = {**ball(), "Solver": {"File": "solver.xml"}}
    validate = [program("simulate"), "scene.xml", "--validate", "--quiet"]
    solve = [program("solve"), SOURCE / "tests/data/light-disc.h5", "solver.xml"]
    return Case({"scene.xml": to_xml("Scene", content).encode(), "solver.xml": solver.read_bytes()}, "solver.xml",
                rng.choice([validate, validate, solve]), mutators.XML, meaning.judge_parameters)


STUDY = {"Title": "A study", "Scene": "scene.xml",
         "Constants": {"step": 0.01, "h": "1/n"}, "Parameters": {"density": "Fluid/Density"},
         "Set": "Domain/Cells={[n], [n]}; Time/Fixed Step=[step]",
         "Ladder": {"Name": "n", "Values": [8.0, 16.0]},
         "Series": {"heavy": {"Set": "Solids/Body/Density=2000"}, "light": {"Constants": {"step": 0.02}}},
         "Quantities": {"speed": {"Expression": "Body.vy/time", "Reference": "9.8*(1 - 1000/density)"},
                        "error": {"Expression": "momentum_error", "Over": "max", "Reference": "0"}}}


def study_case(rng):
    """Mostly only the list of its cases."""
    how = ["--list"] if rng.random() < 0.9 else ["--rungs", "1:1", "--series", "heavy", "--simulate", program("simulate")]
    return Case({"scene.xml": to_xml("Scene", ball()).encode(), "study.xml": to_xml("Study", STUDY).encode()}, "study.xml",
                [program("converge"), "study.xml", "--output", "output", *how], mutators.XML, meaning.judge_parameters)


def mesh_case(rng):
    kind = rng.choice(["obj", "off", "stl", "msh", "vtk", "obj 2D", "msh 2D"])
    extension, dimension = kind[:3], 2 if "2D" in kind else 3
    surface = mesh_files.polygon(0.3, 8) if dimension == 2 else mesh_files.icosahedron(0.3)
    geometry = {"Shape": "file", "File": f"mesh.{extension}"}
    if extension in ("msh", "vtk"):
        write = mesh_files.gmsh if extension == "msh" else mesh_files.vtk
        text = write(*mesh_files.filled(*surface), dimension)
        body = {"Type": "deformable body", "Geometry": geometry, "Material": {"Young's Modulus": 1e4}}
    else:
        text = getattr(mesh_files, extension)(*surface)
        body = {"Type": "rigid body", "Geometry": geometry}
    content = small_scene(body, dimension)
    return Case({"scene.xml": to_xml("Scene", content).encode(), f"mesh.{extension}": text.encode()}, f"mesh.{extension}",
                [program("simulate"), "scene.xml", "--validate", "--quiet"], mutators.TEXT,
                functools.partial(meaning.judge_mesh, extension))


def water(**surface):
    """A pool with a light ball in it, and what else its surface may have."""
    pool = {"Pool": {"Type": "level", "Height": 0.6}}
    return {**ball(), "Domain": {"Cells": [16, 16]}, "Time": {"Fixed Step": 0.005, "Steps": 2},
            "Fluid": {"Density": 1000.0, "Gravity": [0.0, -9.8], "Free Surface": {"Liquid": pool, **surface}}}


def bubble():
    """The gas that four boxes of water leave free."""
    def box(lower, upper):
        return {"Type": "box", "Lower": lower, "Upper": upper}
    around = {"Bottom": box([-1.0, -1.0], [2.0, 0.1]), "Left": box([-1.0, -1.0], [0.05, 0.9]),
              "Right": box([0.9, -1.0], [2.0, 0.9]), "Top": box([-1.0, 0.8], [2.0, 0.9])}
    content = water(**{"Trapped Air": "ideal gas"})
    content["Fluid"]["Free Surface"]["Liquid"] = around
    return content


def jointed():
    """Two bars with a hinge between them, and the budget of energy."""
    content = ball()
    bar = {"Type": "rigid body", "Geometry": {"Shape": "box", "Size": [0.3, 0.1]}, "Density": 700.0}
    content["Solids"] = {"Left": {**bar, "Position": [0.3, 0.5]}, "Right": {**bar, "Position": [0.65, 0.5]}}
    joint = {"Type": "hinge", "Solids": ["Left", "Right"], "Point": [0.475, 0.5]}
    return {**content, "Joints": {"Elbow": joint}, "Observers": {"budget": {"Type": "energy"}}}


@functools.lru_cache
def checkpoint_and_system(kind):
    """Written once by a run of two steps."""
    content = {"rigid": ball, "soft": soft_ball, "joints": jointed, "gas": bubble,
               "particles": lambda: water(Interface={"Type": "particle level set", "Drops": "ballistic"}),
               "fractions": lambda: water(Interface={"Type": "volume of fluid"})}[kind]()
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        (folder / "scene.xml").write_text(to_xml("Scene", content))
        result = run([program("simulate"), folder / "scene.xml", "--quiet", "--output", folder / "output", "--dump-system",
                      "2:S2", folder / "system.h5"], 120)
        assert result.code == 0, result.errors
        return (to_xml("Scene", content).encode(), (folder / "output/checkpoint-000002.h5").read_bytes(),
                (folder / "system.h5").read_bytes())


def checkpoint_case(rng):
    scene, checkpoint, _ = checkpoint_and_system(rng.choice(["rigid", "soft"]))
    return Case({"scene.xml": scene, "checkpoint.h5": checkpoint}, "checkpoint.h5",
                [program("simulate"), "scene.xml", "--quiet", "--output", "output", "--restart", "checkpoint.h5", "--steps",
                 "3"], mutators.HDF5, meaning.judge_bytes)


def checkpoint_content_case(rng):
    """The checksum fits: something else than a run wrote the file."""
    scene, checkpoint, _ = checkpoint_and_system(rng.choice(["rigid", "soft", "joints", "gas", "gas", "particles", "fractions"]))
    return Case({"scene.xml": scene, "checkpoint.h5": checkpoint}, "checkpoint.h5",
                [program("simulate"), "scene.xml", "--quiet", "--output", "output", "--restart", "checkpoint.h5", "--steps",
                 "4"], mutators.RESEALED_HDF5, meaning.judge_sealed_again)


def system_case(rng):
    _, _, system = checkpoint_and_system(rng.choice(["rigid", "soft"]))
    solver = rng.choice(["schur-cg", "paper", "direct", "pressure-schur"])
    return Case({"system.h5": system}, "system.h5",
                [program("solve"), "system.h5", SOURCE / f"xml-params/solvers/{solver}.xml", "--output", "output"],
                mutators.HDF5, meaning.judge_system)


KINDS = [("shipped scene", shipped_scene_case, 20), ("random scene", scene_case, 4), ("scene by hand", hand_written_case, 3),
         ("scene, run", run_case, 3), ("solver", solver_case, 3), ("study", study_case, 3), ("mesh", mesh_case, 5),
         ("checkpoint", checkpoint_case, 5), ("checkpoint, sealed again", checkpoint_content_case, 4), ("system", system_case, 4)]


def non_finite(folder):
    """Returns the entries of an output folder that cannot be read or are not finite; nothing if all is well."""
    for table in ("history", "bodies"):
        path = folder / f"{table}.csv"
        for row in read_table(path) if path.exists() else []:
            for column, text in row.items():
                if column != "name" and not math.isfinite(float(text)):
                    return f"{column} of {path.name} is {text}"
    frames = folder / "frames.h5"
    if frames.exists():
        with h5py.File(frames) as file:
            bad = []
            for name in file:
                if name.startswith("frame-"):
                    file[name].visititems(lambda item, data: bad.append(item) if isinstance(data, h5py.Dataset) and
                                          data.dtype.kind == "f" and not numpy.isfinite(data[...]).all() else None)
            if bad:
                return f"{bad[0]} of a frame is not finite"
    return ""


def failure_of(case, result, folder, verdict):
    """Returns the fault in how a program ended; empty if there is none."""
    if result.timed_out or result.code < 0:
        return result.failure()
    if result.code not in (0, 2, 3, 4):
        return f"exit code {result.code}"
    if NOISE.search(result.errors):
        return f"exit code {result.code} and {NOISE.search(result.errors).group()!r}"
    is_study, is_solve = (Path(case.command[0]).name == name for name in ("converge", "solve"))
    n_messages = result.errors.count("lockstep: ")
    if is_study:
        n_messages = 1 if result.errors.strip() else 0
    if is_solve and result.code == 3:
        n_messages += " failed: " in result.output
    if n_messages != (result.code != 0) and not (is_study and result.code == 0):
        return f"exit code {result.code} with {n_messages} messages"
    created = [path.name for path in folder.iterdir() if path.name not in case.files]
    if result.code == 2 and created and not is_study:
        return f"exit code 2, but {created} was written"
    if any(folder.rglob("*.part")):
        return "a part of a file is left"
    if result.code == 0 and verdict == meaning.MUST:
        return "taken in silence"
    if result.code != 0 and verdict == meaning.NOT:
        return "refused, though it says what it said before"
    try:
        return non_finite(folder / "output")
    except Exception as error:
        return f"output cannot be read: {type(error).__name__} {error}"


@dataclasses.dataclass
class Mutation:
    number: int
    kind: str
    how: str
    code: int
    failure: str
    message: str
    core_seconds: float
    left: str = ""  # by the damage, in the words of meaning.py; nothing if that is not judged
    verdict: str = meaning.MAY


def judged(case, before):
    return case.judge(before, case.files[case.damaged]) if case.judge else ("", meaning.MAY)


def try_mutation(number, arguments):
    rng = random.Random(f"lockstep mutation {number}")
    kinds = [kind for kind in KINDS for _ in range(kind[2])]
    kind, make, _ = kinds[number % len(kinds)] if not arguments.kind else next(k for k in KINDS if k[0] == arguments.kind)
    case = make(rng)
    before = case.files[case.damaged]
    case.files[case.damaged], how = mutators.mutated(rng, before, case.mutators)
    left, verdict = judged(case, before)
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        for name, data in case.files.items():
            (folder / name).write_bytes(data)
        names = {*case.files, "output"}
        command = [folder / word if word in names else word for word in case.command]
        result = run(command, arguments.timeout)
        failure = failure_of(case, result, folder, verdict)
        if failure and arguments.keep:
            kept = Path(arguments.keep) / str(number)
            shutil.rmtree(kept, ignore_errors=True)
            kept.mkdir(parents=True)
            for name, data in case.files.items():
                (kept / name).write_bytes(data)
            command = [Path(word).name if word in names else str(word) for word in case.command]
            (kept / "failure.txt").write_text(f"{' '.join(command)}\n{kind}, {how}\n{failure}\n{result.errors}")
        return Mutation(number, kind, how, result.code, failure, result.errors.strip(), result.core_seconds, left, verdict)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--mutations", type=seed_list, default=seed_list("0-299"), metavar="A-B")
    parser.add_argument("--kind", choices=[kind[0] for kind in KINDS], help="of one kind only")
    parser.add_argument("--jobs", type=int, default=1, help="at a time")
    parser.add_argument("--timeout", type=float, default=60, help="seconds of wall time after which a program hangs")
    parser.add_argument("--keep", metavar="DIR", help="where the files of failing mutations go")
    parser.add_argument("--report", metavar="FILE", help="page whose section on mutated files is written")
    parser.add_argument("--print", action="store_true", help="print how each ended")
    arguments = parser.parse_args()
    begin, results = time.monotonic(), []
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        for mutation in pool.map(lambda number: try_mutation(number, arguments), arguments.mutations):
            results.append(mutation)
            if mutation.failure or arguments.print:
                print(f"mutation {mutation.number}: {mutation.kind}, {mutation.how}, {mutation.left}: "
                      f"{mutation.failure or mutation.code}: {mutation.message[:300]}", flush=True)
    n_failed = sum(bool(mutation.failure) for mutation in results)
    codes = collections.Counter(mutation.code for mutation in results)
    print(f"{len(results)} mutations, {n_failed} failed; exit codes {dict(sorted(codes.items()))}; "
          f"{sum(m.core_seconds for m in results):.0f} s of a core, {time.monotonic() - begin:.0f} s")
    if arguments.report:
        report.write_mutations(Path(arguments.report), arguments.mutations, results)
    sys.exit(1 if n_failed else 0)


if __name__ == "__main__":
    main()
