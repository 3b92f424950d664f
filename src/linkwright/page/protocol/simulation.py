"""A simulation that runs in the graph: its state, and control of it. Metres, seconds, newtons."""

from __future__ import annotations

from typing import Literal

from linkwright.page.protocol.message import PageMessage, ServerMessage


class SimulationStatus(ServerMessage):
    """The state of the simulation; `present` is false if there is none.

    `drivable` is true if a topic of velocities has a subscriber.
    `time` is simulated time; it and the real-time factor are None until the simulation publishes them.
    """

    present: bool
    drivable: bool
    paused: bool
    time: float | None
    real_time_factor: float | None


NO_SIMULATION = SimulationStatus(present=False, drivable=False, paused=False, time=None, real_time_factor=None)


class SimulationNotice(ServerMessage):
    """Why the simulation refused the page's request."""

    text: str


class ModelAdded(ServerMessage):
    """The model that the page requested is in the world."""

    name: str


class ControlSimulation(PageMessage):
    """The user resumes, pauses, steps or resets the simulation."""

    action: Literal["play", "pause", "step", "reset"]


class SpawnModel(PageMessage):
    """The user adds a model or robot to the world: a file's path, ``package://`` or ``model://`` address."""

    address: str
    position: list[float]


class DeleteModel(PageMessage):
    """The user deletes a model from the world."""

    model: str


class DragModel(PageMessage):
    """The user moves a model by an offset, in the world's frame, from its pose when `begins` was true last."""

    model: str
    begins: bool
    offset: list[float]


class PushLink(PageMessage):
    """The user pushes a link (``model::link``) for a moment; `force` is in the world's frame, `point` in the link's."""

    link: str
    point: list[float]
    force: list[float]
