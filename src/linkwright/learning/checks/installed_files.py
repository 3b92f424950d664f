"""The files that the build of a Python package installs."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path, PurePosixPath

from linkwright.diagnostics import Phrase, foreign, phrase
from linkwright.diagnostics.lookalikes import lookalike_hint
from linkwright.learning.checks.findings import add_hint
from linkwright.learning.checks.not_yet import NotYet
from linkwright.process.patience import PatientClock

_TIMEOUT_S = 10.0
_POLL_PERIOD_S = 0.2
_SETUP_FRAME = re.compile(r'File ".*setup\.py", line (\d+)')
_RUNNER_CODE = """
import json, runpy, sys, types
files = []
fake = types.ModuleType("setuptools")
def setup(**given):
    for entry in given.get("data_files", ()):
        if not (isinstance(entry, (tuple, list)) and len(entry) == 2 and isinstance(entry[1], (tuple, list))):
            print(json.dumps({"entry": type(entry).__name__ if hasattr(entry, "__next__") else repr(entry)}))
            sys.exit(0)
        files.append((str(entry[0]), list(map(str, entry[1]))))
fake.setup = setup
fake.find_packages = fake.find_namespace_packages = lambda *_, **__: []
fake.__getattr__ = lambda name: type(name, (), {})
sys.modules["setuptools"] = fake
sys.argv = ["setup.py"]
runpy.run_path("setup.py", run_name="__main__")
print(json.dumps(files))
"""


def expect_valid_setup(folder: Path) -> None:
    """Require the ``setup.py`` of a Python package to exist and to be valid Python.

    Raises:
        NotYet: the file is missing, or has a syntax error.
    """
    path = folder / "setup.py"
    if not path.is_file():
        if (folder / "CMakeLists.txt").is_file():
            return
        raise NotYet(phrase("'{folder}' has no file '{name}'", folder=folder.name, name="setup.py"))
    try:
        compile(path.read_bytes(), str(path), "exec")
    except (SyntaxError, ValueError) as error:
        line = getattr(error, "lineno", None) or 1
        described = phrase(
            "{file}, line {line}: {error}", file="setup.py", line=line, error=foreign(str(error.args[0]))
        )
        text = getattr(error, "text", None) or ""
        raise NotYet(add_hint(described, lookalike_hint(text))) from None


def list_setup_files(folder: Path) -> dict[PurePosixPath, Path]:
    """Return the data files that a ``setup.py`` installs, by their installed paths.

    The file runs in a process of its own, with a stand-in for setuptools.

    Args:
        folder: the folder of the package.

    Returns:
        The source of each file, by its path below the installation prefix.

    Raises:
        NotYet: the file is missing or fails.
    """
    if not (folder / "setup.py").is_file():
        raise NotYet(phrase("'{folder}' has no file '{name}'", folder=folder.name, name="setup.py"))
    try:
        output = _run_setup(folder)
    except subprocess.TimeoutExpired:
        raise NotYet(phrase("setup.py did not end within {seconds:g} s", seconds=_TIMEOUT_S)) from None
    except subprocess.CalledProcessError as error:
        raise NotYet(_describe_failure(error.stderr.strip().splitlines() or [""])) from None
    lines = output.splitlines()
    if not lines:
        raise NotYet(phrase("setup.py ends without an error, but does not call setup(...)"))
    entries = json.loads(lines[-1])
    if isinstance(entries, dict):
        if entries["entry"] == "generator":
            raise NotYet(phrase("setup.py: an entry of data_files is a generator; write a star before the call"))
        raise NotYet(
            phrase(
                "setup.py: {entry} in data_files is not a pair of a folder and a list of files", entry=entries["entry"]
            )
        )
    return {
        PurePosixPath(folder_in_prefix) / Path(name).name: folder / name
        for folder_in_prefix, names in entries
        for name in names
    }


def _run_setup(folder: Path) -> str:
    """Run a ``setup.py``, and return its output.

    Raises:
        subprocess.CalledProcessError: the file fails.
        subprocess.TimeoutExpired: the file takes too long; the load of the machine does not count.
    """
    clock = PatientClock()
    command = [sys.executable, "-c", _RUNNER_CODE]
    with subprocess.Popen(  # noqa: S603 - the learner's own file
        command,
        cwd=folder,
        env={**os.environ, "PYTHONIOENCODING": "utf-8"},  # Windows has other encodings
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        encoding="utf-8",
        errors="replace",
    ) as process:
        while (outputs := _read_outputs(process)) is None:
            if clock.read() > _TIMEOUT_S:
                process.kill()
                raise subprocess.TimeoutExpired(command, _TIMEOUT_S)
    output, errors = outputs
    if process.returncode:
        raise subprocess.CalledProcessError(process.returncode, command, output, errors)
    return output


def _read_outputs(process: subprocess.Popen[str]) -> tuple[str, str] | None:
    """Return a process's standard output and error if it ends within `_POLL_PERIOD_S`, or None."""
    try:
        return process.communicate(timeout=_POLL_PERIOD_S)
    except subprocess.TimeoutExpired:
        return None


def _describe_failure(lines: Sequence[str]) -> Phrase:
    """Return the last line of a traceback with the last line of ``setup.py`` that it names."""
    numbers = [match[1] for line in lines if (match := _SETUP_FRAME.search(line))]
    error = foreign(lines[-1])
    hint = lookalike_hint(lines[-1]) if "invalid character" in lines[-1] else None
    if "can't multiply sequence" in lines[-1]:
        hint = phrase("a comma is missing before the star")
    elif "'tuple' object is not callable" in lines[-1]:
        hint = phrase("a comma is missing at the end of an entry of data_files")
    elif "name 'glob' is not defined" in lines[-1] or "'module' object is not callable" in lines[-1]:
        error = foreign(lines[-1].partition(" Did you forget")[0])
        hint = phrase("write 'from glob import glob' at the top of the file")
    if not numbers:
        return phrase("setup.py fails: {error}", error=error)
    return add_hint(phrase("{file}, line {line}: {error}", file="setup.py", line=int(numbers[-1]), error=error), hint)
