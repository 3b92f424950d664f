"""Reports of estimated mass properties, as text for users and as JSON for programs."""

from __future__ import annotations

import json
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import asdict

from linkwright.diagnostics import Phrase, counted, display_path, phrase, quoted_names
from linkwright.diagnostics.render import shown_width
from linkwright.diagnostics.translation import localized
from linkwright.geometry.mass import MassProperties
from linkwright.inertia.blocks import inertial_block
from linkwright.inertia.estimation import Estimate
from linkwright.inertia.inertial import to_inertial
from linkwright.inertia.verdict import Standing, Verdict, grouped, judge
from linkwright.inertia.writing import Written
from linkwright.loading.lean_typing import Any
from linkwright.urdf import Robot
from linkwright.urdf.bodies import Bodies

_STEP = "  "
_HEAD = (
    phrase("link"),
    phrase("mass (kg)"),
    phrase("density (kg/m3)"),
    phrase("principal moments (kg m2)"),
    phrase("verdict"),
)
_NAMES = {
    Standing.IMPOSSIBLE: phrase("impossible"),
    Standing.DOUBTFUL: phrase("doubtful"),
    Standing.MISSING: phrase("missing"),
    Standing.ROUGH: phrase("rough"),
}
"""The words with which verdicts begin that ask for a change."""

_BASES = {
    "mass": phrase("mass as given"),
    "present": phrase("mass as in the file"),
    "density": phrase("mass from density"),
}


def as_text(
    robot: Robot, estimates: Sequence[Estimate], written: Written | None = None, detailed: Collection[str] = ()
) -> str:
    """Return a table of the links' mass properties with verdicts, the worst first.

    The table is in the user's language.

    Args:
        robot: the robot.
        estimates: the estimates of its links.
        written: the result of writing, if any; the verdicts apply to the values in the file before writing.
        detailed: the links whose computed ``<inertial>`` is shown after the table.
    """
    verdicts = _verdicts(robot, estimates)
    ordered = sorted(estimates, key=lambda estimate: verdicts[estimate.link].place)
    parts = ["\n".join(_table([_row(estimate, verdicts[estimate.link]) for estimate in ordered])) + "\n"]
    parts += ["\n".join(_detail(estimate)) + "\n" for estimate in estimates if estimate.link in detailed]
    if written is not None:
        files = quoted_names(map(display_path, written.files)) if written.files else phrase("no file")
        line = phrase("wrote {count} <inertial> to {files}", count=len(written.links), files=files)
        parts.append(localized(line) + "\n")
    return "\n".join(parts)


def _table(rows: list[tuple[str, ...]]) -> Iterator[str]:
    """Iterate over the lines of a table with its header; cells are left-aligned."""
    lines = [tuple(map(localized, _HEAD)), *rows]
    widths = [max(map(shown_width, column)) for column in zip(*lines, strict=True)]
    for line in lines:
        cells = (cell + " " * (width - shown_width(cell)) for cell, width in zip(line, widths, strict=True))
        yield _STEP.join(cells).rstrip()


def _row(found: Estimate, verdict: Verdict) -> tuple[str, ...]:
    present = verdict.present
    mass = "-" if present is None else f"{present.mass:.4g}"
    if found.properties is not None and found.basis != "present":
        mass = localized(phrase("{present} ({mass:.4g} computed)", present=mass, mass=found.properties.mass))
    moments = "-" if present is None else " ".join(f"{moment:.3g}" for moment in present.principal().moments)
    density = "-" if verdict.density is None else grouped(verdict.density)
    name = _NAMES.get(verdict.standing)
    words = verdict.words if name is None else phrase("{standing}: {words}", standing=name, words=verdict.words)
    return found.link, mass, density, moments, localized(words)


def _detail(found: Estimate) -> Iterator[str]:
    yield f"{found.link}: {localized(_summary(found))}"
    yield from (f"{_STEP}{localized(note)}" for note in found.notes)
    if found.properties is not None:
        yield f"{_STEP}{inertial_block(found.properties, _STEP)}"


def _verdicts(robot: Robot, estimates: Sequence[Estimate]) -> Mapping[str, Verdict]:
    bodies = Bodies(robot)
    return {found.link: judge(robot.links[found.link], found, bodies) for found in estimates}


def as_json(robot: Robot, estimates: Sequence[Estimate], written: Written | None = None) -> str:
    """Return the data of `as_text` as JSON, with the links in the order of the estimates.

    Units are SI, and floats are written in full.
    """
    verdicts = _verdicts(robot, estimates)
    links = [_link_data(found, verdicts[found.link], written) for found in estimates]
    files = [] if written is None else [str(file) for file in written.files]
    return json.dumps({"links": links, "files": files}, indent=2, ensure_ascii=False) + "\n"


def _summary(found: Estimate) -> Phrase:
    if found.properties is None:
        return phrase("no shape has a volume, so nothing is computed")
    shapes = (
        counted("{count} collision shape", "{count} collision shapes", found.shapes)
        if found.kind == "collision"
        else counted("{count} visual shape", "{count} visual shapes", found.shapes)
    )
    return phrase(
        "{shapes}, {basis}: {mass:.6g} kg at {density:.4g} kg/m3",
        shapes=shapes,
        basis=_BASES[found.basis],
        mass=found.properties.mass,
        density=found.density,
    )


def _link_data(found: Estimate, verdict: Verdict, written: Written | None) -> dict[str, Any]:
    data: dict[str, Any] = {"link": found.link, "from": found.kind, "shapes": found.shapes, "basis": found.basis}
    data |= {"density": found.density, "notes": list(found.notes), "inertial": None, "present": None}
    if found.properties is not None:
        data |= _properties_data(found.properties)
    data["present"] = None if verdict.comparison is None else asdict(verdict.comparison)
    data |= {"verdict": verdict.standing.value, "why": str.__str__(verdict.words), "present_density": verdict.density}
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
