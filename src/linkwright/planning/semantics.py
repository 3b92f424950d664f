"""The semantic description of a robot (SRDF).

It has groups, named states, end effectors, and the pairs of links that may collide.

Source: the SRDF specification and the package ``srdfdom``.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, phrase
from linkwright.xmltree import Element, parse


@dataclass(frozen=True, slots=True)
class GroupDefinition:
    """A group of joints as the SRDF defines it.

    Attributes:
        links: links whose parent joints belong to the group.
        joints: joints of the group.
        chains: pairs of a base link and a tip link; the joints between them belong to the group.
        subgroups: groups whose joints belong to this group.
    """

    name: str
    links: tuple[str, ...] = ()
    joints: tuple[str, ...] = ()
    chains: tuple[tuple[str, str], ...] = ()
    subgroups: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class EndEffector:
    """A gripper or tool: the group with its joints, and the link to which it is attached."""

    name: str
    group: str
    parent_link: str
    parent_group: str = ""


@dataclass(frozen=True, slots=True)
class VirtualJoint:
    """A joint between a frame outside of the robot and its root link."""

    name: str
    type: str
    parent_frame: str
    child_link: str


@dataclass(frozen=True, slots=True)
class Semantics:
    """The contents of an SRDF.

    Attributes:
        groups: the groups by name, in the order of the file.
        states: the joint positions in rad or m of each named state, by group and name of the state. Joints with
            several positions (planar, floating) are left out.
        disabled_collisions: the pairs of links that may collide, each with the reason in the file.
        passive_joints: the joints without a motor.
    """

    name: str
    groups: Mapping[str, GroupDefinition]
    states: Mapping[str, Mapping[str, Mapping[str, float]]]
    end_effectors: tuple[EndEffector, ...]
    virtual_joints: tuple[VirtualJoint, ...]
    passive_joints: frozenset[str]
    disabled_collisions: Mapping[frozenset[str], str]


def read_semantics(text: str, name: str = "<robot_description_semantic>") -> Semantics:
    """Read an SRDF.

    Raises:
        LinkwrightError: the text is not XML; ARM101, an element lacks an attribute or has an invalid number.
    """
    root = parse(text, name).root
    groups = {group.name: group for group in map(_read_group, root.elements("group"))}
    states: dict[str, dict[str, dict[str, float]]] = {}
    for element in root.elements("group_state"):
        group_states = states.setdefault(_attribute(element, "group"), {})
        group_states[_attribute(element, "name")] = _read_positions(element)
    return Semantics(
        root.attributes.get("name", ""),
        groups,
        states,
        tuple(map(_read_end_effector, root.elements("end_effector"))),
        tuple(map(_read_virtual_joint, root.elements("virtual_joint"))),
        frozenset(_attribute(element, "name") for element in root.elements("passive_joint")),
        _read_disabled_collisions(root),
    )


def _read_group(element: Element) -> GroupDefinition:
    return GroupDefinition(
        _attribute(element, "name"),
        tuple(_attribute(child, "name") for child in element.elements("link")),
        tuple(_attribute(child, "name") for child in element.elements("joint")),
        tuple((_attribute(child, "base_link"), _attribute(child, "tip_link")) for child in element.elements("chain")),
        tuple(_attribute(child, "name") for child in element.elements("group")),
    )


def _read_positions(state: Element) -> dict[str, float]:
    positions: dict[str, float] = {}
    for element in state.elements("joint"):
        words = _attribute(element, "value").split()
        try:
            numbers = [float(word) for word in words]
        except ValueError:
            text = element.attributes["value"]
            raise _invalid_element(element, phrase("'{text}' is not a number", text=text), "value") from None
        if len(numbers) == 1:
            positions[_attribute(element, "name")] = numbers[0]
    return positions


def _read_end_effector(element: Element) -> EndEffector:
    return EndEffector(
        _attribute(element, "name"),
        _attribute(element, "group"),
        _attribute(element, "parent_link"),
        element.attributes.get("parent_group", ""),
    )


def _read_virtual_joint(element: Element) -> VirtualJoint:
    return VirtualJoint(*(_attribute(element, name) for name in ("name", "type", "parent_frame", "child_link")))


def _read_disabled_collisions(root: Element) -> dict[frozenset[str], str]:
    """Return the disabled pairs, by the rules of Jazzy.

    A link in ``disable_default_collisions`` may collide with all links that have no ``enable_collisions`` with it;
    such a link forms a pair with the empty name.
    """
    disabled: dict[frozenset[str], str] = {}
    for element in root.elements("disable_default_collisions"):
        disabled[frozenset((_attribute(element, "link"), ""))] = "Default"
    for element in root.elements("disable_collisions"):
        disabled[_link_pair(element)] = element.attributes.get("reason", "")
    return disabled


def _link_pair(element: Element) -> frozenset[str]:
    return frozenset((_attribute(element, "link1"), _attribute(element, "link2")))


def _attribute(element: Element, name: str) -> str:
    value = element.attributes.get(name)
    if value is None:
        raise _invalid_element(element, phrase("<{tag}> has no attribute '{name}'", tag=element.tag, name=name))
    return value.strip()


def _invalid_element(element: Element, message: Phrase, attribute: str = "") -> LinkwrightError:
    span = element.attribute_span(attribute) if attribute else element.span()
    return LinkwrightError(Diagnostic("ARM101", message, span))
