"""The semantic description of a robot (SRDF).

It has groups, named states, end effectors, and the pairs of links that may collide.

Source: the SRDF specification and the package ``srdfdom``.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TypeVar

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, phrase
from linkwright.xmltree import Element, parse

_T = TypeVar("_T")


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
        problems: the errors of the elements that were left out, ARM101 and ARM102.
    """

    name: str
    groups: Mapping[str, GroupDefinition]
    states: Mapping[str, Mapping[str, Mapping[str, float]]]
    end_effectors: tuple[EndEffector, ...]
    virtual_joints: tuple[VirtualJoint, ...]
    passive_joints: frozenset[str]
    disabled_collisions: Mapping[frozenset[str], str]
    problems: tuple[Diagnostic, ...] = ()


def read_semantics(text: str, name: str = "<robot_description_semantic>") -> Semantics:
    """Read an SRDF.

    As in MoveIt, elements that lack an attribute or have an invalid number are left out.

    Raises:
        LinkwrightError: the text is not XML.
    """
    root = parse(text, name).root
    problems: list[Diagnostic] = []
    groups = {group.name: group for group in _read_all(root, "group", _read_group, problems)}
    states: dict[str, dict[str, dict[str, float]]] = {}
    for group, state, positions in _read_all(root, "group_state", _read_state, problems):
        states.setdefault(group, {})[state] = positions
    return Semantics(
        root.attributes.get("name", ""),
        groups,
        states,
        tuple(_read_all(root, "end_effector", _read_end_effector, problems)),
        tuple(_read_all(root, "virtual_joint", _read_virtual_joint, problems)),
        frozenset(_read_all(root, "passive_joint", _read_name, problems)),
        _read_disabled_collisions(root, problems),
        tuple(problems),
    )


def _read_all(
    parent: Element, tag: str, read: Callable[[Element, list[Diagnostic]], _T], problems: list[Diagnostic]
) -> list[_T]:
    """Return what the children with a tag say, and collect the errors of those that cannot be read."""
    results = (_try_to_read(element, read, problems) for element in parent.elements(tag))
    return [result for result in results if result is not None]


def _try_to_read(
    element: Element, read: Callable[[Element, list[Diagnostic]], _T], problems: list[Diagnostic]
) -> _T | None:
    try:
        return read(element, problems)
    except LinkwrightError as error:
        problems.extend(error.diagnostics)
        return None


def _read_name(element: Element, _: list[Diagnostic]) -> str:
    return _attribute(element, "name")


def _read_group(element: Element, problems: list[Diagnostic]) -> GroupDefinition:
    return GroupDefinition(
        _attribute(element, "name"),
        tuple(_read_all(element, "link", _read_name, problems)),
        tuple(_read_all(element, "joint", _read_name, problems)),
        tuple(_read_all(element, "chain", _read_chain, problems)),
        tuple(_read_all(element, "group", _read_name, problems)),
    )


def _read_chain(element: Element, _: list[Diagnostic]) -> tuple[str, str]:
    return _attribute(element, "base_link"), _attribute(element, "tip_link")


def _read_state(element: Element, problems: list[Diagnostic]) -> tuple[str, str, dict[str, float]]:
    """Return the group, the name and the joint positions of a named state."""
    group, state = _attribute(element, "group"), _attribute(element, "name")
    positions = _read_all(element, "joint", _read_position, problems)
    return group, state, {joint: numbers[0] for joint, numbers in positions if len(numbers) == 1}


def _read_position(element: Element, _: list[Diagnostic]) -> tuple[str, list[float]]:
    joint, text = _attribute(element, "name"), _attribute(element, "value")
    try:
        return joint, [float(word) for word in text.split()]
    except ValueError:
        raise _invalid_element(element, phrase("'{text}' is not a number", text=text), "value") from None


def _read_end_effector(element: Element, _: list[Diagnostic]) -> EndEffector:
    return EndEffector(
        _attribute(element, "name"),
        _attribute(element, "group"),
        _attribute(element, "parent_link"),
        element.attributes.get("parent_group", ""),
    )


def _read_virtual_joint(element: Element, _: list[Diagnostic]) -> VirtualJoint:
    return VirtualJoint(*(_attribute(element, name) for name in ("name", "type", "parent_frame", "child_link")))


def _read_disabled_collisions(root: Element, problems: list[Diagnostic]) -> dict[frozenset[str], str]:
    """Return the disabled pairs, by the rules of Jazzy.

    A link in ``disable_default_collisions`` may collide with all links that have no ``enable_collisions`` with it;
    such a link forms a pair with the empty name.
    """
    disabled: dict[frozenset[str], str] = {}
    for link in _read_all(root, "disable_default_collisions", _read_default_link, problems):
        disabled[frozenset((link, ""))] = "Default"
    disabled.update(_read_all(root, "disable_collisions", _read_disabled_pair, problems))
    return disabled


def _read_default_link(element: Element, _: list[Diagnostic]) -> str:
    return _attribute(element, "link")


def _read_disabled_pair(element: Element, _: list[Diagnostic]) -> tuple[frozenset[str], str]:
    pair = frozenset((_attribute(element, "link1"), _attribute(element, "link2")))
    return pair, element.attributes.get("reason", "")


def _attribute(element: Element, name: str) -> str:
    value = element.attributes.get(name)
    if value is None:
        raise _invalid_element(element, phrase("<{tag}> has no attribute '{name}'", tag=element.tag, name=name))
    return value.strip()


def _invalid_element(element: Element, message: Phrase, attribute: str = "") -> LinkwrightError:
    span = element.attribute_span(attribute) if attribute else element.span()
    return LinkwrightError(Diagnostic("ARM101", message, span))
