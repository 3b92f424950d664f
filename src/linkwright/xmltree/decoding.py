"""The decoding of the bytes of a file to text.

A file that is valid UTF-8 is read as UTF-8 regardless of its XML declaration, as in ros/xacro. Any other file is read
in the encoding that it declares.
"""

from __future__ import annotations

import codecs
import re

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, SourceText, phrase
from linkwright.diagnostics.diagnostic import FETCH, IS_POINTER, is_pointer
from linkwright.loading.lean_dataclasses import NamedTuple

UTF_8 = "utf-8"
_LONGEST_BEGINNING = 100
"""More characters than a pointer is known by."""
_DECLARED = rb"""^\s*<\?xml[^>]*?\bencoding\s*=\s*["']([A-Za-z][A-Za-z0-9._-]*)["']"""  # compiled only when needed
_BYTE_ORDER_MARKS = (
    (codecs.BOM_UTF8, UTF_8),
    (codecs.BOM_UTF32_LE, "utf-32-le"),
    (codecs.BOM_UTF32_BE, "utf-32-be"),
    (codecs.BOM_UTF16_LE, "utf-16-le"),
    (codecs.BOM_UTF16_BE, "utf-16-be"),
)
_UTF_16_OF_XML = (b"<\0", b"\0<")
"""How XML in UTF-16 begins where the byte order mark is missing."""
_LIKE_GBK = rb"(?:[\x00-\x7f]|[\xa1-\xf7][\xa1-\xfe])+"  # compiled only when needed
"""A text in which bytes beyond ASCII come in pairs, as in GBK and other encodings of East Asia."""
_BEGINNING_OF_BINARY = 1024
"""Images, archives, programs and meshes have a zero among this many bytes."""


class Decoded(NamedTuple):
    """The text of a file without its byte order mark, and the encoding of the file."""

    text: str
    encoding: str = UTF_8


def decode(data: bytes, name: str) -> str:
    """Return the text of a file without its byte order mark.

    Raises:
        LinkwrightError: see `decoded`.
    """
    return decoded(data, name).text


def decoded(data: bytes, name: str) -> Decoded:
    """Return the text and the encoding of a file.

    Raises:
        LinkwrightError: XML104 if the bytes are not text in the file's encoding, or XML106 if the file is a Git LFS
            pointer whose content was not fetched.
    """
    _refuse_pointer(data, name)
    for mark, encoding in _BYTE_ORDER_MARKS:
        if data.startswith(mark):
            return _decode(data[len(mark) :], encoding, name, phrase("its byte order mark specifies it"))
    _refuse_binary(data, name)
    try:
        return Decoded(data.decode(UTF_8))
    except UnicodeDecodeError:
        declared = re.match(_DECLARED, data)
        if declared is None and re.fullmatch(_LIKE_GBK, data):
            return _decode(data, UTF_8, name, phrase("it declares no other encoding, though it looks like GBK"))
        if declared is None:
            return _decode(data, UTF_8, name, phrase("it declares no other encoding"))
        encoding = declared[1].decode("ascii")
        return _decode(data, encoding, name, phrase("its XML declaration specifies it"))


def unsaved(text: str, name: str) -> Decoded:
    """Return a text that is not in a file, such as an unsaved one, with its encoding.

    Raises:
        LinkwrightError: XML106, as for a file.
    """
    _refuse_pointer(text[:_LONGEST_BEGINNING].encode("utf-8", "replace"), name)
    return Decoded(text)


def _refuse_pointer(data: bytes, name: str) -> None:
    if is_pointer(data):
        message = phrase("cannot read '{path}': {reason}", path=name, reason=IS_POINTER)
        raise LinkwrightError(Diagnostic("XML106", message, hint=FETCH))


def _refuse_binary(data: bytes, name: str) -> None:
    beginning = data[:_BEGINNING_OF_BINARY]
    if b"\0" not in beginning:
        return
    if beginning.startswith(_UTF_16_OF_XML):
        message = phrase("'{name}' is in UTF-16 and has no byte order mark", name=name)
        hint = phrase("save the file as UTF-8")
    elif not beginning.lstrip().startswith(b"<"):
        message = phrase("'{name}' is not a text file", name=name)
        hint = phrase("it looks like an image, an archive or a program; check that it is the intended file")
    else:
        return
    source = SourceText(name, "")
    raise LinkwrightError(Diagnostic("XML104", message, span=source.span(0), hint=hint, source=source))


def _decode(data: bytes, encoding: str, name: str, reason: Phrase) -> Decoded:
    try:
        return Decoded(data.decode(encoding), encoding)
    except LookupError:
        message = phrase(
            ("'{name}' declares the encoding '{encoding}', which is not supported"), name=name, encoding=encoding
        )
        raise LinkwrightError(Diagnostic("XML104", message, hint=phrase("save the file as UTF-8"))) from None
    except UnicodeDecodeError as error:
        before = data[: error.start].decode(encoding, "replace")
        source = SourceText(name, before + data[error.start :].decode(encoding, "replace"))
        raise LinkwrightError(
            Diagnostic(
                "XML104",
                phrase("byte 0x{data:02x} is not valid {encoding}", data=data[error.start], encoding=encoding.upper()),
                span=source.span(len(before)),
                hint=phrase(
                    "the file is read as {encoding}, because {reason}; save it as UTF-8",
                    encoding=encoding.upper(),
                    reason=reason,
                ),
                source=source,
            )
        ) from None
