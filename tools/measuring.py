"""What the tools that measure have in common: the program of a build, and runs that may fail."""
import pathlib
import shlex
import subprocess
import sys

TOOL = pathlib.Path(sys.argv[0]).name


def simulate_of(build):
    """Its path; ends the tool if there is none."""
    program = pathlib.Path(build).resolve() / "drivers/simulate"
    if not program.exists():
        sys.exit(f"{TOOL}: there is no {program}; build it, or name another build with --build.")
    return program


def run_or_end(command, **options):
    """Ends the tool with the command if it fails; what it said stands above, unless it was captured."""
    command = [str(part) for part in command]
    done = subprocess.run(command, **options)
    if done.returncode != 0:
        said = "".join(text for text in (done.stdout, done.stderr) if text)
        sys.exit(f"{said}{TOOL}: a run ended with exit code {done.returncode}; nothing is written.\n  {shlex.join(command)}")
    return done
