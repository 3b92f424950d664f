"""Robots whose groups are found: chains of links with boxes, fingers, wheels and a torso."""

from __future__ import annotations

from linkwright.descriptions.service import load
from linkwright.urdf import Robot

BOX = "<collision><geometry><box size='{0} {0} {0}'/></geometry></collision>"


def link(name: str, size: float = 0.0) -> str:
    """Return a link, with a box if it has a size in m."""
    return f"<link name='{name}'>{BOX.format(size) if size else ''}</link>"


def joint(
    name: str,
    parent: str,
    child: str,
    *,
    kind: str = "revolute",
    xyz: str = "0 0 0.3",
    axis: str = "0 1 0",
    limits: tuple[float, float] = (-2.0, 2.0),
    mimic: str = "",
) -> str:
    """Return a joint."""
    limit = (
        ""
        if kind in ("fixed", "continuous")
        else f"<limit lower='{limits[0]}' upper='{limits[1]}' effort='1' velocity='1'/>"
    )
    follows = f"<mimic joint='{mimic}'/>" if mimic else ""
    return (
        f"<joint name='{name}' type='{kind}'><parent link='{parent}'/><child link='{child}'/>"
        f"<origin xyz='{xyz}'/><axis xyz='{axis}'/>{limit}{follows}</joint>"
    )


def chain(parent: str, prefix: str, count: int, *, xyz: str = "0 0 0.3") -> str:
    """Return joints and links one after the other, named by a prefix and a number."""
    parts = []
    for index in range(1, count + 1):
        child = f"{prefix}link_{index}"
        axis = "0 0 1" if index % 2 else "0 1 0"
        parts.append(link(child, 0.05) + joint(f"{prefix}joint_{index}", parent, child, xyz=xyz, axis=axis))
        parent, xyz = child, "0 0 0.3"
    return "".join(parts)


def fingers(parent: str, prefix: str, count: int = 2, *, mimic: bool = True) -> str:
    """Return prismatic fingers; all but the first mimic the first one."""
    parts = []
    for index in range(1, count + 1):
        child = f"{prefix}finger_{index}"
        sign = 1 if index % 2 else -1
        parts.append(
            link(child, 0.02)
            + joint(
                f"{child}_joint",
                parent,
                child,
                kind="prismatic",
                xyz=f"0 {sign * 0.02} {0.05 * ((index + 1) // 2)}",
                axis=f"0 {sign} 0",
                limits=(0.0, 0.04),
                mimic=f"{prefix}finger_1_joint" if mimic and index > 1 else "",
            )
        )
    return "".join(parts)


def wheels(parent: str) -> str:
    """Return two wheels and a caster of two joints."""
    parts = []
    for side, y in (("left", 0.3), ("right", -0.3)):
        name = f"{side}_wheel"
        parts.append(link(name, 0.1) + joint(f"{name}_joint", parent, name, kind="continuous", xyz=f"0 {y} 0"))
    parts.append(link("caster") + joint("caster_joint", parent, "caster", kind="continuous", xyz="0.3 0 0"))
    parts.append(link("roll") + joint("roll_joint", "caster", "roll", kind="continuous", xyz="0 0 -0.1"))
    return "".join(parts)


def robot(*parts: str, name: str = "test_robot") -> Robot:
    """Return a robot."""
    return load(f"<robot name='{name}'>{''.join(parts)}</robot>")


def mobile_arm() -> Robot:
    """Return an arm with a palm, a tool frame and two fingers, on a base with wheels."""
    return robot(
        link("base", 0.2),
        wheels("base"),
        chain("base", "", 6),
        link("hand", 0.06) + joint("hand_mount", "link_6", "hand", kind="fixed", xyz="0 0 0.1"),
        link("hand_tcp") + joint("tcp_mount", "hand", "hand_tcp", kind="fixed", xyz="0 0 0.1"),
        fingers("hand", ""),
    )


def two_arms() -> Robot:
    """Return a torso with two arms, each with a gripper, and a head of two joints."""
    return robot(
        link("base", 0.2),
        link("torso", 0.2) + joint("lift", "base", "torso", kind="prismatic", limits=(0.0, 0.3)),
        *(
            chain("torso", f"{side}_", 5, xyz=f"0 {y} 0") + fingers(f"{side}_link_5", f"{side}_")
            for side, y in (("left", 0.3), ("right", -0.3))
        ),
        chain("torso", "head_", 2),
    )
