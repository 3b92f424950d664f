"""What readers and writers are made with."""

from __future__ import annotations

from dataclasses import dataclass, field

from linkwright.graph.dds.participant import Participant
from linkwright.graph.dds.remote import RemoteGraph
from linkwright.graph.dds.wire_types import WireTypes


@dataclass(frozen=True, slots=True)
class Domain:
    """The DDS domain, as the process takes part in it.

    Attributes:
        participant: ours.
        remote: who is outside.
        types: descriptions of types.
        said: what was told of the domain as a whole, once.
    """

    participant: Participant
    remote: RemoteGraph
    types: WireTypes
    said: set[str] = field(default_factory=set)
