"""Distinguish lost publishers (killed, crashed, unreachable) from orderly departures.

A publisher that leaves announces this: ROS 2 withdraws an endpoint from ``ros_discovery_info`` before removing it from
the domain (rmw_dds_common), and so does Linkwright. An endpoint that disappears without being withdrawn is lost: its
participant was silent for longer than its lease, or was removed from the domain when a process failed. If a participant
announces that its process runs on this machine, the end of that process decides, without waiting for the lease to
expire.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Collection
from dataclasses import dataclass
from typing import TYPE_CHECKING

from linkwright.graph.endpoints.base import EndpointInfo, EndpointKind
from linkwright.graph.names.rules import NodeIdentity

if TYPE_CHECKING:
    from linkwright.wire.dds.remote import RemoteEndpoint, RemoteGraph

GRACE_S = 0.4
"""Seconds after the end of a process within which the departure of its participant is announced."""

WITHDRAWAL_TIMEOUT_S = 1.0
"""Seconds after an endpoint disappears within which the announcement of its withdrawal may still arrive."""

POLL_S = 0.2
"""The interval, in seconds, between two checks of the processes."""


@dataclass(slots=True)
class _MissingWriter:
    """A writer that disappeared before its node withdrew it.

    Attributes:
        endpoint: the writer.
        node: the node that the writer belongs to.
        deadline: when the writer counts as lost, in seconds of the steady clock; None until all pending announcements
            have been read.
    """

    endpoint: RemoteEndpoint
    node: NodeIdentity
    deadline: float | None = None


class DdsDepartureMonitor:
    """Decides whether publishers that disappeared were lost.

    Only the discovery thread may call the methods, except `watch`.

    Args:
        remote: the remote graph, which calls `on_endpoint_left` and `on_announcement`.
        now: the steady clock, in seconds.
    """

    def __init__(self, remote: RemoteGraph, now: Callable[[], float] = time.monotonic) -> None:
        self._remote = remote
        self._now = now
        self._watchers: list[Callable[[EndpointInfo], None]] = []
        self._missing_writers: list[_MissingWriter] = []
        self._dead_since: dict[bytes, float] = {}
        self._reported: set[bytes] = set()
        remote.departures = self

    def watch(self, callback: Callable[[EndpointInfo], None]) -> None:
        """Register a callback for lost publishers.

        The callback runs in the discovery thread.
        """
        self._watchers.append(callback)

    def on_endpoint_left(self, endpoint: RemoteEndpoint, node: NodeIdentity | None) -> None:
        """Handle the disappearance of an endpoint.

        Args:
            endpoint: the endpoint.
            node: the node that still announces the endpoint; None if the endpoint was withdrawn.
        """
        if self._watchers and endpoint.is_writer and node is not None and endpoint.participant not in self._reported:
            self._missing_writers.append(_MissingWriter(endpoint, node))

    def on_announcement(self, participant: bytes, endpoints: Collection[bytes]) -> None:
        """Handle an announcement.

        Missing endpoints that the announcement does not contain were withdrawn.
        """
        self._missing_writers = [
            missing
            for missing in self._missing_writers
            if missing.endpoint.participant != participant or missing.endpoint.guid in endpoints
        ]

    def report_lost_publishers(self) -> float | None:
        """Report the publishers that have become lost since the last call.

        Returns:
            The seconds until the next call, or None if no call is needed.
        """
        if not self._watchers:
            return None
        self._check_missing_writers()
        processes = self._check_processes()
        return POLL_S if self._missing_writers or processes else None

    def _check_missing_writers(self) -> None:
        now, undecided = self._now(), []
        for missing in self._missing_writers:
            if missing.deadline is None:
                missing.deadline = now + WITHDRAWAL_TIMEOUT_S
            if now < missing.deadline:
                undecided.append(missing)
            else:
                self._report(missing.endpoint, missing.node)
        self._missing_writers = undecided

    def _check_processes(self) -> bool:
        """Check the processes of participants on this machine, and return whether there are any."""
        now = self._now()
        local_participants = [
            participant for participant in self._remote.participants() if participant.process is not None
        ]
        dead = {participant.guid for participant in local_participants if participant.has_died()}
        self._dead_since = {guid: self._dead_since.get(guid, now) for guid in dead}
        self._reported &= dead | {missing.endpoint.participant for missing in self._missing_writers}
        for guid, since in self._dead_since.items():
            if now - since >= GRACE_S and guid not in self._reported:
                self._reported.add(guid)
                for endpoint, node in self._remote.find_participant_writers(guid):
                    self._report(endpoint, node)
        return bool(local_participants)

    def _report(self, endpoint: RemoteEndpoint, node: NodeIdentity | None) -> None:
        info = endpoint.endpoint_info(node)
        if info is not None and info.kind is EndpointKind.PUBLISHER:
            for callback in self._watchers:
                callback(info)
