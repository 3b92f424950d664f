"""The Cyclone types of a domain's topics, kept until the domain is closed.

Two properties of Cyclone's Python package prevent using its types directly.

First, the package cannot create a topic without a description of the type, and the description is sent with each
endpoint. That is harmful: Cyclone compares descriptions if both sides have one, and cannot read those that Fast DDS 3
sends for types with sequences, so that not even ``ros_discovery_info`` would be shared with a node on rmw_fastrtps_cpp.
rmw_cyclonedds_cpp up to Jazzy sends no descriptions. A type is a C structure whose first member points to a table of
functions (``ddsi_sertype_ops``). Here that pointer is replaced by a pointer to a copy of the table without the
functions that describe the type.

Second, Cyclone's table of instances keeps the key of a sample beyond the lifetime of its topic. The package's keys
point to their type to determine whether the type has key members, but they are not counted as references to it. ROS
types have no keys, so all of them share one entry, the entry of the topic that was written first. If that type were
freed with its last topic, each further sample of any topic would be compared through a dangling pointer. Then either
entries are not found again and accumulate, or the wrong entry is freed, which ends in a segmentation fault. Therefore
no type is freed before its domain is closed.
"""

from __future__ import annotations

import ctypes as c
from functools import lru_cache
from threading import Lock
from typing import Any

from linkwright.wire.dds.cyclone import check_call, load

_TOPIC_NAME = "linkwright_type_{}"
"""The pattern for the names of the topics from which types are taken."""

_TABLE_SIZE = 14
"""The number of members of the table: its version, an argument, and the functions."""

_DESCRIBING_FUNCTIONS = slice(8, 11)
"""``type_id``, ``type_map`` and ``type_info``."""

_VERSION_ON_WINDOWS = 1


class TopicTypes:
    """The types of one domain.

    Any thread may use this object.
    """

    def __init__(self) -> None:
        self._dds = load()
        self._type_addresses: dict[Any, int] = {}
        self._lock = Lock()

    def create_topic(self, participant: int, name: str, described_type: Any) -> int:
        """Create a topic.

        Args:
            participant: Cyclone's handle of the participant.
            name: the topic's DDS name.
            described_type: the class that describes the topic's type to Cyclone (`WireTypes`).

        Returns:
            Cyclone's handle of the topic.

        Raises:
            CycloneError: Cyclone refuses the topic.
        """
        operation = f"topic '{name}'"
        with self._lock:  # no other thread may see a type while it is created
            address = self._type_addresses.get(described_type)
            if address is None:
                address = self._type_addresses[described_type] = self._create_type(
                    participant, described_type, operation
                )
        pointer = c.c_void_p(self._dds.ddsi_sertype_ref(address))
        code = self._dds.dds_create_topic_sertype(participant, name.encode(), c.byref(pointer), None, None, None)
        if code < 0:
            self._dds.ddsi_sertype_unref(address)
        return check_call(code, operation)

    def free(self) -> None:
        """Free the types of a closed domain, after Cyclone has stopped referring to them."""
        while self._type_addresses:
            self._dds.ddsi_sertype_free(self._type_addresses.popitem()[1])

    def _create_type(self, participant: int, described_type: Any, operation: str) -> int:
        """Create a type and return its address.

        The type belongs to an unused topic of the Python package, which is deleted with `participant`. If the topic
        were deleted immediately, Cyclone would drop its description while it reads the descriptions of other types
        without a lock (``ddsi_topic_descriptor_from_type``). Graphs of one process that joined at the same time
        then crashed.
        """
        name = _TOPIC_NAME.format(len(self._type_addresses))
        unused_topic = check_call(self._dds.create_topic(participant, name, described_type, None, None), operation)
        pointer = c.c_void_p()
        check_call(self._dds.dds_get_entity_sertype(unused_topic, c.byref(pointer)), "reading the type of a topic")
        address: int = self._dds.ddsi_sertype_ref(pointer)
        functions = c.c_void_p.from_address(address)
        functions.value = _table_without_descriptions(functions.value or 0)
        return address


@lru_cache
def _table_without_descriptions(table: int) -> int:
    """Copy a function table without the functions that describe types, and return its address.

    If the layout of the table is not known, the address of the table itself is returned. The copy is never freed,
    because Cyclone may use it until the process ends.
    """
    dds = load()
    members = (c.c_void_p * _TABLE_SIZE).from_address(table)
    if members[0] not in (dds.type_version, _VERSION_ON_WINDOWS):
        return table
    copy: int = dds.dds_alloc(c.sizeof(members))
    c.memmove(copy, table, c.sizeof(members))
    copied_members = (c.c_void_p * _TABLE_SIZE).from_address(copy)
    copied_members[_DESCRIBING_FUNCTIONS] = [None] * len(copied_members[_DESCRIBING_FUNCTIONS])
    return copy
