"""The files that drawing a robot takes: meshes, and what these name in turn."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable
from pathlib import Path
from urllib.parse import unquote, urlsplit

from linkwright.viewer.protocol.robot import RobotScene
from linkwright.viewer.web.files import FileRefusedError, MeshFolders

_ADDRESS = re.compile(r"/mesh/([^/]+)/(.+)")
_COLLADA_IMAGE = re.compile(r"<init_from>\s*(?:<ref>)?\s*([^<]+?)\s*<")
_MATERIAL_FILE = re.compile(r"^[ \t]*mtllib[ \t]+(.+?)[ \t]*\r?$", re.MULTILINE)
_MATERIAL_MAP = re.compile(r"^[ \t]*(?:map_\w+|bump|norm|disp)[ \t]+(.+?)[ \t]*\r?$", re.MULTILINE)


def addresses(scenes: Iterable[RobotScene]) -> list[str]:
    """The addresses of the meshes and textures that robots name, each once."""
    found: dict[str, None] = {}
    for scene in scenes:
        for link in scene.links:
            for shape in (*link.visuals, *link.collisions):
                for address in (shape.url, shape.texture):
                    if address is not None:
                        found[address] = None
    return list(found)


class FileSet:
    """Files by the path of their address, under the same rules by which pages are served.

    Args:
        meshes: the folders that may be read.
    """

    def __init__(self, meshes: MeshFolders) -> None:
        self._meshes = meshes

    def path(self, address: str) -> Path:
        """The file at an address.

        Raises:
            FileRefusedError: it may not be read, or is not there.
        """
        found = _ADDRESS.fullmatch(urlsplit(address).path)
        if found is None:
            raise FileRefusedError(404, "no such file")
        return self._meshes.file(found[1], unquote(found[2]))

    def collect(self, wanted: Iterable[str]) -> dict[str, bytes]:
        """The contents by the path of their address, with the files that meshes name; what is not there is left out."""
        contents: dict[str, bytes] = {}
        waiting = [urlsplit(address).path for address in wanted]
        while waiting:
            address = waiting.pop()
            if address in contents:
                continue
            try:
                path = self.path(address)
                contents[address] = path.read_bytes()
            except (FileRefusedError, OSError):
                continue
            folder = address.rpartition("/")[0]
            waiting += [f"{folder}/{name}" for name in named_files(path.suffix.lower(), contents[address])]
        return contents


def named_files(ending: str, data: bytes) -> list[str]:
    """Names of other files in a mesh or material file, as they stand in it, relative to its folder."""
    names: list[str] = []
    if ending == ".dae":
        names = _COLLADA_IMAGE.findall(data.decode("utf-8", "replace"))
    elif ending == ".obj":
        names = _MATERIAL_FILE.findall(data.decode("utf-8", "replace"))
    elif ending == ".mtl":
        # Options and their numbers may stand before a name, which may hold spaces only without them.
        lines = _MATERIAL_MAP.findall(data.decode("utf-8", "replace"))
        names = [line.split()[-1] if line.startswith("-") else line for line in lines]
    elif ending == ".gltf":
        try:
            document = json.loads(data)
            parts = [*document.get("buffers", ()), *document.get("images", ())]
            names = [str(part["uri"]) for part in parts if "uri" in part]
        except (ValueError, AttributeError, TypeError):
            return []
    return [name for name in names if not name.startswith(("data:", "/", "file:", "http:", "https:"))]
