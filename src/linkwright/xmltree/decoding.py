"""Decode the bytes of a file to text.

A file that is valid UTF-8 is read as UTF-8, regardless of its XML declaration, as in ros/xacro. Any other file is read
in the encoding that it declares.
"""

from __future__ import annotations

import codecs
import re

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, SourceText, phrase
from linkwright.diagnostics.diagnostic import POINTER_HINT, POINTER_REASON, is_pointer
from linkwright.loading.lean_dataclasses import NamedTuple

UTF_8 = "utf-8"
_POINTER_CHECK_LENGTH = 100
"""The number of characters that suffice to recognize a Git LFS pointer."""
_DECLARED_ENCODING = (
    rb"""^\s*<\?xml[^>]*?\bencoding\s*=\s*["']([A-Za-z][A-Za-z0-9._-]*)["']"""  # compiled only when needed
)
_BYTE_ORDER_MARKS = (
    (codecs.BOM_UTF8, UTF_8),
    (codecs.BOM_UTF32_LE, "utf-32-le"),
    (codecs.BOM_UTF32_BE, "utf-32-be"),
    (codecs.BOM_UTF16_LE, "utf-16-le"),
    (codecs.BOM_UTF16_BE, "utf-16-be"),
)
_UTF_16_STARTS = (b"<\0", b"\0<")
"""The first bytes of XML in UTF-16 without a byte order mark."""
_GBK_PATTERN = rb"(?:[\x00-\x7f]|[\xa1-\xf7][\xa1-\xfe])+"  # compiled only when needed
"""Text whose bytes beyond ASCII come in pairs, as in GBK and other East Asian encodings."""
_BINARY_CHECK_LENGTH = 1024
"""The number of leading bytes to search for a zero byte, as in images, archives, programs and meshes."""


class Decoded(NamedTuple):
    """The text of a file without its byte order mark, and the encoding of the file."""

    text: str
    encoding: str = UTF_8


def decode(data: bytes, name: str) -> str:
    """Return the text of a file without its byte order mark.

    Raises:
        LinkwrightError: see `decode_with_encoding`.
    """
    return decode_with_encoding(data, name).text


def decode_with_encoding(data: bytes, name: str) -> Decoded:
    """Return the text and the encoding of a file.

    Raises:
        LinkwrightError: XML104 if the bytes are not text in the file's encoding, or XML106 if the file is a Git LFS
            pointer whose content was not fetched.
    """
    _check_not_pointer(data, name)
    for mark, encoding in _BYTE_ORDER_MARKS:
        if data.startswith(mark):
            return _decode(data[len(mark) :], encoding, name, phrase("its byte order mark specifies this encoding"))
    _check_not_binary(data, name)
    try:
        return Decoded(data.decode(UTF_8))
    except UnicodeDecodeError:
        declaration = re.match(_DECLARED_ENCODING, data)
        if declaration is None and re.fullmatch(_GBK_PATTERN, data):
            return _decode(data, UTF_8, name, phrase("it declares no other encoding, though it looks like GBK"))
        if declaration is None:
            return _decode(data, UTF_8, name, phrase("it declares no other encoding"))
        encoding = declaration[1].decode("ascii")
        return _decode(data, encoding, name, phrase("its XML declaration specifies this encoding"))


def wrap_text(text: str, name: str) -> Decoded:
    """Return a text that was not read from a file as a `Decoded` in UTF-8.

    Raises:
        LinkwrightError: XML106 if the text is a Git LFS pointer.
    """
    _check_not_pointer(text[:_POINTER_CHECK_LENGTH].encode("utf-8", "replace"), name)
    return Decoded(text)


def _check_not_pointer(data: bytes, name: str) -> None:
    if is_pointer(data):
        message = phrase("cannot read '{path}': {reason}", path=name, reason=POINTER_REASON)
        raise LinkwrightError(Diagnostic("XML106", message, hint=POINTER_HINT))


def _check_not_binary(data: bytes, name: str) -> None:
    beginning = data[:_BINARY_CHECK_LENGTH]
    if b"\0" not in beginning:
        return
    if beginning.startswith(_UTF_16_STARTS):
        message = phrase("'{name}' is in UTF-16 and has no byte order mark", name=name)
        hint = phrase("save the file as UTF-8")
    elif not beginning.lstrip().startswith(b"<"):
        message = phrase("'{name}' is not a text file", name=name)
        hint = phrase("it contains NUL bytes, as images, archives and programs do; check that it is the intended file")
    else:
        return
    source = SourceText(name, "")
    raise LinkwrightError(Diagnostic("XML104", message, span=source.span(0), hint=hint, source=source))


def _decode(data: bytes, encoding: str, name: str, reason: Phrase) -> Decoded:
    try:
        return Decoded(data.decode(encoding), encoding)
    except LookupError:
        message = phrase(
            "'{name}' declares the encoding '{encoding}', which is not supported", name=name, encoding=encoding
        )
        raise LinkwrightError(Diagnostic("XML104", message, hint=phrase("save the file as UTF-8"))) from None
    except UnicodeDecodeError as error:
        valid_text = data[: error.start].decode(encoding, "replace")
        source = SourceText(name, valid_text + data[error.start :].decode(encoding, "replace"))
        raise LinkwrightError(
            Diagnostic(
                "XML104",
                phrase("byte 0x{data:02x} is not valid {encoding}", data=data[error.start], encoding=encoding.upper()),
                span=source.span(len(valid_text)),
                hint=phrase(
                    "save the file as UTF-8; it is read as {encoding}, because {reason}",
                    encoding=encoding.upper(),
                    reason=reason,
                ),
                source=source,
            )
        ) from None
