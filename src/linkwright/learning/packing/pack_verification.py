"""Verify a pack: the checksums of its files, and whether each target can be installed.

The check reads the requirements in the wheels themselves and evaluates their markers for each target. It does not use
the table from which the pack was built.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from packaging.requirements import Requirement
from packaging.specifiers import SpecifierSet
from packaging.utils import NormalizedName, canonicalize_name, parse_wheel_filename
from packaging.version import Version

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, phrase
from linkwright.learning.packing.locked_files import rank_wheel
from linkwright.learning.packing.pack_folder import PackFolder, PackSettings, compute_sha256
from linkwright.learning.packing.targets import Target
from linkwright.learning.packing.wheel_metadata import read_metadata

_PINNED_REQUIREMENT = re.compile(r"([A-Za-z0-9._-]+)(?:\[[^\]]*\])?==(\S+) --hash=sha256:([0-9a-f]{64})")


@dataclass(frozen=True)
class _Wheel:
    """The metadata of a wheel that the check needs."""

    name: NormalizedName
    version: Version
    file: str
    requirements: tuple[Requirement, ...]
    extras: frozenset[str]
    pythons: SpecifierSet


@dataclass
class _PackedWheels:
    """The wheels of a pack, by the checksums that requirements name."""

    folder: Path
    sums: Mapping[str, str]
    _read: dict[str, _Wheel] = field(default_factory=dict)

    def find(self, digest: str) -> _Wheel | None:
        """Return the wheel with a checksum.

        Raises:
            LinkwrightError: LEARN305 if it is not a wheel.
        """
        file = self.sums.get(digest)
        if file is None:
            return None
        if digest not in self._read:
            metadata = read_metadata(self.folder / file)
            name, version, _, _ = parse_wheel_filename(file)
            requirements = tuple(map(Requirement, metadata.get_all("Requires-Dist") or ()))
            pythons = SpecifierSet(metadata.get("Requires-Python") or "")
            extras = frozenset(map(canonicalize_name, metadata.get_all("Provides-Extra") or ()))
            self._read[digest] = _Wheel(name, version, file, requirements, extras, pythons)
        return self._read[digest]


def check_pack(folder: PackFolder, progress: Callable[[int, int], None]) -> list[Diagnostic]:
    """Verify a pack, and return its problems.

    Args:
        folder: the pack.
        progress: called with the number of bytes read so far and the total number of bytes.

    Raises:
        LinkwrightError: LEARN307 if the folder is not a pack, or LEARN305 if the pack is not complete.
    """
    settings, sums = folder.read_settings(), folder.read_sums()
    problems = list(_find_file_problems(folder, sums, progress))
    if not problems:
        by_digest = {digest: Path(file).name for file, digest in sums.items() if file.startswith("wheels/")}
        wheels = _PackedWheels(folder.wheels, by_digest)
        for target in settings.targets:
            problems += _find_target_problems(folder, settings, target, wheels)
    return problems


def _find_file_problems(
    folder: PackFolder, sums: Mapping[str, str], progress: Callable[[int, int], None]
) -> Iterator[Diagnostic]:
    sizes = {file: _get_size(folder.path / file) for file in sums}
    total, done = sum(sizes.values()), 0
    for file, digest in sums.items():
        try:
            actual = compute_sha256(folder.path / file)
        except OSError as error:
            reason = error.strerror or str(error)
            yield _damaged_pack_problem(phrase("'{file}' cannot be read: {reason}", file=file, reason=reason))
            continue
        if actual != digest:
            yield _damaged_pack_problem(phrase("'{file}' is damaged or was changed", file=file))
        done += sizes[file]
        progress(done, total)


def _get_size(path: Path) -> int:
    try:
        return path.stat().st_size
    except OSError:
        return 0


def _damaged_pack_problem(message: Phrase) -> Diagnostic:
    return Diagnostic(
        "LEARN305", message, hint=phrase("repeat `linkwright learn pack FOLDER`, which replaces the file")
    )


def _find_target_problems(
    folder: PackFolder, settings: PackSettings, target: Target, wheels: _PackedWheels
) -> Iterator[Diagnostic]:
    """Yield the problems that prevent an installation on a target."""
    try:
        text = folder.requirements(target).read_text(encoding="utf-8")
    except OSError:
        yield _unsuitable_wheel_problem(phrase("{target}: its list of packages is missing", target=target.label))
        return
    pinned: dict[NormalizedName, _Wheel] = {}
    for name, version, digest in _PINNED_REQUIREMENT.findall(text):
        try:
            wheel = wheels.find(digest)
        except LinkwrightError as error:
            yield from error.diagnostics
            continue
        if wheel is None or (wheel.name, str(wheel.version)) != (canonicalize_name(name), version):
            yield _unsuitable_wheel_problem(
                phrase(
                    "{target}: the pack has no wheel of {name} {version}",
                    target=target.label,
                    name=name,
                    version=version,
                )
            )
        elif rank_wheel(wheel.file, target) is None or not wheel.pythons.contains(f"{target.python}.99"):
            yield _unsuitable_wheel_problem(
                phrase(
                    "{target}: the wheel '{file}' is not compatible with this Python or platform",
                    target=target.label,
                    file=wheel.file,
                )
            )
        else:
            pinned[wheel.name] = wheel
    yield from _find_missing_requirements(settings, target, pinned)


def _find_missing_requirements(
    settings: PackSettings, target: Target, pinned: Mapping[NormalizedName, _Wheel]
) -> Iterator[Diagnostic]:
    """Yield the direct and indirect requirements of Linkwright that no wheel satisfies."""
    root = Requirement(f"linkwright[{','.join(settings.extras)}]" if settings.extras else "linkwright")
    queue: list[tuple[Requirement, str]] = [(root, "pack.json")]
    visited: set[tuple[str, str]] = set()
    while queue:
        requirement, dependent = queue.pop()
        name = canonicalize_name(requirement.name)
        wheel = pinned.get(name)
        if wheel is None or not requirement.specifier.contains(wheel.version, prereleases=True):
            yield _unsuitable_wheel_problem(
                phrase(
                    "{target}: no wheel for '{requirement}', which {dependent} needs",
                    target=target.label,
                    requirement=str(requirement),
                    dependent=dependent,
                )
            )
            continue
        for unknown in set(map(canonicalize_name, requirement.extras)) - wheel.extras:
            yield _unsuitable_wheel_problem(phrase("'{file}' has no extra '{extra}'", file=wheel.file, extra=unknown))
        for extra in {"", *requirement.extras} - {extra for key, extra in visited if key == name}:
            visited.add((name, extra))
            queue += [(needed, wheel.file) for needed in wheel.requirements if _does_apply(needed, extra, target)]


def _does_apply(requirement: Requirement, extra: str, target: Target) -> bool:
    """Return whether a requirement applies on a target.

    `extra` is the requested extra; empty for none.
    """
    if requirement.marker is None:
        return not extra
    if not extra:
        return requirement.marker.evaluate(target.markers)
    return requirement.marker.evaluate({**target.markers, "extra": extra})


def _unsuitable_wheel_problem(message: Phrase) -> Diagnostic:
    return Diagnostic("LEARN306", message)
