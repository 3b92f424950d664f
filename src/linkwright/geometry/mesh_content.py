"""Keys for the contents of mesh files, so that copies of a file are read once."""

from __future__ import annotations

import hashlib
from pathlib import Path

ContentKey = tuple[str, bytes]
"""The format and a hash of the bytes."""
_MAX_BYTES = 64 << 20
_WITH_SHAPE = (".stl", ".dae", ".obj")
"""The formats whose files contain their whole shape. A glTF file can name others with its points."""
_WITH_SURFACES = (".stl", ".dae")
"""The formats whose files without the names of images contain everything that is drawn."""
_NAME_OF_IMAGE = b"init_from"
"""The tag in COLLADA before the name of the file of an image."""


def shape_key(path: Path) -> ContentKey | None:
    """Return a key that is equal for files with the same triangles; None if other files may have a part of them."""
    content = _content(path, _WITH_SHAPE)
    return None if content is None else _key(path, content)


def surface_key(path: Path) -> ContentKey | None:
    """Return a key that is equal for files that look the same; None if other files may have colors or textures."""
    content = _content(path, _WITH_SURFACES)
    return None if content is None or _NAME_OF_IMAGE in content else _key(path, content)


def _content(path: Path, suffixes: tuple[str, ...]) -> bytes | None:
    """Return the bytes of a file, or None if it has another format, is too large, or cannot be read."""
    try:
        if path.suffix.lower() in suffixes and path.is_file() and path.stat().st_size <= _MAX_BYTES:
            return path.read_bytes()
    except OSError:
        pass
    return None


def _key(path: Path, content: bytes) -> ContentKey:
    return path.suffix.lower(), hashlib.sha256(content).digest()
