"""Rules about inertia tensors that are possible but implausible."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from linkwright.diagnostics import Diagnostic, Note, Severity, phrase
from linkwright.lint.explanations import is_explained
from linkwright.lint.extents import MAX_PLACEHOLDER_MASS
from linkwright.lint.option import Option
from linkwright.lint.rule import Rule
from linkwright.lint.rules.inertia import find_child_or_inertial, links_with_inertial
from linkwright.lint.subject import Subject
from linkwright.lint.tensors import DIAGONAL_NAMES, PRODUCT_NAMES, name_others
from linkwright.urdf import Inertial, Link


class PlaceholderInertia(Rule):
    """The same inertia on links of different shapes.

    ## Why

    If all links have a tensor of ones, it is a placeholder from a tutorial. For a link of a few hundred grams, such a
    tensor is thousands of times too large, and the robot moves far too sluggishly. The inertia depends on size and
    mass, so it cannot be the same for all links. The rule only applies if at least half of the links share such a
    tensor. Other rules then report neither the size of the tensor nor the center of mass. If a comment on the line or
    above it explains the value, the finding is informational.

    ## Example

    ```xml
    <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>
    ```

    on the body, each wheel and the caster.

    ## Use instead

    Write a tensor for each link. `linkwright inertia FILE` computes all tensors.
    """

    code = "LW315"
    name = "inertia-placeholder"
    options = (Option("links", 3, "the smallest number of links with the same tensor that is reported"),)

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        for group in _find_shared_tensors(subject, self.option(subject, "links", int)):
            link, inertial = group[0]
            others = name_others([other.name for other, _ in group[1:]])
            yield self.report(
                phrase(
                    "link '{name}' has the same inertia as {count} links of other shapes",
                    name=link.name,
                    count=len(group) - 1,
                ),
                find_child_or_inertial(inertial, "inertia"),
                notes=[Note(others)],
                hint=phrase("run `linkwright inertia` to compute the inertia of each link from its shapes"),
                severity=Severity.INFO if is_explained(inertial.element, "inertia") else None,
            )


SKIPPED_FOR_PLACEHOLDERS = frozenset({"LW322", "LW323", "LW324", "LW325"})
"""The codes of the rules that skip a link if `PlaceholderInertia` reports its inertia."""


def find_placeholder_links(subject: Subject) -> set[str]:
    """Return the names of the links whose inertia `PlaceholderInertia` reports."""
    min_links = PlaceholderInertia().option(subject, "links", int)
    return {link.name for group in _find_shared_tensors(subject, min_links) for link, _ in group}


def _find_shared_tensors(subject: Subject, min_links: int) -> Iterator[list[tuple[Link, Inertial]]]:
    """Yield groups of links that share a tensor of three equal moments, but differ in shape.

    A group has at least `min_links` links and at least `min_links` different shapes, and contains at least half of
    all links with an inertia.
    """
    groups: dict[tuple[float, ...], list[tuple[Link, Inertial]]] = {}
    for link, inertial in links_with_inertial(subject):
        values = tuple(getattr(inertial, name) for name in (*DIAGONAL_NAMES, *PRODUCT_NAMES))
        if any(values) and inertial.mass >= MAX_PLACEHOLDER_MASS and subject.bodies.turns(link.name):
            groups.setdefault(values, []).append((link, inertial))
    count = sum(map(len, groups.values()))
    for (ixx, iyy, izz, *_), group in groups.items():
        shapes = {_make_shape_key(link) for link, _ in group} - {()}
        if ixx == iyy == izz and min(len(group), len(shapes)) >= min_links and 2 * len(group) >= count:
            yield group


class RotatedIsotropicInertia(Rule):
    """A rotation in the `<origin>` of an inertia that is the same about every axis.

    ## Why

    The rotation in `<inertial>` only rotates the tensor, not the shapes. A tensor with three equal moments and no
    products is the same in every orientation. The rotation was probably meant for something else.

    ## Example

    ```xml
    <origin xyz="0 0 0.1" rpy="1.5708 0 0"/>
    <mass value="1"/>
    <inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/>
    ```

    ## Use instead

    ```xml
    <origin xyz="0 0 0.1"/>
    ```
    """

    code = "LW316"
    name = "inertia-turned-in-vain"
    holds_for_parts = True
    default = False

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        for link, inertial in links_with_inertial(subject):
            is_isotropic = inertial.ixx == inertial.iyy == inertial.izz
            products = inertial.ixy or inertial.ixz or inertial.iyz
            if is_isotropic and not products and any(inertial.origin.rpy) and inertial.ixx:
                yield self.report(
                    phrase(
                        "the rotation of <inertial> of link '{name}' changes nothing: its inertia is the same "
                        "about every axis",
                        name=link.name,
                    ),
                    find_child_or_inertial(inertial, "origin"),
                    "rpy",
                    hint=phrase("leave 'rpy' out, or give the moments of the shape"),
                )


class TinyInertia(Rule):
    """A moving body with a moment of inertia that solvers cannot work with.

    ## Why

    An integrator with steps of a millisecond becomes unstable if a joint rotates a body with almost no inertia.

    ## Example

    ```xml
    <inertia ixx="1e-12" ixy="0" ixz="0" iyy="1e-12" iyz="0" izz="1e-12"/>
    ```

    ## Use instead

    Write at least about 1e-8 kg m2, which is the inertia of a steel ball with a diameter of 8 mm. Add armature or
    damping at the joint.
    """

    code = "LW317"
    name = "inertia-tiny"
    default = False
    options = (Option("smallest", 1e-9, "smallest principal moment of a moving body, in kg m2"),)

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        smallest = self.option(subject, "smallest", float)
        for body in subject.bodies.all:
            inertial_links = [link for link in subject.bodies.members(body) if link.inertial is not None]
            if body.joint is None or not inertial_links:
                continue
            moment = float(subject.extents.mass_properties(body).principal().moments[0])
            if 0 < moment < smallest and inertial_links[0].inertial is not None:
                yield self.report(
                    phrase(
                        "the smallest moment of inertia of moving link '{links}' is {moment:.2g} kg m2",
                        links=body.links[0],
                        moment=moment,
                    ),
                    find_child_or_inertial(inertial_links[0].inertial, "inertia"),
                    hint=phrase("simulate with a larger inertia, or give the joint damping"),
                )


def _make_shape_key(link: Link) -> tuple[object, ...]:
    """Return a key that is the same for links with the same shapes."""
    return tuple(shape.geometry for shape in (link.collisions or link.visuals))
