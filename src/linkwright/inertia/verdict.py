"""Verdicts on the ``<inertial>`` of a link, from a comparison with its shapes."""

from __future__ import annotations

from enum import Enum
from math import inf, log

import numpy as np

from linkwright.diagnostics import Phrase, joined, phrase
from linkwright.geometry.mass import MassProperties
from linkwright.geometry.validity import MAX_DENSITY, MIN_DENSITY, find_problems
from linkwright.inertia.comparison import Comparison, compare
from linkwright.inertia.estimation import Estimate
from linkwright.loading.lean_dataclasses import dataclass
from linkwright.urdf import Link, Mesh
from linkwright.urdf.bodies import Bodies

_DOUBTFUL_RATIO = 10.0
_ROUGH_RATIO = 2.0
"""The thresholds for doubtful and for rough moments, as ratios to the moments of a solid with the same shapes."""

_DOUBTFUL_DISTANCE_RATIO = 0.5
_ROUGH_DISTANCE_RATIO = 0.1
"""The thresholds for doubtful and for rough centers of mass, as distances in fractions of the diagonal."""


class Grade(Enum):
    """The grades of an ``<inertial>``, the worst first."""

    IMPOSSIBLE = "impossible"
    DOUBTFUL = "doubtful"
    MISSING = "missing"
    ROUGH = "rough"
    FITS = "fits"
    UNJUDGED = "unjudged"


_GRADE_ORDER = tuple(Grade)


@dataclass(frozen=True, slots=True)
class Verdict:
    """The verdict on a link's ``<inertial>``.

    Attributes:
        grade: the grade.
        reason: the reason, as a clause.
        error_size: the size of the error; comparable between verdicts with the same grade.
        file_properties: the values of the file, in the link frame; None if they are missing or unusable.
        density: the density of the link's shapes with the file's mass, in kg/m3; None if it is unknown.
        comparison: the comparison of the file with the shapes; None if there is nothing to compare.
    """

    grade: Grade
    reason: Phrase
    error_size: float = 0.0
    file_properties: MassProperties | None = None
    density: float | None = None
    comparison: Comparison | None = None

    @property
    def sort_key(self) -> tuple[int, float]:
        """The sort key that puts the worst verdict first."""
        return _GRADE_ORDER.index(self.grade), -self.error_size


@dataclass(frozen=True, slots=True)
class _Reason:
    """A problem of an ``<inertial>``, with its grade."""

    grade: Grade
    text: Phrase
    error_size: float = 0.0


def assess(link: Link, estimate: Estimate, bodies: Bodies) -> Verdict:
    """Return the verdict on a link's ``<inertial>``.

    Args:
        link: the link.
        estimate: the estimate from the link's shapes.
        bodies: the robot's links grouped by fixed joints; a link's mass may represent links without a mass.
    """
    if link.inertial is None:
        return _assess_without_inertial(link, bodies)
    if not link.inertial.is_computable:
        return Verdict(Grade.IMPOSSIBLE, phrase("its numbers are out of range"))
    file_properties = link.inertial.properties
    shapes = link.collisions if estimate.kind == "collision" else link.visuals
    comparison = None if estimate.properties is None else compare(file_properties, estimate.properties)
    computed = (
        estimate.properties if estimate.shapes == len(shapes) else None
    )  # A part of the shapes is not conclusive.
    is_alone = not bodies.includes_massless_links(link)
    reasons = [_Reason(Grade.IMPOSSIBLE, words) for words in find_problems(file_properties)]
    density = None
    if is_alone and computed is not None and comparison is not None:
        if file_properties.mass > 0:
            density = file_properties.mass / computed.mass * estimate.density
            reasons += _find_density_reasons(
                density, has_mesh=any(isinstance(shape.geometry, Mesh) for shape in shapes)
            )
        reasons += _find_comparison_reasons(comparison, computed)
    if reasons:
        worst_grade = min(reasons, key=lambda reason: _GRADE_ORDER.index(reason.grade)).grade
        worst_reasons = [reason for reason in reasons if reason.grade is worst_grade]
        words, error_size = (
            joined([reason.text for reason in worst_reasons], "; "),
            max(reason.error_size for reason in worst_reasons),
        )
        return Verdict(worst_grade, words, error_size, file_properties, density, comparison)
    if computed is None:
        return Verdict(Grade.UNJUDGED, phrase("there is no shape to compare with"), 0.0, file_properties)
    if not is_alone:
        words = phrase("its mass includes links that are fixed to it")
        return Verdict(Grade.UNJUDGED, words, 0.0, file_properties, None, comparison)
    return Verdict(Grade.FITS, phrase("it matches its shapes"), 0.0, file_properties, density, comparison)


def _assess_without_inertial(link: Link, bodies: Bodies) -> Verdict:
    """Return the verdict on a link without an ``<inertial>``."""
    body = bodies.of(link.name)
    members = [] if body is None else bodies.members(body)
    link_with_mass = next(
        (member.name for member in members if member.inertial is not None and member.inertial.mass > 0), None
    )
    if link_with_mass is not None:
        return Verdict(Grade.UNJUDGED, phrase("it is fixed to '{link}', which has a mass", link=link_with_mass))
    if link.visuals or link.collisions or (body is not None and body.joint is not None and members[0] is link):
        return Verdict(Grade.MISSING, phrase("it has no <inertial>"))
    return Verdict(Grade.UNJUDGED, phrase("it is only a frame"))


def _find_density_reasons(density: float, *, has_mesh: bool) -> list[_Reason]:
    if density > MAX_DENSITY:
        # A mesh may be a thin skin around a heavy interior.
        grade = Grade.DOUBTFUL if has_mesh else Grade.IMPOSSIBLE
        words = phrase("it is denser than any solid: osmium has {density} kg/m3", density=format_digits(MAX_DENSITY))
        return [_Reason(grade, words, log(density / MAX_DENSITY))]
    if density < MIN_DENSITY:
        error_size = log(MIN_DENSITY / density) if density > 0 else inf  # The density is 0 for a negligible mass.
        return [_Reason(Grade.DOUBTFUL, phrase("it is lighter than air"), error_size)]
    return []


def _find_comparison_reasons(comparison: Comparison, computed: MassProperties) -> list[_Reason]:
    reasons = []
    box = computed.equivalent_box()
    relative_distance = 0.0 if box is None else comparison.center_distance / float(np.linalg.norm(box))
    if relative_distance > _ROUGH_DISTANCE_RATIO:
        words = phrase(
            "its center of mass is {length} from the center of its shapes", length=_format_distance(comparison)
        )
        reasons.append(
            _Reason(
                Grade.DOUBTFUL if relative_distance > _DOUBTFUL_DISTANCE_RATIO else Grade.ROUGH,
                words,
                log(relative_distance / _ROUGH_DISTANCE_RATIO),
            )
        )
    ratios = [ratio for ratio in comparison.moment_ratios or () if ratio > 0]
    if ratios:
        ratio = max(ratios, key=lambda value: abs(log(value)))
        times = max(ratio, 1 / ratio)
        if times > _ROUGH_RATIO:
            times_text = f"{times:.2g}" if times < _DOUBTFUL_RATIO else format_digits(times)
            words = (
                phrase("its moments are {factor} times the moments of a solid with its shapes", factor=times_text)
                if ratio > 1
                else phrase("its moments are 1/{factor} of the moments of a solid with its shapes", factor=times_text)
            )
            reasons.append(_Reason(Grade.DOUBTFUL if times > _DOUBTFUL_RATIO else Grade.ROUGH, words, log(times)))
    return reasons


def _format_distance(comparison: Comparison) -> str:
    distance = comparison.center_distance
    return f"{distance:.3g} m" if distance >= 1 else f"{distance * 1000:.3g} mm"


def format_digits(number: float) -> str:
    """Format a number with thousands separators, or with three significant digits below 100."""
    return f"{number:,.0f}".replace(",", " ") if number >= 100 else f"{number:.3g}"
