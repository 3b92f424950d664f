"""Warnings about bodies that overlap at the start (SIM144).

`simulation.recovery` separates these bodies.
"""

from __future__ import annotations

from collections.abc import Container, Iterable

from linkwright.diagnostics import Diagnostic, Phrase, Severity, counted, phrase
from linkwright.simulation.library import load_mujoco
from linkwright.simulation.scene.connections import get_model_name
from linkwright.simulation.simulation import Simulation

_MIN_DEPTH = 0.02
"""The depth in m above which bodies count as overlapping. Soft contacts are up to this deep at rest."""
_MAX_REPORTED = 8
"""The maximum number of overlaps that are reported individually."""


def find_overlaps(simulation: Simulation, names: Container[str] | None = None) -> list[Diagnostic]:
    """Return warnings (SIM144) about bodies that currently overlap, the deepest overlap first.

    Args:
        simulation: the simulation of the world.
        names: the names of the models to check; None for all models.
    """
    simulation.refresh()
    model, data = simulation.model, simulation.data
    load_mujoco().mj_collision(model, data)
    depths: dict[tuple[str, str], float] = {}
    for contact in data.contact:
        if contact.dist < -_MIN_DEPTH and not contact.exclude:
            links = [model.body(int(model.geom_bodyid[geom])).name for geom in contact.geom if geom >= 0]
            pair = _sort_moving_first(simulation, links)
            if len(pair) == 2 and (names is None or any(get_model_name(link) in names for link in pair)):
                key = (
                    (pair[0], pair[1])
                    if get_model_name(pair[0]) == get_model_name(pair[1])
                    else (get_model_name(pair[0]), get_model_name(pair[1]))
                )
                depths[key] = max(depths.get(key, 0.0), -float(contact.dist))
    deepest = sorted(depths.items(), key=lambda item: -item[1])
    findings = [_create_finding(simulation, *pair, depth) for pair, depth in deepest[:_MAX_REPORTED]]
    remaining_count = len(deepest) - len(findings)
    if remaining_count:
        message = counted(
            "{count} other pair of models overlaps", "{count} other pairs of models overlap", remaining_count
        )
        findings.append(Diagnostic("SIM144", message, severity=Severity.WARNING))
    return findings


def _sort_moving_first(simulation: Simulation, links: Iterable[str]) -> list[str]:
    """Return links sorted with movable links before static ones."""
    return sorted(links, key=lambda link: int(simulation.model.body_weldid[simulation.body(link)]) == 0)


def _create_finding(simulation: Simulation, link: str, other_link: str, depth: float) -> Diagnostic:
    is_same_model = get_model_name(link) == get_model_name(other_link)
    message: Phrase = phrase(
        "'{link}' starts {depth} m inside '{other_link}'", link=link, depth=f"{depth:.2f}", other_link=other_link
    )
    hint = phrase("they are pushed apart slowly; move one of them if this is not intended")
    if is_same_model:
        hint = phrase("they are pushed apart slowly; to ignore contacts within the model, remove <self_collide>")
    element = simulation.scene.models[get_model_name(link)].model.element
    span, source = (None, None) if element is None else (element.span(), element.source)
    return Diagnostic("SIM144", message, span, severity=Severity.WARNING, hint=hint, source=source)
