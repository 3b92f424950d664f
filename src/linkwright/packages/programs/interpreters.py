"""The Python interpreter that runs an installed script."""

from __future__ import annotations

import os
import shlex
import shutil
import subprocess
import sys
from functools import cache
from pathlib import Path

from linkwright.loading.deferred import lazy_pattern

_VERSION = lazy_pattern(r"python(\d+)\.(\d+)")
_QUERY_TIMEOUT_S = 5.0


def needs_our_interpreter(path: Path) -> bool:
    """Return whether a script for another Python version must run with the current interpreter.

    This is the case if ROS is not installed.

    Linkwright's stand-ins for ROS modules need compiled libraries, which exist only for the version of this process.
    """
    interpreter = _find_python_interpreter(path)
    if interpreter is None or _has_ros_for_python():
        return False
    return _find_python_version(interpreter) not in (None, sys.version_info[:2])


def read_interpreter_words(path: Path) -> list[str]:
    """Return the interpreter and its arguments in a script's first line, or an empty list."""
    try:
        with path.open("rb") as file:
            first = file.readline(512)
    except OSError:
        return []
    return shlex.split(first[2:].decode(errors="replace")) if first.startswith(b"#!") else []


def _find_python_interpreter(path: Path) -> str | None:
    """Return the Python interpreter that a script's first line names, or None."""
    words = read_interpreter_words(path)
    if words and Path(words[0]).name == "env":
        words = [word for word in words[1:] if not word.startswith("-")]
    if not words or not Path(words[0]).name.startswith("python"):
        return None
    return shutil.which(words[0])


@cache
def _find_python_version(interpreter: str) -> tuple[int, ...] | None:
    version_in_name = _VERSION.search(Path(os.path.realpath(interpreter)).name)
    if version_in_name:
        return int(version_in_name[1]), int(version_in_name[2])
    program = "import sys; print(*sys.version_info[:2])"
    try:
        completed = subprocess.run(  # noqa: S603 - the interpreter that the user's script names
            [interpreter, "-I", "-S", "-c", program],
            capture_output=True,
            timeout=_QUERY_TIMEOUT_S,
            check=True,
            text=True,
        )
        return tuple(int(word) for word in completed.stdout.split())
    except (OSError, subprocess.SubprocessError, ValueError):
        return None


def _has_ros_for_python() -> bool:
    """Return whether a prefix of the environment contains a real rclpy."""
    prefixes = os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep)
    patterns = ("lib/python*/site-packages/rclpy", "local/lib/python*/dist-packages/rclpy")
    return any(
        next(Path(prefix).glob(pattern), None) is not None for prefix in prefixes if prefix for pattern in patterns
    )
