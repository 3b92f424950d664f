"""The base classes of messages, and their encoding and decoding as text.

To define a message is to register it: the codec and the page's types follow. All messages of pages are validated.
The module of a message that few pages send can be imported with the first one, see `define_later`.
"""

from __future__ import annotations

import json
import re
from functools import cache, lru_cache, partial
from importlib import import_module
from typing import Any, ClassVar, Union

import msgspec
from msgspec import Struct

from linkwright.diagnostics import Phrase
from linkwright.diagnostics.translation import said_in


def _tag(name: str) -> str:
    """Return the name of a class in JSON: ``SetJoint`` is ``set_joint``."""
    return re.sub(r"(?<!^)(?=[A-Z])", "_", name).lower()


class Record(Struct):
    """A part of messages."""


class ServerMessage(Struct, tag_field="type", tag=_tag):
    """A message from the server to pages."""

    NEWEST_OF: ClassVar[tuple[str, ...]] = ()
    """Fields that identify the subject of a message: of messages that wait for a slow page only the newest for each of
    their values is sent; without any, the newest of the class."""


class PageMessage(Struct, tag_field="type", tag=_tag, forbid_unknown_fields=True):
    """A message from a page to the server. It is validated: a missing, unknown or mistyped field is refused."""


class DataContent(Struct, tag_field="kind", tag=_tag):
    """The content of a display with large arrays, of `pack_data`."""


def tag_of(message: Struct) -> str:
    """Return the name of a message's class in JSON."""
    return str(message.__struct_config__.tag)


class BadMessageError(ValueError):
    """A page sent data that is not a message of the protocol; the text gives the reason."""


def plain(value: Any) -> Any:
    """Return the plain text or number of a derived class, such as those of numpy, for JSON."""
    if isinstance(value, str):
        return str.__str__(value)
    if isinstance(value, float):
        return float(value)
    if isinstance(value, int):
        return int(value)
    raise TypeError(f"JSON cannot represent a {type(value).__name__}")


def encode(message: ServerMessage, language: str | None = None) -> str:
    """Return a message as JSON. Half characters of names that are not in UTF-8 become question marks.

    Args:
        message: the message.
        language: the language of its phrases; None leaves them as they are.
    """
    try:
        return _encoder(language).encode(message).decode()
    except UnicodeEncodeError:
        built = msgspec.to_builtins(message, enc_hook=partial(_plain_or_localized, language=language))
        text = json.dumps(built, ensure_ascii=False, separators=(",", ":"))
        return text.encode("utf-8", "replace").decode()


@cache
def _encoder(language: str | None) -> msgspec.json.Encoder:
    return msgspec.json.Encoder(enc_hook=partial(_plain_or_localized, language=language))


def _plain_or_localized(value: Any, language: str | None) -> Any:
    """Return a phrase in the language, or another value as `plain` has it."""
    return plain(said_in(value, language) if language is not None and isinstance(value, Phrase) else value)


def redundancy_key(message: ServerMessage) -> str:
    """Return the key by which a message replaces earlier ones: one for each class, or each value of its `NEWEST_OF`."""
    return "\n".join((tag_of(message), *(str(getattr(message, name)) for name in message.NEWEST_OF)))


def decode(text: str) -> PageMessage:
    """Return the message that a page sent.

    Raises:
        BadMessageError: it is not JSON, its type is unknown, or its fields are not exactly those of the type.
    """
    try:
        try:
            return _decoded(text)
        except msgspec.ValidationError:
            if not _define(text):
                raise
            return _decoded(text)
    except (msgspec.DecodeError, ValueError, RecursionError) as error:
        raise BadMessageError(str(error)) from None


def _decoded(text: str) -> PageMessage:
    message: PageMessage = _decoder(len(PageMessage.__subclasses__())).decode(text)
    return message


@lru_cache(maxsize=1)
def _decoder(_known: int) -> msgspec.json.Decoder[Any]:
    """Return the decoder of all messages defined so far; a new one after a feature defined more."""
    by_tag: dict[str, type[PageMessage]] = {}
    for cls in PageMessage.__subclasses__():
        tag = str(cls.__struct_config__.tag)
        if by_tag.get(tag, cls).__module__ == cls.__module__:  # another package cannot take the name of a message
            by_tag[tag] = cls
    return msgspec.json.Decoder(Union[tuple(by_tag.values())])  # noqa: UP007  # made of a tuple


_LATER: dict[str, str] = {}
"""The modules of messages that are imported with the first message, by its name in JSON."""


class _Head(Struct):
    """The part of a message that names its class."""

    type: str


def address_of(message: type) -> str:
    """Return the address of a class of messages, as ``module:class``."""
    return f"{message.__module__}:{message.__qualname__}"


def define_later(address: str) -> None:
    """Import the module of a `PageMessage` when the first page sends one.

    Args:
        address: the address of its class, as ``module:class``.
    """
    module, _, name = address.partition(":")
    _LATER.setdefault(_tag(name), module)


def _define(text: str) -> bool:
    """Define the message that a page sent; False if it is defined, or unknown."""
    module = _LATER.pop(msgspec.json.decode(text, type=_Head).type, None)
    if module is None:
        return False
    import_module(module)
    return True


PROTOCOL_VERSION = 5
"""Increased on every change that an older page would misread; the page reloads itself if it differs."""


class Hello(ServerMessage):
    """First message on every connection; `run` changes when the program is started again."""

    protocol: int
    version: str
    title: str
    run: str


class ProgramIsLate(ServerMessage):
    """Whether this program's own delays, and not the line, are most of the time that answers of the page take."""

    late: bool


class Received(PageMessage):
    """Acknowledges the number of messages that the page has received, after the first one and after each large one."""

    count: int
