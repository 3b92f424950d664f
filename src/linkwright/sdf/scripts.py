"""Read material scripts: Gazebo's built-in materials, and models' ``.material`` files.

The renderer of Gazebo classic, Ogre, defines materials in a script language. Only the colors and the first image of a
material are read here. Colors in the SDF file take precedence over the colors of the script.

Source: ``gazebo.material`` of Gazebo classic, and Ogre's manual, "Material scripts".
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

from linkwright.sdf.links import Link, Visual
from linkwright.sdf.materials import Material, MaterialScript, Pbr, Workflow
from linkwright.sdf.models import Model
from linkwright.sdf.resources import Missing, ResourceFinder
from linkwright.sdf.values import Color
from linkwright.sdf.worlds import Sdf


class Look(NamedTuple):
    """The colors and the texture that a script defines for a material.

    A color is None if the script does not set it; without a texture, `image` is empty.
    """

    ambient: Color | None = None
    diffuse: Color | None = None
    specular: Color | None = None
    emissive: Color | None = None
    image: str = ""


def _uniform_look(red: float, green: float, blue: float, alpha: float = 1.0, *, glow: bool = False) -> Look:
    color = (float(red), float(green), float(blue), alpha)
    return Look(color, color, None, color if glow else None)


_BUILT_IN_LOOKS = {
    "Black": _uniform_look(0, 0, 0),
    "Blue": _uniform_look(0, 0, 1),
    "BlueGlow": _uniform_look(0, 0, 1, glow=True),
    "BlueLaser": _uniform_look(0, 0, 1, 0.4),
    "BlueTransparent": _uniform_look(0, 0, 1, 0.5),
    "Bricks": _uniform_look(0.6, 0.35, 0.27),
    "CeilingTiled": _uniform_look(0.8, 0.8, 0.78),
    "DarkGray": _uniform_look(0.175, 0.175, 0.175),
    "DarkYellow": _uniform_look(0.7, 0.7, 0),
    "FlatBlack": _uniform_look(0.1, 0.1, 0.1),
    "Gold": Look((0.4, 0.24869, 0.020759, 1.0), (0.8, 0.64869, 0.120759, 1.0), (0.4, 0.4, 0.4, 1.0)),
    "Green": _uniform_look(0, 1, 0),
    "GreenGlow": _uniform_look(0, 1, 0, glow=True),
    "GreenTransparent": _uniform_look(0, 1, 0, 0.5),
    "Grey": Look((0.3, 0.3, 0.3, 1.0), (0.7, 0.7, 0.7, 1.0), (0.01, 0.01, 0.01, 1.0)),
    "GreyTransparent": _uniform_look(0.5, 0.5, 0.5, 0.5),
    "Indigo": _uniform_look(0.33, 0, 0.5),
    "LightOff": _uniform_look(1, 0, 0, glow=True),
    "LightOn": _uniform_look(0, 1, 0, glow=True),
    "Orange": Look((1.0, 0.5088, 0.0468, 1.0), (1.0, 0.5088, 0.0468, 1.0), (0.5, 0.5, 0.5, 1.0)),
    "OrangeTransparent": _uniform_look(1, 0.44, 0, 0.4),
    "PaintedWall": _uniform_look(0.85, 0.83, 0.78),
    "Pioneer2Body": Look(
        (0.481193, 0.000123, 0.000123, 1.0), (0.681193, 0.000923, 0.000923, 1.0), (0.5, 0.5, 0.5, 1.0)
    ),
    "Purple": _uniform_look(1, 0, 1),
    "PurpleGlow": _uniform_look(1, 0, 1, glow=True),
    "Red": _uniform_look(1, 0, 0),
    "RedBright": _uniform_look(0.87, 0.26, 0.07),
    "RedGlow": _uniform_look(1, 0, 0, glow=True),
    "RedTransparent": _uniform_look(1, 0, 0, 0.5),
    "Residential": _uniform_look(0.35, 0.35, 0.35),
    "Road": _uniform_look(0.3, 0.3, 0.3),
    "SkyBlue": Look((0.13, 0.44, 0.7, 1.0), (0.0, 0.0, 1.0, 1.0)),
    "Turquoise": _uniform_look(0, 1, 1),
    "TurquoiseGlow": _uniform_look(0, 1, 1, glow=True),
    "White": _uniform_look(1, 1, 1),
    "WhiteGlow": _uniform_look(1, 1, 1, glow=True),
    "Wood": _uniform_look(0.62, 0.46, 0.3),
    "WoodFloor": _uniform_look(0.55, 0.36, 0.2),
    "WoodPallet": _uniform_look(0.7, 0.56, 0.38),
    "Yellow": _uniform_look(1, 1, 0),
    "YellowGlow": _uniform_look(1, 1, 0, glow=True),
    "YellowTransparent": _uniform_look(1, 1, 0, 0.5),
    "ZincYellow": _uniform_look(0.9725, 0.9529, 0.2078),
}
"""Gazebo's built-in materials by name without prefix. Textured materials have the approximate color of their image."""
_GAZEBO_PREFIX = "Gazebo/"
_MAX_SCRIPT_BYTES = 1_000_000
"""The maximum size of a script in bytes. The script with Gazebo's materials has 19 000."""
_TOKENS = re.compile(r"//[^\n]*|/\*.*?\*/|\{|\}|\n|[^\s{}]+", re.DOTALL)
_COLOR_NAMES = ("ambient", "diffuse", "specular", "emissive")


def find_gazebo_look(name: str) -> Look | None:
    """Return the look of a built-in material of Gazebo, such as ``Gazebo/Grey``, or None."""
    return _BUILT_IN_LOOKS.get(name.removeprefix(_GAZEBO_PREFIX)) if name.startswith(_GAZEBO_PREFIX) else None


def with_look(material: Material, look: Look) -> Material:
    """Return a material with missing colors and a missing texture taken from a script's look."""
    pbr = material.pbr
    if look.image and pbr is None:
        pbr = Pbr(metal=Workflow(albedo_map=look.image))
    return replace(
        material,
        ambient=material.ambient or look.ambient,
        diffuse=material.diffuse or look.diffuse,
        specular=material.specular or look.specular,
        emissive=material.emissive or look.emissive,
        pbr=pbr,
    )


def find_appearance(material: Material) -> tuple[Color | None, str]:
    """Return the color of a material or None, and the address of its color image or ``""``.

    Material scripts were read with the world. For a model from text, only Gazebo's own material names are known here.
    """
    gazebo_material = find_gazebo_look(material.script.name) if material.script else None
    if gazebo_material is not None:
        material = with_look(material, gazebo_material)
    workflow = material.pbr and (material.pbr.metal or material.pbr.specular)
    image = workflow.albedo_map if workflow else ""
    return material.diffuse or material.ambient, image


def with_scripts(sdf: Sdf, finder: ResourceFinder) -> Sdf:
    """Return the content of a file with its materials completed from scripts.

    Args:
        sdf: the content of the file, with its includes resolved.
        finder: finds scripts and images.
    """
    library = _ScriptLibrary(finder)
    worlds = tuple(replace(world, models=tuple(map(library.model, world.models))) for world in sdf.worlds)
    return replace(sdf, worlds=worlds, models=tuple(map(library.model, sdf.models)))


class _ScriptLibrary:
    def __init__(self, finder: ResourceFinder) -> None:
        self._finder = finder
        self._files: dict[Path, dict[str, Look]] = {}

    def model(self, model: Model) -> Model:
        links = tuple(map(self._link, model.links))
        return replace(model, links=links, models=tuple(map(self.model, model.models)))

    def _link(self, link: Link) -> Link:
        if not any(visual.material is not None and visual.material.script is not None for visual in link.visuals):
            return link
        return replace(link, visuals=tuple(map(self._visual, link.visuals)))

    def _visual(self, visual: Visual) -> Visual:
        if visual.material is None or visual.material.script is None:
            return visual
        look = self._find_look(visual.material.script, visual)
        return visual if look is None else replace(visual, material=with_look(visual.material, look))

    def _find_look(self, script: MaterialScript, visual: Visual) -> Look | None:
        source = None if visual.element is None else visual.element.source
        folder = Path() if source is None else Path(source.name).parent
        paths = {uri: self._finder.file(uri.strip(), folder) for uri in script.uris if uri and uri.strip()}
        existing_paths = {uri: path for uri, path in paths.items() if not isinstance(path, Missing)}
        for file in (file for existing_path in existing_paths.values() for file in _list_script_files(existing_path)):
            look = self._read(file).get(script.name)
            if look is not None:
                return look._replace(image=_find_image(look.image, file, existing_paths))
        return find_gazebo_look(script.name)

    def _read(self, file: Path) -> dict[str, Look]:
        if file not in self._files:
            self._files[file] = {}
            with suppress(OSError):
                if file.stat().st_size <= _MAX_SCRIPT_BYTES:
                    self._files[file] = read_script(file.read_text(encoding="utf-8", errors="replace"))
        return self._files[file]


def _find_image(name: str, script: Path, paths: Mapping[str, Path]) -> str:
    """Return the URI of a texture that a script names, or an empty string if it is missing.

    The file is searched for in the folders of the material, beside the script, and in the folder ``textures`` next to
    the script's folder.
    """
    if name:
        for uri, path in paths.items():
            if (path / name).is_file():
                return f"{uri.strip().rstrip('/')}/{name}"
        for folder in (script.parent, script.parent.parent / "textures"):
            if (folder / name).is_file():
                return (folder / name).absolute().as_uri()
    return ""


def _list_script_files(path: Path) -> list[Path]:
    if not path.is_dir():
        return [path]
    with suppress(OSError):
        return sorted(path.glob("*.material"))
    return []


def read_script(text: str) -> dict[str, Look]:
    """Return the looks of the materials in an Ogre script, by name.

    If a property occurs several times, its first value is used.
    """
    looks: dict[str, Look] = {}
    current = ""
    depth = 0
    for line in _split_lines(text):
        keyword, *arguments = line
        if keyword == "material" and depth == 0 and arguments:
            current = arguments[0].strip('"')
            parent = arguments[-1].strip('"') if ":" in arguments else ""
            looks[current] = looks.get(parent) or find_gazebo_look(parent) or Look()
        elif keyword in "{}":
            depth = max(0, depth + (1 if keyword == "{" else -1))
        elif current and depth:
            looks[current] = _with_property(looks[current], keyword, arguments)
    return looks


def _with_property(look: Look, keyword: str, values: list[str]) -> Look:
    if keyword == "texture" and values and not look.image:
        return look._replace(image=values[0].strip('"'))
    if keyword in _COLOR_NAMES and getattr(look, keyword) is None:
        with suppress(ValueError):
            numbers = [float(value) for value in values[:4]]
            # In a specular color, the last of four or five numbers is the shininess.
            alpha = numbers[3] if len(numbers) == 4 and (keyword != "specular" or len(values) == 5) else 1.0
            if len(numbers) >= 3:
                colors: dict[str, Any] = {keyword: (numbers[0], numbers[1], numbers[2], alpha)}
                return look._replace(**colors)
    return look


def _split_lines(text: str) -> Iterator[list[str]]:
    """Yield the symbols of each nonempty line, without comments.

    Each brace counts as a line.
    """
    symbols: list[str] = []
    for match in _TOKENS.finditer(text):
        symbol = match[0]
        if symbol.startswith(("//", "/*")):
            continue
        if symbol in ("{", "}", "\n"):
            if symbols:
                yield symbols
            symbols = []
            if symbol != "\n":
                yield [symbol]
        else:
            symbols.append(symbol)
    if symbols:
        yield symbols
