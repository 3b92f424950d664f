"""Rules about the whole robot: its tree of links, repeated elements, and its version."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping

from linkwright.diagnostics import Diagnostic, Note, Severity, phrase
from linkwright.lint.fix import remove_element
from linkwright.lint.rule import Rule
from linkwright.lint.subject import Subject
from linkwright.urdf import schema
from linkwright.xmltree import Element


class NoShapes(Rule):
    """A robot with several links but no shapes.

    ## Why

    RViz and simulators show nothing. Usually, an include or a macro call is missing, or a condition is false.

    ## Example

    ```xml
    <robot name="r">
      <link name="base_link"/>
      <link name="arm_link"/> ...
    ```

    ## Use instead

    Give the links a `<visual>`. If no joint moves and all links are empty, the description probably only defines
    frames, such as those of two cameras, and the finding is informational.
    """

    code = "LW102"
    name = "nothing-to-see"

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """Report a robot whose links have neither visuals nor collisions."""
        robot = subject.robot
        if robot is None or len(robot.links) < 2 or any(link.inertial for link in robot.links.values()):
            return  # a single link, or a model for dynamics, needs no shapes
        if any(subject.elements("ros2_control")):
            return  # a bench setup describes only hardware
        if not any(link.visuals or link.collisions for link in robot.links.values()) and not any(
            link.element is not None and (link.element.first("visual") or link.element.first("collision"))
            for link in robot.links.values()
        ):
            has_only_frames = all(joint.type == "fixed" for joint in robot.joints.values())
            yield self.report(
                phrase(
                    "none of the {count} links of robot '{name}' has a shape", count=len(robot.links), name=robot.name
                ),
                subject.root,
                hint=phrase("give the links a <visual>"),
                severity=Severity.INFO if has_only_frames else None,
            )


class DisconnectedPart(Rule):
    """A part of the robot that no joint connects to the rest.

    ## Why

    A description must be one tree, and urdfdom refuses several roots. The reader reports the second root (URDF152).
    This rule reports every further part with its links, and the joint that would connect the part.

    ## Example

    ```xml
    <link name="base_link"/>
    <link name="arm_link"/>
    <link name="camera_link"/>   <!-- and no joint -->
    ```

    ## Use instead

    ```xml
    <joint name="camera_joint" type="fixed">
      <parent link="base_link"/>
      <child link="camera_link"/>
    </joint>
    ```
    """

    code = "LW103"
    name = "disconnected-part"
    severity = Severity.ERROR

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """Report every disconnected part at its topmost link.

        The part with the most links is left out, and so is the part that the reader reports.
        """
        links = {link.name: link for link in subject.links if link.name}
        joints = [joint for joint in subject.joints if joint.parent in links and joint.child in links]
        parents = {joint.child: joint.parent for joint in joints}
        roots = [name for name in links if name not in parents]
        if len(roots) < 2:
            return
        sizes = Counter(root for root in _find_roots(links, parents).values() if root is not None)
        main_root = max(roots, key=lambda root: (sizes[root], -roots.index(root)))
        reported_root = roots[1] if roots[1] != main_root else roots[0]  # the reader's finding is at the second root
        for root in roots:
            element = links[root].element
            if root in (main_root, reported_root) or element is None:
                continue
            links_below = sizes[root] - 1
            if links_below:
                message = phrase(
                    "link '{root}' and the {count} below it are not connected to '{main}'",
                    root=root,
                    count=links_below,
                    main=main_root,
                )
            else:
                message = phrase("link '{root}' is not connected to '{main}'", root=root, main=main_root)
            yield self.report(
                message,
                element,
                hint=phrase(
                    'add <joint name="{root}_joint" type="fixed"><parent link="{main}"/><child '
                    'link="{root}"/></joint>, with the intended parent',
                    root=root,
                    main=main_root,
                ),
            )


class RepeatedElement(Rule):
    """An element that occurs twice although only the first is read.

    ## Why

    urdfdom reads the first `<origin>`, `<geometry>`, `<limit>` and so on in each parent and ignores the others. A
    change to the second element has no effect.

    ## Example

    ```xml
    <visual>
      <origin xyz="0 0 0"/>
      <origin xyz="0 0 0.5"/>
    ```

    ## Use instead

    Keep the intended element and remove the other.
    """

    code = "LW111"
    name = "repeated-element"
    holds_for_parts = True

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """Report every repetition of an element that may occur only once."""
        for schema_element in subject.structure.schema_elements:
            first_elements: dict[str, Element] = {}
            for child in schema_element.element.elements():
                rule = schema_element.rule.child_rules.get(child.tag)
                if rule is None or rule.is_repeated or schema_element.rule is schema.GEOMETRY:
                    continue
                first_element = first_elements.setdefault(child.tag, child)
                if first_element is not child:
                    yield self.report(
                        phrase(
                            "{element} has more than one <{tag}>; only the first is read",
                            element=schema_element,
                            tag=child.tag,
                        ),
                        child,
                        hint=phrase("keep only the intended <{tag}>", tag=child.tag),
                        notes=(Note(phrase("only this element is read"), first_element.span()),),
                        fix=remove_element(child, safe=False),
                    )


class NewerVersion(Rule):
    """A description of a URDF version that the robot software in use refuses.

    ## Why

    Versions 1.1 and 1.2 require urdfdom 5.1 or newer. The urdfdom of ROS 2 Jazzy and older only reads version 1.0 and
    refuses the whole model.

    ## Example

    ```xml
    <robot name="r" version="1.2">
    ```

    ## Use instead

    Write `version="1.0"`, or omit the attribute. Once all programs that read the description use a newer urdfdom,
    ignore the rule.
    """

    code = "LW113"
    name = "newer-version"

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """Report a description with a version above 1.0."""
        robot = subject.robot
        if robot is not None and robot.version > (1, 0):
            version = ".".join(map(str, robot.version))
            yield self.report(
                phrase("urdfdom rejects URDF version '{version}' in ROS 2 Jazzy and older", version=version),
                subject.root,
                "version",
                hint=phrase('write version="1.0" if the file uses nothing newer'),
            )


def _find_roots(names: Iterable[str], parents: Mapping[str, str]) -> dict[str, str | None]:
    """Return the topmost link above each link, or None if the joints form a cycle."""
    roots: dict[str, str | None] = {}
    for name in names:
        path, ancestor = [], name
        while ancestor in parents and ancestor not in roots:
            roots[ancestor] = None  # also at the end, if the walk returns to it
            path.append(ancestor)
            ancestor = parents[ancestor]
        root = roots[ancestor] if ancestor in parents else ancestor
        roots.update((descendant, root) for descendant in (name, *path))
    return roots
