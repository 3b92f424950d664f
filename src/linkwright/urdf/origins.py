"""Reading ``<origin>``."""

from __future__ import annotations

from functools import lru_cache
from math import sqrt

from linkwright.urdf.explain import explain_attributes
from linkwright.urdf.findings import Findings
from linkwright.urdf.model import Pose
from linkwright.urdf.rotation import rpy_from_quaternion
from linkwright.urdf.schema import ORIGIN
from linkwright.urdf.values import degrees_hint, looks_like_degrees, numbers, vector3
from linkwright.xmltree import Element

_IDENTITY = Pose()
_ROUNDING = 1e-15


def read_origin(element: Element | None, owner: str, findings: Findings) -> Pose | None:
    """The pose an ``<origin>`` gives, the identity when there is none; None when it is malformed."""
    if element is None:
        return _IDENTITY
    get = element.attributes.get
    quaternion = get("quat_xyzw")
    try:
        if quaternion is not None:
            return _read_with_quaternion(element, quaternion, owner, findings)
        rpy = get("rpy", "0 0 0")
        pose, suspicious = _pose(get("xyz", "0 0 0"), rpy)
    except ValueError:
        explain_attributes(element, ORIGIN, owner, findings)
        return None
    if suspicious:
        findings.warning(
            "URDF190",
            f"'rpy' in <origin> of {owner} looks like degrees: '{rpy}'",
            element,
            "rpy",
            hint=degrees_hint(*pose.rpy),
        )
    return pose


@lru_cache(maxsize=4096)
def _pose(xyz: str, rpy: str) -> tuple[Pose, bool]:
    """The pose, and whether its angles look like degrees."""
    angles = vector3(rpy)
    return Pose(vector3(xyz), angles), looks_like_degrees(*angles)


def _read_with_quaternion(element: Element, quaternion: str, owner: str, findings: Findings) -> Pose | None:
    get = element.attributes.get
    if findings.version < (1, 1):
        findings.warning(
            "URDF171",
            f"'quat_xyzw' in <origin> of {owner} is ignored: it needs URDF 1.1",
            element,
            "quat_xyzw",
            hint='write <robot version="1.1" ...>, or give rpy',
        )
        return _pose(get("xyz", "0 0 0"), get("rpy", "0 0 0"))[0]
    if "rpy" in element.attributes:
        findings.error(
            "URDF170",
            f"<origin> of {owner} has both 'rpy' and 'quat_xyzw'",
            element,
            "quat_xyzw",
            hint="keep one of them",
        )
        return None
    found = numbers(quaternion)
    if len(found) != 4:
        raise ValueError(quaternion)
    norm = sqrt(sum(part * part for part in found))
    if abs(norm - 1) < _ROUNDING:
        norm = 1.0  # what is written for a quaternion of unit length is read as the same one
    x, y, z, w = (part / norm for part in found) if norm > 0 else (0.0, 0.0, 0.0, 1.0)
    return Pose(vector3(get("xyz", "0 0 0")), rpy_from_quaternion((x, y, z, w)), (x, y, z, w))
