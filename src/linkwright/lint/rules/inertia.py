"""Rules about masses: whether links have a mass, and whether it is plausible."""

from __future__ import annotations

from collections.abc import Iterable

from linkwright.diagnostics import Diagnostic, Note, Severity, Span, phrase, quoted_names
from linkwright.lint.finding import Finding
from linkwright.lint.option import Option
from linkwright.lint.rule import Rule
from linkwright.lint.subject import Subject
from linkwright.lint.tensors import DIAGONAL_NAMES, PRODUCT_NAMES, name_others
from linkwright.lint.walk import is_for_simulation
from linkwright.urdf import Inertial, Link
from linkwright.xmltree import Element


def find_child_or_inertial(inertial: Inertial, tag: str) -> Element | None:
    """Return a child of an ``<inertial>``, or this element itself if the child is missing.

    The result is None if the inertial does not come from an element.
    """
    element = inertial.element
    return (element.first(tag) or element) if element is not None else None


def links_with_inertial(subject: Subject) -> Iterable[tuple[Link, Inertial]]:
    """Yield the links that have an ``<inertial>``, each with this inertial."""
    for link in subject.links:
        if link.inertial is not None:
            yield link, link.inertial


class MissingInertial(Rule):
    """A moving link without `<inertial>`, although others have one or the robot is for simulation.

    ## Why

    Gazebo drops a link without mass, together with the joint that moves it, and dynamics libraries treat it as
    massless. A link that is fixed to another link needs no inertia, because simulators merge the two. Therefore, the
    rule checks links that move together as one body. If the robot is not for simulation, the finding on a link without
    shapes is only informational, since a driver may command such a link.

    ## Example

    ```xml
    <link name="arm"/>
    <joint name="shoulder" type="revolute">
      <parent link="base_link"/>
      <child link="arm"/>
      ...
    </joint>
    ```

    ## Use instead

    ```xml
    <link name="arm">
      <inertial>
        <origin xyz="0 0 0.2" rpy="0 0 0"/>
        <mass value="1.2"/>
        <inertia ixx="0.016" ixy="0" ixz="0" iyy="0.016" iyz="0" izz="0.001"/>
      </inertial>
      ...
    </link>
    ```

    `linkwright inertia FILE` computes the numbers from the link's shapes, and `--write` adds them to the file.
    """

    code = "LW301"
    name = "inertial-missing"

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        robot = subject.robot
        if robot is None:
            return
        has_inertials, is_simulated = any(link.inertial for link in robot.links.values()), is_for_simulation(subject)
        if not has_inertials and not is_simulated:
            return
        reason = phrase("others have one") if has_inertials else phrase("the robot is made for simulation")
        for body in subject.bodies.all:
            links = subject.bodies.members(body)
            if body.joint is None or any(link.inertial for link in links):
                continue
            if any(_is_broken(link) for link in links):
                continue  # the reader reports an inertial that cannot be read
            element = links[0].element
            fixed_links = [link.name for link in links[1:4]]
            notes = (
                [
                    Note(
                        phrase(
                            "the links that are fixed to it do not have one, either: {links}",
                            links=quoted_names(fixed_links),
                        )
                    )
                ]
                if fixed_links
                else []
            )
            notes.insert(
                0, Note(phrase("joint '{name}' moves it", name=body.joint.name), _find_span(body.joint.element))
            )
            yield self.report(
                phrase("moving link '{name}' has no <inertial>, although {reason}", name=links[0].name, reason=reason),
                element,
                "name",
                notes=notes,
                hint=phrase("run `linkwright inertia` to compute it from the link's shapes"),
                severity=None
                if is_simulated or any(link.visuals or link.collisions for link in links)
                else Severity.INFO,
            )


class ZeroMass(Rule):
    """A body with a mass of zero.

    ## Why

    A body without mass cannot be simulated: simulators refuse it or drop the link. A link that is only a frame and is
    fixed to a link with a mass needs no mass, and is not reported.

    ## Example

    ```xml
    <mass value="0"/>
    ```

    ## Use instead

    Write the mass in kilograms. For a link that is fixed to another link, the whole `<inertial>` may be omitted.
    """

    code = "LW302"
    name = "mass-zero"

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        for link, inertial in links_with_inertial(subject):
            if inertial.mass == 0 and not _is_frame(subject, link) and not _is_scenery(subject, inertial):
                yield self.finding(link.name, inertial)

    def finding(self, name: str, inertial: Inertial) -> Finding:
        """Return the finding on a mass of zero, in a robot or a world."""
        return self.report(
            phrase("the mass of link '{name}' is zero", name=name),
            find_child_or_inertial(inertial, "mass"),
            "value",
            hint=phrase("give its mass in kg, or leave <inertial> out if the link is only a frame"),
        )


class NegativeMass(Rule):
    """A mass below zero.

    ## Why

    A mass cannot be negative. urdfdom reads it without a warning, and the simulation becomes unstable.

    ## Example

    ```xml
    <mass value="-1.5"/>
    ```

    ## Use instead

    ```xml
    <mass value="1.5"/>
    ```
    """

    code = "LW303"
    name = "mass-negative"
    holds_for_parts = True

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        for link, inertial in links_with_inertial(subject):
            if inertial.mass < 0:
                yield self.finding(link.name, inertial)

    def finding(self, name: str, inertial: Inertial) -> Finding:
        """Return the finding on a negative mass, in a robot or a world."""
        return self.report(
            phrase("the mass of link '{name}' is negative: {mass:g} kg", name=name, mass=inertial.mass),
            find_child_or_inertial(inertial, "mass"),
            "value",
            hint=phrase("give a positive mass in kg"),
        )


class TinyMass(Rule):
    """A moving body with almost no mass.

    ## Why

    Solvers divide by masses. If one joint carries a milligram and a joint below it carries kilograms, the simulation
    jitters or becomes unstable. Such masses are placeholders, or values in tonnes.

    ## Example

    ```xml
    <mass value="1e-9"/>
    ```

    ## Use instead

    Write the mass of the part. For an auxiliary link of a joint with several axes, write at least a thousandth of the
    load.
    """

    code = "LW304"
    name = "mass-tiny"
    options = (Option("smallest", 1e-6, "smallest mass of a moving body, in kg"),)

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        smallest = self.option(subject, "smallest", float)
        tiny_bodies: list[tuple[Link, Inertial, float]] = []
        for body in subject.bodies.all:
            masses = [(link, link.inertial) for link in subject.bodies.members(body) if link.inertial is not None]
            total = sum(inertial.mass for _, inertial in masses)
            if body.joint is not None and 0 < total < smallest:
                tiny_bodies.append((*masses[0], total))
        if tiny_bodies:
            (link, inertial, total), *others = tiny_bodies
            yield self.report(
                phrase("the mass of moving link '{name}' is tiny: {total:g} kg", name=link.name, total=total),
                find_child_or_inertial(inertial, "mass"),
                "value",
                notes=[Note(name_others([other.name for other, *_ in others]))] if others else [],
                hint=phrase("masses are in kg; give the link a mass that solvers can work with"),
            )


class HugeMass(Rule):
    """A mass that is too large for a link of a robot.

    ## Why

    If a single link has a hundred tonnes, the mass is usually in grams, or the decimal point is misplaced.

    ## Example

    ```xml
    <mass value="250000"/>
    ```

    ## Use instead

    ```xml
    <mass value="250"/>
    ```
    """

    code = "LW305"
    name = "mass-huge"
    holds_for_parts = True
    options = (Option("largest", 1e5, "largest mass of a link, in kg"),)

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        largest = self.option(subject, "largest", float)
        for link, inertial in links_with_inertial(subject):
            if inertial.mass > largest:
                yield self.report(
                    phrase("the mass of link '{name}' is {mass:g} kg", name=link.name, mass=inertial.mass),
                    find_child_or_inertial(inertial, "mass"),
                    "value",
                    hint=phrase("masses are in kg; if this is in grams, write {mass:g}", mass=inertial.mass / 1000),
                )


class RootInertia(Rule):
    """An inertia on the root link, which KDL does not support.

    ## Why

    KDL's root segment cannot have an inertia, so the inertia in the file is ignored. robot_state_publisher, MoveIt and
    all other programs that use kdl_parser print a warning at every start. An empty root link above the link, such as
    `base_footprint`, solves the problem.

    ## Example

    ```xml
    <link name="base_link">
      <inertial>...</inertial>
    </link>
    ```

    ## Use instead

    ```xml
    <link name="base_footprint"/>
    <joint name="base_joint" type="fixed">
      <parent link="base_footprint"/>
      <child link="base_link"/>
    </joint>
    <link name="base_link">
      <inertial>...</inertial>
    </link>
    ```
    """

    code = "LW306"
    name = "inertia-on-root"
    severity = Severity.INFO

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        robot = subject.robot
        inertial = robot.links[robot.root].inertial if robot is not None and robot.root in robot.links else None
        if robot is not None and inertial is not None and len(robot.links) > 1:
            yield self.report(
                phrase("root link '{root}' has an inertia, which KDL ignores with a warning", root=robot.root),
                inertial.element,
                hint=phrase(
                    "add an empty root link, such as 'base_footprint', and connect it to this link with a fixed joint"
                ),
            )


def _is_frame(subject: Subject, link: Link) -> bool:
    """Return whether a massless link is part of a body with mass or of a shapeless root body."""
    body = subject.bodies.of(link.name)
    if body is None:
        return False
    members = subject.bodies.members(body)
    if any(member.inertial is not None and member.inertial.mass > 0 for member in members):
        return True
    return body.joint is None and not any(member.visuals or member.collisions for member in members)


def _is_scenery(subject: Subject, inertial: Inertial) -> bool:
    """Return whether the robot is a single link with zero inertia, which Bullet keeps fixed."""
    return len(subject.links) == 1 and not any(getattr(inertial, name) for name in (*DIAGONAL_NAMES, *PRODUCT_NAMES))


def _is_broken(link: Link) -> bool:
    """Return whether a link has an ``<inertial>`` that could not be read."""
    return link.element is not None and link.element.first("inertial") is not None and link.inertial is None


def _find_span(element: Element | None) -> Span | None:
    return element.span() if element is not None else None
