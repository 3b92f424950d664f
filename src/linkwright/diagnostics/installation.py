"""This installation of Linkwright, and the commands that add packages to it.

Installers record the origin in files: ``direct_url.json`` (PEP 610) names the origin of a distribution, and
``pipx_metadata.json`` or ``uv-receipt.toml`` marks an environment of a tool, which recreates the environment when it
installs again.
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
"""The name of the distribution with the engine only."""
PATH_PLACEHOLDER = "PATH_TO_LINKWRIGHT"
"""The placeholder in a command for the path of a checkout or wheel that no longer exists."""


@dataclass(frozen=True)
class Origin:
    """The origin of an installed distribution.

    Attributes:
        location: a path or a URL; empty for a package index.
        editable: whether the distribution runs from the files of the checkout.
        name: the name of the distribution.
    """

    location: str = ""
    editable: bool = False
    name: str = NAME

    @property
    def is_missing(self) -> bool:
        """Whether the origin is a checkout or a file that no longer exists."""
        return bool(self.location) and "://" not in self.location and not Path(self.location).exists()

    def installer_arguments(self, extras: Iterable[str]) -> list[str]:
        """Return the arguments with which an installer installs the distribution with extras."""
        extras_suffix = f"[{','.join(sorted(extras))}]" if extras else ""
        if "://" in self.location:
            return [f"{self.name}{extras_suffix} @ {self.location}"]
        location = PATH_PLACEHOLDER if self.is_missing else self.location or self.name
        if self.location and Path(self.location) == Path.cwd():
            location = "."
        return [*(["-e"] if self.editable else []), f"{location}{extras_suffix}"]


@dataclass(frozen=True)
class Installation:
    """A distribution in its environment.

    Attributes:
        origin: the origin of the distribution.
        tool: the start of the command of pip or uv that installs into the environment; `PIPX` or `UV_TOOL` if the
                environment belongs to pipx or ``uv tool``.
        extras: the extras that the tool was asked to install, and that it would drop if they were not requested again.
        other_packages: other packages that the tool was asked to install, and that it would drop in the same way.
    """

    origin: Origin
    tool: tuple[str, ...]
    extras: frozenset[str] = frozenset()
    other_packages: tuple[str, ...] = ()

    def command_for_extras(self, *extras: str) -> str:
        """Return the command that adds extras to the installation."""
        return self._create_command(self.tool, {*self.extras, *extras}, self.other_packages)

    def command_for_packages(self, *packages: str) -> str:
        """Return the command that adds other packages, by their names for pip."""
        if self.tool == PIPX:
            return _quote_command(["pipx", "inject", self.origin.name, *packages])
        if self.tool == UV_TOOL:
            return self._create_command(self.tool, self.extras, (*self.other_packages, *packages))
        return _quote_command([*self.tool, *packages])

    def _create_command(self, tool: tuple[str, ...], extras: Iterable[str], other_packages: Iterable[str]) -> str:
        others = (argument for name in other_packages for argument in ("--with", name))
        return _quote_command([*tool, *others, *self.origin.installer_arguments(extras)])


PIPX = ("pipx", "install", "--force")
UV_TOOL = ("uv", "tool", "install")
_EXTRAS_PATTERN = lazy_pattern(r"\[([^\]]*)\]")
_UNQUOTED_PATTERN = lazy_pattern(r"[\w@%+=:,./\\-]+")
_UV_CACHE_FOLDERS = ("archive-v", "environments-v")


def find_installation() -> Installation:
    """Return the installation of the running Linkwright."""
    return find_installation_in(Path(sys.prefix), _find_origin())


def find_installation_in(prefix: Path, origin: Origin) -> Installation:
    """Return the installation of Linkwright in an environment.

    Args:
        prefix: the folder of the environment.
        origin: the origin of Linkwright.
    """
    pipx_metadata, receipt = prefix / "pipx_metadata.json", prefix / "uv-receipt.toml"
    if pipx_metadata.is_file():
        requirement = json.loads(pipx_metadata.read_text(encoding="utf-8"))["main_package"]["package_or_url"]
        return Installation(origin, PIPX, _parse_extras(requirement))
    if receipt.is_file():
        toml: Any = import_module("tomllib" if sys.version_info >= (3, 11) else "tomli")
        requirements = toml.loads(receipt.read_text(encoding="utf-8"))["tool"]["requirements"]
        own_requirements = (
            required_package for required_package in requirements if required_package["name"] == origin.name
        )
        other_packages = tuple(
            required_package["name"] for required_package in requirements if required_package["name"] != origin.name
        )
        extras = frozenset(
            extra for required_package in own_requirements for extra in required_package.get("extras", ())
        )
        return Installation(origin, UV_TOOL, extras, other_packages)
    if prefix.parent.name.startswith(_UV_CACHE_FOLDERS):  # uvx created the environment for this run only
        return Installation(origin, UV_TOOL)
    return Installation(origin, _find_pip_command(prefix, origin))


def parse_origin(direct_url: Mapping[str, Any], name: str = NAME) -> Origin:
    """Return the origin of a distribution from the content of its ``direct_url.json``."""
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


def _find_origin() -> Origin:
    for name in (NAME, ENGINE):
        with suppress(metadata.PackageNotFoundError):
            direct_url = metadata.distribution(name).read_text("direct_url.json")
            return parse_origin(json.loads(direct_url), name) if direct_url else Origin(name=name)
    checkout = Path(__file__).parents[3]  # Linkwright runs from a folder without being installed
    return Origin(str(checkout), editable=True) if (checkout / "pyproject.toml").is_file() else Origin()


def _find_pip_command(prefix: Path, origin: Origin) -> tuple[str, ...]:
    """Return the start of the command for installing into an environment that no tool manages."""
    if find_spec("pip"):
        pip_path = shutil.which("pip")
        is_on_path = pip_path is not None and Path(pip_path).parent == Path(sys.executable).parent
        return ("pip", "install") if is_on_path else (sys.executable, "-m", "pip", "install")
    checkout_uv = Path(origin.location, ".build", "uv", "bin", "uv")  # installed by the Makefile
    uv = str(checkout_uv) if shutil.which("uv") is None and checkout_uv.is_file() else "uv"
    is_active = os.environ.get("VIRTUAL_ENV", "") == str(prefix)
    return (uv, "pip", "install", *(() if is_active else ("--python", str(prefix))))


def _parse_extras(requirement: str) -> frozenset[str]:
    match = _EXTRAS_PATTERN.search(requirement)
    return frozenset(match[1].replace(" ", "").split(",")) if match else frozenset()


def _quote_command(words: list[str]) -> str:
    """Quote a command line for the user's shell.

    Windows gets double quotes, because cmd has no others.
    """
    if sys.platform == "win32":
        return " ".join(word if _UNQUOTED_PATTERN.fullmatch(word) else f'"{word}"' for word in words)
    return shlex.join(words)
