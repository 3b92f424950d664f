"""The packages that a target needs, in the tested versions.

``tools/pack_wheels.py`` creates their table, ``wheels.json``, from ``uv.lock``: the packages that the extras need,
with markers and the names, checksums and sizes of the wheels for all targets. So neither a resolver nor a
network is needed to determine the content of a pack.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from packaging.markers import Marker
from packaging.utils import InvalidWheelFilename, parse_wheel_filename

from linkwright.diagnostics import Diagnostic, LinkwrightError, did_you_mean, joined, phrase
from linkwright.learning.packing.targets import Target

TABLE_FILE = Path(__file__).with_name("wheels.json")
OWN_PACKAGES = ("linkwright-core", "linkwright")
"""The distributions of Linkwright itself, which are not in the table's files."""

Packages = Mapping[str, Mapping[str, Any]]
"""The packages of the table by ``NAME VERSION``, or by the name alone for `OWN_PACKAGES`."""


@dataclass(frozen=True)
class LockedFile:
    """A file in a package index.

    Attributes:
        package: the name of the distribution.
        version: its version.
        name: the name of the file.
        sha256: its checksum.
        size: its size in bytes.
    """

    package: str
    version: str
    name: str
    sha256: str
    size: int

    @property
    def is_wheel(self) -> bool:
        """Whether the file is a wheel; otherwise it is a source distribution."""
        return self.name.endswith(".whl")


@cache
def load_locked_packages() -> Packages:
    """Return the packages in the table ``wheels.json``."""
    packages: Packages = json.loads(TABLE_FILE.read_text(encoding="utf-8"))
    return packages


def list_known_extras(packages: Packages) -> list[str]:
    """Return the extras of Linkwright that the table has packages for."""
    return sorted(packages["linkwright"]["extras"])


def check_extras(extras: Sequence[str], packages: Packages) -> None:
    """Check that extras exist.

    Raises:
        LinkwrightError: LEARN301 if an extra is unknown.
    """
    known = list_known_extras(packages)
    for name in extras:
        if name not in known:
            hint = did_you_mean(name, known) or phrase("choose from {names}", names=joined(known))
            message = phrase("a pack cannot contain the extra '{name}'", name=name)
            raise LinkwrightError(Diagnostic("LEARN301", message, hint=hint))


def find_needed_packages(target: Target, extras: Iterable[str], packages: Packages) -> list[str]:
    """Return the keys of the packages that Linkwright with some extras needs on a target.

    `OWN_PACKAGES` are left out. The result always includes pip, which installs the other packages.
    """
    environment = target.markers
    queue: list[tuple[str, str]] = [("linkwright", ""), *(("linkwright", extra) for extra in extras)]
    queue += [(key, "") for key in packages if key.startswith("pip ")]
    visited = set(queue)
    while queue:
        key, extra = queue.pop()
        package = packages[key]
        edges = package.get("extras", {}).get(extra, ()) if extra else package.get("needs", ())
        for edge in edges:
            if "marker" in edge and not _is_satisfied(edge["marker"], environment):
                continue
            for name in ("", *edge.get("extras", ())):
                if (edge["key"], name) not in visited:
                    visited.add((edge["key"], name))
                    queue.append((edge["key"], name))
    return sorted({key for key, _ in visited} - set(OWN_PACKAGES))


def _is_satisfied(marker: str, environment: dict[str, str]) -> bool:
    return _parse_marker(marker).evaluate(environment)


@cache
def _parse_marker(marker: str) -> Marker:
    return Marker(marker)


def find_needed_files(target: Target, extras: Iterable[str], packages: Packages) -> Iterator[LockedFile]:
    """Yield the files that Linkwright with some extras needs on a target.

    For a package without wheels, this is the source distribution. Packages without a suitable wheel are omitted;
    tests ensure that no such package is needed.
    """
    for key in find_needed_packages(target, extras, packages):
        name, version = key.split(" ")
        files = [LockedFile(name, version, *row) for row in packages[key]["files"]]
        chosen = choose_best_wheel((file.name for file in files if file.is_wheel), target)
        yield from (file for file in files if (file.name == chosen if chosen else not file.is_wheel))


def choose_best_wheel(names: Iterable[str], target: Target) -> str | None:
    """Return the file name of the best wheel for a target, or None if no wheel is suitable.

    Of wheels for the same Python, the best one supports the oldest systems.
    """
    ranked = [(rank, name) for name in names if (rank := rank_wheel(name, target)) is not None]
    return min(ranked)[1] if ranked else None


def rank_wheel(name: str, target: Target) -> int | None:
    """Return the rank of a wheel for a target, 0 for the best; None for an unsuitable wheel."""
    try:
        tags = parse_wheel_filename(name)[3]
    except InvalidWheelFilename:
        return None
    ranks = [target.tag_ranks[tag] for tag in tags if tag in target.tag_ranks]
    return min(ranks, default=None)
