"""Verdicts on the ``<inertial>`` of a link, from a comparison with its shapes."""

from __future__ import annotations

from enum import Enum
from math import inf, log

import numpy as np

from linkwright.diagnostics import Phrase, joined, phrase
from linkwright.geometry.mass import MassProperties
from linkwright.geometry.validity import HEAVIEST_DENSITY, LIGHTEST_DENSITY, problems
from linkwright.inertia.comparison import Comparison, compare
from linkwright.inertia.estimation import Estimate
from linkwright.inertia.inertial import from_inertial
from linkwright.loading.lean_dataclasses import dataclass
from linkwright.urdf import Link, Mesh
from linkwright.urdf.bodies import Bodies

_DOUBTFUL = 10.0
_ROUGH = 2.0
"""The factor between moments and those of a solid of the same shapes from which they are rough."""

_FAR = 0.5
_OFF = 0.1
"""The distances of a centre of mass from that of the shapes to be doubtful, and rough, in their diagonals."""


class Standing(Enum):
    """The grades of an ``<inertial>``, the worst first."""

    IMPOSSIBLE = "impossible"
    DOUBTFUL = "doubtful"
    MISSING = "missing"
    ROUGH = "rough"
    FITS = "fits"
    UNJUDGED = "unjudged"


_ORDER = tuple(Standing)


@dataclass(frozen=True, slots=True)
class Verdict:
    """The verdict on a link's ``<inertial>``.

    Attributes:
        standing: the grade.
        words: the reason, as a clause.
        badness: the size of the error; comparable between verdicts with the same standing.
        present: the values of the file, in the link frame; None if they are missing or unusable.
        density: the density of the link's shapes with the file's mass, in kg/m3; None if it is unknown.
        comparison: the comparison of the file with the shapes; None if there is nothing to compare.
    """

    standing: Standing
    words: Phrase
    badness: float = 0.0
    present: MassProperties | None = None
    density: float | None = None
    comparison: Comparison | None = None

    @property
    def place(self) -> tuple[int, float]:
        """The sort key, which puts the worst verdict first."""
        return _ORDER.index(self.standing), -self.badness


@dataclass(frozen=True, slots=True)
class _Reason:
    """A problem of an ``<inertial>``, with its grade."""

    standing: Standing
    words: Phrase
    badness: float = 0.0


def judge(link: Link, found: Estimate, bodies: Bodies) -> Verdict:
    """Return the verdict on a link's ``<inertial>``.

    Args:
        link: the link.
        found: the estimate from its shapes.
        bodies: the robot's links grouped by fixed joints; the mass of a link may include that of links without a mass.
    """
    if link.inertial is None:
        return _without(link, bodies)
    if not link.inertial.is_computable:
        return Verdict(Standing.IMPOSSIBLE, phrase("its numbers are out of range"))
    present = from_inertial(link.inertial)
    shapes = link.collisions if found.kind == "collision" else link.visuals
    comparison = None if found.properties is None else compare(present, found.properties)
    computed = found.properties if found.shapes == len(shapes) else None  # A part of the shapes is not conclusive.
    alone = not bodies.includes_massless_links(link)
    reasons = [_Reason(Standing.IMPOSSIBLE, words) for words in problems(present)]
    density = None
    if alone and computed is not None and comparison is not None:
        if present.mass > 0:
            density = present.mass / computed.mass * found.density
            reasons += _of_density(density, has_mesh=any(isinstance(shape.geometry, Mesh) for shape in shapes))
        reasons += _of_comparison(comparison, computed)
    if reasons:
        worst = min(reasons, key=lambda reason: _ORDER.index(reason.standing)).standing
        worst_reasons = [reason for reason in reasons if reason.standing is worst]
        words, badness = (
            joined([reason.words for reason in worst_reasons], "; "),
            max(reason.badness for reason in worst_reasons),
        )
        return Verdict(worst, words, badness, present, density, comparison)
    if computed is None:
        return Verdict(Standing.UNJUDGED, phrase("there is no shape to compare with"), 0.0, present)
    if not alone:
        words = phrase("its mass includes links that are fixed to it")
        return Verdict(Standing.UNJUDGED, words, 0.0, present, None, comparison)
    return Verdict(Standing.FITS, phrase("fits its shapes"), 0.0, present, density, comparison)


def _without(link: Link, bodies: Bodies) -> Verdict:
    """Return the verdict on a link without an ``<inertial>``."""
    body = bodies.of(link.name)
    members = [] if body is None else bodies.members(body)
    heavy = next((member.name for member in members if member.inertial is not None and member.inertial.mass > 0), None)
    if heavy is not None:
        return Verdict(Standing.UNJUDGED, phrase("it is fixed to '{link}', which has a mass", link=heavy))
    if link.visuals or link.collisions or (body is not None and body.joint is not None and members[0] is link):
        return Verdict(Standing.MISSING, phrase("it has no <inertial>"))
    return Verdict(Standing.UNJUDGED, phrase("it is only a frame"))


def _of_density(density: float, *, has_mesh: bool) -> list[_Reason]:
    if density > HEAVIEST_DENSITY:
        # A mesh may be a thin skin around a heavy interior.
        standing = Standing.DOUBTFUL if has_mesh else Standing.IMPOSSIBLE
        words = phrase("denser than any solid: osmium has {density} kg/m3", density=grouped(HEAVIEST_DENSITY))
        return [_Reason(standing, words, log(density / HEAVIEST_DENSITY))]
    if density < LIGHTEST_DENSITY:
        badness = log(LIGHTEST_DENSITY / density) if density > 0 else inf  # The density is 0 for a negligible mass.
        return [_Reason(Standing.DOUBTFUL, phrase("lighter than air"), badness)]
    return []


def _of_comparison(comparison: Comparison, computed: MassProperties) -> list[_Reason]:
    reasons = []
    box = computed.equivalent_box()
    part = 0.0 if box is None else comparison.center_distance / float(np.linalg.norm(box))
    if part > _OFF:
        words = phrase("its centre of mass is {length} from that of its shapes", length=_length(comparison))
        reasons.append(_Reason(Standing.DOUBTFUL if part > _FAR else Standing.ROUGH, words, log(part / _OFF)))
    ratios = [ratio for ratio in comparison.moment_ratios or () if ratio > 0]
    if ratios:
        ratio = max(ratios, key=lambda value: abs(log(value)))
        times = max(ratio, 1 / ratio)
        if times > _ROUGH:
            shown = f"{times:.2g}" if times < _DOUBTFUL else grouped(times)
            words = (
                phrase("its moments are {times} times those of a solid of its shapes", times=shown)
                if ratio > 1
                else phrase("its moments are 1/{times} of those of a solid of its shapes", times=shown)
            )
            reasons.append(_Reason(Standing.DOUBTFUL if times > _DOUBTFUL else Standing.ROUGH, words, log(times)))
    return reasons


def _length(comparison: Comparison) -> str:
    distance = comparison.center_distance
    return f"{distance:.3g} m" if distance >= 1 else f"{distance * 1000:.3g} mm"


def grouped(number: float) -> str:
    """Format a number with thousands separators, or with three significant digits below 100."""
    return f"{number:,.0f}".replace(",", " ") if number >= 100 else f"{number:.3g}"
