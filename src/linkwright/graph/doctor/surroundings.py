"""Troubles of states and settings: managed nodes that are not active, and who can see whom."""

from __future__ import annotations

from collections.abc import Iterator

from linkwright.diagnostics import Diagnostic, Note, Severity
from linkwright.graph.doctor.record import Observation, listed

_HIGHEST_SAFE_DOMAIN = 101
"""On Linux the ports of higher domains overlap with those that the system gives away."""


def examine_lifecycle(seen: Observation) -> Iterator[Diagnostic]:
    """Managed nodes that do nothing yet."""
    waiting: dict[str, list[str]] = {}
    for node, state in seen.lifecycle.items():
        if state in ("unconfigured", "inactive"):
            waiting.setdefault(state, []).append(node)
    for state, nodes in sorted(waiting.items()):
        next_one = "configure" if state == "unconfigured" else "activate"
        yield Diagnostic(
            "DOC701",
            f"managed node {listed(sorted(nodes))} is {state}, so it does nothing yet",
            severity=Severity.WARNING,
            hint=f"bring it up: ros2 lifecycle set {min(nodes)} {next_one}",
        )


def examine_surroundings(seen: Observation) -> Iterator[Diagnostic]:
    """Settings that keep nodes from seeing each other, and a graph with nobody in it."""
    yield from _domain(seen.environment.get("ROS_DOMAIN_ID", ""))
    if seen.nodes:
        return
    settings = [f"{name}={value}" for name, value in sorted(seen.environment.items()) if value]
    notes = [Note(f"looked for {seen.seconds:g} s in domain {seen.environment.get('ROS_DOMAIN_ID') or 0}")]
    if settings:
        notes.append(Note(f"set in this shell: {', '.join(settings)}"))
    yield Diagnostic(
        "DOC801",
        "no nodes are running where this shell looks",
        severity=Severity.WARNING,
        notes=tuple(notes),
        hint="use the same ROS_DOMAIN_ID as the nodes; for nodes on other computers set "
        "ROS_AUTOMATIC_DISCOVERY_RANGE=SUBNET (and leave ROS_LOCALHOST_ONLY unset)",
    )


def _domain(text: str) -> Iterator[Diagnostic]:
    if text.strip().isdecimal() and int(text) > _HIGHEST_SAFE_DOMAIN:
        yield Diagnostic(
            "DOC803",
            f"ROS_DOMAIN_ID is {text}; above {_HIGHEST_SAFE_DOMAIN} the ports may be those that the system gives away",
            severity=Severity.INFO,
            hint=f"choose one from 0 to {_HIGHEST_SAFE_DOMAIN}",
        )
