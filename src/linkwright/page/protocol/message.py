"""The base classes of messages, and their encoding as text and as binary frames.

Defining a message class registers it. Its codec and the types of the page are derived from the class. All messages from
pages are validated. A module with messages that few pages send can be imported when the first of them arrives, see
`define_later`.

Binary frames to pages are little endian: transforms, content with large arrays, and chunks of these.

Content is the drawable form of the messages that displays process. Its frame is four uint32 (kind 2, bytes of the
header, 0, 0), the header as JSON in UTF-8, and the arrays. The header and each array are padded to a multiple of 8
bytes. The header is ``{"display", "key", "frame", "stamp", "pose", "content"}``. An array in the content is represented
in the JSON by ``{"$": [type, offset, count]}``: the type is ``f4`` or ``u1``, and the offset counts bytes from the end
of the padded header.
"""

from __future__ import annotations

import json
import re
import struct
from functools import cache, lru_cache, partial
from importlib import import_module
from typing import Any, ClassVar, Union

import msgspec
import numpy as np
from msgspec import Struct
from numpy.typing import NDArray

from linkwright.diagnostics import Phrase
from linkwright.diagnostics.translation import translate_phrase


def _tag(name: str) -> str:
    """Return the tag of a class in JSON, such as ``set_joint`` for ``SetJoint``."""
    return re.sub(r"(?<!^)(?=[A-Z])", "_", name).lower()


class Record(Struct):
    """The base class of the structured parts of messages."""


class ServerMessage(Struct, tag_field="type", tag=_tag):
    """The base class of messages from the server to pages."""

    NEWEST_OF: ClassVar[tuple[str, ...]] = ()
    """The fields that identify the subject of a message. Of the messages that are queued for a slow page, only the
    newest for each value of these fields is sent, or the newest of the class if there are no fields."""


class PageMessage(Struct, tag_field="type", tag=_tag, forbid_unknown_fields=True):
    """The base class of messages from a page to the server.

    Messages with missing, unknown or mistyped fields are rejected.
    """


class DataContent(Struct, tag_field="kind", tag=_tag):
    """The base class of content with large arrays of displays. `pack_data` packs it."""


def get_tag(message: Struct) -> str:
    """Return the tag of a message's class in JSON."""
    return str(message.__struct_config__.tag)


class BadMessageError(ValueError):
    """Raised if a page has sent data that is not a message of the protocol.

    The message gives the reason.
    """


def to_plain(value: Any) -> Any:
    """Return a string or number as a built-in type, which JSON can represent.

    Its class may be derived from the built-in type.

    An example is a NumPy float.
    """
    if isinstance(value, str):
        return str.__str__(value)
    if isinstance(value, float):
        return float(value)
    if isinstance(value, int):
        return int(value)
    raise TypeError(f"JSON cannot represent a {type(value).__name__}")


def encode(message: ServerMessage, language: str | None = None) -> str:
    """Return a message as JSON.

    Surrogates, which represent bytes of file names that are not UTF-8, are replaced with question marks.

    Args:
        message: the message.
        language: the language of the message's phrases; None to leave them untranslated.
    """
    try:
        return _get_encoder(language).encode(message).decode()
    except UnicodeEncodeError:
        plain_message = msgspec.to_builtins(message, enc_hook=partial(_to_plain_or_localized, language=language))
        text = json.dumps(plain_message, ensure_ascii=False, separators=(",", ":"))
        return text.encode("utf-8", "replace").decode()


@cache
def _get_encoder(language: str | None) -> msgspec.json.Encoder:
    return msgspec.json.Encoder(enc_hook=partial(_to_plain_or_localized, language=language))


def _to_plain_or_localized(value: Any, language: str | None) -> Any:
    """Return a phrase in the language, or any other value as converted by `to_plain`."""
    return to_plain(translate_phrase(value, language) if language is not None and isinstance(value, Phrase) else value)


def make_redundancy_key(message: ServerMessage) -> str:
    """Return the key with which a message replaces earlier messages in an outbox.

    There is one key for each class, or for each value of the fields in the class's `NEWEST_OF`.
    """
    return "\n".join((get_tag(message), *(str(getattr(message, name)) for name in message.NEWEST_OF)))


def decode(text: str) -> PageMessage:
    """Return the message that a page sent.

    Raises:
        BadMessageError: the text is not JSON, its type is unknown, or its fields do not match the type exactly.
    """
    try:
        try:
            return _decode_defined(text)
        except msgspec.ValidationError:
            if not _import_module(text):
                raise
            return _decode_defined(text)
    except (msgspec.DecodeError, ValueError, RecursionError) as error:
        raise BadMessageError(str(error)) from None


def _decode_defined(text: str) -> PageMessage:
    message: PageMessage = _get_decoder(len(PageMessage.__subclasses__())).decode(text)
    return message


@lru_cache(maxsize=1)
def _get_decoder(_known: int) -> msgspec.json.Decoder[Any]:
    """Return a decoder for all message classes defined so far.

    The decoder is cached by the number of classes, so that a new class leads to a new decoder.
    """
    by_tag: dict[str, type[PageMessage]] = {}
    for cls in PageMessage.__subclasses__():
        tag = str(cls.__struct_config__.tag)
        if by_tag.get(tag, cls).__module__ == cls.__module__:  # another package must not replace a message class
            by_tag[tag] = cls
    return msgspec.json.Decoder(Union[tuple(by_tag.values())])  # noqa: UP007  # the types are in a tuple


_MODULES_BY_TAG: dict[str, str] = {}
"""The modules that are imported when the first message of a class arrives, by the tag of the class."""


class _TypeField(Struct):
    """The field of a message that identifies its class."""

    type: str


def get_import_path(message: type) -> str:
    """Return the import path of a message class, as ``module:class``."""
    return f"{message.__module__}:{message.__qualname__}"


def define_later(import_path: str) -> None:
    """Register a `PageMessage` class by name.

    Its module is imported when the first such message arrives.

    Args:
        import_path: the import path of the message class, as ``module:class``.
    """
    module, _, name = import_path.partition(":")
    _MODULES_BY_TAG.setdefault(_tag(name), module)


def _import_module(text: str) -> bool:
    """Import the module of a message.

    Return False if the module is already imported or not registered.
    """
    module = _MODULES_BY_TAG.pop(msgspec.json.decode(text, type=_TypeField).type, None)
    if module is None:
        return False
    import_module(module)
    return True


PROTOCOL_VERSION = 5
"""The version of the protocol, increased with every incompatible change. A page with another version reloads itself."""


class Hello(ServerMessage):
    """The first message on every connection. `run` changes when the program is started again."""

    protocol: int
    version: str
    title: str
    run: str


class ProgramIsLate(ServerMessage):
    """Whether the program, not the connection, causes most of the delay that the page observes."""

    late: bool


class Received(PageMessage):
    """The acknowledgment of messages: the number of messages that the page has received.

    It is sent after the first message and after each large message.
    """

    count: int


_TRANSFORMS_HEADER = struct.Struct("<IIIId")
TRANSFORMS_KIND = 1


class FrameTable(ServerMessage):
    """The names and parents of the frames in binary frames with this revision.

    A parent is an index, or -1 for a root.
    """

    revision: int
    names: list[str]
    parents: list[int]


def pack_transforms(revision: int, stamp: float, poses: NDArray[Any], ages: NDArray[Any]) -> bytes:
    """Return a binary frame with the poses and ages of all frames.

    The header is four uint32 (kind 1, revision of the frame table, number of frames N, 0) and a float64 stamp in
    seconds; then float32 N x 7 (x y z qx qy qz qw in the Fixed Frame, NaN if there is no transform) and N float32
    (seconds since the last transform of each frame; 0 for static frames). All numbers are little endian.

    Args:
        revision: the revision of the `FrameTable` with the names of the rows.
        stamp: the time of the newest transform, in seconds since the epoch.
        poses: the poses, shape (N, 7).
        ages: the ages, shape (N,).

    Raises:
        ValueError: the shapes do not match.
    """
    count = len(poses)
    if poses.shape != (count, 7) or ages.shape != (count,):
        raise ValueError(f"poses must be (N, 7) and ages (N,), not {poses.shape} and {ages.shape}")
    header = _TRANSFORMS_HEADER.pack(TRANSFORMS_KIND, revision, count, 0, stamp)
    return header + poses.astype("<f4").tobytes() + np.asarray(ages).astype("<f4").tobytes()


def unpack_transforms(frame: bytes) -> tuple[int, NDArray[np.float64]]:
    """Return the revision and the poses, shape (N, 7), of a frame from `pack_transforms`.

    The revision is -1 for any other frame.
    """
    if len(frame) < _TRANSFORMS_HEADER.size or _TRANSFORMS_HEADER.unpack_from(frame)[0] != TRANSFORMS_KIND:
        return -1, np.empty((0, 7))
    _, revision, count, _, _ = _TRANSFORMS_HEADER.unpack_from(frame)
    numbers = np.frombuffer(frame, "<f4", count * 7, _TRANSFORMS_HEADER.size)
    return revision, numbers.reshape(count, 7).astype(np.float64)


DATA_KIND = 2
_HEADER = struct.Struct("<IIII")
_ALIGNMENT = 8

Floats = NDArray[np.float32]
"""An array of any shape, which is a flat Float32Array in the page."""

Bytes = NDArray[np.uint8]
"""An array of any shape, which is a flat Uint8Array in the page."""

_ARRAY_TYPES = {"f": ("f4", "<f4"), "u": ("u1", "u1")}
_EMPTY_PLACEHOLDERS: dict[str, dict[str, list[Any]]] = {
    kind: {"$": [name, 0, 0]} for kind, (name, _) in _ARRAY_TYPES.items()
}
"""The placeholders of empty arrays, which are shared because each simple marker has three of them."""


class DisplayForgotten(ServerMessage):
    """The removal of a display's content under a key, or of all its content if the key is None."""

    NEWEST_OF: ClassVar[tuple[str, ...]] = ("display", "key")

    display: str
    key: str | None


def pack_data(
    display: str,
    content: DataContent,
    *,
    key: str = "",
    frame: str = "",
    pose: NDArray[Any] | None = None,
    stamp: float = 0.0,
) -> bytes:
    """Return a binary frame with a display's content.

    Args:
        display: the display's ID.
        content: the content.
        key: the key of the content; it replaces earlier content of the display with the same key.
        frame: the frame that the content is in; empty for the Fixed Frame.
        pose: the pose of the frame in the Fixed Frame at the time of the content, x, y, z, qx, qy, qz, qw; None if the
            content moves with the frame.
        stamp: the time of the content, in seconds since the epoch.
    """
    arrays = _Arrays()
    header = {
        "display": display,
        "key": key,
        "frame": frame,
        "stamp": stamp,
        "pose": None if pose is None else [float(number) for number in pose],
        "content": content,
    }
    text = _encode_header(header, arrays)
    parts = [_HEADER.pack(DATA_KIND, len(text), 0, 0), text, _make_padding(_HEADER.size + len(text))]
    return b"".join([*parts, *arrays.parts])


class _Arrays:
    """The concatenated arrays of a frame.

    Attributes:
        parts: the bytes of the arrays and the padding.
    """

    def __init__(self) -> None:
        self.parts: list[bytes] = []
        self._length = 0

    def clear(self) -> None:
        """Remove all arrays."""
        self.parts.clear()
        self._length = 0

    def encode_value(self, value: Any) -> Any:
        """Return the JSON form of a value.

        An array is added, and its placeholder is returned.
        """
        return self.put(value) if isinstance(value, np.ndarray) else to_plain(value)

    def put(self, array: NDArray[Any]) -> dict[str, list[Any]]:
        """Add an array and return its placeholder in the header."""
        if array.size == 0:
            return _EMPTY_PLACEHOLDERS[array.dtype.kind]
        name, dtype = _ARRAY_TYPES[array.dtype.kind]
        reference = {"$": [name, self._length, array.size]}
        data = np.ascontiguousarray(array, dtype=dtype).tobytes()
        padding = _make_padding(len(data))
        self.parts += [data, padding]
        self._length += len(data) + len(padding)
        return reference


def _encode_header(header: dict[str, Any], arrays: _Arrays) -> bytes:
    """Return the header as JSON.

    Surrogates, which file names may contain, are replaced with question marks.
    """
    try:
        return msgspec.json.encode(header, enc_hook=arrays.encode_value)
    except UnicodeEncodeError:
        arrays.clear()
        header = msgspec.to_builtins(header, enc_hook=arrays.encode_value)
        return json.dumps(header, ensure_ascii=False, separators=(",", ":")).encode("utf-8", "replace")


def _make_padding(length: int) -> bytes:
    return b"\0" * (-length % _ALIGNMENT)


PIECE_KIND = 4


def pack_chunk(frame: bytes, number: int, offset: int, size: int) -> bytes:
    """Return a binary frame with a chunk of another frame.

    The result consists of four little-endian uint32 (kind 4, number, offset, length of the complete frame) and the
    bytes from the offset on. The page processes the frame when it has received the last chunk. A chunk with offset 0
    begins another frame.

    Args:
        frame: the complete frame.
        number: the number of the transfer, which is the same for all chunks of a frame and differs for the next frame.
        offset: the offset of the chunk in the frame, in bytes.
        size: the maximum size of the chunk, in bytes.
    """
    return _HEADER.pack(PIECE_KIND, number, offset, len(frame)) + frame[offset : offset + size]
