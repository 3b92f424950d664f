"""Problems of time: stamps that differ from the clock, and mixed use of simulated time."""

from __future__ import annotations

from collections.abc import Iterator

from linkwright.diagnostics import Diagnostic, Note, Severity, phrase
from linkwright.doctor.record import Observation, ObservedStamp, format_names, list_node_names
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND

_MAX_DIFFERENCE_NS = 5 * NANOSECONDS_PER_SECOND
"""The difference from which a stamp is reported.

tf2 keeps transforms for ten seconds, and displays wait for a shorter time.
"""
_CLOCK_TOPIC = "/clock"


def examine_clocks(observation: Observation) -> Iterator[Diagnostic]:
    """Yield findings about stamps and simulated time."""
    yield from _examine_simulated_time(observation)
    yield from _examine_stamps(observation)


def _is_hidden(node: str) -> bool:
    return node.rpartition("/")[2].startswith("_")


def _examine_simulated_time(observation: Observation) -> Iterator[Diagnostic]:
    simulated_nodes = sorted(node for node, value in observation.sim_time.items() if value)
    other_nodes = sorted(node for node, value in observation.sim_time.items() if not value)
    senders = list_node_names(observation.find_publishers(_CLOCK_TOPIC))
    # a node that publishes /clock may itself use system time
    other_nodes = [node for node in other_nodes if node not in senders and not _is_hidden(node)]
    if simulated_nodes and not senders:
        yield Diagnostic(
            "DOC602",
            phrase(
                "use_sim_time is true for {simulated_nodes}, but no node publishes /clock, "
                "so their time does not advance",
                simulated_nodes=format_names(simulated_nodes),
            ),
            hint=phrase("start the simulation or play the bag with --clock, or set use_sim_time to false"),
        )
    elif (
        simulated_nodes
        and observation.clock is not None
        and observation.clock.message_count > 1
        and observation.clock.first_ns == observation.clock.last_ns
    ):
        yield Diagnostic(
            "DOC603",
            phrase("/clock stays at {last_ns:.3f} s", last_ns=observation.clock.last_ns / NANOSECONDS_PER_SECOND),
            severity=Severity.WARNING,
            notes=(Note(phrase("published by {senders}", senders=format_names(senders))),),
            hint=phrase("check whether the simulation is paused"),
        )
    elif simulated_nodes and observation.clock is None and observation.seconds:
        yield Diagnostic(
            "DOC603",
            phrase("no message was received on /clock in {seconds:g} s", seconds=observation.seconds),
            severity=Severity.WARNING,
            notes=(Note(phrase("published by {senders}", senders=format_names(senders))),),
            hint=phrase("check whether the simulation is paused or has not been started"),
        )
    if simulated_nodes and other_nodes:
        yield Diagnostic(
            "DOC601",
            phrase(
                "use_sim_time is true for {simulated_nodes}, but false for {other_nodes}",
                simulated_nodes=format_names(simulated_nodes),
                other_nodes=format_names(other_nodes),
            ),
            severity=Severity.WARNING,
            notes=(Note(phrase("the stamps of these nodes are far apart, so transforms and messages do not match")),),
            hint=phrase("set use_sim_time for all nodes: SetParameter('use_sim_time', True) in the launch file"),
        )
    if len(senders) > 1:
        yield Diagnostic(
            "DOC604",
            phrase("{count} nodes publish /clock: {senders}", count=len(senders), senders=format_names(senders)),
            notes=(
                Note(phrase("the time jumps between the clocks, and each jump back clears the buffers of transforms")),
            ),
            hint=phrase("stop one of them; play only one bag with --clock"),
        )


def _examine_stamps(observation: Observation) -> Iterator[Diagnostic]:
    unset_topics: dict[str, list[str]] = {}
    wrong_stamps: dict[str, list[ObservedStamp]] = {}
    for stamp in observation.stamps:
        if stamp.is_zero:
            unset_topics.setdefault(stamp.sender, []).append(stamp.topic)
        elif abs(stamp.age_ns) > _MAX_DIFFERENCE_NS:
            wrong_stamps.setdefault(stamp.sender, []).append(stamp)
    for sender, topics in sorted(unset_topics.items()):
        yield Diagnostic(
            "DOC606",
            phrase(
                "the messages of '{sender}' on {topics} have no stamp",
                sender=sender,
                topics=format_names(sorted(topics)),
            ),
            severity=Severity.WARNING,
            notes=(
                Note(phrase("tf2 reads a stamp of 0 as the latest time; robot_state_publisher ignores such states")),
            ),
            hint=phrase("set header.stamp to the node's time: node.get_clock().now().to_msg()"),
        )
    for sender, stamps in sorted(wrong_stamps.items()):
        farthest = max(stamps, key=lambda stamp: abs(stamp.age_ns))
        topics_text = format_names(sorted({stamp.topic for stamp in stamps}))
        yield Diagnostic(
            "DOC605",
            phrase(
                "the stamps of '{sender}' on {topics} are {seconds:.1f} s behind the clock here",
                sender=sender,
                topics=topics_text,
                seconds=farthest.age_ns / NANOSECONDS_PER_SECOND,
            )
            if farthest.age_ns > 0
            else phrase(
                "the stamps of '{sender}' on {topics} are {seconds:.1f} s ahead of the clock here",
                sender=sender,
                topics=topics_text,
                seconds=-farthest.age_ns / NANOSECONDS_PER_SECOND,
            ),
            severity=Severity.WARNING,
            notes=_make_notes(sender, observation),
            hint=phrase("synchronize the computers' clocks (chrony, timedatectl), or set use_sim_time for all nodes"),
        )


def _make_notes(sender: str, observation: Observation) -> tuple[Note, ...]:
    if observation.sim_time.get(sender):
        return (Note(phrase("'{sender}' uses simulated time", sender=sender)),)
    return ()
