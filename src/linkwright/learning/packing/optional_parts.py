"""The parts of Linkwright whose packages some systems do not have."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from linkwright.diagnostics import Phrase, phrase
from linkwright.diagnostics.translation import LANGUAGES, translate_phrase
from linkwright.learning.packing.locked_files import Packages, needed_packages
from linkwright.learning.packing.targets import Target, select_targets


@dataclass(frozen=True)
class OptionalPart:
    """A part that works without its package in a lesser way, or not at all.

    Attributes:
        packages: the packages; one of them is enough.
        purpose: what a learner does not have without them.
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


def missing_parts(target: Target, extras: Iterable[str], packages: Packages) -> Iterator[OptionalPart]:
    """Yield the parts of some extras that have no package on a target."""
    chosen = tuple(extras)
    here = package_names(target, chosen, packages)
    anywhere = set().union(*(package_names(other, chosen, packages) for other in select_targets((), ())))
    for part in PARTS:
        if anywhere.intersection(part.packages) and not here.intersection(part.packages):
            yield part


def missing_texts(
    targets: Iterable[Target], extras: Iterable[str], packages: Packages
) -> dict[str, dict[str, list[str]]]:
    """Return what each target lacks, by its name and by language, without targets that lack nothing."""
    chosen = tuple(extras)
    texts = {}
    for target in targets:
        if parts := list(missing_parts(target, chosen, packages)):
            texts[target.name] = {
                language: [translate_phrase(part.purpose, language) for part in parts] for language in LANGUAGES
            }
    return texts


def package_names(target: Target, extras: Iterable[str], packages: Packages) -> set[str]:
    """Return the names of the packages that a target needs."""
    return {key.partition(" ")[0] for key in needed_packages(target, extras, packages)}
