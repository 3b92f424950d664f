"""Findings on bodies that overlap at the start (SIM144), which `simulation.recovery` separates."""

from __future__ import annotations

from collections.abc import Container, Iterable

from linkwright.diagnostics import Diagnostic, Phrase, Severity, counted, phrase
from linkwright.simulation.library import load_mujoco
from linkwright.simulation.scene.connections import model_of
from linkwright.simulation.simulation import Simulation

_LEAST = 0.02
"""The depth in m from which bodies overlap; soft contacts are as deep at rest."""
_MOST = 8
"""The number of overlaps that are reported individually."""


def overlaps(simulation: Simulation, names: Container[str] | None = None) -> list[Diagnostic]:
    """Return warnings (SIM144) about bodies that currently overlap, the deepest overlap first.

    Args:
        simulation: the simulation of the world.
        names: the models to check; all by default.
    """
    simulation.refresh()
    model, data = simulation.model, simulation.data
    load_mujoco().mj_collision(model, data)
    depths: dict[tuple[str, str], float] = {}
    for contact in data.contact:
        if contact.dist < -_LEAST and not contact.exclude:
            links = [model.body(int(model.geom_bodyid[geom])).name for geom in contact.geom if geom >= 0]
            pair = _moving_first(simulation, links)
            if len(pair) == 2 and (names is None or any(model_of(link) in names for link in pair)):
                key = (
                    (pair[0], pair[1])
                    if model_of(pair[0]) == model_of(pair[1])
                    else (model_of(pair[0]), model_of(pair[1]))
                )
                depths[key] = max(depths.get(key, 0.0), -float(contact.dist))
    deepest = sorted(depths.items(), key=lambda item: -item[1])
    findings = [_finding(simulation, *pair, depth) for pair, depth in deepest[:_MOST]]
    rest = len(deepest) - len(findings)
    if rest:
        message = counted("{count} other pair of models overlaps", "{count} other pairs of models overlap", rest)
        findings.append(Diagnostic("SIM144", message, severity=Severity.WARNING))
    return findings


def _moving_first(simulation: Simulation, links: Iterable[str]) -> list[str]:
    """Return links with those that can move first."""
    return sorted(links, key=lambda link: int(simulation.model.body_weldid[simulation.body(link)]) == 0)


def _finding(simulation: Simulation, first: str, second: str, depth: float) -> Diagnostic:
    values = {"first": first, "second": second, "depth": f"{depth:.2f}"}
    within = model_of(first) == model_of(second)
    message: Phrase = phrase("'{first}' starts {depth} m inside '{second}'", **values)
    hint = phrase("they are pushed apart slowly; move one of them if this is not intended")
    if within:
        hint = phrase("they are pushed apart slowly; links of a model touch only where <self_collide> is true")
    element = simulation.scene.models[model_of(first)].model.element
    span, source = (None, None) if element is None else (element.span(), element.source)
    return Diagnostic("SIM144", message, span, severity=Severity.WARNING, hint=hint, source=source)
