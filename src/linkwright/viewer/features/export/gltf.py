"""glTF 2.0 binary files: a document, and the arrays and images that it speaks of."""

from __future__ import annotations

import json
import struct
from typing import Any

import numpy as np
from numpy.typing import NDArray

_MAGIC, _VERSION = 0x46546C67, 2
_JSON, _BINARY = 0x4E4F534A, 0x004E4942
_FLOAT, _UNSIGNED_SHORT, _UNSIGNED_INT = 5126, 5123, 5125
_VERTICES, _INDICES = 34962, 34963
_TYPES = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4"}
_REPEAT, _LINEAR, _LINEAR_MIPMAPS = 10497, 9729, 9987


class GltfFile:
    """A glTF that grows; everything added is known by its index.

    Args:
        generator: the program that makes it.
    """

    def __init__(self, generator: str) -> None:
        self._parts: dict[str, list[dict[str, Any]]] = {}
        self._binary = bytearray()
        self._generator = generator

    def add(self, kind: str, **content: Any) -> int:
        """Add to one of the document's lists (``nodes``, ``meshes``, ``materials``, ...); what is None is left out."""
        entries = self._parts.setdefault(kind, [])
        entries.append({name: value for name, value in content.items() if value is not None})
        return len(entries) - 1

    def entry(self, kind: str, index: int) -> dict[str, Any]:
        """What was added, to be changed."""
        return self._parts[kind][index]

    def vertices(self, values: NDArray[Any], *, bounded: bool = False) -> int:
        """Add an array of shape (N, 2 to 4), as float32; with its bounds, as positions must have them."""
        array = np.ascontiguousarray(values, dtype="<f4")
        bounds: dict[str, Any] = {}
        if bounded:
            bounds = {"min": array.min(axis=0).tolist(), "max": array.max(axis=0).tolist()}
        return self.add(
            "accessors",
            bufferView=self._view(array.tobytes(), _VERTICES),
            componentType=_FLOAT,
            count=len(array),
            type=_TYPES[array.shape[1]],
            **bounds,
        )

    def indices(self, values: NDArray[Any]) -> int:
        """Add the corners of triangles."""
        short = values.size == 0 or int(values.max()) < 0xFFFF
        array = np.ascontiguousarray(values, dtype="<u2" if short else "<u4").reshape(-1)
        return self.add(
            "accessors",
            bufferView=self._view(array.tobytes(), _INDICES),
            componentType=_UNSIGNED_SHORT if short else _UNSIGNED_INT,
            count=array.size,
            type="SCALAR",
        )

    def texture(self, data: bytes, content_type: str) -> int:
        """Add a PNG or JPEG as a texture that repeats."""
        if not self._parts.get("samplers"):
            self.add("samplers", magFilter=_LINEAR, minFilter=_LINEAR_MIPMAPS, wrapS=_REPEAT, wrapT=_REPEAT)
        image = self.add("images", bufferView=self._view(data), mimeType=content_type)
        return self.add("textures", source=image, sampler=0)

    def binary(self, roots: list[int]) -> bytes:
        """The file (.glb), showing these nodes."""
        document: dict[str, Any] = {
            "asset": {"version": "2.0", "generator": self._generator},
            "scene": 0,
            "scenes": [{"nodes": roots}],
            **self._parts,
        }
        if self._binary:
            document["buffers"] = [{"byteLength": len(self._binary)}]
        text = json.dumps(document, ensure_ascii=False, allow_nan=False, separators=(",", ":")).encode()
        chunks = [_chunk(_JSON, text, b" ")]
        if self._binary:
            chunks.append(_chunk(_BINARY, bytes(self._binary), b"\0"))
        body = b"".join(chunks)
        return struct.pack("<III", _MAGIC, _VERSION, 12 + len(body)) + body

    def _view(self, data: bytes, target: int | None = None) -> int:
        self._binary += b"\0" * (-len(self._binary) % 4)
        index = self.add("bufferViews", buffer=0, byteOffset=len(self._binary), byteLength=len(data), target=target)
        self._binary += data
        return index


def _chunk(kind: int, data: bytes, padding: bytes) -> bytes:
    data += padding * (-len(data) % 4)
    return struct.pack("<II", len(data), kind) + data
