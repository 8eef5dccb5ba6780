"""Runs the programs under limits, and reads what they wrote."""
import csv
import dataclasses
import os
import resource
import signal
import subprocess
import tempfile
import time
from pathlib import Path

BUILD = Path(__file__).resolve().parents[2] / "build/release/drivers"
MPIEXEC = os.environ.get("LOCKSTEP_MPIEXEC", "mpirun")
MOST_BYTES = 6 << 30  # address space, so that a wild size ends the run and not the machine
RANK_SETTINGS = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMP_NUM_THREADS": "1",
                 "OMPI_MCA_rmaps_base_oversubscribe": "1", "OMPI_MCA_mpi_yield_when_idle": "1",
                 "OMPI_MCA_hwloc_base_binding_policy": "none"}


def program(name):
    """Path of a program of the build, unless LOCKSTEP_NAME says otherwise."""
    return os.environ.get(f"LOCKSTEP_{name.upper()}", str(BUILD / name))


@dataclasses.dataclass
class Run:
    code: int  # exit code of the program; -9 for SIGKILL, as subprocess has it
    timed_out: bool
    output: str
    errors: str
    core_seconds: float

    def failure(self):
        """Returns the reason why the program did not end well; empty if it did."""
        if self.timed_out:
            return "hangs"
        if self.code < 0:
            return f"ends by {signal.Signals(-self.code).name}"
        return f"exit code {self.code}: {self.errors.strip()[:300]}" if self.code else ""


def limit():
    """In the child: a session of its own, so that all its ranks can be ended together."""
    os.setsid()
    resource.setrlimit(resource.RLIMIT_AS, (MOST_BYTES, MOST_BYTES))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def run(command, seconds, ranks=1):
    """Runs a command on some ranks, for at most `seconds` of wall time."""
    start = [] if ranks == 1 else [MPIEXEC, "--oversubscribe", "-np", str(ranks)]
    with tempfile.TemporaryFile() as output, tempfile.TemporaryFile() as errors:
        process = subprocess.Popen([*start, *map(str, command)], stdin=subprocess.DEVNULL, stdout=output, stderr=errors,
                                   preexec_fn=limit, env={**os.environ, **RANK_SETTINGS})
        code, timed_out, usage = wait(process, seconds)
        output.seek(0), errors.seek(0)
        texts = [file.read().decode(errors="replace") for file in (output, errors)]
        return Run(code, timed_out, *texts, usage.ru_utime + usage.ru_stime)


def end_session(leader):
    """Ends a process and all that it started; mpirun's ranks are in process groups of their own."""
    for entry in Path("/proc").iterdir():
        try:
            if entry.name.isdigit() and os.getsid(int(entry.name)) == leader:
                os.kill(int(entry.name), signal.SIGKILL)
        except ProcessLookupError:
            pass


def wait(process, seconds):
    """Exit code, whether it had to be killed, and what it and its children used."""
    end, pause = time.monotonic() + seconds, 0.005
    timed_out = False
    while True:
        found, status, usage = os.wait4(process.pid, os.WNOHANG)
        if found:
            process.returncode = os.waitstatus_to_exitcode(status)
            return process.returncode, timed_out, usage
        if time.monotonic() > end and not timed_out:
            timed_out = True
            end_session(process.pid)
        time.sleep(pause)
        pause = min(0.1, 1.3 * pause)


def read_table(path):
    """The rows of history.csv or bodies.csv as text."""
    with open(path) as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))
