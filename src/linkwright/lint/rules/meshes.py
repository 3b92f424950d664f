"""Rules about the content of mesh files and the size of meshes."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from math import isclose

from linkwright.diagnostics import Diagnostic, Note, Severity, phrase
from linkwright.lint.fix import Fix, add_attribute, replace_value
from linkwright.lint.meshes import MeshUse
from linkwright.lint.option import Option
from linkwright.lint.rule import Rule
from linkwright.lint.rules.geometry import is_scenery
from linkwright.lint.subject import Subject
from linkwright.loading.lean_typing import TYPE_CHECKING

if TYPE_CHECKING:
    from linkwright.geometry.outlines import Outline


def iterate_readable_meshes(subject: Subject, kind: str | None = None) -> Iterator[tuple[MeshUse, Outline]]:
    """Yield the uses of readable meshes with their scaled outlines.

    `kind` is ``visual``, ``collision``, or None for both.
    """
    for use in subject.meshes.uses:
        if kind is None or use.kind == kind:
            mesh = subject.meshes.load_outline(use.shape)
            if mesh is not None:
                yield use, mesh


def get_file_name(use: MeshUse) -> str:
    """Return the last component of a mesh's URI."""
    return use.mesh.filename.rpartition("/")[2]


_POWERS_OF_TEN = (10.0, 100.0, 1000.0, 10_000.0)


class ZeroScale(Rule):
    """A mesh scale with a factor of zero.

    ## Why

    The factor flattens the mesh to nothing. urdfdom accepts it silently.

    ## Example

    ```xml
    <mesh filename="package://arm/meshes/base.stl" scale="1 1 0"/>
    ```

    ## Use instead

    ```xml
    <mesh filename="package://arm/meshes/base.stl" scale="1 1 1"/>
    ```
    """

    code = "LW430"
    name = "mesh-scale-zero"
    holds_for_parts = True

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        for use in subject.meshes.uses:
            if 0 in use.mesh.scale:
                yield self.report(
                    phrase(
                        "the scale of the {kind} mesh '{file_name}' of link '{name}' contains a zero",
                        kind=use.kind,
                        file_name=get_file_name(use),
                        name=use.link.name,
                    ),
                    use.element,
                    "scale",
                    hint=phrase(
                        "give three factors, such as '1 1 1', or '0.001 0.001 0.001' for a mesh in millimeters"
                    ),
                )


class NegativeScale(Rule):
    """A collision mesh that is mirrored by a negative scale.

    ## Why

    Mirroring turns the triangles inside out. Renderers handle such a mesh, but in physics engines, objects sink into it
    or are pushed out on the wrong side.

    ## Example

    ```xml
    <collision>
      <geometry><mesh filename="package://arm/meshes/finger.stl" scale="1 -1 1"/></geometry>
    </collision>
    ```

    ## Use instead

    Use a mesh file with mirrored geometry, or simple shapes.
    """

    code = "LW431"
    name = "mesh-scale-negative"
    default = False
    holds_for_parts = True
    severity = Severity.INFO

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        for use in subject.meshes.uses:
            x, y, z = use.mesh.scale
            if use.kind == "collision" and x * y * z < 0:
                yield self.report(
                    phrase(
                        "the collision mesh '{file_name}' of link '{name}' is mirrored, which turns its"
                        " triangles inside out",
                        file_name=get_file_name(use),
                        name=use.link.name,
                    ),
                    use.element,
                    "scale",
                    hint=phrase("export the mesh already mirrored, and make its scale positive"),
                )


class UnevenScale(Rule):
    """A mesh scaled by factors along its axes that differ by a power of ten.

    ## Why

    A unit conversion has three equal factors. If one factor is ten or a thousand times another, a digit is wrong. Other
    unequal factors are assumed to be intended.

    ## Example

    ```xml
    <mesh filename="package://arm/meshes/base.stl" scale="0.001 0.01 0.001"/>
    ```

    ## Use instead

    ```xml
    <mesh filename="package://arm/meshes/base.stl" scale="0.001 0.001 0.001"/>
    ```
    """

    code = "LW432"
    name = "mesh-scale-uneven"
    holds_for_parts = True

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        for use in subject.meshes.uses:
            factors = sorted(map(abs, use.mesh.scale))
            if factors[0] > 0 and any(
                isclose(factors[2] / factors[0], power, rel_tol=0.01) for power in _POWERS_OF_TEN
            ):
                yield self.report(
                    phrase(
                        "the scale of the {kind} mesh '{file_name}' of link '{name}' differs {factors:.3g} times"
                        " between axes",
                        kind=use.kind,
                        file_name=get_file_name(use),
                        name=use.link.name,
                        factors=factors[2] / factors[0],
                    ),
                    use.element,
                    "scale",
                    hint=phrase("to convert units, give all three factors the same value"),
                )


class MeshInMillimeters(Rule):
    """A mesh that is larger than a house after scaling.

    ## Why

    STL and OBJ have no unit, and CAD programs write millimeters. URDF interprets the numbers as meters, so the part is
    a thousand times too large. The camera of RViz is then inside the part and shows nothing. A robot of a single link
    with mass zero is scenery, such as a terrain, and may have any size.

    ## Example

    ```xml
    <mesh filename="package://arm/meshes/base.stl"/>
    ```

    ## Use instead

    ```xml
    <mesh filename="package://arm/meshes/base.stl" scale="0.001 0.001 0.001"/>
    ```
    """

    code = "LW433"
    name = "mesh-in-millimeters"
    options = (Option("largest", 50.0, "largest edge of the box around a mesh, in m"),)

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        largest = self.option(subject, "largest", float)
        for use, mesh in () if is_scenery(subject) else iterate_readable_meshes(subject):
            edge = max(mesh.bounds.size)
            if edge > largest:
                scale = " ".join(f"{factor * 0.001:g}" for factor in use.mesh.scale)
                yield self.report(
                    phrase(
                        "the {kind} mesh '{file_name}' of link '{name}' measures {edge:.4g} m",
                        kind=use.kind,
                        file_name=get_file_name(use),
                        name=use.link.name,
                        edge=edge,
                    ),
                    use.element,
                    "filename",
                    hint=phrase('write scale="{scale}" if the file is in millimeters', scale=scale),
                    fix=_make_scale_fix(use, scale),
                )


class MeshTooSmall(Rule):
    """A mesh that is smaller than a millimeter after scaling.

    ## Why

    The mesh is in meters, but was scaled by a thousandth as if it were in millimeters, so it is almost invisible.

    ## Example

    ```xml
    <mesh filename="package://arm/meshes/base.dae" scale="0.001 0.001 0.001"/>
    ```

    ## Use instead

    ```xml
    <mesh filename="package://arm/meshes/base.dae"/>
    ```

    COLLADA files declare their unit, which readers apply.
    """

    code = "LW434"
    name = "mesh-too-small"
    options = (Option("smallest", 1e-3, "smallest size of the box around a mesh, in m"),)

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        smallest = self.option(subject, "smallest", float)
        for use, mesh in iterate_readable_meshes(subject):
            edge = max(mesh.bounds.size)
            if edge < smallest and all(use.mesh.scale):
                is_scaled_down = max(map(abs, use.mesh.scale)) < 0.1
                scale = " ".join(f"{factor * 1000:g}" for factor in use.mesh.scale)
                yield self.report(
                    phrase(
                        "the {kind} mesh '{file_name}' of link '{name}' measures only {edge:.3g} mm",
                        kind=use.kind,
                        file_name=get_file_name(use),
                        name=use.link.name,
                        edge=edge * 1000,
                    ),
                    use.element,
                    "scale" if "scale" in use.element.attributes else "filename",
                    hint=phrase("leave 'scale' out: the file is in meters already")
                    if is_scaled_down
                    else phrase('write scale="{scale}"', scale=scale),
                    fix=_make_scale_fix(use, scale),
                )


class ScalesDiffer(Rule):
    """One mesh file in two very different scales.

    ## Why

    A file has the same unit wherever it is used. If one use scales it by a thousandth and another does not, one of the
    two is wrong.

    ## Example

    ```xml
    <visual><geometry><mesh filename="package://a/meshes/b.stl" scale="0.001 0.001 0.001"/></geometry></visual>
    <collision><geometry><mesh filename="package://a/meshes/b.stl"/></geometry></collision>
    ```

    ## Use instead

    Write the same `scale` everywhere.
    """

    code = "LW438"
    name = "mesh-scales-differ"

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        first_uses: dict[str, MeshUse] = {}
        for use in subject.meshes.uses:
            if 0 in use.mesh.scale:
                continue
            first_use = first_uses.setdefault(use.mesh.filename, use)
            ratio = max(map(abs, use.mesh.scale)) / max(map(abs, first_use.mesh.scale))
            if ratio > 0 and not 1 / 99 < ratio < 99:
                yield self.report(
                    phrase(
                        "the mesh '{file_name}' of link '{name}' is scaled {ratio:.4g} times"
                        " {comparison} than elsewhere",
                        file_name=get_file_name(use),
                        name=use.link.name,
                        ratio=max(ratio, 1 / ratio),
                        comparison=phrase("larger") if ratio > 1 else phrase("smaller"),
                    ),
                    use.element,
                    "scale",
                    notes=[
                        Note(
                            phrase("link '{name}' scales it here", name=first_use.link.name),
                            first_use.element.attribute_span("scale"),
                        )
                    ],
                    hint=phrase("use the same scale everywhere: a mesh file has one unit"),
                )


def _make_scale_fix(use: MeshUse, scale: str) -> Fix | None:
    if "scale" in use.element.attributes:
        return replace_value(use.element, "scale", scale, safe=False)
    return add_attribute(use.element, "scale", scale, safe=False)
