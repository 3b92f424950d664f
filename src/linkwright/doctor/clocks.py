"""Problems of time: stamps far from the current time, and simulated time in only some of the nodes."""

from __future__ import annotations

from collections.abc import Iterator

from linkwright.diagnostics import Diagnostic, Note, Severity, phrase
from linkwright.doctor.record import Observation, StampSeen, listed, nodes_of
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND

_FAR_NS = 5 * NANOSECONDS_PER_SECOND
"""From here on a stamp is far from now: tf2 keeps transforms for ten seconds, and displays give up before."""
_CLOCK = "/clock"


def examine_clocks(seen: Observation) -> Iterator[Diagnostic]:
    """Yield findings on stamps and simulated time."""
    yield from _simulated(seen)
    yield from _stamps(seen)


def _is_hidden(node: str) -> bool:
    return node.rpartition("/")[2].startswith("_")


def _simulated(seen: Observation) -> Iterator[Diagnostic]:
    on = sorted(node for node, value in seen.sim_time.items() if value)
    off = sorted(node for node, value in seen.sim_time.items() if not value)
    senders = nodes_of(seen.publishers_of(_CLOCK))
    off = [node for node in off if node not in senders and not _is_hidden(node)]  # publishers of /clock need not use it
    if on and not senders:
        yield Diagnostic(
            "DOC602",
            phrase(
                "use_sim_time is true for {on}, but no node publishes /clock, so their time does not advance",
                on=listed(on),
            ),
            hint=phrase("start the simulation or play the bag with --clock, or set use_sim_time to false"),
        )
    elif on and seen.clock is not None and seen.clock.ticks > 1 and seen.clock.first_ns == seen.clock.last_ns:
        yield Diagnostic(
            "DOC603",
            phrase("/clock stays at {last_ns:.3f} s", last_ns=seen.clock.last_ns / NANOSECONDS_PER_SECOND),
            severity=Severity.WARNING,
            notes=(Note(phrase("it is published by {senders}", senders=listed(senders))),),
            hint=phrase("is the simulation paused?"),
        )
    elif on and seen.clock is None and seen.seconds:
        yield Diagnostic(
            "DOC603",
            phrase("/clock had no message in {seconds:g} s", seconds=seen.seconds),
            severity=Severity.WARNING,
            notes=(Note(phrase("its publisher is {senders}", senders=listed(senders))),),
            hint=phrase("is the simulation paused, or not started yet?"),
        )
    if on and off:
        yield Diagnostic(
            "DOC601",
            phrase("use_sim_time is true for {on}, but false for {off}", on=listed(on), off=listed(off)),
            severity=Severity.WARNING,
            notes=(Note(phrase("their stamps are far apart, so transforms and messages do not match")),),
            hint=phrase("set it for all of them: SetParameter('use_sim_time', True) in the launch file"),
        )
    if len(senders) > 1:
        yield Diagnostic(
            "DOC604",
            phrase("{count} nodes publish /clock: {senders}", count=len(senders), senders=listed(senders)),
            notes=(Note(phrase("time jumps between them, and each jump back clears the buffers of transforms")),),
            hint=phrase("stop one of them; play only one bag with --clock"),
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
            phrase(
                "the messages of '{sender}' on {topics} have no stamp", sender=sender, topics=listed(sorted(topics))
            ),
            severity=Severity.WARNING,
            notes=(
                Note(phrase("tf2 reads a stamp of 0 as the latest time; robot_state_publisher ignores such states")),
            ),
            hint=phrase("set header.stamp to the node's time: node.get_clock().now().to_msg()"),
        )
    for sender, stamps in sorted(far.items()):
        worst = max(stamps, key=lambda stamp: abs(stamp.behind_ns))
        where = listed(sorted({stamp.topic for stamp in stamps}))
        yield Diagnostic(
            "DOC605",
            phrase(
                "the stamps of '{sender}' on {where} are {seconds:.1f} s behind the clock here",
                sender=sender,
                where=where,
                seconds=worst.behind_ns / NANOSECONDS_PER_SECOND,
            )
            if worst.behind_ns > 0
            else phrase(
                "the stamps of '{sender}' on {where} are {seconds:.1f} s ahead of the clock here",
                sender=sender,
                where=where,
                seconds=-worst.behind_ns / NANOSECONDS_PER_SECOND,
            ),
            severity=Severity.WARNING,
            notes=_why(sender, seen),
            hint=phrase("synchronize the computers' clocks (chrony, timedatectl), or set use_sim_time for all nodes"),
        )


def _why(sender: str, seen: Observation) -> tuple[Note, ...]:
    if seen.sim_time.get(sender):
        return (Note(phrase("'{sender}' uses simulated time", sender=sender)),)
    return ()
