"""Material scripts: Gazebo's own materials by name, and ``.material`` files of models.

The renderer of Gazebo classic, Ogre, has materials in scripts of its own language; only their colours and the first
image are read here. Colours in the SDF file take precedence over the colours of the script.

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
    """The colours and the texture of a material in a script.

    Missing colours are None, and a missing texture is empty.
    """

    ambient: Color | None = None
    diffuse: Color | None = None
    specular: Color | None = None
    emissive: Color | None = None
    image: str = ""


def _plain(red: float, green: float, blue: float, alpha: float = 1.0, *, glow: bool = False) -> Look:
    color = (float(red), float(green), float(blue), alpha)
    return Look(color, color, None, color if glow else None)


_NAMED = {
    "Black": _plain(0, 0, 0),
    "Blue": _plain(0, 0, 1),
    "BlueGlow": _plain(0, 0, 1, glow=True),
    "BlueLaser": _plain(0, 0, 1, 0.4),
    "BlueTransparent": _plain(0, 0, 1, 0.5),
    "Bricks": _plain(0.6, 0.35, 0.27),
    "CeilingTiled": _plain(0.8, 0.8, 0.78),
    "DarkGrey": _plain(0.175, 0.175, 0.175),
    "DarkYellow": _plain(0.7, 0.7, 0),
    "FlatBlack": _plain(0.1, 0.1, 0.1),
    "Gold": Look((0.4, 0.24869, 0.020759, 1.0), (0.8, 0.64869, 0.120759, 1.0), (0.4, 0.4, 0.4, 1.0)),
    "Green": _plain(0, 1, 0),
    "GreenGlow": _plain(0, 1, 0, glow=True),
    "GreenTransparent": _plain(0, 1, 0, 0.5),
    "Grey": Look((0.3, 0.3, 0.3, 1.0), (0.7, 0.7, 0.7, 1.0), (0.01, 0.01, 0.01, 1.0)),
    "GreyTransparent": _plain(0.5, 0.5, 0.5, 0.5),
    "Indigo": _plain(0.33, 0, 0.5),
    "LightOff": _plain(1, 0, 0, glow=True),
    "LightOn": _plain(0, 1, 0, glow=True),
    "Orange": Look((1.0, 0.5088, 0.0468, 1.0), (1.0, 0.5088, 0.0468, 1.0), (0.5, 0.5, 0.5, 1.0)),
    "OrangeTransparent": _plain(1, 0.44, 0, 0.4),
    "PaintedWall": _plain(0.85, 0.83, 0.78),
    "Pioneer2Body": Look(
        (0.481193, 0.000123, 0.000123, 1.0), (0.681193, 0.000923, 0.000923, 1.0), (0.5, 0.5, 0.5, 1.0)
    ),
    "Purple": _plain(1, 0, 1),
    "PurpleGlow": _plain(1, 0, 1, glow=True),
    "Red": _plain(1, 0, 0),
    "RedBright": _plain(0.87, 0.26, 0.07),
    "RedGlow": _plain(1, 0, 0, glow=True),
    "RedTransparent": _plain(1, 0, 0, 0.5),
    "Residential": _plain(0.35, 0.35, 0.35),
    "Road": _plain(0.3, 0.3, 0.3),
    "SkyBlue": Look((0.13, 0.44, 0.7, 1.0), (0.0, 0.0, 1.0, 1.0)),
    "Turquoise": _plain(0, 1, 1),
    "TurquoiseGlow": _plain(0, 1, 1, glow=True),
    "White": _plain(1, 1, 1),
    "WhiteGlow": _plain(1, 1, 1, glow=True),
    "Wood": _plain(0.62, 0.46, 0.3),
    "WoodFloor": _plain(0.55, 0.36, 0.2),
    "WoodPallet": _plain(0.7, 0.56, 0.38),
    "Yellow": _plain(1, 1, 0),
    "YellowGlow": _plain(1, 1, 0, glow=True),
    "YellowTransparent": _plain(1, 1, 0, 0.5),
    "ZincYellow": _plain(0.9725, 0.9529, 0.2078),
}
"""Gazebo's own materials; those that are images there have about the colour of the image."""
_PREFIX = "Gazebo/"
_LARGEST = 1_000_000
"""Bytes of a script; Gazebo's own has 19 000."""
_WORDS = re.compile(r"//[^\n]*|/\*.*?\*/|\{|\}|\n|[^\s{}]+", re.DOTALL)
_COLORS = ("ambient", "diffuse", "specular", "emissive")


def gazebo_look(name: str) -> Look | None:
    """Return the look of one of Gazebo's materials, such as ``Gazebo/Grey``; None for other names."""
    return _NAMED.get(name.removeprefix(_PREFIX)) if name.startswith(_PREFIX) else None


def with_look(material: Material, look: Look) -> Material:
    """Return a material in which a script's look replaces missing colours and a missing texture."""
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


def with_scripts(sdf: Sdf, finder: ResourceFinder) -> Sdf:
    """Return a file whose materials are completed from the scripts that they name.

    Args:
        sdf: the file, with its includes resolved.
        finder: the finder of scripts and images.
    """
    library = _Library(finder)
    worlds = tuple(replace(world, models=tuple(map(library.model, world.models))) for world in sdf.worlds)
    return replace(sdf, worlds=worlds, models=tuple(map(library.model, sdf.models)))


class _Library:
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
        look = self._look(visual.material.script, visual)
        return visual if look is None else replace(visual, material=with_look(visual.material, look))

    def _look(self, script: MaterialScript, visual: Visual) -> Look | None:
        source = None if visual.element is None else visual.element.source
        beside = Path() if source is None else Path(source.name).parent
        found = {uri: self._finder.file(uri.strip(), beside) for uri in script.uris if uri and uri.strip()}
        places = {uri: place for uri, place in found.items() if not isinstance(place, Missing)}
        for file in (file for place in places.values() for file in _scripts(place)):
            look = self._read(file).get(script.name)
            if look is not None:
                return look._replace(image=_image(look.image, file, places))
        return gazebo_look(script.name)

    def _read(self, file: Path) -> dict[str, Look]:
        if file not in self._files:
            self._files[file] = {}
            with suppress(OSError):
                if file.stat().st_size <= _LARGEST:
                    self._files[file] = read_script(file.read_text(encoding="utf-8", errors="replace"))
        return self._files[file]


def _image(name: str, script: Path, places: Mapping[str, Path]) -> str:
    """Return the URI of a texture that a script names; empty if there is no such file.

    The texture is searched for in the folders of the material, and near the script.
    """
    if name:
        for uri, place in places.items():
            if (place / name).is_file():
                return f"{uri.strip().rstrip('/')}/{name}"
        for folder in (script.parent, script.parent.parent / "textures"):
            if (folder / name).is_file():
                return (folder / name).absolute().as_uri()
    return ""


def _scripts(place: Path) -> list[Path]:
    if not place.is_dir():
        return [place]
    with suppress(OSError):
        return sorted(place.glob("*.material"))
    return []


def read_script(text: str) -> dict[str, Look]:
    """Return the looks of the materials in an Ogre script, by name.

    The first value of each property is used.
    """
    found: dict[str, Look] = {}
    current = ""
    depth = 0
    for line in _lines(text):
        head, *words = line
        if head == "material" and depth == 0 and words:
            current = words[0].strip('"')
            parent = words[-1].strip('"') if ":" in words else ""
            found[current] = found.get(parent) or gazebo_look(parent) or Look()
        elif head in "{}":
            depth = max(0, depth + (1 if head == "{" else -1))
        elif current and depth:
            found[current] = _with_property(found[current], head, words)
    return found


def _with_property(look: Look, word: str, values: list[str]) -> Look:
    if word == "texture" and values and not look.image:
        return look._replace(image=values[0].strip('"'))
    if word in _COLORS and getattr(look, word) is None:
        with suppress(ValueError):
            numbers = [float(value) for value in values[:4]]
            # In a specular colour, the last of four or five numbers is the shininess.
            alpha = numbers[3] if len(numbers) == 4 and (word != "specular" or len(values) == 5) else 1.0
            if len(numbers) >= 3:
                colours: dict[str, Any] = {word: (numbers[0], numbers[1], numbers[2], alpha)}
                return look._replace(**colours)
    return look


def _lines(text: str) -> Iterator[list[str]]:
    """Yield the tokens of each nonempty line, without comments; each brace is a separate line."""
    words: list[str] = []
    for match in _WORDS.finditer(text):
        word = match[0]
        if word.startswith(("//", "/*")):
            continue
        if word in ("{", "}", "\n"):
            if words:
                yield words
            words = []
            if word != "\n":
                yield [word]
        else:
            words.append(word)
    if words:
        yield words
