"""Modelling a world: the models and lights of its file, and pages' edits of them.

Poses are x, y, z in metres and roll, pitch, yaw in radians, in the frame of the world. A size is that of a shape in
metres: x, y, z of a box, wall or ramp; radius and length of a cylinder; the radius of a sphere. The frame of a shape is
in its middle; a ramp rises along x. Colours are red, green, blue, alpha from 0 to 1.
"""

from __future__ import annotations

from typing import Literal

from linkwright.viewer.protocol.message import PageMessage, Record, ServerMessage

WorldShape = Literal["box", "cylinder", "sphere", "wall", "ramp"]
NewKind = Literal[
    "box", "cylinder", "sphere", "wall", "ramp", "point_light", "directional_light", "spot_light", "model"
]


class WorldThing(Record):
    """A model or light of the world.

    `shape`, `size` and `colour` are of a model that is one simple shape, else None and empty; `address` is of a model
    that an ``<include>`` names; `parts` are the names of the models grouped in it.
    """

    name: str
    kind: Literal["model", "light"]
    pose: list[float]
    static: bool
    shape: WorldShape | None
    size: list[float]
    colour: list[float] | None
    address: str | None
    parts: list[str]


class ModellingState(ServerMessage):
    """Whether the world can be edited and is, and what stands in it.

    `file` is None for a world without a file of its own, which is saved as one that the user names. While nobody edits
    the world, `things` may be empty.
    """

    available: bool
    active: bool
    file: str | None
    unsaved: bool
    can_undo: bool
    can_redo: bool
    things: list[WorldThing]


NO_WORLD = ModellingState(
    available=False, active=False, file=None, unsaved=False, can_undo=False, can_redo=False, things=[]
)


class ModelChoice(Record):
    """A model on the search path, and the address that includes it."""

    name: str
    address: str


class ModelChoices(ServerMessage):
    """The models that may be added, by name."""

    models: list[ModelChoice]


class ThingChange(Record):
    """A change of a model or light; fields that are None stay."""

    name: str
    pose: list[float] | None
    size: list[float] | None
    new_name: str | None
    static: bool | None
    colour: list[float] | None


class SetModelling(PageMessage):
    """The user begins or ends to edit the world; while it is edited, time stands still at the beginning."""

    active: bool


class AddThing(PageMessage):
    """The user adds something; `address` is that of a model, `size` may be empty for the usual one."""

    shape: NewKind
    address: str
    pose: list[float]
    size: list[float]


class ChangeThings(PageMessage):
    """The user changes things, in one step of undo."""

    changes: list[ThingChange]


class CopyThings(PageMessage):
    """The user copies things; the copies stand at an offset (x y z) from them."""

    names: list[str]
    offset: list[float]


class DeleteThings(PageMessage):
    """The user takes things out of the world."""

    names: list[str]


class GroupThings(PageMessage):
    """The user makes one model of several, which are then its parts."""

    names: list[str]
    name: str


class UngroupThing(PageMessage):
    """The user makes models of the world of the parts of one."""

    name: str


class UndoWorld(PageMessage):
    """The user takes the last change of the world back."""


class RedoWorld(PageMessage):
    """The user makes the change again that was taken back last."""


class SaveWorld(PageMessage):
    """The user saves the world: into its file, or as another where `path` names one."""

    path: str | None


class AskModels(PageMessage):
    """The user wants to choose among the models on the search path."""
