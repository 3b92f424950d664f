"""Scenes of robots in a pose."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from linkwright.diagnostics import Diagnostic, LinkwrightError, Severity, phrase
from linkwright.geometry.shapes import MAX_COORDINATE, Placement
from linkwright.inertia.mesh_library import MeshLibrary
from linkwright.packages import PackageFinder
from linkwright.picture.bodies import Anchor, Body, Color, Labels, Surface, Texture
from linkwright.picture.link_frames import compute_link_frames, placement_from_pose
from linkwright.picture.materials import SurfaceLibrary, choose_surface_color, decode_texture, make_shape_surface
from linkwright.picture.scene import Scene
from linkwright.urdf import Link, Material, Mesh, Robot, Visual

GHOST_COLOR: Color = (0.25, 0.45, 0.85)
"""The default color of ghosts."""
OUTLINE_COLOR: Color = (0.90, 0.08, 0.56)
"""The default color of outlines: magenta, because robots are often orange, red or yellow."""


def robot_scene(
    robot: Robot,
    finder: PackageFinder,
    positions: Mapping[str, float] | None = None,
    *,
    folder: Path | None = None,
    ghost: Color | None = None,
    outlined: Mapping[str, Color] | None = None,
    library: SurfaceLibrary | None = None,
    root: Placement | None = None,
) -> Scene:
    """Return a scene with a robot's visuals.

    Args:
        robot: the robot to show.
        finder: finds the packages of its meshes.
        positions: joint positions in rad or m by name; see `compute_link_frames` for the others.
        folder: the folder for relative paths in a description without a file; the current folder by default.
        ghost: the color in which the robot is drawn as transparent, for the old one of two; None for its own colors.
        outlined: the colors of lines around links, by the names of the links.
        library: the meshes that were already read, to share them between scenes.
        root: the frame of the root link in the scene; None for the scene in the frame of the root link.

    Raises:
        UnknownNameError: KIN101 or KIN102, a name is not that of a joint that has a position.
    """
    reader = _VisualReader(library or SurfaceLibrary(), MeshLibrary(finder, folder or Path.cwd()))
    frames = compute_link_frames(robot, positions or {})
    if root is not None:
        frames = {name: frame.inside(root) for name, frame in frames.items()}
    outline_colors = outlined or {}
    bodies = []
    for name in robot.links:
        if name in frames and max(map(abs, frames[name].position)) <= MAX_COORDINATE:
            surfaces = reader.read_surfaces(robot.links[name])
            bodies.append(Body(name, frames[name], surfaces, ghost, outline_colors.get(name)))
        elif name in frames:
            reader.add_out_of_range(name)
            del frames[name]
    return Scene(bodies, reader.problems, _make_labels(robot, frames))


def _make_labels(robot: Robot, frames: Mapping[str, Placement]) -> Labels:
    links = [Anchor(name, frames[name].position) for name in robot.links if name in frames]
    joints = [
        Anchor(name, frames[joint.child].position) for name, joint in robot.joints.items() if joint.child in frames
    ]
    return Labels(tuple(links), tuple(joints))


class _VisualReader:
    """A converter of visuals to surfaces.

    Attributes:
        problems: the findings about visuals that are drawn incompletely.
    """

    def __init__(self, library: SurfaceLibrary, files: MeshLibrary) -> None:
        self.problems: list[Diagnostic] = []
        self._library = library
        self._files = files

    def read_surfaces(self, link: Link) -> tuple[Surface, ...]:
        """Convert the visuals of a link to surfaces in the link's frame."""
        surfaces = []
        for visual in link.visuals:
            for surface in self._read_visual(link, visual):
                surface_in_link = surface.placed(placement_from_pose(visual.origin))
                if surface_in_link.is_in_range:
                    surfaces.append(surface_in_link)
                else:
                    self.add_out_of_range(link.name)
        return tuple(surfaces)

    def add_out_of_range(self, link: str) -> None:
        """Add a finding that a link is too large or too far away."""
        message = phrase("link '{link}' is drawn incompletely: a coordinate is out of range", link=link)
        self._add(Diagnostic("PIC101", message, severity=Severity.WARNING))

    def _read_visual(self, link: Link, visual: Visual) -> list[Surface]:
        material, geometry = visual.material, visual.geometry
        color = None if material is None else material.rgba
        rgb = None if color is None else color[:3]
        alpha = 1.0 if color is None else color[3]
        texture = None
        if material is not None and material.texture:
            texture = self._read_texture(link, material)
        if not isinstance(geometry, Mesh):
            surface = make_shape_surface(geometry, texture)
            shown = choose_surface_color(None, rgb, is_textured=surface.texture is not None, format_has_colors=False)
            return [surface.colored(shown, alpha)]
        try:
            path = self._files.locate(geometry.filename, visual.element)
            parts = self._library.read(path)
        except LinkwrightError as error:
            self._add_problem(link, geometry.filename, error)
            return []
        if path in self._library.errors_of_colorless_files:
            self._add_colorless(link, geometry.filename, self._library.errors_of_colorless_files[path])
        format_has_colors = path.suffix.lower() != ".stl"
        return [
            part.surface.scaled(geometry.scale).colored(
                choose_surface_color(part.file_material, rgb, is_textured=False, format_has_colors=format_has_colors),
                alpha,
            )
            for part in parts
        ]

    def _read_texture(self, link: Link, material: Material) -> Texture | None:
        try:
            path = self._files.locate(material.texture or "", material.element)
            texture = decode_texture(path.read_bytes())
        except (LinkwrightError, OSError):
            texture = None
        if texture is None:
            message = phrase(
                "link '{link}' is drawn without its texture '{name}'", link=link.name, name=material.texture or ""
            )
            self._add(Diagnostic("PIC102", message, severity=Severity.WARNING))
        return texture

    def _add_problem(self, link: Link, name: str, error: LinkwrightError) -> None:
        cause = error.diagnostics[0]
        message = phrase(
            "link '{link}' is drawn without the mesh '{name}': {reason}",
            link=link.name,
            name=name,
            reason=cause.message,
        )
        self._add(Diagnostic("PIC101", message, severity=Severity.WARNING, hint=cause.hint))

    def _add_colorless(self, link: Link, name: str, error: LinkwrightError) -> None:
        message = phrase("link '{link}' is drawn without the colors of the mesh '{name}'", link=link.name, name=name)
        self._add(Diagnostic("PIC103", message, severity=Severity.WARNING, hint=error.diagnostics[0].hint))

    def _add(self, problem: Diagnostic) -> None:
        if problem not in self.problems:
            self.problems.append(problem)
