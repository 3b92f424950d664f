"""The parts of Linkwright whose packages are not available on all systems."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from linkwright.diagnostics import Phrase, phrase
from linkwright.diagnostics.translation import LANGUAGES, translate_phrase
from linkwright.learning.packing.locked_files import Packages, find_needed_packages
from linkwright.learning.packing.targets import Target, select_targets


@dataclass(frozen=True)
class OptionalPart:
    """A part that works with limitations, or not at all, without its package.

    Attributes:
        packages: the packages, one of which is sufficient.
        purpose: the feature that is missing without the packages.
    """

    packages: tuple[str, ...]
    purpose: Phrase


PARTS = (
    OptionalPart(("cyclonedds",), phrase("DDS: processes communicate over Zenoh (RMW_IMPLEMENTATION=rmw_zenoh_cpp)")),
    OptionalPart(("mujoco", "mujoco-core"), phrase("simulation of worlds")),
    OptionalPart(("embreex",), phrase("fast laser scans: they are computed without embreex")),
    OptionalPart(("onnxruntime",), phrase("trained detectors and speech networks (ONNX)")),
    OptionalPart(("pocketsphinx",), phrase("the speech engine pocketsphinx")),
)
"""The parts in the order in which a course needs them."""


def find_missing_parts(target: Target, extras: Iterable[str], packages: Packages) -> Iterator[OptionalPart]:
    """Yield the parts of some extras whose packages are not available on a target."""
    chosen = tuple(extras)
    selected_packages = list_package_names(target, chosen, packages)
    anywhere = set().union(*(list_package_names(other, chosen, packages) for other in select_targets((), ())))
    for part in PARTS:
        if anywhere.intersection(part.packages) and not selected_packages.intersection(part.packages):
            yield part


def describe_missing_parts(
    targets: Iterable[Target], extras: Iterable[str], packages: Packages
) -> dict[str, dict[str, list[str]]]:
    """Return the missing features by target and language, without targets that lack none."""
    chosen = tuple(extras)
    texts = {}
    for target in targets:
        if parts := list(find_missing_parts(target, chosen, packages)):
            texts[target.name] = {
                language: [translate_phrase(part.purpose, language) for part in parts] for language in LANGUAGES
            }
    return texts


def list_package_names(target: Target, extras: Iterable[str], packages: Packages) -> set[str]:
    """Return the names of the packages that a target needs."""
    return {key.partition(" ")[0] for key in find_needed_packages(target, extras, packages)}
