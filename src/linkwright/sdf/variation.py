"""Varies the masses, friction and sensor noise of models."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields, is_dataclass, replace
from typing import Any, TypeVar, cast

from linkwright.sdf.links import Collision, Inertia, Inertial, Link
from linkwright.sdf.models import Model
from linkwright.sdf.noise import Noise
from linkwright.sdf.surfaces import Friction

V = TypeVar("V")

_SCALED_NOISE = ("mean", "stddev", "bias_mean", "bias_stddev", "dynamic_bias_stddev")


def with_mass(model: Model, factor: float) -> Model:
    """Return a model with the masses, inertias and densities of its links multiplied by a factor."""

    def scaled(link: Link) -> Link:
        inertial = link.inertial or Inertial()
        inertia = Inertia(*(getattr(inertial.inertia, field.name) * factor for field in fields(Inertia)))
        density = None if inertial.density is None else inertial.density * factor
        return replace(link, inertial=replace(inertial, mass=inertial.mass * factor, inertia=inertia, density=density))

    return _changed(model, Link, scaled)


def with_friction(model: Model, coefficient: float) -> Model:
    """Return a model with a new coefficient of friction for all collisions and directions."""

    def scaled(collision: Collision) -> Collision:
        friction = replace(collision.surface.friction or Friction(), mu=coefficient, mu2=coefficient)
        return replace(collision, surface=replace(collision.surface, friction=friction))

    return _changed(model, Collision, scaled)


def with_noise(model: Model, factor: float) -> Model:
    """Return a model with the noise and bias in all ``<noise>`` elements multiplied by a factor."""

    def scaled(noise: Noise) -> Noise:
        return replace(noise, **{name: getattr(noise, name) * factor for name in _SCALED_NOISE})

    return _changed(model, Noise, scaled)


def _changed(value: V, kind: type[Any], change: Callable[[Any], Any]) -> V:
    """Return a value in which `change` is applied to all contained instances of a class.

    Unchanged parts are the same objects as before.
    """
    if isinstance(value, kind):
        return cast("V", change(value))
    if isinstance(value, tuple):
        parts = [_changed(item, kind, change) for item in value]
        if all(new is old for new, old in zip(parts, value, strict=True)):
            return value
        return cast("V", type(value)(*parts) if hasattr(value, "_fields") else tuple(parts))
    if not is_dataclass(value) or isinstance(value, type):
        return value
    new = {
        field.name: _changed(getattr(value, field.name), kind, change)
        for field in fields(value)
        if field.name != "element"
    }
    new = {name: part for name, part in new.items() if part is not getattr(value, name)}
    return replace(value, **new) if new else value
