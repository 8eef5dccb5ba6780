"""State of a run: whether it goes on, how it ended, and how far it is."""
import os
import re
import socket
import time

RECENT = 20  # steps that tell how fast a run is


def state_of(summary):
    """State in summary.json, and whether the process that wrote "running" is still there."""
    status = summary.get("status", "not finished: no summary.json")
    if status in ("failed", "stopped by an exception"):
        return f"{status}: {summary.get('message', '')}"
    if status != "running":
        return status
    host = summary.get("machine", {}).get("host")
    if host != socket.gethostname():
        return f"running on {host}, as far as its files tell"
    return "running" if is_alive(summary.get("process", 0), summary.get("started", 0)) else "killed: ended without a word"


def is_alive(process, started):
    """A process of that number that was there when the run began; numbers are given again."""
    try:
        with open(f"/proc/{process}/stat") as file:
            fields = file.read().rpartition(")")[2].split()
        with open("/proc/uptime") as file:
            seconds_up = float(file.read().split()[0])
    except OSError:
        return False
    is_zombie = fields[0] == "Z"
    began = time.time() - seconds_up + int(fields[19]) / os.sysconf("SC_CLK_TCK")
    return not is_zombie and began <= started + 2


def progress_of(summary, values, history):
    """Progress of a run that is not done: which part is done and, if it goes on, for how long it still will."""
    if summary.get("status") == "done" or not history or not history["rows"]:
        return None
    names = [column["name"] for column in history["columns"]]
    last = dict(zip(names, history["rows"][-1]))
    start, end, most_steps = ends(summary.get("command", ""), values)
    now, step = float(last["time"]), int(last["step"])
    done = max((now - start) / (end - start), step / most_steps if most_steps else 0)
    text = f"{min(done, 1):.0%} of {f'{most_steps} steps' if most_steps and step / most_steps >= done else f'{end:g} s'}"
    recent = [dict(zip(names, row)) for row in history["rows"][-RECENT:]]
    if state_of(summary).startswith("running") and len(recent) > 1 and done > 0:
        seconds = sum(float(row["wall_seconds"]) for row in recent[1:])
        speed = (now - float(recent[0]["time"])) / (end - start)
        if most_steps:
            speed = max(speed, (len(recent) - 1) / most_steps)
        text += f", {duration(seconds * max(1 - done, 0) / speed)} left at the speed of the last {len(recent) - 1} steps"
    return text


def ends(command, values):
    """Start and end [s], and the most steps (0: as many as it takes); options come before the scene."""
    option = dict(re.findall(r"--(end-time|steps)[ =](\S+)", command))
    return (float(values.get("Time/Start", 0)), float(option.get("end-time", values.get("Time/End", 1))),
            int(option.get("steps", values.get("Time/Steps", 0))))


def duration(seconds):
    if seconds < 90:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.0f} min" if seconds < 5400 else f"{seconds / 3600:.1f} h"
