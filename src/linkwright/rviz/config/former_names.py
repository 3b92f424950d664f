"""The names that RViz 1 used for classes, and for keys that have changed since.

A file of RViz 1 contains ``Class: rviz/Grid``, ``Topic: /scan`` next to ``Queue Size``, and ``Robot Description``.
Such a file is read through these names, and edits are written under them, so that it remains a file of RViz 1.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType

Path = tuple[str, ...]

GROUP = "rviz_common/Group"
"""The class of a display that holds others."""

_FORMER = "rviz/"
_PRESENT = "rviz_default_plugins/"
_RENAMED = {"Group": GROUP, "WrenchStamped": _PRESENT + "Wrench"}


def is_former(cls: str) -> bool:
    """Return whether a class is named as in RViz 1."""
    return cls.startswith(_FORMER)


def modern_class(cls: str) -> str:
    """Return RViz 2's class name of a display, tool or view, given its name in RViz 1 or RViz 2."""
    if not is_former(cls):
        return cls
    name = cls.removeprefix(_FORMER)
    return _RENAMED.get(name, _PRESENT + name)


@dataclass(frozen=True, slots=True)
class FormerKey:
    """The RViz 1 key for a property of RViz 2.

    Attributes:
        key: the key, at the same level as the display's ``Class``.
        read: converts a value to its spelling in RViz 2.
        write: converts a value to its spelling in RViz 1.
    """

    key: str
    read: Callable[[str], str] = str
    write: Callable[[str], str] = str


def former_keys(cls: str) -> Mapping[Path, FormerKey]:
    """Return the RViz 1 keys for a class by property path; an empty mapping for a class of RViz 2."""
    if not is_former(cls):
        return _NONE
    return _BY_CLASS.get(cls.removeprefix(_FORMER), _TOPIC)


def _reliability(unreliable: str) -> str:
    return "Best Effort" if unreliable.strip().lower() in ("true", "1") else "Reliable"


def _unreliable(reliability: str) -> str:
    return "true" if reliability == "Best Effort" else "false"


def _namespace(update_topic: str) -> str:
    return update_topic.removesuffix("/update")


def _update_topic(namespace: str) -> str:
    return f"{namespace.rstrip('/')}/update"


def _variance(deviation: str) -> str:
    try:
        return repr(float(deviation) ** 2)
    except (ValueError, OverflowError):
        return deviation


def _deviation(variance: str) -> str:
    try:
        return repr(math.sqrt(float(variance)))
    except ValueError:
        return variance


def _quality(topic: Path) -> dict[Path, FormerKey]:
    return {
        (*topic, "Depth"): FormerKey("Queue Size"),
        (*topic, "Reliability Policy"): FormerKey("Unreliable", _reliability, _unreliable),
    }


def _named(topic: str) -> dict[Path, FormerKey]:
    return {("Topic",): FormerKey(topic), **_quality(("Topic",))}


_NONE: Mapping[Path, FormerKey] = MappingProxyType({})
_TOPIC: Mapping[Path, FormerKey] = MappingProxyType(_quality(("Topic",)))
_BY_CLASS: Mapping[str, Mapping[Path, FormerKey]] = MappingProxyType(
    {
        "Camera": _named("Image Topic"),
        "DepthCloud": _NONE,
        "Image": _named("Image Topic"),
        "InteractiveMarkers": {
            ("Interactive Markers Namespace",): FormerKey("Update Topic", _namespace, _update_topic)
        },
        "Marker": _named("Marker Topic"),
        "MarkerArray": _named("Marker Topic"),
        "RobotModel": {("Description Topic",): FormerKey("Robot Description")},
        "SetInitialPose": {
            ("Covariance x",): FormerKey("X std deviation", _variance, _deviation),
            ("Covariance y",): FormerKey("Y std deviation", _variance, _deviation),
            ("Covariance yaw",): FormerKey("Theta std deviation", _variance, _deviation),
        },
    }
)
