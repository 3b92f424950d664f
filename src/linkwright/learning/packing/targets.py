"""The systems and Pythons that packs support, with wheel tags and environment markers."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache, cached_property

from packaging.tags import Tag, compatible_tags, cpython_tags, mac_platforms

from linkwright.diagnostics import Diagnostic, LinkwrightError, did_you_mean, joined, phrase

PYTHONS = ("3.10", "3.11", "3.12", "3.13", "3.14")
"""The versions of Python that a pack can be made for, oldest first."""

_GLIBC_MINORS = range(28, 4, -1)
"""The minor versions of glibc 2 whose wheels fit. Debian 10, Ubuntu 20.04 and RHEL 8 have 2.28 or newer."""
_NEWEST_MACOS = (15, 0)
"""The newest macOS whose wheels fit. Of several wheels, the one for the oldest macOS is chosen."""
_PLATFORM_ALIASES = {5: "manylinux1", 12: "manylinux2010", 17: "manylinux2014"}
"""The older names of platforms by the minor version of glibc."""
_LATEST_PATCH = "99"
"""The patch release that markers see. Requirements for older ones are for Pythons that have been fixed since."""


@dataclass(frozen=True)
class System:
    """An operating system on a kind of processor.

    Attributes:
        label: the name in texts for users.
        platform: ``sys.platform``.
        machine: ``platform.machine()``.
        platform_system: ``platform.system()``.
    """

    label: str
    platform: str
    machine: str
    platform_system: str

    @property
    def platforms(self) -> list[str]:
        """The platform tags of suitable wheels, from the newest system to the oldest."""
        if self.platform == "win32":
            return ["win_amd64"]
        if self.platform == "darwin":
            return list(mac_platforms(_NEWEST_MACOS, self.machine))
        names: list[str] = []
        for minor in _GLIBC_MINORS:
            names += [f"manylinux_2_{minor}_{self.machine}"]
            names += [f"{_PLATFORM_ALIASES[minor]}_{self.machine}"] if minor in _PLATFORM_ALIASES else []
        return names


SYSTEMS = {
    "windows": System("Windows", "win32", "AMD64", "Windows"),
    "macos-arm64": System("macOS Apple silicon", "darwin", "arm64", "Darwin"),
    "macos-x86_64": System("macOS Intel", "darwin", "x86_64", "Darwin"),
    "linux-x86_64": System("Linux x86-64", "linux", "x86_64", "Linux"),
    "linux-aarch64": System("Linux ARM64", "linux", "aarch64", "Linux"),
}


@dataclass(frozen=True)
class Target:
    """A system with a version of Python.

    Attributes:
        system: a key of `SYSTEMS`.
        python: one of `PYTHONS`.
    """

    system: str
    python: str

    @property
    def name(self) -> str:
        """The name in the files of a pack, such as ``linux-x86_64-py3.12``."""
        return f"{self.system}-py{self.python}"

    @property
    def label(self) -> str:
        """The name in texts for users."""
        return f"{SYSTEMS[self.system].label}, Python {self.python}"

    @cached_property
    def tag_ranks(self) -> dict[Tag, int]:
        """The ranks of the tags of suitable wheels; lower is better."""
        return {tag: rank for rank, tag in enumerate(_list_tags(self.system, self.python))}

    @property
    def markers(self) -> dict[str, str]:
        """The environment for requirement markers (PEP 508), without an extra."""
        system = SYSTEMS[self.system]
        return {
            "extra": "",
            "implementation_name": "cpython",
            "implementation_version": f"{self.python}.{_LATEST_PATCH}",
            "os_name": "nt" if system.platform == "win32" else "posix",
            "platform_machine": system.machine,
            "platform_python_implementation": "CPython",
            "platform_release": "",
            "platform_system": system.platform_system,
            "platform_version": "",
            "python_full_version": f"{self.python}.{_LATEST_PATCH}",
            "python_version": self.python,
            "sys_platform": system.platform,
        }


@cache
def _list_tags(system: str, python: str) -> tuple[Tag, ...]:
    """Return the suitable tags.

    For each interpreter and ABI, tags of the oldest systems come first.
    """
    version = [int(part) for part in python.split(".")]
    platforms = SYSTEMS[system].platforms[::-1]
    interpreter = f"cp{''.join(python.split('.'))}"
    return (
        *cpython_tags(version, platforms=platforms),
        *compatible_tags(version, interpreter=interpreter, platforms=platforms),
    )


def select_targets(systems: Sequence[str], pythons: Sequence[str]) -> list[Target]:
    """Return the targets with the named systems and Pythons; an empty list selects all.

    Raises:
        LinkwrightError: LEARN301 if a name is unknown.
    """
    _check_names("systems", systems, SYSTEMS)
    _check_names("Pythons", pythons, PYTHONS)
    return list(_iterate_targets(systems or list(SYSTEMS), pythons or PYTHONS))


def _iterate_targets(systems: Sequence[str], pythons: Sequence[str]) -> Iterator[Target]:
    for system in SYSTEMS:
        if system in systems:
            yield from (Target(system, python) for python in PYTHONS if python in pythons)


def _check_names(kind: str, names: Sequence[str], known_names: Sequence[str] | dict[str, System]) -> None:
    unknown = [name for name in names if name not in known_names]
    if not unknown:
        return
    name = unknown[0]
    message = (
        phrase("a pack cannot be made for the system '{name}'", name=name)
        if kind == "systems"
        else phrase("a pack cannot be made for Python '{name}'", name=name)
    )
    hint = did_you_mean(name, known_names) or phrase("choose from {names}", names=joined(known_names))
    raise LinkwrightError(Diagnostic("LEARN301", message, hint=hint))
