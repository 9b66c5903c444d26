"""Instructions of a rendering, as callgrind counts them. Python 3.11 or later, no packages."""

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
# Of scenes that are written for a count.
SCENES = TARGET / "scenes"

# A processor that every valgrind knows, whatever machine this is.
RUSTFLAGS = "-Ctarget-cpu=x86-64-v3"

# What is counted: the loop over the tiles, and what it calls.
LOOP = re.compile(r"_R.*TileByTile.*Renderer6render|_ZN.*TileByTile.*Renderer.*6render17h[0-9a-f]{16}E")


class Failure(Exception):
    """Why nothing could be counted."""


def run(command, **options):
    result = subprocess.run(command, cwd=ROOT, text=True, capture_output=True, **options)
    if result.returncode != 0:
        raise Failure(f"{' '.join(map(str, command))}\n{result.stdout}{result.stderr}")
    return result.stdout


def why_not():
    """Why nothing can be counted here, if so."""
    if platform.machine() not in ("x86_64", "AMD64"):
        return "the counts are of x86-64"
    missing = [tool for tool in ("valgrind", "nm") if not shutil.which(tool)]
    if missing:
        return f"{' and '.join(missing)} missing (Debian: apt-get install valgrind binutils)"
    return None


def build():
    """The program, and the name that callgrind knows its loop by."""
    environment = {**os.environ, "RUSTFLAGS": RUSTFLAGS, "CARGO_TARGET_DIR": str(TARGET)}
    environment.pop("CARGO_ENCODED_RUSTFLAGS", None)
    command = ["cargo", "build", "--release", "--locked", "--package", "rayweave"]
    if subprocess.run(command, cwd=ROOT, env=environment).returncode != 0:
        raise Failure("the program does not build")
    program = TARGET / "release" / "rayweave"
    symbols = {line.split()[-1] for line in run(["nm", program]).splitlines()}
    loops = [symbol for symbol in symbols if LOOP.fullmatch(symbol)]
    if len(loops) != 1:
        raise Failure(f"not one function is the sequential strategy's loop (LOOP in this script): {loops}")
    return program, loops[0]


def count(program, loop, words):
    """The instructions between entering and leaving the loop, without start, reading and writing; and the picture's digest."""
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
