"""Runs of pip that download wheels for any system, and build wheels of pure Python.

pip uses the package index of the user's configuration. Each file is requested with its checksum, so that pip accepts
no other file.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from importlib.util import find_spec
from pathlib import Path

from packaging.utils import parse_wheel_filename

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, foreign, joined, phrase
from linkwright.learning.packing.locked_files import LockedFile
from linkwright.learning.packing.targets import SYSTEMS, Target

_DRAFT_FOLDER = ".download"
"""The folder in a folder of wheels in which pip writes."""
_COLOR_CODE = re.compile(r"\x1b\[[0-9;]*m")
_END_OF_BUILD = "[end of output]"
_PIP_OPTIONS = ("--disable-pip-version-check", "--no-input", "--progress-bar", "off")
_PINNED_VARIABLE = "LINKWRIGHT_PINNED_CORE"
"""The environment variable with which `hatch_build.py` makes wheels as in a release."""


def download_wheels(files: Sequence[LockedFile], target: Target, wheels: Path) -> None:
    """Download wheels that fit a target into a folder.

    Raises:
        LinkwrightError: LEARN303 if pip fails.
        OSError: the folder cannot be written.
    """
    platforms = {tag.platform for file in files for tag in parse_wheel_filename(file.name)[3]} - {"any"}
    arguments = ["download", "--no-deps", "--only-binary=:all:", "--require-hashes", "--implementation", "cp"]
    arguments += ["--python-version", target.python]
    for platform in sorted(platforms) or SYSTEMS[target.system].platforms[:1]:
        arguments += ["--platform", platform]
    with _create_draft_folder(wheels) as drafts:
        _write_requirements(files, drafts)
        _run_pip(
            [*arguments, "--dest", str(drafts), "-r", str(drafts / "requirements.txt")], [file.name for file in files]
        )
        for file in files:
            (drafts / file.name).replace(wheels / file.name)


def build_wheel(file: LockedFile, wheels: Path) -> Path:
    """Build the wheel of a source distribution in a folder, and return the wheel.

    Raises:
        LinkwrightError: LEARN303 if pip fails, or the wheel is for this system only.
        OSError: the folder cannot be written.
    """
    with _create_draft_folder(wheels) as drafts:
        _write_requirements([file], drafts)
        arguments = ["wheel", "--no-deps", "--require-hashes", "--wheel-dir", str(drafts)]
        _run_pip([*arguments, "-r", str(drafts / "requirements.txt")], [file.name])
        (wheel,) = drafts.glob("*.whl")
        if not is_for_all_systems(wheel.name):
            message = phrase("the wheel that was built from '{file}' works only on this system", file=file.name)
            raise LinkwrightError(Diagnostic("LEARN303", message))
        return wheel.replace(wheels / wheel.name)


def build_checkout(checkout: Path, wheels: Path) -> list[Path]:
    """Build and return the wheels of a checkout of Linkwright, as for a release.

    Raises:
        LinkwrightError: LEARN303 if pip fails.
        OSError: the folder cannot be written.
    """
    with _create_draft_folder(wheels) as drafts:
        arguments = ["wheel", "--no-deps", "--wheel-dir", str(drafts), str(checkout / "core"), str(checkout)]
        _run_pip(arguments, [str(checkout)], {_PINNED_VARIABLE: "1"})
        return [wheel.replace(wheels / wheel.name) for wheel in sorted(drafts.glob("*.whl"))]


def is_for_all_systems(name: str) -> bool:
    """Return whether a wheel contains only Python, for any system and all versions of Python 3."""
    return any((tag.abi, tag.platform) == ("none", "any") for tag in parse_wheel_filename(name)[3])


@contextmanager
def _create_draft_folder(wheels: Path) -> Iterator[Path]:
    """Yield an empty folder, so that an interruption leaves no partial file among the wheels."""
    drafts = wheels / _DRAFT_FOLDER
    shutil.rmtree(drafts, ignore_errors=True)
    drafts.mkdir(parents=True)
    try:
        yield drafts
    finally:
        shutil.rmtree(drafts, ignore_errors=True)


def _write_requirements(files: Iterable[LockedFile], folder: Path) -> None:
    lines = [f"{file.package}=={file.version} --hash=sha256:{file.sha256}\n" for file in files]
    (folder / "requirements.txt").write_text("".join(lines), encoding="utf-8")


def _run_pip(
    arguments: Sequence[str], requested_names: Sequence[str], variables: Mapping[str, str] | None = None
) -> None:
    command = [*_find_pip_command(), arguments[0], *_PIP_OPTIONS, *arguments[1:]]
    environment = {**os.environ, **(variables or {}), "PIP_REQUIRE_VIRTUALENV": "0"}
    done = subprocess.run(  # noqa: S603 - pip, with Linkwright's own arguments
        command,
        env=environment,
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        encoding="utf-8",
        errors="replace",
        check=False,
    )
    if done.returncode:
        message = phrase(
            "pip cannot download or build {files}: {reason}",
            files=_join_first_names(requested_names),
            reason=foreign(_find_reason(done.stderr)),
        )
        hint = phrase("repeat the command to continue; it keeps the files that the pack has")
        raise LinkwrightError(Diagnostic("LEARN303", message, hint=hint))


def _join_first_names(names: Sequence[str]) -> Phrase:
    """Return a phrase that lists the first of some names, and counts the others."""
    if len(names) <= 3:
        return joined(names)
    return phrase("{names} and {count} others", names=joined(names[:2]), count=len(names) - 2)


def _find_reason(output: str) -> str:
    """Return the line of pip's output that contains the reason."""
    lines = [line.strip() for line in _COLOR_CODE.sub("", output).splitlines() if line.strip()]
    if _END_OF_BUILD in lines:  # the last line of a program that pip ran is its exception
        return lines[max(lines.index(_END_OF_BUILD) - 1, 0)]
    broken_connections = [line for line in lines if "connection broken" in line]
    errors = [line for line in lines if line.startswith("ERROR:")]
    return re.sub(r"^(ERROR|WARNING): ", "", (broken_connections[-1:] or errors or lines or ["pip"])[0])


def _find_pip_command() -> list[str]:
    if find_spec("pip") is not None:
        return [sys.executable, "-m", "pip"]
    if pip := shutil.which("pip") or shutil.which("pip3"):
        return [pip]
    hint = phrase("run `{command}`", command=f"{sys.executable} -m ensurepip")
    raise LinkwrightError(Diagnostic("LEARN303", phrase("pip is not installed"), hint=hint))
