"""Tells lost publishers (killed, crashed, out of reach) from those that left in order.

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

GRACE = 0.4
"""Seconds after the end of a process within which it is heard that its participant has left."""

FAREWELL_WITHIN = 1.0
"""Seconds after an endpoint is gone within which it is heard that it was withdrawn, should that come late."""

POLL_SECONDS = 0.2
"""Seconds after which processes are looked at again."""


@dataclass(slots=True)
class _MissingWriter:
    """A writer that disappeared before its node withdrew it.

    Attributes:
        endpoint: the writer.
        node: the node that the writer belongs to.
        due: when the writer counts as lost, in seconds of the steady clock; None until all pending announcements have
            been read.
    """

    endpoint: RemoteEndpoint
    node: NodeIdentity
    due: float | None = None


class Departures:
    """Decides whether publishers that disappeared were lost. All but `watch` is for one thread.

    This thread is the discovery thread.

    Args:
        remote: the remote graph, which calls `endpoint_left` and `announced`.
        now: the steady clock, in seconds.
    """

    def __init__(self, remote: RemoteGraph, now: Callable[[], float] = time.monotonic) -> None:
        self._remote = remote
        self._now = now
        self._watchers: list[Callable[[EndpointInfo], None]] = []
        self._gone: list[_MissingWriter] = []
        self._dead_since: dict[bytes, float] = {}
        self._reported: set[bytes] = set()
        remote.departures = self

    def watch(self, lost: Callable[[EndpointInfo], None]) -> None:
        """Register a callback for lost publishers, which runs in the discovery thread."""
        self._watchers.append(lost)

    def endpoint_left(self, endpoint: RemoteEndpoint, node: NodeIdentity | None) -> None:
        """Handle the disappearance of an endpoint.

        Args:
            endpoint: the endpoint.
            node: the node that still announces the endpoint; None if the endpoint was withdrawn.
        """
        if self._watchers and endpoint.is_writer and node is not None and endpoint.participant not in self._reported:
            self._gone.append(_MissingWriter(endpoint, node))

    def announced(self, participant: bytes, endpoints: Collection[bytes]) -> None:
        """Handle an announcement: missing endpoints that are not in the announcement were withdrawn."""
        self._gone = [
            gone for gone in self._gone if gone.endpoint.participant != participant or gone.endpoint.guid in endpoints
        ]

    def review(self) -> float | None:
        """Report the publishers that have become lost since the last call.

        Returns:
            The seconds until the next call, or None if no call is needed.
        """
        if not self._watchers:
            return None
        self._review_gone()
        processes = self._review_processes()
        return POLL_SECONDS if self._gone or processes else None

    def _review_gone(self) -> None:
        now, waiting = self._now(), []
        for gone in self._gone:
            if gone.due is None:
                gone.due = now + FAREWELL_WITHIN
            if now < gone.due:
                waiting.append(gone)
            else:
                self._report(gone.endpoint, gone.node)
        self._gone = waiting

    def _review_processes(self) -> bool:
        """Check the processes of participants on this machine; return whether there are any."""
        now = self._now()
        here = [participant for participant in self._remote.participants() if participant.process is not None]
        dead = {participant.guid for participant in here if participant.has_died()}
        self._dead_since = {guid: self._dead_since.get(guid, now) for guid in dead}
        self._reported &= dead | {gone.endpoint.participant for gone in self._gone}
        for guid, since in self._dead_since.items():
            if now - since >= GRACE and guid not in self._reported:
                self._reported.add(guid)
                for endpoint, node in self._remote.writers_of(guid):
                    self._report(endpoint, node)
        return bool(here)

    def _report(self, endpoint: RemoteEndpoint, node: NodeIdentity | None) -> None:
        info = endpoint.endpoint_info(node)
        if info is not None and info.kind is EndpointKind.PUBLISHER:
            for lost in self._watchers:
                lost(info)
