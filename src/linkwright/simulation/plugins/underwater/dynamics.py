"""The dynamics of drives under water, which thrusters and fins share.

Source: uuv_simulator (parameters, formulas); D. R. Yoerger, J. G. Cooke, J. E. Slotine, "The influence of thruster
dynamics on underwater vehicle behavior", 1990; W. M. Bessa and others, "Thruster dynamics compensation for the
positioning of underwater robotic vehicles", 2006.
"""

from __future__ import annotations

from collections.abc import Callable
from math import exp
from typing import Any

from linkwright.diagnostics import LinkwrightError, phrase
from linkwright.simulation.plugins.plugin import SimulatedPlugin
from linkwright.xmltree import Element

Step = Callable[[float, float, float], float]
"""Returns the new state, from the state, the command and the time in s."""


def create_step(plugin: SimulatedPlugin[Any], element: Element) -> Step:
    """Return the dynamics that an element ``<dynamics>`` describes.

    Raises:
        LinkwrightError: SIM160, the type is not known, or a number is missing.
    """
    kind = plugin.text_in(element, "type")
    if kind == "ZeroOrder":
        return lambda _, command, __: command
    if kind == "FirstOrder":
        time_constant = plugin.number_in(element, "timeConstant")
        if time_constant <= 0.0:
            return lambda _, command, __: command
        return lambda state, command, seconds: command + (state - command) * exp(-seconds / time_constant)
    if kind == "Yoerger":
        alpha, beta = (plugin.number_in(element, tag) for tag in ("alpha", "beta"))
        return lambda state, command, seconds: state + seconds * (beta * command - alpha * state * abs(state))
    if kind == "Bessa":
        inertia, linear, quadratic, torque, resistance = (
            plugin.number_in(element, tag) for tag in ("Jmsp", "Kv1", "Kv2", "Kt", "Rm")
        )
        return lambda state, command, seconds: (
            state
            + seconds * (command * torque / resistance - linear * state - quadratic * state * abs(state)) / inertia
        )
    raise unknown_type_error(plugin, element, "ZeroOrder, FirstOrder, Yoerger, Bessa")


def require_child(plugin: SimulatedPlugin[Any], tag: str) -> Element:
    """Return a child of the element of a plugin.

    Raises:
        LinkwrightError: SIM160, there is no such child.
    """
    child = None if plugin.context.element is None else plugin.context.element.first(tag)
    if child is None:
        raise plugin.parameter_error(
            phrase("plugin '{plugin}': <{tag}> is missing", plugin=plugin.context.name, tag=tag)
        )
    return child


def unknown_type_error(plugin: SimulatedPlugin[Any], element: Element, names: str) -> LinkwrightError:
    """Return the error for an element whose ``<type>`` is not one of some names."""
    message = phrase(
        "plugin '{plugin}': the <type> of <{tag}> must be one of {names}",
        plugin=plugin.context.name,
        tag=element.tag,
        names=names,
    )
    return plugin.parameter_error(message, element)
