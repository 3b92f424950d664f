"""Keys for the contents of mesh files, so that copies of a file are read once."""

from __future__ import annotations

import hashlib
from pathlib import Path

ContentKey = tuple[str, bytes]
"""The format and a hash of the bytes."""
_MAX_BYTES = 64 << 20
_SHAPE_SUFFIXES = (".stl", ".dae", ".obj")
"""The formats whose files contain their whole shape. A glTF file can name others with its points."""
_SURFACE_SUFFIXES = (".stl", ".dae")
"""The formats whose files without the names of images contain everything that is drawn."""
_IMAGE_MARKER = b"init_from"
"""The tag in COLLADA before the name of the file of an image."""


def shape_key(path: Path) -> ContentKey | None:
    """Return a key that is equal for files with the same triangles, or None if other files may be needed."""
    content = _read_content(path, _SHAPE_SUFFIXES)
    return None if content is None else _create_key(path, content)


def surface_key(path: Path) -> ContentKey | None:
    """Return a key that is equal for files with the same look, or None if other files may be needed."""
    content = _read_content(path, _SURFACE_SUFFIXES)
    return None if content is None or _IMAGE_MARKER in content else _create_key(path, content)


def _read_content(path: Path, suffixes: tuple[str, ...]) -> bytes | None:
    """Return the bytes of a file, or None if its format, its size or an error prevents it."""
    try:
        if path.suffix.lower() in suffixes and path.is_file() and path.stat().st_size <= _MAX_BYTES:
            return path.read_bytes()
    except OSError:
        pass
    return None


def _create_key(path: Path, content: bytes) -> ContentKey:
    return path.suffix.lower(), hashlib.sha256(content).digest()
