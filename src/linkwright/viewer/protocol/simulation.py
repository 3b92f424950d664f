"""A simulation that runs in the graph: its state, and control of it. Metres, seconds, newtons."""

from __future__ import annotations

from typing import Literal

from linkwright.viewer.protocol.message import PageMessage, ServerMessage


class SimulationStatus(ServerMessage):
    """The state of the simulation; `present` is false where there is none.

    `drivable` is true where something listens for velocities, on whatever topic.
    `time` is simulated time; it and the real-time factor are None until the simulation has told them.
    """

    present: bool
    drivable: bool
    paused: bool
    time: float | None
    real_time_factor: float | None


NO_SIMULATION = SimulationStatus(present=False, drivable=False, paused=False, time=None, real_time_factor=None)


class SimulationNotice(ServerMessage):
    """Why the simulation did not do what the page asked for."""

    text: str


class ModelAdded(ServerMessage):
    """The model that the page asked for is in the world."""

    name: str


class ControlSimulation(PageMessage):
    """The user wants time to go on, to stand still, to make one step, or to begin anew."""

    action: Literal["play", "pause", "step", "reset"]


class SpawnModel(PageMessage):
    """The user puts a model or robot into the world: a file's path, ``package://`` or ``model://`` address."""

    address: str
    position: list[float]


class DeleteModel(PageMessage):
    """The user takes a model out of the world."""

    model: str


class DragModel(PageMessage):
    """The user moves a model by an offset, in the world's frame, from where it was when `begins` was true last."""

    model: str
    begins: bool
    offset: list[float]


class PushLink(PageMessage):
    """The user pushes a link (``model::link``) for a moment; `force` is in the world's frame, `point` in the link's."""

    link: str
    point: list[float]
    force: list[float]
