"""Problems of the environment: settings that prevent nodes from discovering each other."""

from __future__ import annotations

from collections.abc import Iterator

from linkwright.diagnostics import Diagnostic, Note, Severity, phrase
from linkwright.doctor.record import Observation

_HIGHEST_SAFE_DOMAIN = 101
"""The highest domain on Linux whose ports do not overlap with those that the system gives away."""

_OVER_DDS = phrase(
    "use the same ROS_DOMAIN_ID as the nodes; for nodes on other computers set "
    "ROS_AUTOMATIC_DISCOVERY_RANGE=SUBNET (and leave ROS_LOCALHOST_ONLY unset)"
)
_OVER_ZENOH = phrase(
    "use the same ROS_DOMAIN_ID as the nodes, and start a router with 'linkwright run "
    "rmw_zenoh_cpp rmw_zenohd' to find nodes of rmw_zenoh_cpp; nodes of DDS are not found over "
    "Zenoh"
)


def examine_environment(seen: Observation) -> Iterator[Diagnostic]:
    """Yield findings on settings that prevent discovery, and on an empty graph."""
    if not seen.over_zenoh:
        yield from _domain(seen.environment.get("ROS_DOMAIN_ID", ""))
    if seen.nodes:
        return
    settings = [f"{name}={value}" for name, value in sorted(seen.environment.items()) if value]
    notes = [
        Note(
            phrase(
                "observed for {seconds:g} s in domain {environment}",
                seconds=seen.seconds,
                environment=seen.environment.get("ROS_DOMAIN_ID") or 0,
            )
        )
    ]
    if settings:
        notes.append(Note(phrase("set in this shell: {settings}", settings=", ".join(settings))))
    yield Diagnostic(
        "DOC801",
        phrase("no nodes are running where this shell looks"),
        severity=Severity.WARNING,
        notes=tuple(notes),
        hint=_OVER_ZENOH if seen.over_zenoh else _OVER_DDS,
    )


def _domain(text: str) -> Iterator[Diagnostic]:
    if text.strip().isdecimal() and int(text) > _HIGHEST_SAFE_DOMAIN:
        yield Diagnostic(
            "DOC803",
            phrase(
                "ROS_DOMAIN_ID is {domain}: above {highest}, the system can give the ports to other programs",
                domain=text,
                highest=_HIGHEST_SAFE_DOMAIN,
            ),
            severity=Severity.INFO,
            hint=phrase("choose one from 0 to {highest}", highest=_HIGHEST_SAFE_DOMAIN),
        )
