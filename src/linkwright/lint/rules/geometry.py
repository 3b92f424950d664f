"""Rules about the sizes and origins of simple shapes."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from linkwright.diagnostics import Diagnostic, Note, Severity, phrase, term
from linkwright.lint.meshes import shape_element
from linkwright.lint.option import Option
from linkwright.lint.rule import Rule
from linkwright.lint.subject import Subject
from linkwright.urdf import Box, Collision, Geometry, Inertial, Link, Mesh, Sphere, Visual
from linkwright.urdf.schema import GEOMETRY


def iterate_shapes(subject: Subject) -> Iterator[tuple[Link, Visual | Collision]]:
    """Yield every visual and collision with its link."""
    for link in subject.links:
        yield from ((link, visual) for visual in link.visuals)
        yield from ((link, collision) for collision in link.collisions)


def is_scenery(subject: Subject) -> bool:
    """Return whether the description is a single fixed object, such as a ground or a building.

    Bullet treats a link of mass zero as immovable. Its planes, tables and terrains are such links.
    """
    links = list(subject.links)
    return len(links) == 1 and links[0].inertial is not None and links[0].inertial.mass == 0


def name_kind(shape: Visual | Collision) -> str:
    """Return the kind of a shape, ``visual`` or ``collision``."""
    return "visual" if isinstance(shape, Visual) else "collision"


def list_sizes(geometry: Geometry) -> tuple[tuple[str, float], ...]:
    """Return the name and length in m of each size of a shape, or an empty tuple for a mesh."""
    if isinstance(geometry, Mesh):
        return ()
    if isinstance(geometry, Box):
        return tuple(("size", edge) for edge in geometry.size)
    if isinstance(geometry, Sphere):
        return (("radius", geometry.radius),)
    return ("radius", geometry.radius), ("length", geometry.length)


class NonPositiveSize(Rule):
    """A shape with a size of zero or less.

    ## Why

    Below URDF 1.2, urdfdom accepts any number. RViz then shows nothing or a shape turned inside out, and physics
    engines stop with an assertion. If all sizes of a visual are zero, the finding is only informational, since some
    authors use such visuals as markers.

    ## Example

    ```xml
    <box size="0.4 -0.3 0.1"/>
    ```

    ## Use instead

    ```xml
    <box size="0.4 0.3 0.1"/>
    ```
    """

    code = "LW401"
    name = "size-not-positive"
    holds_for_parts = True

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        for link, shape in iterate_shapes(subject):
            sizes = list_sizes(shape.geometry)
            invalid_size = next(((name, size) for name, size in sizes if size <= 0), None)
            if invalid_size is not None:
                name, size = invalid_size
                is_marker = isinstance(shape, Visual) and not any(size for _, size in sizes)
                shape_name = type(shape.geometry).__name__.lower()
                yield self.report(
                    phrase(
                        "'{name}' of the {shape} {kind} of link '{link_name}' is {value}",
                        name=name,
                        shape=term(name_kind(shape)),
                        kind=shape_name,
                        link_name=link.name,
                        value=phrase("zero") if size == 0 else phrase("negative"),
                    ),
                    shape_element(shape),
                    name,
                    hint=phrase("give a positive size in meters"),
                    severity=Severity.INFO if is_marker else None,
                )


class HugeSize(Rule):
    """A shape of more than a hundred meters.

    ## Why

    URDF uses meters. In a file exported from CAD, a size of 400 usually means 400 mm. A robot of a single link with
    mass zero is scenery, such as a ground, and may be of any size.

    ## Example

    ```xml
    <box size="400 300 100"/>
    ```

    ## Use instead

    ```xml
    <box size="0.4 0.3 0.1"/>
    ```
    """

    code = "LW402"
    name = "size-huge"
    holds_for_parts = True
    options = (Option("largest", 100.0, "largest size of a shape, in m"),)

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        largest = self.option(subject, "largest", float)
        for link, shape in () if is_scenery(subject) else iterate_shapes(subject):
            name, size = max(list_sizes(shape.geometry), key=lambda item: item[1], default=("", 0.0))
            if size > largest:
                shape_name = type(shape.geometry).__name__.lower()
                yield self.report(
                    phrase(
                        "the {shape} {kind} of link '{name}' measures {size:g} m",
                        shape=term(name_kind(shape)),
                        kind=shape_name,
                        name=link.name,
                        size=size,
                    ),
                    shape_element(shape),
                    name,
                    hint=phrase("lengths are in meters; if this is in millimeters, write {size:g}", size=size / 1000),
                )


class TinySize(Rule):
    """A shape of less than a tenth of a millimeter in every direction.

    ## Why

    Such a shape is invisible, and contacts with it are noise. It is a placeholder, which should be removed, or its
    lengths were divided by a thousand twice.

    ## Example

    ```xml
    <sphere radius="0.00002"/>
    ```

    ## Use instead

    ```xml
    <sphere radius="0.02"/>
    ```
    """

    code = "LW403"
    name = "size-tiny"
    holds_for_parts = True
    options = (Option("smallest", 1e-4, "smallest size of a shape, in m"),)

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        smallest = self.option(subject, "smallest", float)
        for link, shape in iterate_shapes(subject):
            sizes = list_sizes(shape.geometry)
            if sizes and all(0 < size < smallest for _, size in sizes):
                shape_name = type(shape.geometry).__name__.lower()
                yield self.report(
                    phrase(
                        "the {shape} {kind} of link '{name}' is smaller than {smallest:g} mm",
                        shape=term(name_kind(shape)),
                        kind=shape_name,
                        name=link.name,
                        smallest=smallest * 1000,
                    ),
                    shape_element(shape),
                    sizes[0][0],
                    hint=phrase("lengths are in meters; remove the shape if none is intended"),
                )


class SeveralShapes(Rule):
    """More than one shape in a `<geometry>`.

    ## Why

    Readers use only the first shape and silently ignore the others.

    ## Example

    ```xml
    <geometry>
      <box size="0.4 0.3 0.1"/>
      <cylinder radius="0.1" length="0.05"/>
    </geometry>
    ```

    ## Use instead

    Write a `<visual>` or `<collision>` for each shape. A link may have as many as it needs.
    """

    code = "LW404"
    name = "geometry-several-shapes"
    holds_for_parts = True

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        for link in subject.elements("link"):
            for shape in link.elements():
                geometry = shape.first("geometry") if shape.tag in ("visual", "collision") else None
                children = geometry.elements() if geometry is not None else ()
                shapes = [element for element in children if element.tag in GEOMETRY.child_rules]
                for extra_shape in shapes[1:]:
                    yield self.report(
                        phrase(
                            "<{tag}> is not the first shape in a <geometry> of link '{link}', and is ignored",
                            tag=extra_shape.tag,
                            link=link.attributes.get("name", ""),
                        ),
                        extra_shape,
                        notes=[
                            Note(
                                phrase("only the first shape, this <{tag}>, is read", tag=shapes[0].tag),
                                shapes[0].span(),
                            )
                        ],
                        hint=phrase("write a separate <{tag}> for it", tag=shape.tag),
                    )


class ShapeTooFar(Rule):
    """A shape or a center of mass more than twenty meters from its link's frame.

    ## Why

    URDF uses meters. A position of several hundred is usually in millimeters.

    ## Example

    ```xml
    <visual>
      <origin xyz="0 0 150"/>
    ```

    ## Use instead

    ```xml
    <visual>
      <origin xyz="0 0 0.15"/>
    ```
    """

    code = "LW405"
    name = "shape-far"
    holds_for_parts = True
    options = (Option("largest", 20.0, "largest distance along an axis, in m"),)

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        largest = self.option(subject, "largest", float)
        for link in subject.links:
            items: list[Visual | Collision | Inertial] = [*link.visuals, *link.collisions]
            items += [link.inertial] if link.inertial is not None else []
            for item in items:
                distance = max(map(abs, item.origin.xyz))
                if distance > largest and item.element is not None:
                    scaled = " ".join(f"{number / 1000:g}" for number in item.origin.xyz)
                    yield self.report(
                        phrase(
                            "<{tag}> of link '{name}' is {reach:g} m away from the link",
                            tag=item.element.tag,
                            name=link.name,
                            reach=distance,
                        ),
                        item.element.first("origin") or item.element,
                        "xyz",
                        hint=phrase("lengths are in meters; if this is in millimeters, write '{small}'", small=scaled),
                    )
