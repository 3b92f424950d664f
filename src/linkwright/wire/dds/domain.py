"""A DDS domain, as used by readers and writers."""

from __future__ import annotations

from dataclasses import dataclass

from linkwright.wire.dds.pacing import Pacer
from linkwright.wire.dds.participant import Participant
from linkwright.wire.dds.remote import RemoteGraph
from linkwright.wire.dds.type_descriptions import WireTypes


@dataclass(frozen=True, slots=True)
class Domain:
    """The DDS domain, from the perspective of this process.

    Attributes:
        participant: our participant.
        remote: the remote graph.
        types: descriptions of types.
        fragment_size: the size in bytes up to which a sample always fits into one packet.
        pacer: sends large samples to Fast DDS.
    """

    participant: Participant
    remote: RemoteGraph
    types: WireTypes
    fragment_size: int
    pacer: Pacer
