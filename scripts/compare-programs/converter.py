"""The command line that the converters share."""

import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from scene_to_text import SceneError, read_scene


def convert(command, usage, scene_to_other):
    """Writes the scene that the command line names to standard output. Returns the exit status."""
    program, *arguments = command
    if not 1 <= len(arguments) <= 2 or arguments[0].startswith("-"):
        print(usage, file=sys.stderr)
        return 2
    try:
        parts = read_scene(arguments[0])
        width, height = map(int, arguments[1].split("x")) if arguments[1:] else parts["image"]
        sys.stdout.writelines(scene_to_other(parts, width, height))
    except (OSError, SceneError, ValueError) as error:
        print(f"{os.path.basename(program)}: {arguments[0]}: {error}", file=sys.stderr)
        return 1
    return 0
