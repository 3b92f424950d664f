"""The ``<ros2_control>`` elements of two descriptions: renames and interfaces."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from linkwright.xmltree import Element

ROS2_CONTROL = "ros2_control"
_MIN_SIMILARITY = 0.5
"""The minimum share of equal interfaces for which hardware with another name counts as renamed."""


def find_renamed_hardware(old: Sequence[Element], new: Sequence[Element]) -> Iterator[tuple[Element, Element]]:
    """Yield the pairs of renamed ``<ros2_control>`` elements.

    The two share at least half of their interfaces.
    """
    old_names, new_names = ({_get_name(element) for element in _select_hardware(elements)} for elements in (old, new))
    unmatched = [element for element in _select_hardware(new) if _get_name(element) not in old_names]
    for element in _select_hardware(old):
        if _get_name(element) in new_names:
            continue
        best = max(unmatched, key=lambda other: _compute_similarity(element, other), default=None)
        if best is not None and _compute_similarity(element, best) >= _MIN_SIMILARITY:
            unmatched.remove(best)
            yield element, best


def interfaces_of(elements: Iterable[Element]) -> set[tuple[str, str]]:
    """Return the interfaces of hardware as pairs.

    A pair consists of the name of the joint, sensor or GPIO, and the interface name.

    A state interface has the name ``state NAME``, because controllers claim commands and states separately.
    """
    return {
        (
            owner.attributes.get("name", ""),
            f"{'state ' * (interface.tag == 'state_interface')}{interface.attributes.get('name')}",
        )
        for element in _select_hardware(elements)
        for owner in element.elements()
        for interface in owner.elements()
        if interface.tag in ("command_interface", "state_interface")
    }


def find_lost_interfaces(old: Iterable[Element], new: Iterable[Element]) -> set[tuple[str, str]]:
    """Return the interfaces that only the old hardware has, in the form of `interfaces_of`.

    Hardware exports each item of an interface with a size, such as ``output_0`` to ``output_6``. The interface is not
    lost if the new hardware names the items.
    """
    old = list(old)
    offered = interfaces_of(new)
    arrays = {
        (owner.attributes.get("name", ""), interface.attributes.get("name"), interface.attributes["size"])
        for element in _select_hardware(old)
        for owner in element.elements()
        for interface in owner.elements()
        if interface.attributes.get("size", "").isdecimal()
    }
    named = {
        (owner, f"{kind}{name}")
        for owner, name, size in arrays
        for kind in ("", "state ")
        if int(size) and all((owner, f"{kind}{name}_{index}") in offered for index in range(int(size)))
    }
    return interfaces_of(old) - offered - named


def _select_hardware(elements: Iterable[Element]) -> list[Element]:
    return [element for element in elements if element.tag == ROS2_CONTROL]


def _get_name(element: Element) -> str:
    return element.attributes.get("name", "")


def _compute_similarity(old: Element, new: Element) -> float:
    """Return the share of interfaces that two elements have in common.

    A sensor or joint with another namespace, such as ``/imu`` instead of ``imu``, has the same interfaces.
    """
    old_interfaces, new_interfaces = (
        {(owner.rpartition("/")[2], name) for owner, name in interfaces_of([element])} for element in (old, new)
    )
    total = len(old_interfaces | new_interfaces)
    return len(old_interfaces & new_interfaces) / total if total else 0.0
