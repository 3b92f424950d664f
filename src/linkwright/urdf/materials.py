"""Reading materials, and which one a visual gets.

urdfdom's rule: the first definition of a name in the file wins, those at robot level before those in links, even over
the colour written in the visual itself. A definition in a later link does not help an earlier one.
"""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

from linkwright.diagnostics import did_you_mean
from linkwright.urdf.explain import explain_attributes
from linkwright.urdf.findings import Findings
from linkwright.urdf.model import Material
from linkwright.urdf.schema import MATERIAL
from linkwright.urdf.values import numbers
from linkwright.xmltree import Element

_BLACK = (0.0, 0.0, 0.0, 1.0)


class MaterialTable:
    """The materials known so far, by name, and the names that nothing defined."""

    __slots__ = ("_findings", "_undefined", "known")

    def __init__(self, findings: Findings) -> None:
        self.known: dict[str, Material] = {}
        self._findings = findings
        self._undefined: list[tuple[Material, str]] = []

    def define(self, element: Element) -> None:
        """Read a material at robot level; one without colour and texture is black."""
        findings = self._findings
        material = read_material(element, "the robot", findings) or Material("", element=element)
        if material.rgba is None and material.texture is None:
            color = element.first("color")
            if color is None or "rgba" not in color.attributes:
                findings.error(
                    "URDF162",
                    f"material '{material.name}' has neither a colour nor a texture, so it is black",
                    color or element,
                    hint='add <color rgba="0.8 0.8 0.8 1"/>',
                )
            material = replace(material, rgba=_BLACK)
        if material.name in self.known:
            findings.duplicate("material", material.name, element, self.known[material.name].element)
        else:
            self.known[material.name] = material

    def resolve(self, own: Material, owner: str) -> Material | None:
        """The material of a visual that names or defines `own`; None when it is nowhere defined so far."""
        defines = own.rgba is not None or own.texture is not None
        if not own.name:
            return own if defines else None
        known = self.known.get(own.name)
        if known is None:
            if not defines:
                self._undefined.append((own, owner))
                return None
            self.known[own.name] = own
            return own
        return known

    def report_undefined(self) -> None:
        """Warn of the names that were not defined when they were used."""
        for material, owner in self._undefined:
            element = material.element
            assert element is not None
            color = element.first("color")
            if color is not None and "rgba" in color.attributes:
                continue  # its colour is malformed, and that was said
            later = self.known.get(material.name)
            if later is not None:
                hint = "a later link defines it: move that definition to robot level"
            else:
                hint = did_you_mean(material.name, self.known) or "define it at robot level"
            message = f"material '{material.name}' of {owner} is not defined"
            self._findings.warning("URDF160", message, element, "name", hint=hint)


def read_material(element: Element, owner: str, findings: Findings) -> Material | None:
    """A material as it is written; None without a name."""
    name = element.attributes.get("name")
    if name is None:
        explain_attributes(element, MATERIAL, owner, findings)
    color: Element | None = None
    texture: Element | None = None
    for child in element.children:
        if isinstance(child, Element):
            if child.tag == "color" and color is None:
                color = child
            elif child.tag == "texture" and texture is None:
                texture = child
    rgba = None
    if color is not None and "rgba" in color.attributes:
        rgba = _read_rgba(color, name or "", findings)
    if name is None:
        return None
    return Material(name, rgba, None if texture is None else texture.attributes.get("filename"), element)


@lru_cache(maxsize=1024)
def _rgba(text: str) -> tuple[float, float, float, float]:
    red, green, blue, alpha = numbers(text)
    if not (0 <= red <= 1 and 0 <= green <= 1 and 0 <= blue <= 1 and 0 <= alpha <= 1):
        raise ValueError(text)
    return red, green, blue, alpha


def _read_rgba(color: Element, material: str, findings: Findings) -> tuple[float, float, float, float] | None:
    text = color.attributes["rgba"]
    try:
        return _rgba(text)
    except ValueError:
        pass
    owner = f"material '{material}'"
    try:
        found = numbers(text)
    except ValueError:
        explain_attributes(color, MATERIAL.children[0], owner, findings)
        return None
    if any(not 0 <= part <= 1 for part in found):
        hint = None
        if all(0 <= part <= 255 for part in found):
            scaled = [f"{part / 255:.3g}" if part > 1 else f"{part:g}" for part in found]
            hint = f"colours go from 0 to 1, not to 255: '{' '.join(scaled)}'"
        message = f"'rgba' of {owner} has a number outside 0 to 1: '{text}'"
        findings.error("URDF123", message, color, "rgba", hint=hint)
        return None
    # urdfdom says nothing here and paints it black.
    hint = f"add the alpha: '{text.strip()} 1'" if len(found) == 3 else "give red, green, blue and alpha"
    findings.warning(
        "URDF122",
        f"'rgba' of {owner} has {len(found)} numbers where 4 are expected, so it is black: '{text}'",
        color,
        "rgba",
        hint=hint,
    )
    return _BLACK
