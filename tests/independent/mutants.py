"""Scenes with random damage through `check` and a short `run`: no panic, and no process above five seconds of processor time."""

import os
import random
import re
import resource
import sys
from pathlib import Path

from program import Findings, Program, arguments

ROOT = Path(__file__).resolve().parents[2]
FOLDERS = ("docs/scenes", "docs/guide", "docs/chaos", "docs/stability", "tests/cases")
# No process may take longer (s of the processor); one that takes twice as long is ended. Memory (bytes).
LONGEST, MEMORY = 5, 4 << 30
METHODS = ("dla", "dla4", "dla-trapezoid", "lobatto3", "gauss4", "gauss-adaptive", "energy2", "rk4", "rk4-reduced", "dop853")
NUMBERS = (
    "0",
    "-1",
    "1e300",
    "-1e300",
    "5e-324",
    "nan",
    "inf",
    "-inf",
    "1e16",
    "1e-9",
    "3",
    "999999999999",
    "0.1",
    '"1"',
    "[]",
    "{}",
    "true",
)
FORMULAS = (
    "sin(",
    "^",
    "/",
    "*0",
    "^-1",
    "^t",
    "sqrt(",
    "abs(",
    "max(",
    "t",
    "x'",
    "theta",
    "log(",
    "atan2(",
    ")",
    "(",
    "e",
    "1e999",
    "..",
    "'",
)


class Mutator:
    """Makes a damaged scene from a seed."""

    def __init__(self, program):
        files = sorted(path for folder in FOLDERS for path in (ROOT / folder).glob("*.toml"))
        self.scenes = [path.read_text() for path in files if program.ask("check", path).code == 0]
        words = (ROOT / "tests" / "fuzz" / "scene.dict").read_text().splitlines()
        self.words = [word[1:-1].replace('\\"', '"').replace("\\\\", "\\") for word in words if word.startswith('"')]

    def scene(self, seed):
        chance = random.Random(seed)
        text = chance.choice(self.scenes)
        for _ in range(chance.choice((1, 1, 1, 2, 3, 6))):
            text = chance.choice((*(self.number,) * 6, *(self.formula,) * 3, self.line, self.word, self.sign, self.splice))(chance, text)
        return text

    def number(self, chance, text):
        found = list(re.finditer(r"(?<![\w.])-?\d+(\.\d+)?(e-?\d+)?", text))
        if not found:
            return text
        place = chance.choice(found)
        value = float(place[0])
        value = repr(value * 10 ** chance.choice((chance.uniform(-12, 12), chance.uniform(-1, 1))) * chance.choice((1, 1, -1)))
        return text[: place.start()] + (value if chance.random() < 0.7 else chance.choice(NUMBERS)) + text[place.end() :]

    def formula(self, chance, text):
        found = [place for place in re.finditer(r'"[^"\n]*"', text) if set("*+-/^(") & set(place[0])]
        if not found:
            return text
        place = chance.choice(found)
        at = chance.randrange(place.start() + 1, place.end())
        return text[:at] + chance.choice(FORMULAS) + text[at + chance.choice((0, 0, 1, 3)) :]

    def line(self, chance, text):
        lines = text.splitlines()
        k = chance.randrange(len(lines) or 1)
        kept = lines[k : k + 1]
        lines[k : k + 1] = chance.choice(([], kept * 2, [*kept, *chance.sample(lines, min(2, len(lines)))]))
        return "\n".join(lines)

    def word(self, chance, text):
        found = list(re.finditer(r"\w+", text))
        if not found:
            return text
        place = chance.choice(found)
        return text[: place.start()] + chance.choice((chance.choice(self.words), chance.choice(found)[0])) + text[place.end() :]

    def sign(self, chance, text):
        at = chance.randrange(len(text) + 1)
        return (
            text[:at]
            + chance.choice(("", chr(chance.randrange(1, 127)), chr(chance.choice((0x0, 0xE9, 0x202E, 0x1F600))), text[at : at + 20] * 50))
            + text[at + 1 :]
        )

    def splice(self, chance, text):
        other = chance.choice(self.scenes).split("\n\n")
        parts = text.split("\n\n")
        parts[chance.randrange(len(parts))] = chance.choice(other)
        return "\n\n".join(parts)


def bounded():
    resource.setrlimit(resource.RLIMIT_CPU, (2 * LONGEST, 2 * LONGEST + 1))
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))


def ended(command, errors):
    """Exit code (negative: a signal) and seconds of the processor; messages go to the file of errors."""
    child = os.fork()
    if child == 0:
        try:
            bounded()
            os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
            os.dup2(os.open(errors, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o600), 2)
            os.execv(command[0], command)
        finally:
            os._exit(127)
    _, status, used = os.wait4(child, 0)
    return os.waitstatus_to_exitcode(status), used.ru_utime + used.ru_stime


def main():
    options = arguments(__doc__, 20_000).parse_args()
    program, findings = Program(options.program, options.folder), Findings()
    mutator = Mutator(program)
    path, errors = os.path.realpath(options.program), str(program.folder / "mutant.errors")
    longest = 0.0
    for seed in range(options.first, options.first + options.count):
        text = mutator.scene(seed)
        file = program.folder / "mutant.toml"
        file.write_text(text, errors="replace")
        method = METHODS[seed % len(METHODS)]
        for command in (["check", str(file)], ["run", str(file), "--method", method, "--step", "0.01", "--duration", "0.2"]):
            code, seconds = ended([path, *command], errors)
            longest = max(longest, seconds)
            findings.count(f"{command[0]} ended with {code}")
            message = Path(errors).read_text(errors="replace")
            where = {"seed": seed, "command": command[0], "method": method, "code": code, "seconds": seconds}
            if code not in (0, 1, 2) or "panicked" in message:
                findings.fail("panic", **where, message=message[:300], kept=kept(program, seed, text))
            elif seconds > LONGEST:
                findings.fail("slow", **where, message=message[:300], kept=kept(program, seed, text))
            elif code != 0 and not message.startswith(("error", "note", "warning")):
                findings.fail("no message", **where, message=message[:300], kept=kept(program, seed, text))
    findings.counts["longest (ms)"] = round(1000 * longest)
    return findings.end()


def kept(program, seed, text):
    file = program.folder / f"mutant-{seed}.toml"
    file.write_text(text, errors="replace")
    return file.name


if __name__ == "__main__":
    sys.exit(main())
