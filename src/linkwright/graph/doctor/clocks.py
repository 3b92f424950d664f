"""Troubles of time: stamps far from now, simulated time that some nodes follow and others do not."""

from __future__ import annotations

from collections.abc import Iterator

from linkwright.diagnostics import Diagnostic, Note, Severity
from linkwright.graph.doctor.record import Observation, StampSeen, listed, nodes_of

_SECOND = 1_000_000_000
_FAR_NS = 5 * _SECOND
"""From here on a stamp is far from now: tf2 keeps transforms for ten seconds, and displays give up before."""
_CLOCK = "/clock"


def examine_clocks(seen: Observation) -> Iterator[Diagnostic]:
    """What is wrong with time."""
    yield from _simulated(seen)
    yield from _stamps(seen)


def _simulated(seen: Observation) -> Iterator[Diagnostic]:
    on = sorted(node for node, value in seen.sim_time.items() if value)
    off = sorted(node for node, value in seen.sim_time.items() if not value)
    senders = nodes_of(seen.publishers_of(_CLOCK))
    off = [node for node in off if node not in senders]  # who makes time need not follow it
    if on and not senders:
        yield Diagnostic(
            "DOC602",
            f"use_sim_time is true for {listed(on)}, but nobody publishes /clock, so time stands still for them",
            hint="start the simulation or play the bag with --clock, or set use_sim_time to false",
        )
    elif on and seen.clock is not None and seen.clock.ticks > 1 and seen.clock.first_ns == seen.clock.last_ns:
        yield Diagnostic(
            "DOC603",
            f"/clock stands still at {seen.clock.last_ns / _SECOND:.3f} s",
            severity=Severity.WARNING,
            notes=(Note(f"it is published by {listed(senders)}"),),
            hint="is the simulation paused?",
        )
    elif on and seen.clock is None and seen.seconds:
        yield Diagnostic(
            "DOC603",
            f"/clock told no time in {seen.seconds:g} s",
            severity=Severity.WARNING,
            notes=(Note(f"its publisher is {listed(senders)}"),),
            hint="is the simulation paused, or not started yet?",
        )
    if on and off:
        yield Diagnostic(
            "DOC601",
            f"use_sim_time is true for {listed(on)}, but false for {listed(off)}",
            severity=Severity.WARNING,
            notes=(Note("their stamps lie far apart, and transforms and messages do not meet"),),
            hint="set it for all of them: SetParameter('use_sim_time', True) in the launch file",
        )
    if len(senders) > 1:
        yield Diagnostic(
            "DOC604",
            f"{len(senders)} nodes publish /clock: {listed(senders)}",
            notes=(Note("time jumps between them, and each jump back clears the buffers of transforms"),),
            hint="end one of them; of a bag, play with one --clock only",
        )


def _stamps(seen: Observation) -> Iterator[Diagnostic]:
    zero: dict[str, list[str]] = {}
    far: dict[str, list[StampSeen]] = {}
    for stamp in seen.stamps:
        if stamp.zero:
            zero.setdefault(stamp.sender, []).append(stamp.topic)
        elif abs(stamp.behind_ns) > _FAR_NS:
            far.setdefault(stamp.sender, []).append(stamp)
    for sender, topics in sorted(zero.items()):
        yield Diagnostic(
            "DOC606",
            f"the messages of '{sender}' on {listed(sorted(topics))} have no stamp",
            severity=Severity.WARNING,
            notes=(Note("tf2 takes a stamp of 0 for the latest there is; robot_state_publisher ignores such states"),),
            hint="set header.stamp to the node's time: node.get_clock().now().to_msg()",
        )
    for sender, stamps in sorted(far.items()):
        worst = max(stamps, key=lambda stamp: abs(stamp.behind_ns))
        way = "behind" if worst.behind_ns > 0 else "ahead of"
        where = listed(sorted({stamp.topic for stamp in stamps}))
        yield Diagnostic(
            "DOC605",
            f"the stamps of '{sender}' on {where} are {abs(worst.behind_ns) / _SECOND:.1f} s {way} the clock here",
            severity=Severity.WARNING,
            notes=_why(sender, seen),
            hint="set the computers' clocks by one another (chrony, timedatectl), or use_sim_time for all nodes",
        )


def _why(sender: str, seen: Observation) -> tuple[Note, ...]:
    if seen.sim_time.get(sender):
        return (Note(f"'{sender}' goes by simulated time"),)
    return ()
