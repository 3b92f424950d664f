"""Reads compressed files of recordings without metadata.

The metadata are missing if only the file was copied, or if the recorder was killed. rosbag2 compresses whole files or
single messages, and only ``metadata.yaml`` states which.
"""

from __future__ import annotations

import shutil
import sys
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

from linkwright.bag.names import PACKED

if TYPE_CHECKING:
    from rosbags.rosbag2 import Reader

if sys.version_info >= (3, 14):
    from compression import zstd
else:
    from backports import zstd

_MAGIC = b"\x28\xb5\x2f\xfd"
"""The first bytes of zstd's format (RFC 8878); messages begin with a zero."""


def decompress_file(path: Path, folder: Path) -> Path:
    """Decompress a file into a folder, and return the path of the result.

    Of a truncated file, the available part is decompressed.

    Raises:
        zstd.ZstdError: the file is not compressed with zstd.
        OSError: the result cannot be written.
    """
    plain = folder / path.name.removesuffix(PACKED)
    with zstd.open(path, "rb") as source, plain.open("wb") as target, suppress(EOFError):
        shutil.copyfileobj(source, target)
    return plain


def unpack_messages(reader: Reader) -> None:
    """Make the reader of a single file decompress its messages, if the first message is compressed.

    Args:
        reader: the library's reader, which is open.
    """
    storage: Any = reader.storage
    first = next(iter(reader.messages()), None) if reader.message_count else None
    if first is None or not first[2].startswith(_MAGIC):
        return
    packed = storage.messages

    def messages(*arguments: Any) -> Iterator[tuple[Any, int, bytes]]:
        for connection, stamp_ns, data in packed(*arguments):
            yield connection, stamp_ns, zstd.decompress(data)

    storage.messages = messages
    storage.metadata = storage.metadata._replace(compression_mode="message", compression_format="zstd")
