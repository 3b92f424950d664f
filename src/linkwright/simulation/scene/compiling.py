"""Compile a scene to MuJoCo's model, and detect the models that MuJoCo rejects."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from math import isfinite
from typing import Any
from warnings import catch_warnings, simplefilter

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, foreign, phrase
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.sdf.models import Model
from linkwright.sdf.resources import ResourceFinder
from linkwright.sdf.worlds import World, find_physics
from linkwright.simulation.library import load_mujoco
from linkwright.simulation.scene.meshes import MeshLibrary
from linkwright.simulation.scene.scene import SERVO_SUFFIX, Scene

_MEMORY_THRESHOLD, MAX_LINKS = 1000, 10_000
"""The number of links above which MuJoCo gets memory for all pairs of links, and the maximum number of links."""
_BYTES_PER_PAIR, _BASE_BYTES = 3, 1 << 28


def count_links(models: Iterable[Model]) -> int:
    """Return the number of links in models, or raise if there are too many.

    Raises:
        LinkwrightError: SIM105, there are too many links.
    """
    count = sum(_count_model_links(model) for model in models)
    if count > MAX_LINKS:
        message = phrase("the world has {count} links, more than can be simulated", count=count)
        raise LinkwrightError(Diagnostic("SIM105", message, hint=too_many_links_hint()))
    return count


def too_many_links_hint() -> Phrase:
    """Return the hint for a world with too many links."""
    return phrase("use at most {maximum} links; put shapes that never move into one link", maximum=MAX_LINKS)


def _count_model_links(model: Model) -> int:
    return len(model.links) + sum(_count_model_links(nested_model) for nested_model in model.models)


def compile_scene(scene: Scene, previous: tuple[Any, Any] | None = None) -> tuple[Any, Any]:
    """Compile a scene, and return MuJoCo's model and data.

    Args:
        scene: the simulated scene.
        previous: the previous model and data, whose state is kept; None for a first compilation.

    Raises:
        LinkwrightError: SIM104, MuJoCo rejects the scene; SIM105, there are too many links.
    """
    mujoco = load_mujoco()
    scene.set_wheel_surfaces()
    count = count_links(model.model for model in scene.models.values())
    if count > _MEMORY_THRESHOLD:
        scene.spec.memory = _BYTES_PER_PAIR * count * count + _BASE_BYTES
    try:
        with catch_warnings():
            simplefilter("ignore")  # `check` and the simulation report the relevant warnings of MuJoCo
            if previous is not None:
                model, data = scene.spec.recompile(*previous)
                _keep_commands(previous[0], model)
                return model, data
            model = scene.spec.compile()
            return model, mujoco.MjData(model)
    except (ValueError, mujoco.FatalError) as error:
        reason = str(error).removeprefix("Error: ").splitlines()[0]
        raise LinkwrightError(
            Diagnostic("SIM104", phrase("MuJoCo cannot simulate this world: {reason}", reason=foreign(reason)))
        ) from None


def _keep_commands(previous: Any, model: Any) -> None:
    """Set the targets of servos and the gains of motors in a model as in the previous one.

    MuJoCo keeps its data. Without the targets, joints would leap to their initial positions until the next command.
    """
    mujoco = load_mujoco()
    equality, actuator, joint = (getattr(mujoco.mjtObj, f"mjOBJ_{kind}") for kind in ("EQUALITY", "ACTUATOR", "JOINT"))
    for index in range(previous.neq):
        name = mujoco.mj_id2name(previous, equality, index) or ""
        new_index = mujoco.mj_name2id(model, equality, name) if SERVO_SUFFIX in name else -1
        if new_index >= 0:
            model.eq_data[new_index] = previous.eq_data[index]
            old_dof, new_dof = (
                each.jnt_dofadr[mujoco.mj_name2id(each, joint, name.partition(SERVO_SUFFIX)[0])]
                for each in (previous, model)
            )
            model.dof_frictionloss[new_dof] = previous.dof_frictionloss[old_dof]
    for index in range(previous.nu):
        new_index = mujoco.mj_name2id(model, actuator, mujoco.mj_id2name(previous, actuator, index))
        if new_index >= 0:
            model.actuator_gainprm[new_index] = previous.actuator_gainprm[index]
            model.actuator_biasprm[new_index] = previous.actuator_biasprm[index]


def find_rejected_models(world: World, finder: ResourceFinder) -> dict[str, Phrase]:
    """Return the models that MuJoCo rejects, by name, with MuJoCo's messages.

    Each model is compiled alone.

    Args:
        world: the world, with its includes resolved and as it was saved.
        finder: the finder of mesh files.
    """
    messages = {model.name: _find_rejection_message(replace(world, models=(model,)), finder) for model in world.models}
    return {name: message for name, message in messages.items() if message is not None}


def _find_rejection_message(world: World, finder: ResourceFinder) -> Phrase | None:
    """Return MuJoCo's message if a world cannot be compiled, or else None."""
    try:
        compile_scene(Scene(world, MeshLibrary(finder)))
    except LinkwrightError as error:
        return error.diagnostics[0].message
    return None


def step_to_nanoseconds(step: float, world: World) -> int:
    """Return a time step in ns from a time step in s.

    An error refers to the element of `world` that sets the time step, if there is one.

    Raises:
        LinkwrightError: SIM106, the time step is not positive, or shorter than a nanosecond.
    """
    if not (isfinite(step) and round(step * NANOSECONDS_PER_SECOND) > 0):
        message = phrase("a time step of {step} s cannot be simulated", step=step)
        hint = phrase("use a time step such as <max_step_size>0.001")
        physics = find_physics(world)
        element = physics.element if physics.max_step_size == step else None
        if element is None:
            raise LinkwrightError(Diagnostic("SIM106", message, hint=hint))
        step_element = element.first("max_step_size") or element
        raise LinkwrightError(Diagnostic("SIM106", message, step_element.span(), hint=hint, source=step_element.source))
    return round(step * NANOSECONDS_PER_SECOND)
