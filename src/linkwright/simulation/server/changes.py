"""The changes that turn one world into another: models that are removed, replaced and added."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, foreign, phrase
from linkwright.geometry.single import Transform
from linkwright.sdf.comparison import alike
from linkwright.sdf.frames import FrameError, Frames
from linkwright.sdf.models import Model
from linkwright.sdf.poses import AT_ORIGIN
from linkwright.sdf.resources import ResourceFinder
from linkwright.sdf.worlds import World, physics_of
from linkwright.simulation.scene.compiling import count_links
from linkwright.simulation.scene.scene import SceneModel
from linkwright.simulation.server.motion import Motion
from linkwright.simulation.simulation import Simulation


@dataclass(frozen=True, slots=True)
class AddedModel:
    """A model to add.

    Attributes:
        model: the model, with its includes resolved.
        name: the name of the model in the world.
        pose: the initial pose of the model's frame in the world.
        namespace: the default namespace for the nodes of the model's plugins.
        motion: the motion of the replaced model; None if no model is replaced.
        here: whether the model continues at the pose of the replaced model.
    """

    model: Model
    name: str
    pose: Transform
    namespace: str = ""
    motion: Motion | None = None
    here: bool = False


@dataclass(frozen=True, slots=True)
class Changes:
    """The changes from one world to another.

    Attributes:
        gone: names of the removed models.
        moved: the new poses in the world of models that differ only in their pose.
        renewed: changed models that replace the running models of the same names.
        new: the added models.
    """

    gone: tuple[str, ...]
    moved: dict[str, Transform]
    renewed: tuple[AddedModel, ...]
    new: tuple[AddedModel, ...]

    def with_all(self, running: Mapping[str, SceneModel], namespaces: Mapping[str, str]) -> Changes:
        """Return these changes, but with all other models also replaced, at their current or new poses."""
        others = {*self.gone, *(change.name for change in self.renewed)}
        poses = {name: self.moved.get(name, each.pose) for name, each in running.items() if name not in others}
        rest = (
            AddedModel(running[name].model, name, pose, namespaces.get(name, ""), here=name not in self.moved)
            for name, pose in poses.items()
        )
        return replace(self, moved={}, renewed=(*self.renewed, *rest))

    def with_connected(self, running: Mapping[str, SceneModel], namespaces: Mapping[str, str]) -> Changes:
        """Return these changes, but with moved models replaced if joints of the world connect them.

        The replacements are at the new poses.
        """
        connected = {name for model in running.values() if model.hangs_on for name in (model.name, *model.hangs_on)}
        again = {name: pose for name, pose in self.moved.items() if name in connected}
        moved = {name: pose for name, pose in self.moved.items() if name not in connected}
        added = (AddedModel(running[name].model, name, pose, namespaces.get(name, "")) for name, pose in again.items())
        return replace(self, moved=moved, renewed=(*self.renewed, *added))


def changes_to(world: World, running: Mapping[str, SceneModel], owned: Collection[str]) -> Changes:
    """Return the changes from the running models to the models of another world.

    Args:
        world: the other world, with its includes resolved and as it was saved.
        running: the running models, by name.
        owned: names of the running models that belong to a world; all others stay.

    Raises:
        LinkwrightError: SIM102, a model has the name of a model that stays; SIM140, a model cannot be placed.
    """
    frames = Frames(world)
    moved: dict[str, Transform] = {}
    renewed: list[AddedModel] = []
    new: list[AddedModel] = []
    names: set[str] = set()
    for model in world.models:
        if model.name in names:
            continue  # `check` reports duplicate names.
        names.add(model.name)
        try:
            pose = frames.pose(model.name)
        except FrameError as error:
            raise _simulation_error(model.name, error) from error
        before = running.get(model.name)
        if before is None:
            new.append(AddedModel(model, model.name, pose))
        elif model.name not in owned:
            span = None if model.element is None else model.element.span()
            message = phrase("a model '{name}' already exists", name=model.name)
            hint = phrase("it was added to the running simulation: delete it there, or give this model another name")
            raise LinkwrightError(Diagnostic("SIM102", message, span, hint=hint))
        elif before.is_outdated or not alike(_unplaced(before.model), _unplaced(model)):
            renewed.append(AddedModel(model, model.name, pose, here=pose == before.pose))
        elif pose != before.pose:
            moved[model.name] = pose
    gone = tuple(name for name in running if name in owned and name not in names)
    return Changes(gone, moved, tuple(renewed), tuple(new))


def check(
    world: World, simulation: Simulation, added: Sequence[AddedModel], finder: ResourceFinder
) -> list[Diagnostic]:
    """Compile models in a separate world to check whether a running simulation can add them.

    Args:
        world: the world, whose own models are ignored.
        simulation: the running simulation.
        added: the models to add.
        finder: the finder of mesh files.

    Returns:
        The findings on parts that cannot be simulated.

    Raises:
        LinkwrightError: SIM104, SIM105, SIM140, the models cannot be simulated.
    """
    models = {model.name: model.model for model in simulation.scene.models.values()}
    count_links((models | {change.name: change.model for change in added}).values())
    trial = simulation.separate_simulation(replace(world, models=(), states=()), finder)
    add_models(trial, added)
    return trial.scene.diagnostics


def add_models(simulation: Simulation, added: Sequence[AddedModel]) -> None:
    """Add models to a simulation, either all or none.

    Raises:
        LinkwrightError: SIM102, a model with one of the names already exists; SIM104, SIM105, SIM140, a model cannot be
            simulated.
    """
    came: list[str] = []
    by_name = {change.name: change for change in added}
    try:
        for name in simulation.scene.in_order(list(by_name)):
            each = by_name[name]
            came.append(name)
            simulation.spawn(each.model, each.name, each.pose)
        simulation.refresh()
    except (FrameError, ValueError, RuntimeError, LinkwrightError) as error:
        for name in reversed(came):
            if name in simulation.scene.models:
                simulation.delete(name)
        raise _simulation_error(came[-1], error) from error


def surroundings(world: World) -> tuple[object, ...]:
    """Return the properties of a world on which the plugins of its models depend, for comparison."""
    physics = physics_of(world)
    joints = tuple(world.joints)
    return world.name, world.spherical_coordinates, world.magnetic_field, world.wind, physics.max_step_size, joints


def _simulation_error(name: str, error: Exception) -> LinkwrightError:
    if isinstance(error, LinkwrightError):
        return error
    reason: Phrase = foreign(error)
    if isinstance(error, FrameError):
        reason = phrase("the pose of '{name}' is not defined", name=error.name)
    message = phrase("model '{name}' cannot be simulated: {reason}", name=name, reason=reason)
    return LinkwrightError(Diagnostic("SIM140", message))


def _unplaced(model: Model) -> Model:
    return replace(model, pose=AT_ORIGIN, placement_frame="")
