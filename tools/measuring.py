"""The common part of the tools that measure: the program of a build, runs on ranks and such as may fail, tables."""
import csv
import os
import pathlib
import shlex
import subprocess
import sys

TOOL = pathlib.Path(sys.argv[0]).name


def program_of(build, name):
    """Its path; ends the tool if there is none."""
    program = pathlib.Path(build).resolve() / "drivers" / name
    if not program.exists():
        sys.exit(f"{TOOL}: there is no {program}; build it, or name another build with --build.")
    return program


def simulate_of(build):
    return program_of(build, "simulate")


def run_or_end(command, **options):
    """Ends the tool with the command if it fails; what it said stands above, unless it was captured."""
    command = [str(part) for part in command]
    done = subprocess.run(command, **options)
    if done.returncode != 0:
        said = "".join(text for text in (done.stdout, done.stderr) if text)
        sys.exit(f"{said}{TOOL}: a run ended with exit code {done.returncode}; nothing is written.\n  {shlex.join(command)}")
    return done


def version_of(program):
    """With the commit that it was built from."""
    return subprocess.run([program, "--version"], capture_output=True, text=True).stdout.strip()


def environment():
    """For runs of one thread a rank, as root too, of more ranks than cores too."""
    return dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", OMP_NUM_THREADS="1",
                OMPI_MCA_mpi_yield_when_idle="1")


def stages_of(summary, seconds="mean_seconds"):
    """Seconds by stage of summary.json, under the names of the paper's step: one of kick, drift, kick has the solves within its kicks."""
    result = {}
    for entry in summary.get("stages", []):
        name = entry["name"].replace("step / kick / forces", "step / F3 forces").replace("step / kick / ", "step / ")
        if name != "step / kick":
            result[name] = result.get(name, 0) + entry[seconds]
    return result


def on_ranks(n):
    """Words that stand before a command."""
    return ["mpirun", "--oversubscribe", "-n", str(n)] if n > 1 else []


def write_rows(path, rows):
    with open(path, "w", newline="") as file:
        writer = csv.DictWriter(file, rows[0].keys())
        writer.writeheader()
        writer.writerows(rows)
