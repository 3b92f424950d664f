"""The types of a domain's topics, as Cyclone has them: each made once, kept as long as the domain, known by its name.

Two properties of Cyclone's Python package prevent the use of its types as they are.

It cannot make a topic without a description of the type, and the description is sent with each endpoint. That does
harm: Cyclone compares descriptions where both sides have one, and cannot read those that Fast DDS 3 sends of types with
sequences, so that not even ``ros_discovery_info`` would be shared with a node on rmw_fastrtps_cpp. rmw_cyclonedds_cpp
up to Jazzy sends none. A type is a structure of C whose first member points to a table of functions
(``ddsi_sertype_ops``); here it gets a table of ours, in which the functions that describe the type are left out.

And Cyclone's table of instances keeps the key of a sample beyond its topic. The package's keys point to their type, to
see whether it has key members at all, but do not count as its users. ROS's types have no keys, so all of them share one
entry, that of the topic that was written first. If that type were freed with its last topic, each further sample of any
topic would be compared through a dangling pointer: entries are then not found again and pile up, or the wrong one is
freed, which ends in a segmentation fault. So no type is freed before its domain is closed.
"""

from __future__ import annotations

import ctypes as c
from functools import lru_cache
from threading import Lock
from typing import Any

from linkwright.wire.dds.cyclone import checked, load

_UNUSED = "linkwright_type_{}"
"""The names of the topics that types are taken from."""

_FUNCTIONS = 14
"""Members of the table: its version, an argument, and the functions."""

_DESCRIBING = slice(8, 11)
"""``type_id``, ``type_map`` and ``type_info``."""

_VERSION_ON_WINDOWS = 1


class TopicTypes:
    """The types of one domain; may be used from any thread."""

    def __init__(self) -> None:
        self._dds = load()
        self._made: dict[Any, int] = {}
        self._lock = Lock()

    def create_topic(self, participant: int, name: str, described_type: Any) -> int:
        """A topic.

        Args:
            participant: Cyclone's handle.
            name: its DDS name.
            described_type: the class that describes its type to Cyclone here (`WireTypes`).

        Raises:
            CycloneError: Cyclone refuses it.
        """
        what = f"topic '{name}'"
        with self._lock:  # only this thread has a type that is being made
            address = self._made.get(described_type)
            if address is None:
                address = self._made[described_type] = self._new(participant, described_type, what)
        pointer = c.c_void_p(self._dds.ddsi_sertype_ref(address))
        code = self._dds.dds_create_topic_sertype(participant, name.encode(), c.byref(pointer), None, None, None)
        if code < 0:
            self._dds.ddsi_sertype_unref(address)
        return checked(code, what)

    def free(self) -> None:
        """Free the types of a domain that was closed, when nothing of Cyclone's looks at them any more."""
        while self._made:
            self._dds.ddsi_sertype_free(self._made.popitem()[1])

    def _new(self, participant: int, described_type: Any, what: str) -> int:
        """The address of a type: that of an unused topic of the package's, which is deleted with `participant`.

        Were it deleted at once, Cyclone would forget the description again, while it reads those of other types
        without a lock (``ddsi_topic_descriptor_from_type``): graphs of a process that joined at the same time crashed.
        """
        name = _UNUSED.format(len(self._made))
        unused = checked(self._dds.create_topic(participant, name, described_type, None, None), what)
        pointer = c.c_void_p()
        checked(self._dds.dds_get_entity_sertype(unused, c.byref(pointer)), "asking for a type")
        address: int = self._dds.ddsi_sertype_ref(pointer)
        functions = c.c_void_p.from_address(address)
        functions.value = _undescribing(functions.value or 0)
        return address


@lru_cache
def _undescribing(table: int) -> int:
    """The address of a copy of a table of functions without those that describe; its own if it is not as we know it.

    The copy is never freed: Cyclone may look into it as long as the process runs.
    """
    dds = load()
    known = (c.c_void_p * _FUNCTIONS).from_address(table)
    if known[0] not in (dds.type_version, _VERSION_ON_WINDOWS):
        return table
    copy: int = dds.dds_alloc(c.sizeof(known))
    c.memmove(copy, table, c.sizeof(known))
    own = (c.c_void_p * _FUNCTIONS).from_address(copy)
    own[_DESCRIBING] = [None] * len(own[_DESCRIBING])
    return copy
