#!/usr/bin/python3
"""Finds pages of docs/results that are older than what they depend on, and remakes them: the part of tools/results --stale."""
import argparse
import dataclasses
import datetime
import os
import re
import shlex
import signal
import subprocess
import sys
import time
from pathlib import Path

from result_pages import RESULTS, ROOT, names_of_pages, page_of, seconds_of

COMMIT = re.compile(r"\b(?:from|commit|build of) ([0-9a-f]{7,40})\b(-dirty)?")


@dataclasses.dataclass
class Age:
    page: object
    commit: str        # as the page names it
    made: int = 0      # when that was committed [s since 1970]; 0: not known
    behind: int = 0    # commits since then that changed what the page depends on
    is_dirty: bool = False
    is_known: bool = True

    def is_stale(self):
        return self.behind > 0 or self.is_dirty or not self.is_known


def git(root, *arguments):
    """Output of git, or None where it fails."""
    done = subprocess.run(["git", "-C", str(root), *arguments], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    return done.stdout.strip() if done.returncode == 0 else None


def commit_of_tree(root=ROOT):
    """Commit that a page names: HEAD, with "-dirty" where the tree differs from it in more than the pages, on which no figure depends."""
    is_clean = git(root, "diff", "--quiet", "HEAD", "--", ".", f":(exclude){RESULTS}") is not None
    return (git(root, "rev-parse", "--short", "HEAD") or "unknown") + ("" if is_clean else "-dirty")


def age_by(root, page, commit, dirty):
    date = git(root, "show", "--no-patch", "--format=%ct", commit)
    behind = git(root, "rev-list", "--count", f"{commit}..HEAD", "--", *page.paths)
    if date is None or behind is None:
        return Age(page, commit, is_known=False)
    return Age(page, commit + dirty, int(date), int(behind), bool(dirty))


def age_of(root, page):
    """By the oldest of the commits that the page names: its parts may come from several."""
    commits = COMMIT.findall((Path(root) / RESULTS / f"{page.name}.md").read_text())
    ages = [age_by(root, page, commit, dirty) for commit, dirty in commits] or [Age(page, "none", is_known=False)]
    return min(ages, key=lambda age: (age.is_known, -age.is_dirty, -age.behind, age.made))


def stale_pages(root):
    """Oldest first."""
    ages = [age_of(root, page) for page in filter(None, (page_of(root, name) for name in names_of_pages(root)))]
    return sorted((age for age in ages if age.is_stale()), key=lambda age: (age.made, age.page.name))


def command_of(page):
    return "; ".join(shlex.join(words) for words in page.commands)


def say_unknown(ages):
    n_unknown = sum(not age.is_known for age in ages)
    if n_unknown:
        print(f"results: this clone does not have the commits of {n_unknown} pages ('?'), which count as stale; if it is a shallow "
              "one, `git fetch --unshallow` brings them.", file=sys.stderr)


def show(root, ages):
    rows = [("page", "commit", "of", "behind", "seconds", "made again by")]
    for age in ages:
        seconds = seconds_of(root, age.page.name)
        date = f"{datetime.datetime.fromtimestamp(age.made, datetime.timezone.utc):%Y-%m-%d}" if age.made else "?"
        note = f" (by hand: {age.page.by_hand})" if age.page.by_hand else ""
        rows.append((age.page.name, age.commit, date, str(age.behind) if age.is_known else "?",
                     "?" if seconds is None else f"{seconds:.0f}", command_of(age.page) + note))
    widths = [max(len(row[column]) for row in rows) for column in range(5)]
    for row in rows:
        cells = [cell.rjust(width) if column in (3, 4) else cell.ljust(width) for column, (cell, width) in enumerate(zip(row, widths))]
        print("  ".join([*cells, row[5]]))
    print(f"{len(ages)} of {len(names_of_pages(root))} pages are older than what they depend on.")


def end_group(running):
    """The command and what it started: runs on ranks, too."""
    try:
        os.killpg(running.pid, signal.SIGTERM)
        running.wait(timeout=20)
    except (ProcessLookupError, subprocess.TimeoutExpired):
        running.kill()
        running.wait()


def run(root, words, log, seconds):
    """Its exit code; None if the time was over first."""
    # The programs are built once, from a clean tree: a page that was just written would change the version that they name.
    environment = dict(os.environ, LOCKSTEP_IS_BUILT="1")
    running = subprocess.Popen([str(Path(root) / words[0]), *words[1:]], cwd=root, stdout=log, stderr=subprocess.STDOUT,
                               env=environment, start_new_session=True)
    try:
        return running.wait(timeout=seconds)
    except subprocess.TimeoutExpired:
        return None
    finally:
        if running.poll() is None:
            end_group(running)


def make(root, page, end):
    """"made", "failed", or "no time left"."""
    path = Path(root) / "build/results" / page.name / "remake.log"
    path.parent.mkdir(parents=True, exist_ok=True)
    with open(path, "w") as log:
        codes = []
        for words in page.commands:
            codes.append(run(root, words, log, end - time.monotonic()))
            if codes[-1] is None:
                return "no time left"
    if any(codes):
        return f"failed (exit code {max(codes)}, {path.relative_to(root)})"
    return "made"


def remake(root, ages, hours):
    """Exit code: 0, or 1 if a page failed."""
    commit, end = commit_of_tree(root), time.monotonic() + 3600 * hours
    if commit.endswith("-dirty"):
        sys.exit("results: pages name the commit that they are made from: commit the changes outside of docs/results first.")
    outcomes = []
    for age in ages:
        if commit_of_tree(root) != commit:
            print(f"The tree is no more that of {commit}, so the rest waits: start anew.")
            break
        if time.monotonic() >= end:
            print("The time is over.")
            break
        seconds = seconds_of(root, age.page.name) or 0
        if age.page.by_hand:
            outcome = f"left: {age.page.by_hand}"
        elif time.monotonic() + seconds >= end:
            outcome = f"left: it took {seconds:.0f} s last time, and fewer are left"
        else:
            print(f"{time.strftime('%H:%M:%S')}  {age.page.name} ...", flush=True)
            outcome = make(root, age.page, end)
        print(f"{time.strftime('%H:%M:%S')}  {age.page.name}: {outcome}", flush=True)
        outcomes.append(outcome)
    n_made, n_failed = outcomes.count("made"), sum(outcome.startswith("failed") for outcome in outcomes)
    print(f"{n_made} pages made from {commit}, {n_failed} failed, {len(ages) - n_made - n_failed} left. Look at them, and commit.")
    return 1 if n_failed else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--stale", action="store_true", required=True)
    parser.add_argument("--remake", action="store_true")
    parser.add_argument("--hours", type=float, default=float("inf"))
    parser.add_argument("--root", type=Path, default=ROOT, help="of the tree")
    arguments = parser.parse_args()
    ages = stale_pages(arguments.root)
    say_unknown(ages)
    if arguments.remake:
        return remake(arguments.root, ages, arguments.hours)
    show(arguments.root, ages)
    return 0


if __name__ == "__main__":
    sys.exit(main())
