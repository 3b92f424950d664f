"""The changes between two worlds: models that are removed, moved, replaced and added."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, foreign, phrase
from linkwright.geometry.single import Transform
from linkwright.sdf.comparison import have_equal_content
from linkwright.sdf.frames import FrameError, Frames
from linkwright.sdf.models import Model
from linkwright.sdf.poses import AT_ORIGIN
from linkwright.sdf.resources import ResourceFinder
from linkwright.sdf.worlds import World, find_physics
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
        motion: the motion of the model that this model replaces; None if it replaces no model.
        keeps_motion: whether the model keeps the current pose and velocity of the model that it replaces.
    """

    model: Model
    name: str
    pose: Transform
    namespace: str = ""
    motion: Motion | None = None
    keeps_motion: bool = False


@dataclass(frozen=True, slots=True)
class Changes:
    """The changes from one world to another.

    Attributes:
        removed_names: the names of the models to remove.
        moved: the new poses in the world of the models that differ only in their pose, by name.
        replaced: the models that replace running models with the same names.
        added: the models to add.
    """

    removed_names: tuple[str, ...]
    moved: dict[str, Transform]
    replaced: tuple[AddedModel, ...]
    added: tuple[AddedModel, ...]

    def with_all_replaced(self, running: Mapping[str, SceneModel], namespaces: Mapping[str, str]) -> Changes:
        """Return these changes with all other running models replaced, too.

        The replacements are at their current or new poses.
        """
        changed_names = {*self.removed_names, *(change.name for change in self.replaced)}
        poses = {name: self.moved.get(name, model.pose) for name, model in running.items() if name not in changed_names}
        replacements = (
            AddedModel(running[name].model, name, pose, namespaces.get(name, ""), keeps_motion=name not in self.moved)
            for name, pose in poses.items()
        )
        return replace(self, moved={}, replaced=(*self.replaced, *replacements))

    def with_connected_replaced(self, running: Mapping[str, SceneModel], namespaces: Mapping[str, str]) -> Changes:
        """Return these changes with moved models replaced if joints connect them to other models.

        The replacements are at the new poses.
        """
        connected = {
            name for model in running.values() if model.attached_to for name in (model.name, *model.attached_to)
        }
        connected_poses = {name: pose for name, pose in self.moved.items() if name in connected}
        moved = {name: pose for name, pose in self.moved.items() if name not in connected}
        replacements = (
            AddedModel(running[name].model, name, pose, namespaces.get(name, ""))
            for name, pose in connected_poses.items()
        )
        return replace(self, moved=moved, replaced=(*self.replaced, *replacements))


def find_changes(world: World, running: Mapping[str, SceneModel], world_models: Collection[str]) -> Changes:
    """Return the changes from the running models to the models of another world.

    Args:
        world: the other world, with its includes resolved and its saved state applied.
        running: the running models, by name.
        world_models: the names of the running models that came from a world; all other models stay.

    Raises:
        LinkwrightError: SIM102, a model has the name of a model that stays; SIM140, the pose of a model is not defined.
    """
    frames = Frames(world)
    moved_poses: dict[str, Transform] = {}
    replaced: list[AddedModel] = []
    added: list[AddedModel] = []
    names: set[str] = set()
    for model in world.models:
        if model.name in names:
            continue  # `check_models` reports duplicate names.
        names.add(model.name)
        try:
            pose = frames.pose(model.name)
        except FrameError as error:
            raise _simulation_error(model.name, error) from error
        running_model = running.get(model.name)
        if running_model is None:
            added.append(AddedModel(model, model.name, pose))
        elif model.name not in world_models:
            span = None if model.element is None else model.element.span()
            message = phrase("a model '{name}' already exists", name=model.name)
            hint = phrase("that model was added to the running simulation; delete it there, or rename this model")
            raise LinkwrightError(Diagnostic("SIM102", message, span, hint=hint))
        elif running_model.is_outdated or not have_equal_content(
            _without_pose(running_model.model), _without_pose(model)
        ):
            replaced.append(AddedModel(model, model.name, pose, keeps_motion=pose == running_model.pose))
        elif pose != running_model.pose:
            moved_poses[model.name] = pose
    removed_names = tuple(name for name in running if name in world_models and name not in names)
    return Changes(removed_names, moved_poses, tuple(replaced), tuple(added))


def check_models(
    world: World, simulation: Simulation, added: Sequence[AddedModel], finder: ResourceFinder
) -> list[Diagnostic]:
    """Check that a running simulation can add models, by compiling them separately.

    Args:
        world: the world; its models and states are ignored.
        simulation: the running simulation.
        added: the models to add.
        finder: the finder of mesh files.

    Returns:
        The findings on parts of the models that cannot be simulated.

    Raises:
        LinkwrightError: SIM102, SIM104, SIM105, SIM140, the models cannot be simulated.
    """
    models = {model.name: model.model for model in simulation.scene.models.values()}
    count_links((models | {change.name: change.model for change in added}).values())
    trial_simulation = simulation.create_separate_simulation(replace(world, models=(), states=()), finder)
    add_models(trial_simulation, added)
    return trial_simulation.scene.diagnostics


def add_models(simulation: Simulation, added: Sequence[AddedModel]) -> None:
    """Add all given models to a simulation, or none if one of them cannot be added.

    Raises:
        LinkwrightError: SIM102, a model with one of the names already exists; SIM104, SIM105, SIM140, a model cannot be
            simulated.
    """
    attempted_names: list[str] = []
    by_name = {change.name: change for change in added}
    try:
        for name in simulation.scene.sort_by_attachment(list(by_name)):
            added_model = by_name[name]
            attempted_names.append(name)
            simulation.spawn(added_model.model, added_model.name, added_model.pose)
        simulation.refresh()
    except (FrameError, ValueError, RuntimeError, LinkwrightError) as error:
        for name in reversed(attempted_names):
            if name in simulation.scene.models:
                simulation.delete(name)
        raise _simulation_error(attempted_names[-1], error) from error


def get_properties_used_by_plugins(world: World) -> tuple[object, ...]:
    """Return the properties of a world on which plugins of models depend.

    The server compares these properties with those of a world that replaces this one.
    """
    physics = find_physics(world)
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


def _without_pose(model: Model) -> Model:
    return replace(model, pose=AT_ORIGIN, placement_frame="")
