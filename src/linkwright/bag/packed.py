"""Read compressed files of recordings that have no metadata.

The metadata is missing if only a file was copied, or if the recorder was killed. rosbag2 compresses either whole files
or single messages, and records the choice only in ``metadata.yaml``.
"""

from __future__ import annotations

import shutil
import sys
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

from linkwright.bag.names import COMPRESSED_SUFFIX

if TYPE_CHECKING:
    from rosbags.rosbag2 import Reader

if sys.version_info >= (3, 14):
    from compression import zstd
else:
    from backports import zstd

_MAGIC = b"\x28\xb5\x2f\xfd"
"""The first bytes of zstd data (RFC 8878). An uncompressed message begins with a zero."""


def decompress_file(path: Path, folder: Path) -> Path:
    """Decompress a file into a folder, and return the path of the result.

    Of a truncated file, the part that exists is decompressed.

    Raises:
        zstd.ZstdError: the file is not compressed with zstd.
        OSError: the result cannot be written.
    """
    target_path = folder / path.name.removesuffix(COMPRESSED_SUFFIX)
    with zstd.open(path, "rb") as source, target_path.open("wb") as target, suppress(EOFError):
        shutil.copyfileobj(source, target)
    return target_path


def decompress_messages(reader: Reader) -> None:
    """Make a single file's reader decompress its messages if the first one is compressed.

    Args:
        reader: the library's reader of a single file; it must be open.
    """
    storage: Any = reader.storage
    first_message = next(iter(reader.messages()), None) if reader.message_count else None
    if first_message is None or not first_message[2].startswith(_MAGIC):
        return
    read_messages = storage.messages

    def messages(*arguments: Any) -> Iterator[tuple[Any, int, bytes]]:
        for connection, stamp_ns, data in read_messages(*arguments):
            yield connection, stamp_ns, zstd.decompress(data)

    storage.messages = messages
    storage.metadata = storage.metadata._replace(compression_mode="message", compression_format="zstd")
