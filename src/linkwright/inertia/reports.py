"""Reports of estimated mass properties, as text for users and as JSON for programs."""

from __future__ import annotations

import json
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import asdict

from linkwright.diagnostics import Phrase, counted, display_path, phrase, quoted_names
from linkwright.diagnostics.render import compute_width
from linkwright.diagnostics.translation import localized
from linkwright.geometry.mass import MassProperties
from linkwright.inertia.blocks import inertial_block
from linkwright.inertia.estimation import Estimate
from linkwright.inertia.verdict import Grade, Verdict, assess, format_digits
from linkwright.inertia.writing import WriteResult
from linkwright.loading.lean_typing import Any
from linkwright.urdf import Inertial, Robot
from linkwright.urdf.bodies import Bodies

_STEP = "  "
_COLUMN_TITLES = (
    phrase("link"),
    phrase("mass (kg)"),
    phrase("density (kg/m3)"),
    phrase("principal moments (kg m2)"),
    phrase("verdict"),
)
_GRADE_NAMES = {
    Grade.IMPOSSIBLE: phrase("impossible"),
    Grade.DOUBTFUL: phrase("doubtful"),
    Grade.MISSING: phrase("missing"),
    Grade.ROUGH: phrase("rough"),
}
"""The first words of verdicts that require a change."""

_BASIS_PHRASES = {
    "mass": phrase("requested mass"),
    "present": phrase("mass in the file"),
    "density": phrase("mass from density"),
}


def format_text(
    robot: Robot,
    estimates: Sequence[Estimate],
    write_result: WriteResult | None = None,
    detailed_links: Collection[str] = (),
) -> str:
    """Return a table of the links' mass properties with verdicts, the worst first.

    The table is in the user's language.

    Args:
        robot: the robot.
        estimates: the estimates of its links.
        write_result: the result of writing, if any; the verdicts apply to the values in the file before writing.
        detailed_links: the links whose computed ``<inertial>`` is shown after the table.
    """
    verdicts = _assess_links(robot, estimates)
    sorted_estimates = sorted(estimates, key=lambda estimate: verdicts[estimate.link].sort_key)
    sections = [
        "\n".join(_format_table([_format_row(estimate, verdicts[estimate.link]) for estimate in sorted_estimates]))
        + "\n"
    ]
    sections += [
        "\n".join(_format_details(estimate)) + "\n" for estimate in estimates if estimate.link in detailed_links
    ]
    if write_result is not None:
        files = quoted_names(map(display_path, write_result.files)) if write_result.files else phrase("no file")
        line = phrase("wrote {count} <inertial> to {files}", count=len(write_result.links), files=files)
        sections.append(localized(line) + "\n")
    return "\n".join(sections)


def _format_table(rows: list[tuple[str, ...]]) -> Iterator[str]:
    """Yield the lines of a table with its header and left-aligned cells."""
    lines = [tuple(map(localized, _COLUMN_TITLES)), *rows]
    widths = [max(map(compute_width, column)) for column in zip(*lines, strict=True)]
    for line in lines:
        cells = (cell + " " * (width - compute_width(cell)) for cell, width in zip(line, widths, strict=True))
        yield _STEP.join(cells).rstrip()


def _format_row(estimate: Estimate, verdict: Verdict) -> tuple[str, ...]:
    file_properties = verdict.file_properties
    mass = "-" if file_properties is None else f"{file_properties.mass:.4g}"
    if estimate.properties is not None and estimate.basis != "present":
        mass = localized(phrase("{present} ({mass:.4g} computed)", present=mass, mass=estimate.properties.mass))
    moments = (
        "-" if file_properties is None else " ".join(f"{moment:.3g}" for moment in file_properties.principal().moments)
    )
    density = "-" if verdict.density is None else format_digits(verdict.density)
    name = _GRADE_NAMES.get(verdict.grade)
    text = verdict.reason if name is None else phrase("{grade}: {reasons}", grade=name, reasons=verdict.reason)
    return estimate.link, mass, density, moments, localized(text)


def _format_details(estimate: Estimate) -> Iterator[str]:
    yield f"{estimate.link}: {localized(_describe_estimate(estimate))}"
    yield from (f"{_STEP}{localized(note)}" for note in estimate.notes)
    if estimate.properties is not None:
        yield f"{_STEP}{inertial_block(estimate.properties, _STEP)}"


def _assess_links(robot: Robot, estimates: Sequence[Estimate]) -> Mapping[str, Verdict]:
    bodies = Bodies(robot)
    return {estimate.link: assess(robot.links[estimate.link], estimate, bodies) for estimate in estimates}


def format_json(robot: Robot, estimates: Sequence[Estimate], write_result: WriteResult | None = None) -> str:
    """Return the data of `format_text` as JSON, with the links in the order of the estimates.

    Units are SI, and floats are written in full.
    """
    verdicts = _assess_links(robot, estimates)
    links = [_link_to_json(estimate, verdicts[estimate.link], write_result) for estimate in estimates]
    files = [] if write_result is None else [str(file) for file in write_result.files]
    return json.dumps({"links": links, "files": files}, indent=2, ensure_ascii=False) + "\n"


def _describe_estimate(estimate: Estimate) -> Phrase:
    if estimate.properties is None:
        return phrase("no shape has a volume, so nothing is computed")
    shapes = (
        counted("{count} collision shape", "{count} collision shapes", estimate.shapes)
        if estimate.kind == "collision"
        else counted("{count} visual shape", "{count} visual shapes", estimate.shapes)
    )
    return phrase(
        "{shapes}, {basis}: {mass:.6g} kg at {density:.4g} kg/m3",
        shapes=shapes,
        basis=_BASIS_PHRASES[estimate.basis],
        mass=estimate.properties.mass,
        density=estimate.density,
    )


def _link_to_json(estimate: Estimate, verdict: Verdict, write_result: WriteResult | None) -> dict[str, Any]:
    data: dict[str, Any] = {
        "link": estimate.link,
        "from": estimate.kind,
        "shapes": estimate.shapes,
        "basis": estimate.basis,
    }
    data |= {"density": estimate.density, "notes": list(estimate.notes), "inertial": None, "present": None}
    if estimate.properties is not None:
        data |= _properties_to_json(estimate.properties)
    data["present"] = None if verdict.comparison is None else asdict(verdict.comparison)
    data |= {"verdict": verdict.grade.value, "why": str.__str__(verdict.reason), "present_density": verdict.density}
    if write_result is not None:
        data["written"] = estimate.link in write_result.links
        data["refused"] = write_result.refusals.get(estimate.link)
    return data


def _properties_to_json(properties: MassProperties) -> dict[str, Any]:
    inertial = Inertial.of(properties)
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
