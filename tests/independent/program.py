"""Runs the program under test, and reads what it prints."""

import argparse
import json
import resource
import signal
import subprocess
import time
from dataclasses import dataclass
from pathlib import Path

# A process that takes longer counts as one without end (s of the processor: others may use it too), or ten times as long by the clock.
PATIENCE = 120


@dataclass
class Answer:
    """What a command came to: exit code, the object it printed, its messages."""

    code: int
    shown: dict | None
    messages: str

    @property
    def refusal(self):
        """The first line of the error, without the numbers in it."""
        lines = [line for line in self.messages.splitlines() if line.startswith("error")] or self.messages.splitlines()
        return lines[0] if lines else ""


NO_END = Answer(-1, None, f"error: no end after {PATIENCE} s")


def bounded():
    resource.setrlimit(resource.RLIMIT_CPU, (PATIENCE, PATIENCE + 5))


class Program:
    """A program file, and the folder where its scenes are written."""

    def __init__(self, path, folder):
        self.path, self.folder = str(path), Path(folder)
        self.folder.mkdir(parents=True, exist_ok=True)

    def scene(self, name, text):
        """The file of a scene."""
        file = self.folder / f"{name}.toml"
        file.write_text(text)
        return str(file)

    def ask(self, *arguments):
        """One command with `--json`."""
        command = [self.path, *map(str, arguments), "--json"]
        try:
            done = subprocess.run(
                command, check=False, capture_output=True, text=True, timeout=10 * PATIENCE, errors="replace", preexec_fn=bounded
            )
        except subprocess.TimeoutExpired:
            return NO_END
        if done.returncode == -signal.SIGXCPU:
            return NO_END
        try:
            shown = json.loads(done.stdout)
        except ValueError:
            shown = None
        return Answer(done.returncode, shown, done.stderr)


class Findings:
    """Failures as they are found: a line for each, and a count of every kind."""

    def __init__(self):
        self.counts, self.failures, self.since = {}, [], time.time()

    def count(self, kind, more=1):
        self.counts[kind] = self.counts.get(kind, 0) + more

    def fail(self, kind, **data):
        self.count(kind)
        self.failures.append({"kind": kind, **data})
        print(json.dumps(self.failures[-1], default=float), flush=True)

    def end(self):
        """Prints the counts; the exit code."""
        print(json.dumps({**self.counts, "failures": len(self.failures), "seconds": round(time.time() - self.since)}))
        return 1 if self.failures else 0


def arguments(purpose, count):
    """What every script of the folder takes."""
    parser = argparse.ArgumentParser(description=purpose)
    parser.add_argument("program", help="the program under test, such as target/release/noslip")
    parser.add_argument("--count", type=int, default=count, help="how many [default: %(default)s]")
    parser.add_argument("--first", type=int, default=0, help="the first seed [default: %(default)s]")
    parser.add_argument("--folder", default="target/independent", help="where scenes are written [default: %(default)s]")
    return parser
