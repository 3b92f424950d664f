"""Simulated worlds: the state and control of a simulation, and modeling.

Units are meters, seconds and newtons. Modeling means that users edit the models and lights of a world's file in a
page.

Poses are x, y, z in meters and roll, pitch, yaw in radians, in the world frame. Sizes of shapes are in meters: x, y, z
of a box, wall or ramp; radius and length of a cylinder; the radius of a sphere. The frame of a shape is at its center,
and a ramp rises along x. Colors are red, green, blue, alpha from 0 to 1.
"""

from __future__ import annotations

from typing import Literal

from linkwright.page.protocol.message import PageMessage, Record, ServerMessage

WorldShape = Literal["box", "cylinder", "sphere", "wall", "ramp"]
NewKind = Literal[
    "box", "cylinder", "sphere", "wall", "ramp", "point_light", "directional_light", "spot_light", "model"
]


class WorldEntity(Record):
    """A model or light of the world.

    `shape`, `size` and `color` are set for a model that consists of one simple shape. For others they are None or
    empty. `address` is set for a model from an ``<include>``. `parts` are the names of the models that are grouped in
    this model.
    """

    name: str
    kind: Literal["model", "light"]
    pose: list[float]
    static: bool
    shape: WorldShape | None
    size: list[float]
    color: list[float] | None
    address: str | None
    parts: list[str]


class ModelingState(ServerMessage):
    """Whether the world can be edited and is being edited, and its models and lights.

    `file` is None for a world without a separate file. It is saved to a file that the user names. While no
    user edits the world, `entities` may be empty.
    """

    available: bool
    active: bool
    file: str | None
    unsaved: bool
    can_undo: bool
    can_redo: bool
    entities: list[WorldEntity]


NO_WORLD = ModelingState(
    available=False, active=False, file=None, unsaved=False, can_undo=False, can_redo=False, entities=[]
)


class ModelChoice(Record):
    """A model on the search path, and the address that an ``<include>`` needs."""

    name: str
    address: str


class ModelChoices(ServerMessage):
    """The models that can be added, sorted by name."""

    models: list[ModelChoice]


class EntityChange(Record):
    """A change to a model or light. Fields that are None do not change."""

    name: str
    pose: list[float] | None
    size: list[float] | None
    new_name: str | None
    static: bool | None
    color: list[float] | None


class SetModeling(PageMessage):
    """Whether the user edits the world. During editing, the simulation is paused at its start."""

    active: bool


class AddEntity(PageMessage):
    """A request to add an object to the world.

    `address` is the address of a model, and an empty `size` means the default size.
    """

    shape: NewKind
    address: str
    pose: list[float]
    size: list[float]


class ChangeEntities(PageMessage):
    """A request to change objects. One undo reverts all the changes."""

    changes: list[EntityChange]


class CopyEntities(PageMessage):
    """A request to copy objects.

    The copies are placed at an offset (x y z) from the originals.
    """

    names: list[str]
    offset: list[float]


class DeleteEntities(PageMessage):
    """A request to delete objects from the world."""

    names: list[str]


class GroupEntities(PageMessage):
    """A request to group several models as the parts of one model."""

    names: list[str]
    name: str


class UngroupEntity(PageMessage):
    """A request to split a model into its parts."""

    name: str


class UndoWorld(PageMessage):
    """A request to undo the last change to the world."""


class RedoWorld(PageMessage):
    """A request to redo the last undone change."""


class SaveWorld(PageMessage):
    """A request to save the world to its file, or to `path` if that is set."""

    path: str | None


class RequestModels(PageMessage):
    """A request for the models on the search path."""


class SimulationStatus(ServerMessage):
    """The state of the simulation. `present` is false if there is none.

    `drivable` is true if a velocity topic has a subscriber. `time` is the simulated time. `time` and the real-time
    factor are None until the simulation publishes them.
    """

    present: bool
    drivable: bool
    paused: bool
    time: float | None
    real_time_factor: float | None


NO_SIMULATION = SimulationStatus(present=False, drivable=False, paused=False, time=None, real_time_factor=None)


class SimulationNotice(ServerMessage):
    """A notice about the page's request: why it was refused, or how its result differs from it."""

    text: str


class ModelAdded(ServerMessage):
    """The confirmation that a requested model was added to the world."""

    name: str


class ControlSimulation(PageMessage):
    """A request to resume, pause, step or reset the simulation."""

    action: Literal["play", "pause", "step", "reset"]


class SpawnModel(PageMessage):
    """A request to add a model or robot to the simulation.

    The model is identified by a file path, or by a ``package://`` or ``model://`` URI.
    """

    address: str
    position: list[float]


class DeleteModel(PageMessage):
    """A request to delete a model from the simulation."""

    model: str


class DragModel(PageMessage):
    """A request to move a model by an offset in the world frame.

    The offset is relative to the pose of the model at the last message with a true `begins`.
    """

    model: str
    begins: bool
    offset: list[float]


class PushLink(PageMessage):
    """A request to push a link (``model::link``) briefly.

    `force` is in the world frame, and `point` in the link's frame.
    """

    link: str
    point: list[float]
    force: list[float]
