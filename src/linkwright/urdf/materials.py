"""Reading materials, and which one a visual gets.

urdfdom's rule: the first definition of a name in the file wins, those at robot level before those in links, even over
the colour written in the visual itself. A definition in a later link does not help an earlier one.
"""

from __future__ import annotations

from dataclasses import replace

from linkwright.diagnostics import did_you_mean, phrase
from linkwright.schema.reading import reader_of
from linkwright.schema.report import UNREADABLE
from linkwright.urdf.explain import BLACK, UrdfReport, owner_name
from linkwright.urdf.model import Material
from linkwright.urdf.schema import MATERIAL
from linkwright.xmltree import Element


class MaterialTable:
    """The materials known so far, by name, and the names that nothing defined."""

    __slots__ = ("_findings", "_undefined", "known")

    def __init__(self, findings: UrdfReport) -> None:
        self.known: dict[str, Material] = {}
        self._findings = findings
        self._undefined: list[tuple[Material, Element]] = []

    def define(self, element: Element, robot: Element) -> None:
        """Read a material at robot level; one without colour and texture is black."""
        findings = self._findings
        material = read_material(element, robot, findings) or Material("", element=element)
        if material.rgba is None and material.texture is None:
            color = element.first("color")
            if color is None or "rgba" not in color.attributes:
                findings.error(
                    "URDF162",
                    phrase("material '{name}' has neither a colour nor a texture, so it is black", name=material.name),
                    color or element,
                    hint=phrase('add <color rgba="0.8 0.8 0.8 1"/>'),
                )
            material = replace(material, rgba=BLACK)
        if material.name in self.known:
            findings.duplicate("material", material.name, element, self.known[material.name].element)
        else:
            self.known[material.name] = material

    def resolve(self, own: Material, owner: Element) -> Material | None:
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
                hint = phrase("a later link defines it: move that definition to robot level")
            else:
                hint = did_you_mean(material.name, self.known) or phrase("define it at robot level")
            message = phrase("material '{name}' of {owner} is not defined", name=material.name, owner=owner_name(owner))
            self._findings.warning("URDF160", message, element, "name", hint=hint)


def read_material(element: Element, owner: Element, findings: UrdfReport) -> Material | None:
    """A material as it is written; None without a name."""
    material: Material = reader_of(MATERIAL, findings.version).read(element, owner, findings)
    return None if material is UNREADABLE else material
