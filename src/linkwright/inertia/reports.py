"""Estimates of mass properties as text for people and as JSON for programs."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import asdict
from math import isclose
from typing import Any

from linkwright.diagnostics import display_path
from linkwright.geometry.mass import MassProperties
from linkwright.inertia.blocks import inertial_block
from linkwright.inertia.comparison import Comparison, compare
from linkwright.inertia.estimate import Estimate
from linkwright.inertia.inertial import from_inertial, is_computable, to_inertial
from linkwright.inertia.writing import Written
from linkwright.urdf import Robot

_STEP = "  "


def as_text(robot: Robot, estimates: Sequence[Estimate], written: Written | None = None) -> str:
    """For each link what was taken, the block, and how the one in the file compares.

    Args:
        robot: the robot.
        estimates: of its links.
        written: what came of writing; the blocks that were written are not printed.
    """
    parts = []
    for found in estimates:
        lines = [f"{found.link}: {_summary(found)}"]
        lines += [f"{_STEP}note: {note}" for note in found.notes]
        if found.properties is not None:
            if written is None or found.link in written.refused:
                lines.append(f"{_STEP}{inertial_block(found.properties, _STEP)}")
            where = "in the file" if written is None or found.link in written.refused else "it was"
            lines.append(f"{_STEP}{where}: {_comparison_text(robot, found.link, found.properties)}")
        parts.append("\n".join(lines) + "\n")
    if written is not None:
        count = len(written.links)
        files = ", ".join(f"'{display_path(file)}'" for file in written.files) or "no file"
        parts.append(f"wrote {count} <inertial> to {files}\n")
    return "\n".join(parts)


def as_json(robot: Robot, estimates: Sequence[Estimate], written: Written | None = None) -> str:
    """The same as an object with ``links``, a list in file order; SI units, floats in full."""
    links = [_link_data(robot, found, written) for found in estimates]
    files = [] if written is None else [str(file) for file in written.files]
    return json.dumps({"links": links, "files": files}, indent=2, ensure_ascii=False) + "\n"


def _summary(found: Estimate) -> str:
    if found.properties is None:
        return "no shape with a volume, so nothing is computed"
    shapes = f"{found.shapes} {found.kind} shape{'' if found.shapes == 1 else 's'}"
    mass = {"mass": "mass as given", "present": "mass as in the file", "density": "mass from density"}[found.basis]
    return f"{shapes}, {mass}: {found.properties.mass:.6g} kg at {found.density:.4g} kg/m3"


def _comparison_text(robot: Robot, link: str, properties: MassProperties) -> str:
    compared = _compared(robot, link, properties)
    if compared is None:
        return "no <inertial>" if robot.links[link].inertial is None else "numbers beyond all bounds"
    words = [f"mass {compared.mass:.6g} kg"]
    if compared.mass_ratio is not None and not isclose(compared.mass_ratio, 1.0, rel_tol=1e-6):
        words[0] += f" ({compared.mass_ratio:.3g} times)"
    words.append(f"centre of mass {compared.center_distance * 1000:.3g} mm away")
    if compared.moment_ratios is not None:
        ratios = " ".join(f"{ratio:.3g}" for ratio in compared.moment_ratios)
        words.append(f"principal moments for each kg {ratios} times")
    return ", ".join(words) + "".join(f"; {problem}" for problem in compared.problems)


def _compared(robot: Robot, link: str, properties: MassProperties) -> Comparison | None:
    inertial = robot.links[link].inertial
    if inertial is None or not is_computable(inertial):
        return None
    return compare(from_inertial(inertial), properties)


def _link_data(robot: Robot, found: Estimate, written: Written | None) -> dict[str, Any]:
    data: dict[str, Any] = {"link": found.link, "from": found.kind, "shapes": found.shapes, "basis": found.basis}
    data |= {"density": found.density, "notes": list(found.notes), "inertial": None, "present": None}
    if found.properties is not None:
        data |= _properties_data(found.properties)
        compared = _compared(robot, found.link, found.properties)
        data["present"] = None if compared is None else asdict(compared)
    if written is not None:
        data["written"] = found.link in written.links
        data["refused"] = written.refused.get(found.link)
    return data


def _properties_data(properties: MassProperties) -> dict[str, Any]:
    inertial = to_inertial(properties)
    principal = properties.principal()
    box = properties.equivalent_box()
    tensor = {name: getattr(inertial, name) for name in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")}
    origin = {"xyz": list(inertial.origin.xyz), "rpy": list(inertial.origin.rpy)}
    return {
        "inertial": {"mass": inertial.mass, "origin": origin, "inertia": tensor},
        "principal_moments": principal.moments.tolist(),
        "principal_axes": principal.axes.T.tolist(),
        "equivalent_box": None if box is None else box.tolist(),
        "xml": inertial_block(properties),
    }
