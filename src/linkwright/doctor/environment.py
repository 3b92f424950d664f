"""Problems of the environment: settings that prevent nodes from discovering each other."""

from __future__ import annotations

from collections.abc import Iterator

from linkwright.diagnostics import Diagnostic, Note, Severity, phrase
from linkwright.doctor.record import Observation

_MAX_SAFE_DOMAIN = 101
"""The highest domain ID on Linux whose ports the system does not assign to other programs."""

_DDS_HINT = phrase(
    "use the same ROS_DOMAIN_ID as the nodes; for nodes on other computers set "
    "ROS_AUTOMATIC_DISCOVERY_RANGE=SUBNET (and leave ROS_LOCALHOST_ONLY unset)"
)
_ZENOH_HINT = phrase(
    "use the same ROS_DOMAIN_ID as the nodes, and start a router with 'linkwright run "
    "rmw_zenoh_cpp rmw_zenohd' to find nodes of rmw_zenoh_cpp; nodes of DDS are not found over "
    "Zenoh"
)


def examine_environment(observation: Observation) -> Iterator[Diagnostic]:
    """Yield findings about settings that prevent discovery, and about an empty graph."""
    if not observation.over_zenoh:
        yield from _examine_domain(observation.environment.get("ROS_DOMAIN_ID", ""))
    if observation.nodes:
        return
    settings = [f"{name}={value}" for name, value in sorted(observation.environment.items()) if value]
    notes = [
        Note(
            phrase(
                "observed for {seconds:g} s in domain {environment}",
                seconds=observation.seconds,
                environment=observation.environment.get("ROS_DOMAIN_ID") or 0,
            )
        )
    ]
    if settings:
        notes.append(Note(phrase("set in this shell: {settings}", settings=", ".join(settings))))
    yield Diagnostic(
        "DOC801",
        phrase("no running nodes were found"),
        severity=Severity.WARNING,
        notes=tuple(notes),
        hint=_ZENOH_HINT if observation.over_zenoh else _DDS_HINT,
    )


def _examine_domain(text: str) -> Iterator[Diagnostic]:
    if text.strip().isdecimal() and int(text) > _MAX_SAFE_DOMAIN:
        yield Diagnostic(
            "DOC803",
            phrase(
                "ROS_DOMAIN_ID is {domain}; above {highest}, the system can assign the ports to other programs",
                domain=text,
                highest=_MAX_SAFE_DOMAIN,
            ),
            severity=Severity.INFO,
            hint=phrase("choose a domain from 0 to {highest}", highest=_MAX_SAFE_DOMAIN),
        )
