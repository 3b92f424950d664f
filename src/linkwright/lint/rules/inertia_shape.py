"""Rules that compare mass properties with the shapes of a link.

A link's body may be larger than the link, since it includes all links that are fixed to it. Links with unreadable
meshes are not reported.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from math import prod

from linkwright.diagnostics import Diagnostic, Note, Phrase, Severity, phrase
from linkwright.geometry.shapes import shape_volume
from linkwright.lint.explanations import is_explained
from linkwright.lint.extents import MAX_MARKER_SIZE, MAX_PLACEHOLDER_MASS
from linkwright.lint.option import Option
from linkwright.lint.rule import Rule
from linkwright.lint.rules.inertia import find_child_or_inertial, links_with_inertial
from linkwright.lint.rules.inertia_doubtful import find_placeholder_links
from linkwright.lint.subject import Subject
from linkwright.lint.tensors import DIAGONAL_NAMES, PRODUCT_NAMES, find_first_flaw, name_others
from linkwright.loading.lean_typing import TYPE_CHECKING
from linkwright.urdf import Inertial, Link, Mesh

if TYPE_CHECKING:
    from linkwright.geometry.shapes import Bounds

_UNITS = ((1e3, "g m2"), (1e4, "kg cm2"), (1e6, "kg mm2"), (1e9, "g mm2"))
"""The value of 1 kg m2 in other units, in which an author may have written the inertia by mistake."""

_MAX_ORIGIN_DISTANCE = 20.0
"""The distance in m above which `shape-far` reports an origin."""

_MIN_SUSPECT_MASS = 1.0
"""The mass in kg below which a value is not in grams by mistake: simulators require a mass of small frames."""

_BALLAST_FACTOR = 10.0
_ESTIMATE_FACTOR = 3.0

_LENGTH_TOLERANCE = 1e-3
"""The difference in m below which two lengths count as equal."""


class DensityTooHigh(Rule):
    """A mass that is too large for the volume of the link's shapes.

    ## Why

    Osmium, the densest material, has 22 600 kg/m3. If a link is denser, its mass is in grams, or its shapes are in a
    unit other than meters. A mesh counts with the volume of its bounding box, so real parts are not reported. If links
    that are fixed to the link have shapes but no mass, the mass is compared with the box around the whole body.

    The finding is only informational in three cases. A comment on the line or above it explains the value, as for
    ballast. The link is part of the robot's base, which a large mass keeps in place, and has at most ten times the
    density of osmium. The mass has one significant digit, such as 1 or 20, so it is an estimate, and the link has at
    most three times the density of osmium.

    ## Example

    A wheel of 6 cm radius and 2 cm width with

    ```xml
    <mass value="300"/>
    ```

    ## Use instead

    ```xml
    <mass value="0.3"/>
    ```
    """

    code = "LW320"
    name = "density-too-high"

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        if not subject.extents.links_with_relevant_mass:
            return
        from linkwright.geometry.validity import MAX_DENSITY

        for link, inertial in subject.extents.links_with_relevant_mass:
            bounds, volume = subject.extents.link_bounds(link), subject.extents.volume(link)
            if (
                bounds is None
                or volume is None
                or bounds.diagonal <= MAX_MARKER_SIZE
                or inertial.mass < _MIN_SUSPECT_MASS
            ):
                continue
            if min(bounds.size) < _LENGTH_TOLERANCE / 10:
                continue  # a sheet: its thickness is not meaningful
            if subject.bodies.includes_massless_links(link):
                body_box = subject.extents.body_bounds(link)
                if body_box is None:
                    continue
                volume = max(volume, prod(body_box.size))
            excess = inertial.mass / volume / MAX_DENSITY if volume > 0 else 0.0
            if excess > 1:
                is_intended = excess < self._tolerated_ratio(subject, link, inertial) or is_explained(
                    inertial.element, "mass"
                )
                yield self.report(
                    phrase(
                        "link '{name}' has a density of {density} kg/m3",
                        name=link.name,
                        density=_group_digits(inertial.mass / volume),
                    ),
                    find_child_or_inertial(inertial, "mass"),
                    "value",
                    notes=[
                        Note(
                            phrase(
                                "{mass:g} kg in {volume}; osmium has 22 600 kg/m3",
                                mass=inertial.mass,
                                volume=_format_volume(volume),
                            )
                        )
                    ],
                    hint=phrase("check the units: masses are in kg and lengths in m"),
                    severity=Severity.INFO if is_intended else None,
                )

    def _tolerated_ratio(self, subject: Subject, link: Link, inertial: Inertial) -> float:
        """Return the tolerated density of a link as a multiple of the density of osmium."""
        body = subject.bodies.of(link.name)
        if body is not None and body.joint is None:
            return _BALLAST_FACTOR
        return _ESTIMATE_FACTOR if inertial.mass == float(f"{inertial.mass:.0e}") else 1.0


class DensityTooLow(Rule):
    """A mass so small that the body would float in air.

    ## Why

    Air has a density of 1.2 kg/m3. If a solid is lighter, its mass is in tonnes, or its shapes are in millimeters or
    centimeters. Links that fixed joints connect are evaluated as one body, by their collision shapes if they have any.

    ## Example

    A body of 1 m x 1 m x 0.5 m with

    ```xml
    <mass value="0.012"/>
    ```

    ## Use instead

    ```xml
    <mass value="12"/>
    ```
    """

    code = "LW321"
    name = "density-too-low"

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        if not any(links_with_inertial(subject)):
            return
        from linkwright.geometry.validity import MIN_DENSITY

        bodies = subject.bodies
        for body in bodies.all:
            members = bodies.members(body)
            links_with_mass = [
                (link, link.inertial) for link in members if link.inertial is not None and link.inertial.mass > 0
            ]
            shapes = [shape.geometry for link in members for shape in (link.collisions or link.visuals)]
            if not links_with_mass or any(isinstance(geometry, Mesh) for geometry in shapes):
                continue  # a frame of rods, for example as a mesh, fills little of its bounding box
            mass = bodies.mass(body)
            volume = sum(shape_volume(geometry) for geometry in shapes if not isinstance(geometry, Mesh))
            if MAX_PLACEHOLDER_MASS <= mass < MIN_DENSITY * volume:
                link, inertial = max(links_with_mass, key=lambda item: item[1].mass)
                yield self.report(
                    phrase(
                        "link '{name}' has a density of {mass:.2g} kg/m3, less than air",
                        name=link.name,
                        mass=mass / volume,
                    ),
                    find_child_or_inertial(inertial, "mass"),
                    "value",
                    notes=[Note(phrase("{mass:g} kg in {volume}", mass=mass, volume=_format_volume(volume)))],
                    hint=phrase("check the units: masses are in kg and lengths in m"),
                )


class CenterOutside(Rule):
    """A center of mass far outside the link's shapes.

    ## Why

    The center of mass is within the hull of a body. A center outside makes the robot tip over or swing for no visible
    reason. Often the `<origin>` of `<inertial>` is in millimeters, or in the frame of another link.

    ## Example

    ```xml
    <inertial>
      <origin xyz="0 0 150"/>
      ...
    ```

    ## Use instead

    ```xml
    <inertial>
      <origin xyz="0 0 0.150"/>
      ...
    ```
    """

    code = "LW322"
    name = "center-of-mass-outside"
    options = (
        Option("margin", 0.25, "the largest distance outside the shapes, as a fraction of the diagonal of their box"),
    )

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        margin = self.option(subject, "margin", float)
        for link, inertial, bounds in _iterate_measured_links(subject):
            center = inertial.origin.xyz
            if max(map(abs, center)) > _MAX_ORIGIN_DISTANCE or _is_at_the_joint(subject, link, inertial):
                continue
            distance = bounds.distance(center)
            if distance > max(margin * bounds.diagonal, _LENGTH_TOLERANCE):
                x, y, z = center
                fits_in_millimeters = bounds.distance((x / 1000, y / 1000, z / 1000)) == 0
                yield self.report(
                    phrase(
                        "the center of mass of link '{name}' is {length} outside its shapes",
                        name=link.name,
                        length=_format_length(distance),
                    ),
                    find_child_or_inertial(inertial, "origin"),
                    "xyz",
                    notes=[_make_extent_note(bounds)],
                    hint=phrase("write the origin in meters; this looks like millimeters")
                    if fits_in_millimeters and distance > 1
                    else _COMPUTE_HINT,
                )


class InertialOriginMissing(Rule):
    """An `<inertial>` without `<origin>` on a link whose shapes are to one side of its frame.

    ## Why

    Without `<origin>`, the center of mass is at the origin of the link frame, which is at the joint. For an arm that
    extends from the joint, the center of mass is then at one end of the arm. Usually, the author moved the shape and
    forgot the mass.

    ## Example

    ```xml
    <link name="upper_arm">
      <visual>
        <origin xyz="0 0 0.25"/>
        <geometry><cylinder radius="0.03" length="0.5"/></geometry>
      </visual>
      <inertial>
        <mass value="1"/>
        ...
    ```

    ## Use instead

    ```xml
      <inertial>
        <origin xyz="0 0 0.25"/>
        <mass value="1"/>
        ...
    ```
    """

    code = "LW323"
    name = "center-of-mass-forgotten"

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        for link, inertial, bounds in _iterate_measured_links(subject):
            element = inertial.element
            if element is None or not _is_at_the_joint(subject, link, inertial):
                continue
            if all(map(_is_origin_off_center, subject.extents.separate_bounds(link))):
                x, y, z = (round(coordinate, 4) + 0.0 for coordinate in bounds.center)
                yield self.report(
                    phrase(
                        "<inertial> of link '{name}' has no <origin>, but the shapes are on one side of the link frame",
                        name=link.name,
                    ),
                    element,
                    notes=[_make_extent_note(bounds)],
                    hint=phrase('add <origin xyz="{x:g} {y:g} {z:g}"/>, if that is where its mass is', x=x, y=y, z=z),
                )


class InertiaTooLarge(Rule):
    """Moments of inertia too large for a mass within the link's shapes.

    ## Why

    A body with all of its mass in the farthest corner of its shapes would have the largest possible moment. A larger
    moment is in other units, such as kg mm2 or g mm2 of CAD programs, or refers to a point other than the center of
    mass, or is invented. The robot then rotates far too sluggishly. Other rules report tensors that are impossible for
    any body.

    ## Example

    ```xml
    <mass value="0.3"/>
    <inertia ixx="540" ixy="0" ixz="0" iyy="540" iyz="0" izz="1000"/>
    ```

    ## Use instead

    ```xml
    <inertia ixx="0.00054" ixy="0" ixz="0" iyy="0.00054" iyz="0" izz="0.001"/>
    ```
    """

    code = "LW324"
    name = "inertia-too-large"
    options = (Option("factor", 2.0, "the smallest factor above the largest possible moment that is reported"),)

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        if not subject.extents.measurable_links:
            return
        from linkwright.geometry.validity import largest_moment_within

        factor = self.option(subject, "factor", float)
        excessive_inertias: dict[tuple[float, ...], list[tuple[Link, Inertial, Bounds, float]]] = {}
        for link, inertial, bounds in _iterate_measured_links(subject):
            limit = largest_moment_within(bounds.nearest(inertial.origin.xyz), bounds, inertial.mass)
            if max(inertial.ixx, inertial.iyy, inertial.izz) > factor * limit and find_first_flaw(inertial) is None:
                key = (inertial.mass, *(getattr(inertial, name) for name in (*DIAGONAL_NAMES, *PRODUCT_NAMES)))
                excessive_inertias.setdefault(key, []).append((link, inertial, bounds, limit))
        for (link, inertial, bounds, limit), *others in excessive_inertias.values():
            yield self._finding(link, inertial, bounds, limit, [other.name for other, *_ in others])

    def _finding(
        self, link: Link, inertial: Inertial, bounds: Bounds, limit: float, others: Sequence[str]
    ) -> Diagnostic:
        name = max(DIAGONAL_NAMES, key=lambda item: getattr(inertial, item))
        largest = getattr(inertial, name)
        uniform_moment = _compute_largest_uniform_moment(bounds, inertial.mass)
        limit_phrase = phrase(
            "a mass of {mass:g} kg within these shapes has a moment of inertia of at most {limit:.2g} kg m2",
            mass=inertial.mass,
            limit=limit,
        )
        return self.report(
            phrase(
                "the inertia of link '{name}' is too large for its shapes: {largest:g} kg m2",
                name=link.name,
                largest=largest,
            ),
            find_child_or_inertial(inertial, "inertia"),
            name,
            notes=[Note(limit_phrase), *([Note(name_others(others))] if others else [])],
            hint=_COMPUTE_HINT
            if uniform_moment <= 0 or _is_round_number(inertial)
            else _make_unit_hint(largest / uniform_moment) or _COMPUTE_HINT,
        )


class InertiaTooSmall(Rule):
    """Moments of inertia hundreds of times smaller than the link's shapes suggest.

    ## Why

    With such moments, all of the mass would have to be in a small part of the link. Usually, the tensor was computed
    for a smaller mass, or with a size in other units. The rule uses the smaller of the boxes around the collision
    shapes and around the visuals, since a visual mesh may extend beyond the body.

    ## Example

    A body of 0.5 m x 0.4 m x 0.2 m with

    ```xml
    <mass value="10"/>
    <inertia ixx="0.0001" ixy="0" ixz="0" iyy="0.0001" iyz="0" izz="0.0001"/>
    ```

    ## Use instead

    ```xml
    <inertia ixx="0.167" ixy="0" ixz="0" iyy="0.242" iyz="0" izz="0.342"/>
    ```
    """

    code = "LW325"
    name = "inertia-too-small"
    options = (Option("factor", 200.0, "the smallest factor below the moment of a solid box that is reported"),)

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        factor = self.option(subject, "factor", float)
        for link, inertial, _ in _iterate_measured_links(subject):
            boxes = subject.extents.separate_bounds(link)
            largest = max(inertial.ixx, inertial.iyy, inertial.izz)
            if not boxes or largest <= 0:
                continue
            uniform_moment = min(_compute_largest_uniform_moment(box, inertial.mass) for box in boxes)
            if largest * factor < uniform_moment and (
                (flaw := find_first_flaw(inertial)) is None or flaw.kind == "triangle"
            ):
                yield self.report(
                    phrase(
                        "the inertia of link '{name}' is {factor} times smaller than the "
                        "inertia of a solid of its size",
                        name=link.name,
                        factor=_group_digits(uniform_moment / largest),
                    ),
                    find_child_or_inertial(inertial, "inertia"),
                    notes=[
                        Note(
                            phrase(
                                "a mass of {mass:g} kg that fills the box of the link has a moment of about "
                                "{usual:.2g} kg m2",
                                mass=inertial.mass,
                                usual=uniform_moment,
                            )
                        )
                    ],
                    hint=_COMPUTE_HINT,
                )


def _iterate_measured_links(subject: Subject) -> Iterator[tuple[Link, Inertial, Bounds]]:
    """Yield the measured links except those whose tensor `PlaceholderInertia` reports."""
    placeholder_names = subject.once(find_placeholder_links) if subject.extents.measurable_links else set()
    return (item for item in subject.extents.measurable_links if item[0].name not in placeholder_names)


def _is_at_the_joint(subject: Subject, link: Link, inertial: Inertial) -> bool:
    """Return whether a link is alone in its body and its ``<inertial>`` has no ``<origin>``."""
    body = subject.bodies.of(link.name)
    is_alone = body is not None and len(body.frames) == 1
    return is_alone and inertial.element is not None and inertial.element.first("origin") is None


def _is_origin_off_center(bounds: Bounds) -> bool:
    """Return whether the origin is near a side of a box or outside it.

    This is the case if its distance from the center along an axis exceeds 0.45 of the edge.
    """
    axes = zip(bounds.center, bounds.size, strict=True)
    return any(abs(center) - 0.45 * size > _LENGTH_TOLERANCE for center, size in axes)


_COMPUTE_HINT = phrase("run `linkwright inertia` to compute it from the link's shapes")


def _compute_largest_uniform_moment(bounds: Bounds, mass: float) -> float:
    """Return the largest moment of a solid box of this mass about its center, in kg m2."""
    squares = sorted(edge**2 for edge in bounds.size)
    return mass * (squares[1] + squares[2]) / 12


def _is_round_number(inertial: Inertial) -> bool:
    """Return whether a tensor consists of the same round number three times, such as 1 1 1.

    No wrong unit explains such a tensor.
    """
    return inertial.ixx == inertial.iyy == inertial.izz == float(f"{inertial.ixx:.0e}")


def _make_unit_hint(ratio: float) -> Phrase | None:
    """Return a hint if an error matches the ratio of two units within a factor of 3, or None."""
    factor, unit = min(_UNITS, key=lambda item: max(item[0] / ratio, ratio / item[0]))
    if max(factor / ratio, ratio / factor) > 3:
        return None
    return phrase("if it is in {unit}, divide it by {factor:.0f}", unit=unit, factor=factor)


def _make_extent_note(bounds: Bounds) -> Note:
    low, high = (" ".join(f"{coordinate:.3g}" for coordinate in corner) for corner in (bounds.low, bounds.high))
    return Note(phrase("the shapes reach from {low} to {high} in the link frame", low=low, high=high))


def _format_length(meters: float) -> Phrase:
    return phrase("{length:.3g} m", length=meters) if meters >= 1 else phrase("{length:.3g} cm", length=meters * 100)


def _format_volume(cubic_meters: float) -> Phrase:
    if cubic_meters >= 0.1:
        return phrase("{volume:.3g} m3", volume=cubic_meters)
    return phrase("{volume:.3g} cm3", volume=cubic_meters * 1e6)


def _group_digits(number: float) -> str:
    return f"{number:,.0f}".replace(",", " ")
