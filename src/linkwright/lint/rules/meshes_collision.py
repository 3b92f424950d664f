"""Rules about collision meshes: their number of triangles, and whether they are closed."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from linkwright.diagnostics import Diagnostic, Severity, phrase
from linkwright.lint.option import Option
from linkwright.lint.rule import Rule
from linkwright.lint.rules.meshes import get_file_name, iterate_readable_meshes
from linkwright.lint.subject import Subject


class HeavyCollision(Rule):
    """A collision mesh with too many triangles.

    ## Why

    All triangles are tested in every simulation step, and for every pose that a planner tries. With a few hundred
    triangles, or a few boxes and cylinders, the same contacts are found in a hundredth of the time. Up to twice the
    allowed number, the finding is only informational, because most programs still handle such a mesh.

    ## Example

    A `<collision>` with a mesh of 80 000 triangles straight from CAD.

    ## Use instead

    Use the convex hull of the mesh, a decimated copy, or simple shapes.
    """

    code = "LW435"
    name = "collision-mesh-heavy"
    holds_for_parts = True
    options = (Option("triangles", 20_000, "largest number of triangles of a collision mesh"),)

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        max_triangles = self.option(subject, "triangles", int)
        reported_paths: set[Path] = set()
        for use, mesh in iterate_readable_meshes(subject, "collision"):
            path = subject.meshes.path(use)
            count = mesh.count
            if count > max_triangles and path is not None and path not in reported_paths:
                reported_paths.add(path)
                yield self.report(
                    phrase(
                        "the collision mesh '{file_name}' of link '{name}' has {count} triangles",
                        file_name=get_file_name(use),
                        name=use.link.name,
                        count=_group_digits(count),
                    ),
                    use.element,
                    "filename",
                    hint=phrase("use its convex hull, a decimated copy, or simple shapes"),
                    severity=Severity.INFO if count <= 2 * max_triangles else None,
                )


class VisualAsCollision(Rule):
    """A collision that uses the same large mesh as the visual.

    ## Why

    A visual mesh has more triangles than collision detection needs, and is often not closed.

    ## Example

    ```xml
    <visual><geometry><mesh filename="package://arm/meshes/base.dae"/></geometry></visual>
    <collision><geometry><mesh filename="package://arm/meshes/base.dae"/></geometry></collision>
    ```

    ## Use instead

    ```xml
    <collision><geometry><mesh filename="package://arm/meshes/collision/base.stl"/></geometry></collision>
    ```
    """

    code = "LW436"
    name = "collision-uses-visual-mesh"
    default = False
    options = (Option("triangles", 2000, "the minimum number of triangles of a shared mesh that is reported"),)

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        max_triangles = self.option(subject, "triangles", int)
        visual_files = {(use.link.name, path) for use, path in subject.meshes.files if use.kind == "visual"}
        for use, mesh in iterate_readable_meshes(subject, "collision"):
            if (use.link.name, subject.meshes.path(use)) in visual_files and mesh.count > max_triangles:
                yield self.report(
                    phrase(
                        "the collision of link '{name}' uses the mesh of its visual, '{file_name}', with"
                        " {count} triangles",
                        name=use.link.name,
                        file_name=get_file_name(use),
                        count=_group_digits(mesh.count),
                    ),
                    use.element,
                    "filename",
                    hint=phrase("make a lighter mesh for collisions, or use simple shapes"),
                )


class OpenMesh(Rule):
    """A collision mesh that is not watertight.

    ## Why

    A mesh with a hole has no inside: volumes and inertias computed from the mesh are wrong, and some physics engines
    push bodies out on the wrong side. Other engines use the convex hull, which may be larger than the visible part.

    ## Example

    A scan, or a shell exported without its back.

    ## Use instead

    Use a closed mesh, the convex hull of the mesh, or simple shapes.
    """

    code = "LW437"
    name = "collision-mesh-open"
    holds_for_parts = True
    severity = Severity.INFO
    default = False

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        reported_paths: set[Path] = set()
        for use, mesh in iterate_readable_meshes(subject, "collision"):
            path = subject.meshes.path(use)
            if path is not None and path not in reported_paths and not mesh.is_watertight:
                reported_paths.add(path)
                yield self.report(
                    phrase(
                        "the collision mesh '{file_name}' of link '{name}' is not watertight",
                        file_name=get_file_name(use),
                        name=use.link.name,
                    ),
                    use.element,
                    "filename",
                    hint=phrase("close its holes, or use its convex hull"),
                )


def _group_digits(number: int) -> str:
    return f"{number:,}".replace(",", " ")
