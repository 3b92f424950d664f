"""Topics whose types go by their names alone, as those of rmw_cyclonedds_cpp up to Jazzy do.

Cyclone's Python package cannot make a topic without describing its type, and the description is sent with each
endpoint. That does harm. Cyclone compares descriptions where both sides have one, and cannot read those that Fast DDS 3
sends of types with sequences, so that not even ``ros_discovery_info`` would be shared with a node on
rmw_fastrtps_cpp. And the Cyclone DDS of Humble (0.10) has been seen to crash on descriptions by this one.

A type is a structure of C whose first member points to a table of functions (``ddsi_sertype_ops``). The package makes
a topic that nobody uses and that is deleted again; its type stays, is given a table of its own in which the functions
that describe it are left out; and the topics that are used are made with that type.
"""

from __future__ import annotations

import ctypes as c
from typing import Any

from linkwright.graph.dds.cyclone import checked, load

_UNUSED = "linkwright_types"
"""The name of the topics that types are taken from."""

_FUNCTIONS = 14
"""Members of the table: its version, an argument, and the functions."""

_DESCRIBING = slice(8, 11)
"""``type_id``, ``type_map`` and ``type_info``."""

_VERSION_ON_WINDOWS = 1

_tables: list[Any] = []
"""Kept as long as the process, because Cyclone forgets types some time after their topics; 112 bytes each."""


class UntypedTopics:
    """Makes the topics of a participant.

    Args:
        participant: Cyclone's handle.
    """

    def __init__(self, participant: int) -> None:
        self._dds = load()
        self._participant = participant
        self._types: dict[Any, int] = {}

    def create(self, name: str, described_type: Any) -> int:
        """A topic.

        Args:
            name: its DDS name.
            described_type: the class that describes its type to Cyclone here.

        Raises:
            CycloneError: Cyclone refuses it.
        """
        what = f"topic '{name}'"
        address = self._types.get(described_type)
        if address is None:
            unused = checked(self._dds.create_topic(self._participant, _UNUSED, described_type, None, None), what)
            address = self._types[described_type] = self._taken_from(unused)
        pointer = c.c_void_p(self._dds.ddsi_sertype_ref(address))
        code = self._dds.dds_create_topic_sertype(self._participant, name.encode(), c.byref(pointer), None, None, None)
        if code < 0:
            self._dds.ddsi_sertype_unref(address)
        return checked(code, what)

    def end(self) -> None:
        """Forget the types; those of topics stay as long as they do."""
        while self._types:
            self._dds.ddsi_sertype_unref(self._types.popitem()[1])

    def _taken_from(self, topic: int) -> int:
        """The address of a topic's type, which does not describe itself any more; the topic is deleted.

        It is deleted before that, because Cyclone looks the description up to forget it.
        """
        pointer = c.c_void_p()
        checked(self._dds.dds_get_entity_sertype(topic, c.byref(pointer)), "asking for a type")
        address: int = self._dds.ddsi_sertype_ref(pointer)
        self._dds.dds_delete(topic)
        functions = c.c_void_p.from_address(address)
        table = (c.c_void_p * _FUNCTIONS).from_address(functions.value or 0)
        if table[0] in (self._dds.type_version, _VERSION_ON_WINDOWS):  # else it is not as we know it: leave it alone
            own = (c.c_void_p * _FUNCTIONS)(*table)
            own[_DESCRIBING] = [None] * len(own[_DESCRIBING])
            _tables.append(own)
            functions.value = c.addressof(own)
        return address
