"""How this Linkwright was installed, and the commands that add packages to it.

Installers record this: ``direct_url.json`` (PEP 610) names the origin of a distribution, and ``pipx_metadata.json`` or
``uv-receipt.toml`` marks an environment that belongs to a tool, which recreates the environment when it installs again.
"""

from __future__ import annotations

import json
import os
import shlex
import shutil
import sys
from collections.abc import Iterable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from importlib import import_module, metadata
from importlib.util import find_spec
from pathlib import Path
from urllib.parse import urlsplit
from urllib.request import url2pathname

from linkwright.loading.deferred import lazy_pattern
from linkwright.loading.lean_typing import Any

NAME = "linkwright"
ENGINE = "linkwright-core"
"""The distribution of the engine alone."""
SOMEWHERE = "PATH_TO_LINKWRIGHT"
"""A placeholder in a command for a checkout or wheel that no longer exists."""


@dataclass(frozen=True)
class Origin:
    """The origin of a distribution.

    Attributes:
        place: a path or a URL; empty for a package index.
        editable: whether the distribution runs from the files of the checkout.
        name: the name of the distribution.
    """

    place: str = ""
    editable: bool = False
    name: str = NAME

    @property
    def is_gone(self) -> bool:
        """Whether the origin is a checkout or a file that no longer exists."""
        return bool(self.place) and "://" not in self.place and not Path(self.place).exists()

    def words(self, extras: Iterable[str]) -> list[str]:
        """Return the installer's arguments that install the distribution with extras."""
        wanted = f"[{','.join(sorted(extras))}]" if extras else ""
        if "://" in self.place:
            return [f"{self.name}{wanted} @ {self.place}"]
        place = SOMEWHERE if self.is_gone else self.place or self.name
        if self.place and Path(self.place) == Path.cwd():
            place = "."
        return [*(["-e"] if self.editable else []), f"{place}{wanted}"]


@dataclass(frozen=True)
class Installation:
    """A distribution in an environment.

    Attributes:
        origin: the origin of the distribution.
        tool: the words of pip or uv that install into the environment; `PIPX` or `UV_TOOL` if it belongs to such a
            tool.
        extras: the extras that the tool was asked to install, and that it would drop if they were not requested again.
        beside: other packages that the tool was asked to install, and that it would drop in the same way.
    """

    origin: Origin
    tool: tuple[str, ...]
    extras: frozenset[str] = frozenset()
    other_packages: tuple[str, ...] = ()

    def command_for_extras(self, *extras: str) -> str:
        """Return the command that adds extras of Linkwright."""
        return self._command(self.tool, {*self.extras, *extras}, self.other_packages)

    def command_for_packages(self, *packages: str) -> str:
        """Return the command that adds other packages, which are given by their names for pip."""
        if self.tool == PIPX:
            return _quoted(["pipx", "inject", self.origin.name, *packages])
        if self.tool == UV_TOOL:
            return self._command(self.tool, self.extras, (*self.other_packages, *packages))
        return _quoted([*self.tool, *packages])

    def _command(self, tool: tuple[str, ...], extras: Iterable[str], beside: Iterable[str]) -> str:
        return _quoted([*tool, *(word for name in beside for word in ("--with", name)), *self.origin.words(extras)])


PIPX = ("pipx", "install", "--force")
UV_TOOL = ("uv", "tool", "install")
_EXTRAS = lazy_pattern(r"\[([^\]]*)\]")
_PLAIN = lazy_pattern(r"[\w@%+=:,./\\-]+")
_CACHE_OF_UV = ("archive-v", "environments-v")


def find_installation() -> Installation:
    """Return how the running Linkwright was installed."""
    return installation_in(Path(sys.prefix), _origin())


def installation_in(prefix: Path, origin: Origin) -> Installation:
    """Return the installation in an environment.

    Args:
        prefix: the environment's folder.
        origin: the origin of Linkwright.
    """
    pipx, receipt = prefix / "pipx_metadata.json", prefix / "uv-receipt.toml"
    if pipx.is_file():
        asked = json.loads(pipx.read_text(encoding="utf-8"))["main_package"]["package_or_url"]
        return Installation(origin, PIPX, _extras_in(asked))
    if receipt.is_file():
        toml: Any = import_module("tomllib" if sys.version_info >= (3, 11) else "tomli")
        requirements = toml.loads(receipt.read_text(encoding="utf-8"))["tool"]["requirements"]
        own = (asked for asked in requirements if asked["name"] == origin.name)
        others = tuple(asked["name"] for asked in requirements if asked["name"] != origin.name)
        extras = frozenset(extra for asked in own for extra in asked.get("extras", ()))
        return Installation(origin, UV_TOOL, extras, others)
    if prefix.parent.name.startswith(_CACHE_OF_UV):  # uvx created the environment for this run only
        return Installation(origin, UV_TOOL)
    return Installation(origin, _pip(prefix, origin))


def origin_of(direct_url: Mapping[str, Any], name: str = NAME) -> Origin:
    """Return the origin of a distribution, given its ``direct_url.json``."""
    url = direct_url["url"]
    if version_control := direct_url.get("vcs_info"):
        revision = version_control.get("requested_revision")
        folder = direct_url.get("subdirectory")
        return Origin(
            f"{version_control['vcs']}+{url}{f'@{revision}' if revision else ''}"
            f"{f'#subdirectory={folder}' if folder else ''}",
            name=name,
        )
    if url.startswith("file:"):
        path = url2pathname(urlsplit(url).path)
        return Origin(path, bool(direct_url.get("dir_info", {}).get("editable")), name)
    return Origin(url, name=name)


def _origin() -> Origin:
    for name in (NAME, ENGINE):
        with suppress(metadata.PackageNotFoundError):
            direct_url = metadata.distribution(name).read_text("direct_url.json")
            return origin_of(json.loads(direct_url), name) if direct_url else Origin(name=name)
    checkout = Path(__file__).parents[3]  # Linkwright runs from a folder without being installed
    return Origin(str(checkout), editable=True) if (checkout / "pyproject.toml").is_file() else Origin()


def _pip(prefix: Path, origin: Origin) -> tuple[str, ...]:
    """Return the command that installs into an environment that does not belong to a tool."""
    if find_spec("pip"):
        found = shutil.which("pip")
        in_reach = found is not None and Path(found).parent == Path(sys.executable).parent
        return ("pip", "install") if in_reach else (sys.executable, "-m", "pip", "install")
    own = Path(origin.place, ".build", "uv", "bin", "uv")  # installed by the Makefile
    uv = str(own) if shutil.which("uv") is None and own.is_file() else "uv"
    active = os.environ.get("VIRTUAL_ENV", "") == str(prefix)
    return (uv, "pip", "install", *(() if active else ("--python", str(prefix))))


def _extras_in(requirement: str) -> frozenset[str]:
    found = _EXTRAS.search(requirement)
    return frozenset(found[1].replace(" ", "").split(",")) if found else frozenset()


def _quoted(words: list[str]) -> str:
    """Return a command line for the user's shell; the shell of Windows has only double quotes."""
    if sys.platform == "win32":
        return " ".join(word if _PLAIN.fullmatch(word) else f'"{word}"' for word in words)
    return shlex.join(words)
