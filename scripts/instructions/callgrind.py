"""Counts the instructions of a rendering with callgrind. Python 3.11 or later, no packages."""

import os
import platform
import re
import shutil
import subprocess
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
TARGET = ROOT / "target" / "instructions"
# Scenes that are written for a count.
SCENES = TARGET / "scenes"

# A processor that every version of valgrind knows.
RUSTFLAGS = "-Ctarget-cpu=x86-64-v3"

# The counted function: the loop over the tiles, with everything that it calls.
LOOP = re.compile(r"_R.*rayweave_sequential6render|_ZN19rayweave_sequential6render17h[0-9a-f]{16}E")


class Failure(Exception):
    """A reason why nothing could be counted."""


def run(command, **options):
    result = subprocess.run(command, cwd=ROOT, text=True, capture_output=True, **options)
    if result.returncode != 0:
        raise Failure(f"{' '.join(map(str, command))}\n{result.stdout}{result.stderr}")
    return result.stdout


def why_not():
    """Returns why nothing can be counted on this machine, or None."""
    if platform.machine() not in ("x86_64", "AMD64"):
        return "the counts are for x86-64"
    missing = [tool for tool in ("valgrind", "nm") if not shutil.which(tool)]
    if missing:
        return f"{' and '.join(missing)} missing (Debian: apt-get install valgrind binutils)"
    return None


def build():
    """Builds the program. Returns its path and the symbol of its loop."""
    environment = {**os.environ, "RUSTFLAGS": RUSTFLAGS, "CARGO_TARGET_DIR": str(TARGET)}
    environment.pop("CARGO_ENCODED_RUSTFLAGS", None)
    command = ["cargo", "build", "--release", "--locked", "--package", "rayweave"]
    if subprocess.run(command, cwd=ROOT, env=environment).returncode != 0:
        raise Failure("the program does not build")
    program = TARGET / "release" / "rayweave"
    symbols = {line.split()[-1] for line in run(["nm", program]).splitlines()}
    loops = [symbol for symbol in symbols if LOOP.fullmatch(symbol)]
    if len(loops) != 1:
        raise Failure("expected one function to be the sequential strategy's loop (LOOP in this script), "
                      f"got {loops}")
    return program, loops[0]


def count(program, loop, words):
    """Returns the instructions within the loop, without start and files, and the image's digest."""
    scene, *options = words.split()
    if "/" not in scene:
        scene = SCENES / scene
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "callgrind"
        told = run(["valgrind", "--tool=callgrind", "--demangle=no", f"--toggle-collect={loop}",
                    f"--callgrind-out-file={out}",
                    program, "render", scene, *options, "--strategy", "sequential", "--output", f"{folder}/picture.ppm"])
        totals = re.search(r"^(?:summary|totals): (\d+)", out.read_text(), re.MULTILINE)
    if not totals or totals[1] == "0":
        raise Failure(f"callgrind counted nothing in {loop}")
    return int(totals[1]), re.search(r"digest (\w+)", told)[1]
