"""Bindings for the C functions of Eclipse Cyclone DDS that Linkwright uses.

The functions are those of the wheel `cyclonedds`, whose Python classes are built on them. Two properties of these
classes do not suit a process that publishes from the thread of an event loop: `DataWriter.write` holds Python's global
interpreter lock (GIL) while it waits for slow readers, and every entity's `__del__` deletes the entity in the thread in
which the garbage collector happens to run. Therefore, the Python package is used only where there is no C function: for
topics of types that are described in Python, and for taking samples as bytes.

Functions that may wait are called with the GIL released, and quick functions with the GIL held, because releasing it
costs up to five milliseconds each time when another thread is computing.
"""

from __future__ import annotations

import ctypes as c
import sys
from functools import lru_cache
from importlib import import_module
from importlib.util import find_spec, module_from_spec
from typing import Any

INFINITY_NS = 0x7FFF_FFFF_FFFF_FFFF
"""DDS_INFINITY, in nanoseconds."""

TIMEOUT = -10

BUILTIN_PARTICIPANTS = 0x7FFF_0001
BUILTIN_PUBLICATIONS = 0x7FFF_0003
BUILTIN_SUBSCRIPTIONS = 0x7FFF_0004
"""Topics that Cyclone fills from discovery (DDS_BUILTIN_TOPIC_DCPS...)."""

ANY_STATE = 0x7F
"""Sample, view and instance states: everything (DDS_ANY_STATE)."""

INSTANCE_ALIVE = 16

LOG_ERRORS = 3
"""DDS_LC_FATAL and DDS_LC_ERROR."""

OFFERED_INCOMPATIBLE_QOS = 1 << 3
REQUESTED_INCOMPATIBLE_QOS = 1 << 4
SAMPLE_LOST = 1 << 5
DATA_AVAILABLE = 1 << 8
LIVELINESS_CHANGED = 1 << 10
PUBLICATION_MATCHED = 1 << 11
SUBSCRIPTION_MATCHED = 1 << 12


class Sample(c.Structure):
    """A sample for a writer of a type described in Python, as serialized bytes."""

    _fields_ = (("data", c.c_char_p), ("size", c.c_size_t))


class MatchedStatus(c.Structure):
    """The C structures dds_publication_matched_status_t and dds_subscription_matched_status_t."""

    _fields_ = (
        ("total_count", c.c_uint32),
        ("total_count_change", c.c_int32),
        ("current_count", c.c_uint32),
        ("current_count_change", c.c_int32),
        ("last_handle", c.c_uint64),
    )


class CountStatus(c.Structure):
    """The C structure dds_sample_lost_status_t."""

    _fields_ = (("total_count", c.c_uint32), ("total_count_change", c.c_int32))


class LivelinessChangedStatus(c.Structure):
    """The C structure dds_liveliness_changed_status_t."""

    _fields_ = (
        ("alive_count", c.c_uint32),
        ("not_alive_count", c.c_uint32),
        ("alive_count_change", c.c_int32),
        ("not_alive_count_change", c.c_int32),
        ("last_handle", c.c_uint64),
    )


_QOS = c.c_void_p
_ENTITY = c.c_int32
_HANDLES = c.POINTER(c.c_uint64)

_QUICK_FUNCTIONS: dict[str, tuple[Any, tuple[Any, ...]]] = {
    "dds_create_qos": (_QOS, ()),
    "dds_delete_qos": (None, (_QOS,)),
    "dds_free": (None, (c.c_void_p,)),
    "dds_alloc": (c.c_void_p, (c.c_size_t,)),
    "dds_qset_history": (None, (_QOS, c.c_int, c.c_int32)),
    "dds_qset_reliability": (None, (_QOS, c.c_int, c.c_int64)),
    "dds_qset_durability": (None, (_QOS, c.c_int)),
    "dds_qset_durability_service": (
        None,
        (_QOS, c.c_int64, c.c_int, c.c_int32, c.c_int32, c.c_int32, c.c_int32),
    ),
    "dds_qset_lifespan": (None, (_QOS, c.c_int64)),
    "dds_qset_deadline": (None, (_QOS, c.c_int64)),
    "dds_qset_liveliness": (None, (_QOS, c.c_int, c.c_int64)),
    "dds_qset_ignorelocal": (None, (_QOS, c.c_int)),
    "dds_qset_userdata": (None, (_QOS, c.c_char_p, c.c_size_t)),
    "dds_qset_writer_data_lifecycle": (None, (_QOS, c.c_bool)),
    "dds_qset_data_representation": (None, (_QOS, c.c_uint32, c.POINTER(c.c_int16))),
    "dds_qset_entity_name": (None, (_QOS, c.c_char_p)),
    "dds_qget_history": (c.c_bool, (_QOS, c.POINTER(c.c_int), c.POINTER(c.c_int32))),
    "dds_qget_reliability": (c.c_bool, (_QOS, c.POINTER(c.c_int), c.POINTER(c.c_int64))),
    "dds_qget_durability": (c.c_bool, (_QOS, c.POINTER(c.c_int))),
    "dds_qget_deadline": (c.c_bool, (_QOS, c.POINTER(c.c_int64))),
    "dds_qget_lifespan": (c.c_bool, (_QOS, c.POINTER(c.c_int64))),
    "dds_qget_liveliness": (c.c_bool, (_QOS, c.POINTER(c.c_int), c.POINTER(c.c_int64))),
    "dds_qget_userdata": (c.c_bool, (_QOS, c.POINTER(c.c_void_p), c.POINTER(c.c_size_t))),
    "dds_qget_entity_name": (c.c_bool, (_QOS, c.POINTER(c.c_void_p))),
    "dds_qget_prop": (c.c_bool, (_QOS, c.c_char_p, c.POINTER(c.c_void_p))),
    "dds_get_guid": (c.c_int32, (_ENTITY, c.c_char_p)),
    "dds_get_entity_sertype": (c.c_int32, (_ENTITY, c.POINTER(c.c_void_p))),
    "ddsi_sertype_ref": (c.c_void_p, (c.c_void_p,)),
    "dds_set_status_mask": (c.c_int32, (_ENTITY, c.c_uint32)),
    "dds_take_status": (c.c_int32, (_ENTITY, c.POINTER(c.c_uint32), c.c_uint32)),
    "dds_get_publication_matched_status": (c.c_int32, (_ENTITY, c.POINTER(MatchedStatus))),
    "dds_get_subscription_matched_status": (c.c_int32, (_ENTITY, c.POINTER(MatchedStatus))),
    "dds_get_sample_lost_status": (c.c_int32, (_ENTITY, c.POINTER(CountStatus))),
    "dds_get_liveliness_changed_status": (c.c_int32, (_ENTITY, c.POINTER(LivelinessChangedStatus))),
    "dds_set_guardcondition": (c.c_int32, (_ENTITY, c.c_bool)),
    "dds_take_guardcondition": (c.c_int32, (_ENTITY, c.POINTER(c.c_bool))),
    "dds_get_matched_publication_data": (c.c_void_p, (_ENTITY, c.c_uint64)),
    "dds_builtintopic_free_endpoint": (None, (c.c_void_p,)),
    "dds_set_log_mask": (None, (c.c_uint32,)),
    "dds_strretcode": (c.c_char_p, (c.c_int32,)),
}

_BLOCKING_FUNCTIONS: dict[str, tuple[Any, tuple[Any, ...]]] = {
    "dds_create_domain": (_ENTITY, (c.c_uint32, c.c_char_p)),
    "dds_create_participant": (_ENTITY, (c.c_uint32, _QOS, c.c_void_p)),
    "dds_create_topic_sertype": (
        _ENTITY,
        (_ENTITY, c.c_char_p, c.POINTER(c.c_void_p), _QOS, c.c_void_p, c.c_void_p),
    ),
    "ddsi_sertype_unref": (None, (c.c_void_p,)),
    "ddsi_sertype_free": (None, (c.c_void_p,)),
    "dds_create_reader": (_ENTITY, (_ENTITY, _ENTITY, _QOS, c.c_void_p)),
    "dds_create_writer": (_ENTITY, (_ENTITY, _ENTITY, _QOS, c.c_void_p)),
    "dds_create_waitset": (_ENTITY, (_ENTITY,)),
    "dds_create_guardcondition": (_ENTITY, (_ENTITY,)),
    "dds_delete": (c.c_int32, (_ENTITY,)),
    "dds_waitset_attach": (c.c_int32, (_ENTITY, _ENTITY, c.c_ssize_t)),
    "dds_waitset_detach": (c.c_int32, (_ENTITY, _ENTITY)),
    "dds_waitset_wait": (c.c_int32, (_ENTITY, c.POINTER(c.c_ssize_t), c.c_size_t, c.c_int64)),
    "dds_write": (c.c_int32, (_ENTITY, c.POINTER(Sample))),
    "dds_write_ts": (c.c_int32, (_ENTITY, c.POINTER(Sample), c.c_int64)),
    "dds_wait_for_acks": (c.c_int32, (_ENTITY, c.c_int64)),
    "dds_assert_liveliness": (c.c_int32, (_ENTITY,)),
    "dds_get_matched_subscriptions": (c.c_int32, (_ENTITY, _HANDLES, c.c_size_t)),
    "dds_get_matched_publications": (c.c_int32, (_ENTITY, _HANDLES, c.c_size_t)),
}


class CycloneError(Exception):
    """Raised when a call of Cyclone DDS fails.

    Attributes:
        code: the return code, which is negative.
    """

    def __init__(self, code: int, operation: str) -> None:
        super().__init__(f"{operation}: {describe_code(code)}")
        self.code = code


class Cyclone:
    """The bound C functions, under their C names, and the parts of the Python package in use."""

    def __init__(self) -> None:
        _open_package()
        from cyclonedds import _clayer  # loads the shared library of the wheel
        from cyclonedds.internal import DDS

        path = DDS._dll_handle._name
        quick_library, blocking_library = c.PyDLL(path), c.CDLL(path)
        for library, functions in ((quick_library, _QUICK_FUNCTIONS), (blocking_library, _BLOCKING_FUNCTIONS)):
            for name, (result, arguments) in functions.items():
                function = getattr(library, name)
                function.restype, function.argtypes = result, arguments
                setattr(self, name, function)
        self.type_version: int | None = c.cast(quick_library.ddsi_sertype_v0, c.c_void_p).value
        self.take_bytes = _clayer.ddspy_take
        self.take_participants = _clayer.ddspy_take_participant
        self.take_endpoints = _clayer.ddspy_take_endpoint
        self.create_topic = _clayer.ddspy_topic_create

    def __getattr__(self, name: str) -> Any:
        raise AttributeError(f"'{name}' of Cyclone DDS is not bound")

    def guid(self, entity: int) -> bytes:
        """Return the globally unique identifier of an entity, 16 bytes."""
        buffer = c.create_string_buffer(16)
        check_call(self.dds_get_guid(entity, buffer), "reading the GUID of an entity")
        return buffer.raw

    def matching_handles(self, entity: int, *, writer: bool) -> list[int]:
        """Return the instance handles of the remote endpoints that match a writer or a reader."""
        function = self.dds_get_matched_subscriptions if writer else self.dds_get_matched_publications
        size = 64
        while True:
            handles = (c.c_uint64 * size)()
            count: int = function(entity, handles, size)
            if count <= size:
                return list(handles[: max(count, 0)])
            size = count + 16

    def writer_guid(self, reader: int, handle: int) -> bytes:
        """Return the GUID of a remote writer matched with a reader.

        Return empty bytes if the writer has left.
        """
        data = self.dds_get_matched_publication_data(reader, handle)
        if not data:
            return b""
        try:
            return c.string_at(data, 16)
        finally:
            self.dds_builtintopic_free_endpoint(data)

    def user_data(self, qos: int) -> bytes:
        """Return the USER_DATA in a set of policies, or empty bytes if there is none."""
        value, size = c.c_void_p(), c.c_size_t()
        if not self.dds_qget_userdata(qos, c.byref(value), c.byref(size)) or not value.value:
            return b""
        try:
            return c.string_at(value.value, size.value)
        finally:
            self.dds_free(value)

    def entity_name(self, qos: int) -> str:
        """Return the name that a participant announces for itself, or an empty string."""
        value = c.c_void_p()
        return self._take_text(value) if self.dds_qget_entity_name(qos, c.byref(value)) else ""

    def property(self, qos: int, name: str) -> str:
        """Return the value of a property that a participant announces, or an empty string."""
        value = c.c_void_p()
        return self._take_text(value) if self.dds_qget_prop(qos, name.encode(), c.byref(value)) else ""

    def _take_text(self, value: c.c_void_p) -> str:
        """Return a string that Cyclone has allocated, and free Cyclone's memory."""
        if not value.value:
            return ""
        try:
            return c.string_at(value.value).decode(errors="replace")
        finally:
            self.dds_free(value)


def _open_package() -> None:
    """Make the package `cyclonedds` import its modules on first use instead of all at once.

    The package's ``__init__`` imports all modules, which takes several times as long as importing those used here.
    Other code that imports the package in this process finds everything in it as before.
    """
    spec = find_spec("cyclonedds")
    if "cyclonedds" in sys.modules or spec is None:
        return
    package = module_from_spec(spec)
    package.__dict__["__getattr__"] = _import_submodule
    sys.modules.setdefault("cyclonedds", package)


def _import_submodule(name: str) -> Any:
    if name.startswith("__"):
        raise AttributeError(f"module 'cyclonedds' has no attribute '{name}'")
    try:
        return import_module(f"cyclonedds.{name}")
    except ModuleNotFoundError as error:
        raise AttributeError(f"module 'cyclonedds' has no attribute '{name}'") from error


@lru_cache(maxsize=1)
def load() -> Cyclone:
    """Return the bound library, loading it on first use."""
    return Cyclone()


def check_call(code: int, operation: str) -> int:
    """Return the result of a successful call.

    Args:
        code: the return code of the call.
        operation: a description of the call, for the error.

    Raises:
        CycloneError: the call failed.
    """
    if code < 0:
        raise CycloneError(code, operation)
    return code


def describe_code(code: int) -> str:
    """Return the meaning of a return code."""
    text: bytes = load().dds_strretcode(code)
    return text.decode(errors="replace") if text else f"error {code}"


def write(writer: int, data: bytes) -> int:
    """Write a sample.

    This may wait for slow readers, with the GIL released.

    Args:
        writer: the writer.
        data: CDR with its header; it is padded to a multiple of four bytes as RTPS requires.

    Returns:
        Zero, or Cyclone's return code.
    """
    if len(data) & 3:
        data += bytes(-len(data) & 3)
    code: int = load().dds_write(writer, c.byref(Sample(data, len(data))))
    return code
