"""The ``<ros2_control>`` elements of two descriptions: their renames, and the interfaces that they offer."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from linkwright.xmltree import Element

ROS2_CONTROL = "ros2_control"
_MIN_COMMON = 0.5
"""The minimum share of equal interfaces for which hardware with another name counts as renamed."""


def renamed_hardware(old: Sequence[Element], new: Sequence[Element]) -> Iterator[tuple[Element, Element]]:
    """Yield the pairs of ``<ros2_control>`` elements with different names that share at least half their interfaces."""
    old_names, new_names = ({_name(element) for element in _hardware(elements)} for elements in (old, new))
    free = [element for element in _hardware(new) if _name(element) not in old_names]
    for element in _hardware(old):
        if _name(element) in new_names:
            continue
        best = max(free, key=lambda other: _similarity(element, other), default=None)
        if best is not None and _similarity(element, best) >= _MIN_COMMON:
            free.remove(best)
            yield element, best


def interfaces_of(elements: Iterable[Element]) -> set[tuple[str, str]]:
    """Return the interfaces of hardware as pairs: the name of the joint, sensor or GPIO, and the interface name.

    A state interface has the name ``state NAME``, because controllers claim commands and states separately.
    """
    return {
        (part.attributes.get("name", ""), f"{'state ' * (each.tag == 'state_interface')}{each.attributes.get('name')}")
        for element in _hardware(elements)
        for part in element.elements()
        for each in part.elements()
        if each.tag in ("command_interface", "state_interface")
    }


def _hardware(elements: Iterable[Element]) -> list[Element]:
    return [element for element in elements if element.tag == ROS2_CONTROL]


def _name(element: Element) -> str:
    return element.attributes.get("name", "")


def _similarity(old: Element, new: Element) -> float:
    """Return the share of interfaces that two elements have in common."""
    old_interfaces, new_interfaces = interfaces_of([old]), interfaces_of([new])
    total = len(old_interfaces | new_interfaces)
    return len(old_interfaces & new_interfaces) / total if total else 0.0
