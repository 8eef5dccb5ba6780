"""Writes the sections of docs/results/robustness.md; each command replaces its own."""
import collections
import datetime
import re
import subprocess

import gases
import joints
import known_failures
import liquids
import long_tension
import meaning
import phases
import resting
import seams
import second_order
from runs import program
from scenes import random_scene

TITLE = "# robustness\n\nRandom scenes and damaged files, and whether what must hold for every one of them holds.\n"
# Features that the seeds from a number on draw beside those of the seeds before them; a family draws no feature of another.
FAMILIES = {
    "full domains": 0,
    "free surface": liquids.FIRST_SEED,
    "volume of fluid": liquids.FIRST_OF_FRACTIONS,
    "joints": joints.FIRST_SEED,
    "trapped air": gases.FIRST_SEED,
    "semi-implicit tension": long_tension.FIRST_SEED,
    "periodic seams": seams.FIRST_SEED,
    "contact in water": resting.FIRST_SEED,
    "two phases": phases.FIRST_SEED,
    "second order": second_order.FIRST_SEED,
}
# Solids, and how often each thing that a scene may say was drawn.
FEATURES = {
    "3D": lambda c: c["Dimension"] == 3,
    "rigid bodies": lambda c: has_type(c, "rigid body"),
    "deformable bodies": lambda c: has_type(c, "deformable body"),
    "cloth": lambda c: has_type(c, "cloth"),
    "meshes from files": lambda c: any(b["Geometry"]["Shape"] == "file" for b in c["Solids"].values()),
    "scripts": lambda c: any("Motion" in b or "Motion" in b.get("Pinned", {}).get("Pin", {}) for b in c["Solids"].values()),
    "pins": lambda c: any("Pinned" in b for b in c["Solids"].values()),
    "attachments": lambda c: any("Attachments" in b for b in c["Solids"].values()),
    "pivots and locks": lambda c: any("Pivot" in b or "Locked" in b for b in c["Solids"].values()),
    "coupling flux": lambda c: c["Coupling"]["Type"] == "flux",
    "every cut cell": lambda c: c["Coupling"].get("Mixed Rule") == "every cut cell",
    "contact": lambda c: c["Contact"]["Type"] != "none",
    "viscosity": lambda c: "Viscosity" in c["Fluid"],
    "order 2 in time": lambda c: c["Fluid"]["Order in Time"] == 2,
    "order 2 of bodies too": lambda c: c["Time"].get("Order in Time") == 2,
    "smoke or temperature": lambda c: "Smoke" in c["Fluid"] or "Temperature" in c["Fluid"],
    "free surface": lambda c: "Free Surface" in c["Fluid"],
    "joints": lambda c: "Joints" in c,
    "moving tiles": lambda c: "Moving Tiles" in c["Fluid"],
    "trapped air": lambda c: "Trapped Air" in c["Fluid"].get("Free Surface", {}),
    "surface tension": lambda c: "Surface Tension" in c["Fluid"].get("Free Surface", {}),
    "drops that fly": lambda c: "Drops" in c["Fluid"].get("Free Surface", {}).get("Interface", {}),
    "observers": lambda c: bool(c["Observers"]),
    "inflows": lambda c: side_is(c, "inflow"),
    "periodic sides": lambda c: side_is(c, "periodic"),
    "strategies but schur-cg": lambda c: "File" in c["Solver"] or c["Solver"]["Strategy"]["Type"] != "schur-cg",
}


def has_type(content, kind):
    return any(body["Type"] == kind for body in content["Solids"].values())


def side_is(content, kind):
    return any(side["Type"] == kind for side in content["Domain"]["Sides"].values())


def write_section(page, heading, body):
    """Replaces the section of this heading, or adds it."""
    text = page.read_text() if page.exists() else TITLE
    section = f"## {heading}\n\n{body.strip()}\n"
    pattern = re.compile(rf"^## {re.escape(heading)}\n.*?(?=^## |\Z)", re.MULTILINE | re.DOTALL)
    text = pattern.sub(lambda _: section + "\n", text) if pattern.search(text) else f"{text.rstrip()}\n\n{section}"
    page.write_text(text.rstrip() + "\n")


def table(heads, rows):
    lines = [heads, ["---"] * len(heads), *rows]
    return "\n".join("| " + " | ".join(map(str, line)) + " |" for line in lines)


def build():
    """The commit that the program was built from."""
    version = subprocess.run([program("simulate"), "--version"], capture_output=True, text=True).stdout
    built = re.search(r"\((.+)\)", version)
    return built.group(1) if built else version.strip()


def made_by(command, builds=()):
    return f"Made by `{command}` on {datetime.date.today()} with a build of {' and '.join(sorted(builds) or [build()])}."


def family_of(seed):
    return max((name for name, first in FAMILIES.items() if first <= seed), key=FAMILIES.get)


def ranges(seeds):
    """As --seeds takes them: "0-39,105"."""
    parts = []
    for seed in seeds:
        if parts and seed == parts[-1][1] + 1:
            parts[-1][1] = seed
        else:
            parts.append([seed, seed])
    return ",".join(str(first) if first == last else f"{first}-{last}" for first, last in parts)


def feature_rows(contents, failing):
    """Number of scenes of each family that have a feature, and of these that fail; "–" where none has it."""
    families = [name for name in FAMILIES if any(family_of(seed) == name for seed in contents)]
    rows = []
    for name, has in [("anything", lambda content: True), *FEATURES.items()]:
        row = [name]
        for family in families:
            drawn = {seed for seed, content in contents.items() if family_of(seed) == family and has(content)}
            n_failing = len(failing & drawn)
            row.append("–" if not drawn else f"{len(drawn)}, {n_failing} fail" if n_failing else str(len(drawn)))
        rows.append(row)
    return ["scenes with", *families], rows


def write_scenes(page, seeds, results, quick):
    """Writes the scenes drawn, the failures, and the largest values of the bounded quantities."""
    failures = collections.Counter()
    for result in results:
        failures.update({failure.partition(":")[0] for failure in result.failures})
    failing = {result.seed for result in results if result.failures}
    contents = {result.seed: random_scene(result.seed).content for result in results}
    classes = "".join(f"\n- {name}: {n} scenes" for name, n in failures.most_common())
    named = "".join(f"\n- seed {seed}: {known_failures.reason(seed) or 'not known before'}" for seed in sorted(failing))
    named = f"\nFailing seeds, with the reasons of `tests/robustness/known_failures.py`:\n{named}\n" if failing else ""
    ranks, option = (" and 2 or 3", " --quick") if quick else (", 2 and 3", "")
    command = f"tests/robustness/random_scenes.py --seeds {ranges(seeds)}{option} --report docs/results/robustness.md"
    starts = ", ".join(f"{name} from {first} on" for name, first in FAMILIES.items() if first > 0)
    body = f"""\
{len(results)} scenes, seeds {ranges(seeds)}: {len(failing)} fail. Each of 3 to 5 steps on 1{ranks} ranks, mostly more than
there are tiles, and again from a checkpoint. What is checked, with its bounds: the head of `tests/robustness/invariants.py`.
{classes}
{named}
A seed's number says what it may draw: {starts}. A column is such a family of seeds; "–": none of these scenes has it.
All seeds that are known to fail, also beyond these, stand in `tests/robustness/known_failures.py`.

{table(*feature_rows(contents, failing))}

{sum(result.core_seconds for result in results):.0f} s of a core. {made_by(command, {result.build for result in results})}"""
    write_section(page, "Random scenes", body)


def write_seams(page, seeds, results, ranks):
    """Says how many scenes with periodic seams came out the same on all numbers of ranks."""
    failing = [result for result in results if result.failures]
    named = "".join(f"\n\n- seed {result.seed}: {known_failures.reason(result.seed) or result.failures[0][:200]}" for result in failing)
    refused = sum(result.refused for result in results)
    words = f"{', '.join(map(str, ranks[:-1]))} and {ranks[-1]}"
    command = (f"tests/robustness/random_scenes.py --seeds {ranges(seeds)} --ranks {' '.join(map(str, ranks))} "
               "--report docs/results/robustness.md")
    body = f"""\
{len(results)} scenes whose longest axis is periodic and of whole tiles, seeds {ranges(seeds)}, each on {words} ranks: {len(failing)} fail. Solids reach
towards the seam, through which the multigrid solves. What is checked is that of the random scenes; {refused} runs were refused for a reason that
their scene has.{named}

{sum(result.core_seconds for result in results):.0f} s of a core. {made_by(command, {result.build for result in results})}"""
    write_section(page, "Periodic seams", body)


def left_rows(results):
    """Numbers of refused and taken files by what damage left of them."""
    groups = collections.defaultdict(collections.Counter)
    for mutation in results:
        if mutation.left:
            group = next(name for name in ("scene", "solver", "study", "mesh", "checkpoint", "system") if name in mutation.kind)
            groups[group, mutation.left, mutation.verdict][mutation.code == 0] += 1
    order = sorted(groups, key=lambda key: (key[0], {"must": 0, "may": 1}[key[2].split()[0]], "not" in key[2], key[1]))
    return [[*key, groups[key][False], groups[key][True]] for key in order]


def write_mutations(page, numbers, results):
    """Exit codes and failures by kind of file, and what the damage left."""
    rows = []
    for kind in dict.fromkeys(mutation.kind for mutation in results):
        those = [mutation for mutation in results if mutation.kind == kind]
        codes = collections.Counter(mutation.code for mutation in those)
        rows.append([kind, len(those), *(codes[code] for code in (0, 2, 3, 4)),
                     sum(bool(mutation.failure) for mutation in those)])
    failing = [str(mutation.number) for mutation in results if mutation.failure]
    n_silent = sum(mutation.code == 0 and mutation.verdict == meaning.MUST for mutation in results)
    named = f"\nFailing: {', '.join(failing)}.\n" if failing else ""
    command = f"tests/robustness/mutations.py --mutations {numbers[0]}-{numbers[-1]} --report docs/results/robustness.md"
    body = f"""\
{len(results)} damaged files: {len(failing)} end as no program should. It must end with 0, 2, 3 or 4, in time and by no signal, with one message if
not 0, with nothing written if 2; what it wrote can be read and is finite. 0: the damage left a file that says something valid.
"Shipped scene": of `xml-params/scenes`, only validated; that of three mistakes each is told asks `tests/errors/test_many_mistakes.py` of 60 more. "Sealed again": the checksum of the damaged file is right.
{named}
{table(["file", "mutations", "exit 0", "exit 2", "exit 3", "exit 4", "failing"], rows)}

What damage left of a file is judged by readers of our own, `tests/robustness/meaning.py`. Some of it must be refused: {n_silent} such files were
taken in silence. A file that says what it said before may not be refused. All else may be valid, such as another radius.

{table(["file", "what is left", "it", "refused", "taken"], left_rows(results))}

{sum(mutation.core_seconds for mutation in results):.0f} s of a core. {made_by(command)}"""
    write_section(page, "Damaged files", body)
