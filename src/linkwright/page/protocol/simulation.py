"""Simulated worlds: the state and control of a simulation, and modelling. Metres, seconds, newtons.

Modelling a world covers the models and lights of its file, and pages' edits of them.

Poses are x, y, z in metres and roll, pitch, yaw in radians, in the world frame. Sizes of shapes are in metres: x, y, z
of a box, wall or ramp; radius and length of a cylinder; the radius of a sphere. The frame of a shape is at its centre,
and a ramp rises along x. Colours are red, green, blue, alpha from 0 to 1.
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

    `shape`, `size` and `colour` are set for a model that is one simple shape, and otherwise None or empty. `address` is
    set for a model that an ``<include>`` names. `parts` are the names of the models grouped in it.
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
    """Whether the world can be edited and is being edited, and its content.

    `file` is None for a world without its own file, which is saved to a file that the user names. While no user edits
    the world, `entities` may be empty.
    """

    available: bool
    active: bool
    file: str | None
    unsaved: bool
    can_undo: bool
    can_redo: bool
    entities: list[WorldEntity]


NO_WORLD = ModellingState(
    available=False, active=False, file=None, unsaved=False, can_undo=False, can_redo=False, entities=[]
)


class ModelChoice(Record):
    """A model on the search path, and the address that includes it."""

    name: str
    address: str


class ModelChoices(ServerMessage):
    """The models that can be added, sorted by name."""

    models: list[ModelChoice]


class EntityChange(Record):
    """A change of a model or light; fields that are None are left unchanged."""

    name: str
    pose: list[float] | None
    size: list[float] | None
    new_name: str | None
    static: bool | None
    colour: list[float] | None


class SetModelling(PageMessage):
    """The user starts or stops editing the world; during editing the simulation is paused at its start."""

    active: bool


class AddEntity(PageMessage):
    """The user adds an object; `address` is the address of a model, and an empty `size` means the default size."""

    shape: NewKind
    address: str
    pose: list[float]
    size: list[float]


class ChangeEntities(PageMessage):
    """The user changes objects, in one undo step."""

    changes: list[EntityChange]


class CopyEntities(PageMessage):
    """The user copies objects; the copies are placed at an offset (x y z) from the originals."""

    names: list[str]
    offset: list[float]


class DeleteEntities(PageMessage):
    """The user deletes objects from the world."""

    names: list[str]


class GroupEntities(PageMessage):
    """The user groups several models into one, and they become its parts."""

    names: list[str]
    name: str


class UngroupEntity(PageMessage):
    """The user splits a model into its parts."""

    name: str


class UndoWorld(PageMessage):
    """The user undoes the last change of the world."""


class RedoWorld(PageMessage):
    """The user redoes the change that was undone last."""


class SaveWorld(PageMessage):
    """The user saves the world: into its file, or into `path` if it is set."""

    path: str | None


class AskModels(PageMessage):
    """The user opens the list of models on the search path."""


class SimulationStatus(ServerMessage):
    """The state of the simulation; `present` is false if there is none.

    `drivable` is true if a velocity topic has a subscriber. `time` is simulated time. It and the real-time factor are
    None until the simulation publishes them.
    """

    present: bool
    drivable: bool
    paused: bool
    time: float | None
    real_time_factor: float | None


NO_SIMULATION = SimulationStatus(present=False, drivable=False, paused=False, time=None, real_time_factor=None)


class SimulationNotice(ServerMessage):
    """The reason why the simulation refused the page's request."""

    text: str


class ModelAdded(ServerMessage):
    """Confirms that the model that the page requested is in the world."""

    name: str


class ControlSimulation(PageMessage):
    """The user resumes, pauses, steps or resets the simulation."""

    action: Literal["play", "pause", "step", "reset"]


class SpawnModel(PageMessage):
    """The user adds a model or robot to the world, by a file path or a ``package://`` or ``model://`` address."""

    address: str
    position: list[float]


class DeleteModel(PageMessage):
    """The user deletes a model from the world."""

    model: str


class DragModel(PageMessage):
    """The user moves a model by an offset in the world frame, from its pose when `begins` was last true."""

    model: str
    begins: bool
    offset: list[float]


class PushLink(PageMessage):
    """The user pushes a link (``model::link``) briefly; `force` is in the world frame, `point` in the link's frame."""

    link: str
    point: list[float]
    force: list[float]
