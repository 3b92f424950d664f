"""The wheel of this checkout, installed into empty environments as users do it."""

from __future__ import annotations

import fcntl
import os
import shutil
import subprocess
import sys
from pathlib import Path

from tests.places import REPOSITORY

_CONSTRAINTS = REPOSITORY / ".build" / "constraints.txt"


def install(folder: Path, *packages: str, extra: str = "all", project: Path = REPOSITORY) -> Path:
    """Create an environment with the wheel and other packages.

    All workers of a test run share it.

    Args:
        folder: a folder that the workers share, for ``wheel/`` and ``environment/``.
        others: other packages to install, such as ``pytest``.
        extra: the extra of the wheel; none if empty.
        project: the folder whose wheel is built.

    Returns:
        The environment's folder, whose ``bin`` has ``linkwright``.
    """
    folder.mkdir(exist_ok=True)
    environment = folder / "environment"
    with (folder / "lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not (folder / "done").exists():
            _uv("build", "--wheel", "--out-dir", str(folder / "wheel"), str(project))
            _uv("venv", "--clear", "--python", sys.executable, str(environment))
            (wheel,) = (folder / "wheel").glob("*.whl")
            python = ("--python", str(environment), "--constraints", str(_CONSTRAINTS))
            _uv("pip", "install", *python, f"{wheel}[{extra}]" if extra else str(wheel), *packages)
            (folder / "done").touch()
    return environment


def _uv(*words: str) -> None:
    uv = Path(shutil.which(os.environ.get("UV") or "uv") or REPOSITORY / ".build" / "uv" / "bin" / "uv").absolute()
    result = subprocess.run([uv, *words, "--quiet"], capture_output=True, text=True, check=False, cwd="/")
    assert result.returncode == 0, f"uv {' '.join(words)}:\n{result.stdout}{result.stderr}"
