"""Rules about references to links and joints from ``<gazebo>`` and similar elements."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from linkwright.diagnostics import Diagnostic, Note, Severity, did_you_mean, phrase, quoted
from linkwright.diagnostics.misspellings import find_misspelled
from linkwright.lint.extension_names import INTERFACE_NAMES, JOINT_ELEMENTS, LINK_ELEMENTS
from linkwright.lint.fix import replace_value
from linkwright.lint.rule import Rule
from linkwright.lint.subject import Subject
from linkwright.loading.deferred import lazy_pattern
from linkwright.xmltree import Element
from linkwright.xmltree.patches import find_element_range

_NUMBER = lazy_pattern(r"\d+")
_IMPORTANT_ELEMENTS = frozenset({"sensor", "plugin", "preserveFixedJoint", "disableFixedJointLumping"})
"""Elements whose absence affects a user, unlike the absence of a color."""
_PLACEHOLDER_CHARACTERS = frozenset("${}")
"""Characters of a name with a placeholder that a program did not fill in."""


def _collect_names(subject: Subject, tag: str) -> set[str]:
    return {element.attributes.get("name", "") for element in subject.elements(tag)}


def _filter_by_numbers(name: str, candidates: Iterable[str]) -> list[str]:
    """Return the candidates that contain the same numbers as a name.

    Other names are siblings: ``arm_1`` is not a misspelling of ``arm_2``.
    """
    return [candidate for candidate in candidates if _NUMBER.findall(candidate) == _NUMBER.findall(name)]


def _guess_kind(gazebo: Element, name: str) -> str:
    """Return the kind of object that a `<gazebo>` probably refers to.

    The kind is ``link`` or ``joint``, or empty if it is unknown. It is derived from the content of the `<gazebo>` or,
    if that is not possible, from the name.
    """
    child_tags = {child.tag for child in gazebo.elements()}
    if child_tags & JOINT_ELEMENTS:
        return "joint"
    if child_tags & LINK_ELEMENTS:
        return "link"
    return next((kind for kind in ("link", "joint") if kind in name.casefold()), "")


def _is_left_over(gazebo: Element, name: str) -> bool:
    """Return whether a `<gazebo>` with an unknown reference seems to belong to an absent part."""
    return _PLACEHOLDER_CHARACTERS.isdisjoint(name) and not any(
        child.tag in _IMPORTANT_ELEMENTS for child in gazebo.elements()
    )


def _is_ros1_control(element: Element) -> bool:
    """Return whether an element is the plugin of ROS 1 that reads transmissions."""
    library = element.attributes.get("filename", "").strip().rpartition("/")[2]
    return element.tag == "plugin" and library in ("libgazebo_ros_control.so", "gazebo_ros_control")


def _iterate_control_joints(subject: Subject) -> Iterator[tuple[Element, Element]]:
    """Yield every ``<ros2_control>`` with each of its joints."""
    for system in subject.elements("ros2_control"):
        for joint in system.elements("joint"):
            yield system, joint


class GazeboReferenceUnknown(Rule):
    """A `<gazebo reference="...">` that names neither a link nor a joint.

    ## Why

    Gazebo silently drops the content of the element, so a wheel has no friction, or a camera has no sensor. The finding
    is only informational if the reference probably belongs to a part that this robot does not have: no name is
    similar, only colors and surfaces are lost, and most references of the description are valid.

    ## Example

    ```xml
    <gazebo reference="camera">   <!-- the link is called camera_link -->
    ```

    ## Use instead

    ```xml
    <gazebo reference="camera_link">
    ```
    """

    code = "LW120"
    name = "gazebo-reference-unknown"
    needs_all_sets = True

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """Report every reference to a link or joint that does not exist."""
        links, joints = _collect_names(subject, "link"), _collect_names(subject, "joint")
        references = [
            (element, name) for element in subject.elements("gazebo") if (name := element.attributes.get("reference"))
        ]
        unknown_references = [(element, name) for element, name in references if name not in links | joints]
        are_exceptions = 2 * len(unknown_references) < len(references)
        for element, name in unknown_references:
            kind = _guess_kind(element, name)
            candidates = {"link": links, "joint": joints}.get(kind, links | joints)
            plausible_names = _filter_by_numbers(name, candidates)
            intended = find_misspelled(name, plausible_names)
            suggestion = did_you_mean(name, plausible_names)
            yield self.report(
                phrase("<gazebo> refers to '{name}', which is neither a link nor a joint", name=name),
                element,
                "reference",
                hint=suggestion or phrase("give the name of a link or joint"),
                fix=replace_value(element, "reference", intended, safe=False) if intended else None,
                severity=Severity.INFO if are_exceptions and not suggestion and _is_left_over(element, name) else None,
            )


class TransmissionJointUnknown(Rule):
    """A `<transmission>` of a joint that does not exist.

    ## Why

    The program that reads the transmission stops with an error, or leaves the joint without a drive.

    ## Example

    ```xml
    <transmission name="elbow_transmission">
      <joint name="elbw_joint"> ...
    ```

    ## Use instead

    Write the name of the joint as in the description.
    """

    code = "LW121"
    name = "transmission-joint-unknown"

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """Report every transmission of a missing joint, also in ``<ros2_control>``."""
        joint_names = _collect_names(subject, "joint")
        transmissions = list(subject.elements("transmission"))
        transmissions += [
            nested for system in subject.elements("ros2_control") for nested in system.elements("transmission")
        ]
        for transmission in transmissions:
            for joint in transmission.elements("joint"):
                name = joint.attributes.get("name")
                if name and name not in joint_names:
                    yield self.report(
                        phrase("<transmission> names joint '{name}', which does not exist", name=name),
                        joint,
                        "name",
                        hint=did_you_mean(name, _filter_by_numbers(name, joint_names))
                        or phrase("give the name of a joint"),
                    )


class ControlJointUnknown(Rule):
    """A `<ros2_control>` with a joint that does not exist.

    ## Why

    The hardware offers interfaces for a joint that the robot does not have. The state of the joint is published, but no
    frame moves, and gz_ros2_control skips the joint.

    ## Example

    ```xml
    <ros2_control name="arm" type="system">
      <joint name="elbw_joint">
    ```

    ## Use instead

    Write the name of the joint as in the description.
    """

    code = "LW122"
    name = "control-joint-unknown"

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """Report every joint of ros2_control that the robot does not have."""
        joint_names = _collect_names(subject, "joint")
        if not joint_names:
            return  # a file without joints describes only the hardware
        for _, joint in _iterate_control_joints(subject):
            name = joint.attributes.get("name")
            if name and name not in joint_names:
                intended = find_misspelled(name, joint_names)
                yield self.report(
                    phrase("<ros2_control> names the joint '{name}', which the robot does not have", name=name),
                    joint,
                    "name",
                    hint=did_you_mean(name, _filter_by_numbers(name, joint_names))
                    or phrase('add <joint name="{name}" ...> to the robot', name=name),
                    fix=replace_value(joint, "name", intended, safe=False) if intended else None,
                )


class ControlInterfaceMisspelled(Rule):
    """A misspelled standard interface in `<ros2_control>`.

    ## Why

    Interfaces are matched by their names. A controller that requires `elbow/position` does not find `elbow/positon`,
    and is not activated.

    ## Example

    ```xml
    <command_interface name="positon"/>
    ```

    ## Use instead

    ```xml
    <command_interface name="position"/>
    ```
    """

    code = "LW123"
    name = "control-interface-misspelled"
    holds_for_parts = True

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """Report every joint interface whose name is close to a standard name."""
        for _, joint in _iterate_control_joints(subject):
            for interface in joint.elements():
                if interface.tag not in ("command_interface", "state_interface"):
                    continue
                name = interface.attributes.get("name", "")
                intended = (
                    find_misspelled(name, INTERFACE_NAMES) if name.isalpha() and name not in INTERFACE_NAMES else None
                )
                if intended is not None:
                    yield self.report(
                        phrase("no controller requests an interface '{name}'", name=name),
                        interface,
                        "name",
                        hint=phrase("did you mean {names}?", names=quoted(intended)),
                        fix=replace_value(interface, "name", intended, safe=False),
                    )


class ControlPluginMissing(Rule):
    """A `<ros2_control>` that names no hardware plugin.

    ## Why

    The controller manager has nothing to load and stops with an error.

    ## Example

    ```xml
    <ros2_control name="arm" type="system">
      <joint name="elbow_joint"> ...
    ```

    ## Use instead

    ```xml
    <ros2_control name="arm" type="system">
      <hardware>
        <plugin>mock_components/GenericSystem</plugin>
      </hardware>
    ```
    """

    code = "LW124"
    name = "control-plugin-missing"
    holds_for_parts = True
    severity = Severity.ERROR

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """Report every ros2_control without a plugin."""
        for system in subject.elements("ros2_control"):
            hardware = system.first("hardware")
            if hardware is None and any(find_misspelled(child.tag, ["hardware"]) for child in system.elements()):
                continue  # a misspelled <hardware>, which another rule reports
            plugin = hardware.first("plugin") if hardware is not None else None
            if plugin is None and ("<hardware" if hardware is None else "<plugin") in _read_source_text(system):
                continue  # the file has this element in a branch that xacro left out
            if plugin is None or not plugin.text().strip():
                missing_tag = "<hardware>" if hardware is None else "<plugin>"
                yield self.report(
                    phrase(
                        "<ros2_control> '{name}' has no {missing}",
                        name=system.attributes.get("name", ""),
                        missing=missing_tag,
                    ),
                    plugin or hardware or system,
                    hint=phrase(
                        "add <hardware><plugin>PACKAGE/CLASS</plugin></hardware>, such as mock_components/GenericSystem"
                    ),
                )


def _read_source_text(element: Element) -> str:
    """Return the text of an element in its file, including the parts that xacro left out."""
    element_span = find_element_range(element)
    return "" if element.source is None or element_span is None else element.source.text[slice(*element_span)]


class ControlJointRepeated(Rule):
    """A joint twice in one `<ros2_control>`.

    ## Why

    Both elements offer interfaces with the same names, which the resource manager refuses.

    ## Example

    ```xml
    <ros2_control name="arm" type="system">
      <joint name="elbow_joint"> ... </joint>
      <joint name="elbow_joint"> ... </joint>
    ```

    ## Use instead

    Write all interfaces of a joint in one `<joint>`.
    """

    code = "LW125"
    name = "control-joint-repeated"
    holds_for_parts = True

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """Report every joint after the first one with the same name in a ``<ros2_control>``."""
        for system in subject.elements("ros2_control"):
            first_joints: dict[str, Element] = {}
            for joint in system.elements("joint"):
                name = joint.attributes.get("name", "")
                first_joint = first_joints.setdefault(name, joint)
                if name and first_joint is not joint:
                    yield self.report(
                        phrase("joint '{name}' is in this <ros2_control> twice", name=name),
                        joint,
                        "name",
                        hint=phrase("write all its interfaces in one <joint>"),
                        notes=(Note(phrase("first listed here"), first_joint.span()),),
                    )


class ControlOfFixedJoint(Rule):
    """A command interface for a fixed joint.

    ## Why

    A fixed joint ignores all commands. Usually, the author made the joint fixed for a test.

    ## Example

    ```xml
    <joint name="camera_joint">   <!-- type="fixed" in the robot -->
      <command_interface name="position"/>
    ```

    ## Use instead

    Remove the joint from `<ros2_control>`, or give it the type of a moving joint.
    """

    code = "LW126"
    name = "control-of-fixed-joint"

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """Report every command interface of a fixed joint."""
        fixed_joints = {joint.name: joint for joint in subject.joints if joint.type == "fixed"}
        for _, control_joint in _iterate_control_joints(subject):
            joint = fixed_joints.get(control_joint.attributes.get("name", ""))
            command = control_joint.first("command_interface")
            if joint is None or command is None or joint.element is None:
                continue
            if joint.element.attributes.get("type") != "fixed":
                continue  # the reader reports an invalid type
            yield self.report(
                phrase("<ros2_control> commands joint '{name}', which is fixed", name=joint.name),
                command,
                hint=phrase("remove it, or give the joint a type that moves"),
                notes=(Note(phrase("joint '{name}' is defined here", name=joint.name), joint.element.span()),),
            )


class TransmissionIgnored(Rule):
    """A `<transmission>` directly in `<robot>`, which nothing in ROS 2 reads.

    ## Why

    A `<transmission>` in `<robot>` is the form of ROS 1. ros2_control and its Gazebo plugins only read joints,
    interfaces and transmissions inside `<ros2_control>`. Only the simulation of Linkwright also runs the plugin of
    ROS 1, `libgazebo_ros_control.so`. Robots that have both forms are not reported. Neither are files that may be for
    ROS 1: those in packages built with catkin, the build tool of ROS 1, and those outside a package.

    ## Example

    ```xml
    <transmission name="elbow_transmission">
      <type>transmission_interface/SimpleTransmission</type> ...
    ```

    ## Use instead

    ```xml
    <ros2_control name="arm" type="system">
      <hardware><plugin>mock_components/GenericSystem</plugin></hardware>
      <joint name="elbow_joint">
        <command_interface name="position"/>
        <state_interface name="position"/>
      </joint>
    </ros2_control>
    ```
    """

    code = "LW127"
    name = "transmission-ignored"
    severity = Severity.INFO

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """Report the first transmission in the form of ROS 1."""
        manifest = subject.package.manifest if subject.package is not None else None
        if manifest is None or manifest.is_ros1 or any(subject.elements("ros2_control")):
            return
        transmissions = list(subject.elements("transmission"))
        if transmissions:
            message = phrase("nothing in ROS 2 reads <transmission> directly in <robot>")
            if len(transmissions) > 1:
                message = phrase("{message} (and {count} more)", message=message, count=len(transmissions) - 1)
            hint = phrase("write <ros2_control> with the joints and their interfaces")
            if any(_is_ros1_control(plugin) for gazebo in subject.elements("gazebo") for plugin in gazebo.elements()):
                hint = phrase("{hint}, and libgazebo_ros2_control.so instead of libgazebo_ros_control.so", hint=hint)
            yield self.report(message, transmissions[0], hint=hint)
