"""Endpoints that are announced in a domain but neither send nor receive.

Samples that arrive at their readers are never taken (DDS ``take``).
"""

from __future__ import annotations

from collections.abc import Sequence
from copy import copy
from typing import TYPE_CHECKING, Any

from linkwright.graph.endpoints.base import EndpointKind
from linkwright.graph.qos.profile import HistoryPolicy, QoSProfile
from linkwright.wire.dds.domain import Domain
from linkwright.wire.dds.services import EndpointPair
from linkwright.wire.dds.topics import MirroredTopic

if TYPE_CHECKING:
    from linkwright.graph.endpoints.base import Presence


def open_presence(presence: Presence, domain: Domain) -> QuietReader | QuietClient:
    """Announce an endpoint that neither sends nor receives.

    Args:
        presence: the endpoint.
        domain: the domain in which it is announced.
    """
    return (QuietReader if presence.kind is EndpointKind.SUBSCRIPTION else QuietClient)(presence, domain)


class QuietReader(MirroredTopic):
    """A reader that stores the last sample but never takes it.

    Writers send it only samples that other readers in this process also receive.
    """

    _STATUS_MASK = 0
    writer_guids: Sequence[bytes] = ()

    def __init__(self, presence: Presence, domain: Domain) -> None:
        super().__init__(presence, domain, _ignore)

    @property
    def reader_guid(self) -> bytes:
        """The reader's GUID, 16 bytes."""
        return self.guid

    def close(self) -> None:
        """Delete the reader."""
        self._participant.delete(self.entity, self._topic)

    def _get_profile(self, endpoint: Any) -> QoSProfile:
        profile: QoSProfile = copy(endpoint.qos_profile)
        profile.history, profile.depth = HistoryPolicy.KEEP_LAST, 1
        return profile

    def _create(self, qos: Any) -> int:
        return self._participant.create_reader(self._topic, qos)


class QuietClient:
    """The reader and the writer of a client that sends no requests.

    Args:
        presence: the client.
        domain: the domain in which it is announced.
    """

    def __init__(self, presence: Presence, domain: Domain) -> None:
        self._pair = EndpointPair(presence, domain, is_server=False)
        self.reader_guid = self._pair.reader_guid
        self.writer_guids = (self._pair.writer_guid,)

    def close(self) -> None:
        """Delete the reader and the writer."""
        self._pair.close()


def _ignore(_: Any) -> None:
    """Ignore a mismatch, because the other process reports the incompatible QoS itself."""
