"""A DDS domain, as readers and writers use it."""

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
        fragment_size: the bytes of a sample up to which it certainly fits into one packet.
        pacer: sends large samples to Fast DDS.
    """

    participant: Participant
    remote: RemoteGraph
    types: WireTypes
    fragment_size: int
    pacer: Pacer
