"""Rules about the origins of joints: distances and angles of ``<origin>``."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from math import pi, radians, sqrt

from linkwright.diagnostics import Diagnostic, Severity, phrase
from linkwright.lint.fix import Fix, value_edit
from linkwright.lint.option import Option
from linkwright.lint.rule import Rule
from linkwright.lint.subject import Subject
from linkwright.lint.walk import (
    SURROUNDING_FRAMES,
    format_number,
    iterate_joint_children,
    iterate_joints,
    parse_numbers,
)
from linkwright.loading.deferred import lazy_pattern
from linkwright.urdf.values import looks_like_degrees
from linkwright.xmltree import Element


class OriginFar(Rule):
    """A joint origin so large that it can only be in millimeters.

    ## Why

    Lengths are in meters. If an elbow is 400 m from its shoulder, the arm was exported in millimeters, and RViz shows
    nothing at the expected position. The position of a robot in its `world` is not checked.

    ## Example

    ```xml
    <origin xyz="0 0 400" rpy="0 0 0"/>
    ```

    ## Use instead

    ```xml
    <origin xyz="0 0 0.4" rpy="0 0 0"/>
    ```
    """

    code = "LW226"
    name = "origin-far"
    holds_for_parts = True
    options = (Option("farthest", 20.0, "the largest distance, in m, that is considered plausible"),)

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """Report every joint whose origin is implausibly far away in meters."""
        max_distance = self.option(subject, "farthest", float)
        for joint, _, origin in iterate_joint_children(subject, "origin"):
            xyz = parse_numbers(origin, "xyz")
            if len(xyz) != 3 or joint.parent in SURROUNDING_FRAMES:
                continue
            distance = sqrt(sum(coordinate * coordinate for coordinate in xyz))
            if distance > max_distance:
                meters = " ".join(format_number(part / 1000) for part in xyz)
                yield self.report(
                    phrase(
                        "joint '{name}' is {distance} m from the frame of '{parent}'",
                        name=joint.name,
                        distance=format_number(distance),
                        parent=joint.parent,
                    ),
                    origin,
                    "xyz",
                    hint=phrase("write {meters} if the value is in millimeters", meters=meters),
                )


class AngleInDegrees(Rule):
    """An `rpy` angle of more than two turns that is not a multiple of 5.

    ## Why

    Angles are in radians, and 22.5 rad is three and a half turns. The URDF reader reports multiples of 5 (URDF190).

    ## Example

    ```xml
    <origin xyz="0 0 0" rpy="0 0 22.5"/>
    ```

    ## Use instead

    ```xml
    <origin xyz="0 0 0" rpy="0 0 0.392699"/>
    ```

    In xacro, `${radians(22.5)}`.
    """

    code = "LW227"
    name = "angle-in-degrees"
    holds_for_parts = True

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """Report every origin with an implausibly large rotation."""
        for owner, origin in _iterate_origins(subject):
            rpy = parse_numbers(origin, "rpy")
            if len(rpy) == 3 and not looks_like_degrees(*rpy) and 4 * pi < max(map(abs, rpy)) <= 360:
                yield self.report(
                    phrase(
                        "'rpy' in <origin> of {owner} is a rotation of more than two turns: '{rpy}'",
                        owner=owner,
                        rpy=origin.attributes["rpy"].strip(),
                    ),
                    origin,
                    "rpy",
                    hint=phrase(
                        "write {radians} if the value is in degrees",
                        radians=" ".join(format_number(radians(angle)) for angle in rpy),
                    ),
                )


class AngleRounded(Rule):
    """An `rpy` angle that is pi or a simple fraction of it, rounded to few digits.

    ## Why

    `1.57` is off by 0.046 degrees, which is half a millimeter at the end of an arm of 70 cm. Frames that should be
    parallel are slightly tilted. The error seldom matters, so the rule is off by default.

    ## Example

    ```xml
    <origin rpy="0 0 1.57"/>
    ```

    ## Use instead

    ```xml
    <origin rpy="0 0 1.5707963267948966"/>
    ```

    In xacro, `${pi/2}`.
    """

    code = "LW228"
    name = "angle-rounded"
    holds_for_parts = True
    severity = Severity.INFO
    default = False

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """Report every simple fraction of pi that is rounded to two to five decimal places."""
        for owner, origin in _iterate_origins(subject):
            texts = origin.attributes.get("rpy", "").split()
            if len(parse_numbers(origin, "rpy")) != 3 or len(texts) != 3:
                continue
            exact_texts = [_find_pi_fraction(text) for text in texts]
            if any(exact_texts):
                suggestion = " ".join(exact_text or old for exact_text, old in zip(exact_texts, texts, strict=True))
                edit = value_edit(origin, "rpy", suggestion)
                yield self.report(
                    phrase(
                        "'rpy' in <origin> of {owner} is a rounded fraction of pi: '{value}'",
                        owner=owner,
                        value=" ".join(texts),
                    ),
                    origin,
                    "rpy",
                    hint=phrase("write {form}", form=suggestion),
                    fix=Fix((edit,), safe=False) if edit else None,
                )


class OriginMissing(Rule):
    """A joint without `<origin>` between two links that both have geometry.

    ## Why

    The frames of the two links coincide, so their shapes overlap. Sometimes the overlap is intended, so the rule is off
    by default.

    ## Example

    ```xml
    <joint name="camera_joint" type="fixed">
      <parent link="base_link"/>
      <child link="camera_link"/>
    </joint>
    ```

    ## Use instead

    ```xml
      <origin xyz="0.1 0 0.2" rpy="0 0 0"/>
    ```
    """

    code = "LW229"
    name = "origin-missing"
    severity = Severity.INFO
    default = False

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """Report every joint without an origin between two links with visuals."""
        visible_links = {link.name for link in subject.links if link.visuals}
        for joint, element in iterate_joints(subject):
            if element.first("origin") is None and {joint.parent, joint.child} <= visible_links:
                yield self.report(
                    phrase(
                        "joint '{name}' has no <origin>, so '{child}' and '{parent}' have the same pose",
                        name=joint.name,
                        child=joint.child,
                        parent=joint.parent,
                    ),
                    element,
                    hint=phrase('add <origin xyz="..." rpy="..."/>, with zeros if that is intended'),
                )


_PI_FRACTIONS = (1.0, 1 / 2, 1 / 3, 2 / 3, 1 / 4, 3 / 4, 3 / 2, 2.0)


_DECIMAL = lazy_pattern(r"[+-]?[0-9]+\.[0-9]{2,5}")


def _find_pi_fraction(text: str) -> str | None:
    """Return the exact value of the fraction of pi that a rounded number approximates, or None."""
    if not _DECIMAL.fullmatch(text):
        return None
    angle = float(text)
    digits = len(text.partition(".")[2])
    for fraction in _PI_FRACTIONS:
        if abs(abs(angle) - fraction * pi) <= 10.0**-digits:
            return repr(fraction * pi if angle > 0 else -fraction * pi)
    return None


def _iterate_origins(subject: Subject) -> Iterator[tuple[str, Element]]:
    for joint, _, origin in iterate_joint_children(subject, "origin"):
        yield phrase("joint '{name}'", name=joint.name), origin
    for link in subject.links:
        if link.element is None:
            continue
        for element in link.element.elements():
            origin_element = element.first("origin") if element.tag in ("inertial", "visual", "collision") else None
            if origin_element is not None:
                yield f"<{element.tag}> of link '{link.name}'", origin_element
