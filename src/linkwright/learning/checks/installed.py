"""The files that the build of a Python package installs."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path, PurePosixPath

from linkwright.diagnostics import foreign, phrase
from linkwright.learning.checks.not_yet import NotYet

_TIMEOUT_SECONDS = 10.0
_RUNNER = """
import json, runpy, sys, types
files = []
fake = types.ModuleType("setuptools")
def setup(**given):
    files.extend((str(place), list(map(str, names))) for place, names in given.get("data_files", ()))
fake.setup = setup
fake.find_packages = fake.find_namespace_packages = lambda *_, **__: []
fake.__getattr__ = lambda name: type(name, (), {})
sys.modules["setuptools"] = fake
sys.argv = ["setup.py"]
runpy.run_path("setup.py", run_name="__main__")
print(json.dumps(files))
"""


def files_of_setup(folder: Path) -> dict[PurePosixPath, Path]:
    """Return the data files that a ``setup.py`` installs.

    The file runs in a process of its own, with a stand-in for setuptools.

    Args:
        folder: the folder of the package.

    Returns:
        The source of each file, by its place below the installation prefix.

    Raises:
        NotYet: the file is missing or fails.
    """
    if not (folder / "setup.py").is_file():
        raise NotYet(phrase("'{folder}' has no file '{name}'", folder=folder.name, name="setup.py"))
    try:
        process = subprocess.run(  # noqa: S603 - the learner's own file
            [sys.executable, "-c", _RUNNER],
            cwd=folder,
            capture_output=True,
            timeout=_TIMEOUT_SECONDS,
            check=True,
            text=True,
            encoding="utf-8",
        )
    except subprocess.TimeoutExpired:
        raise NotYet(phrase("setup.py took longer than {seconds:g} s", seconds=_TIMEOUT_SECONDS)) from None
    except subprocess.CalledProcessError as error:
        last = (error.stderr.strip().splitlines() or [""])[-1]
        raise NotYet(phrase("setup.py fails: {error}", error=foreign(last))) from None
    entries = json.loads(process.stdout.splitlines()[-1])
    return {PurePosixPath(place) / Path(name).name: folder / name for place, names in entries for name in names}
