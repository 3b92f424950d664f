"""Rules about textures."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path

from linkwright.diagnostics import Diagnostic, LinkwrightError, Note, phrase
from linkwright.lint.meshes import material_element
from linkwright.lint.rule import Rule
from linkwright.lint.rules.materials import iterate_definitions, iterate_visuals
from linkwright.lint.rules.meshes_addresses import make_file_hint
from linkwright.lint.rules.meshes_files import find_file_with_other_case
from linkwright.lint.subject import Subject
from linkwright.urdf import Mesh
from linkwright.xmltree import Element

_IMAGE_SUFFIXES = (
    ".png",
    ".jpg",
    ".jpeg",
    ".bmp",
    ".gif",
    ".tga",
    ".tif",
    ".tiff",
    ".dds",
    ".webp",
    ".ktx2",
    ".material",
)
"""The extensions of texture files that RViz reads, and of Ogre's material scripts."""


class MissingTexture(Rule):
    """A texture whose image is not found.

    ## Why

    The part is shown white, or not at all.

    ## Example

    ```xml
    <texture filename="package://my_robot_description/materials/logo.pgn"/>
    ```

    ## Use instead

    ```xml
    <texture filename="package://my_robot_description/materials/logo.png"/>
    ```
    """

    code = "LW503"
    name = "texture-missing"
    holds_for_parts = True

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        for element, uri in _iterate_textures(subject):
            base_folder = Path(element.source.name).parent if element.source is not None else subject.path.parent
            notes, hint = [], None
            try:
                path = subject.finder.resolve(uri, base_folder)
            except LinkwrightError as error:
                notes.append(Note(error.diagnostics[0].message))
            else:
                if path.is_file():
                    continue
                hint = make_file_hint(path, _IMAGE_SUFFIXES)
                same_name_file = find_file_with_other_case(path.absolute())
                if same_name_file is not None:
                    notes.append(
                        Note(
                            phrase(
                                "the file is named '{name}', which differs in upper and lower case",
                                name=same_name_file.name,
                            )
                        )
                    )
            message = phrase("there is no image '{uri}' for this texture", uri=uri)
            yield self.report(message, element, "filename", notes=notes, hint=hint)


class TextureFormat(Rule):
    """A texture file in a format that RViz does not read.

    ## Why

    The part is shown without the texture.

    ## Example

    ```xml
    <texture filename="package://my_robot_description/materials/logo.svg"/>
    ```

    ## Use instead

    ```xml
    <texture filename="package://my_robot_description/materials/logo.png"/>
    ```
    """

    code = "LW504"
    name = "texture-format-unknown"
    holds_for_parts = True

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        for element, uri in _iterate_textures(subject):
            suffix = Path(uri).suffix
            if suffix.lower() not in _IMAGE_SUFFIXES:
                yield self.report(
                    phrase(
                        "the texture '{file}' is not in an image format that RViz reads",
                        file=uri.rpartition("/")[2],
                    ),
                    element,
                    "filename",
                    hint=phrase("use PNG or JPEG"),
                )


class TextureOnStl(Rule):
    """A texture on an STL mesh.

    ## Why

    STL has no texture coordinates, so the image cannot be mapped to the surface and is not shown.

    ## Example

    ```xml
    <visual>
      <geometry><mesh filename="package://arm/meshes/base.stl"/></geometry>
      <material name="logo"><texture filename="package://arm/materials/logo.png"/></material>
    </visual>
    ```

    ## Use instead

    Use a mesh format with texture coordinates: COLLADA, OBJ or glTF.
    """

    code = "LW505"
    name = "texture-on-stl"
    holds_for_parts = True

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        for link, visual in iterate_visuals(subject):
            geometry, material = visual.geometry, visual.material
            if material is None or material.texture is None or material.rgba is not None:
                continue
            if isinstance(geometry, Mesh) and geometry.filename.lower().endswith(".stl"):
                yield self.report(
                    phrase(
                        "the texture of link '{name}' is not shown: an STL mesh has no texture coordinates",
                        name=link.name,
                    ),
                    material_element(visual),
                    "name",
                    hint=phrase("export the mesh as COLLADA, OBJ or glTF"),
                )


def _iterate_textures(subject: Subject) -> Iterator[tuple[Element, str]]:
    """Yield each ``<texture>`` element with the URI of its image."""
    for material in iterate_definitions(subject):
        element = material.element.first("texture") if material.element is not None else None
        if element is not None and material.texture is not None:
            yield element, material.texture
