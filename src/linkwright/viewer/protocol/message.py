"""What messages are derived from. To define a message is to register it: the codec and the page's types follow."""

from __future__ import annotations

import re
from typing import ClassVar

from msgspec import Struct


def _tag(name: str) -> str:
    """By what JSON names a class: ``SetJoint`` is ``set_joint``."""
    return re.sub(r"(?<!^)(?=[A-Z])", "_", name).lower()


class Record(Struct):
    """A part of messages."""


class ServerMessage(Struct, tag_field="type", tag=_tag):
    """What the server says to pages."""

    NEWEST_OF: ClassVar[tuple[str, ...]] = ()
    """Fields that say what a message is about: of messages that wait for a slow page only the newest for each of their
    values is sent; without any, the newest of the class."""


class PageMessage(Struct, tag_field="type", tag=_tag, forbid_unknown_fields=True):
    """What pages say to the server, which takes nothing on trust: a field more, less or of another type is refused."""


class DataContent(Struct, tag_field="kind", tag=_tag):
    """What displays draw: the content of `pack_data`, with large arrays."""


def tag_of(message: Struct) -> str:
    """By what JSON names the class of a message."""
    return str(message.__struct_config__.tag)
