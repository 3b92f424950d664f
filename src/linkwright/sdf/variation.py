"""Vary the masses, friction and sensor noise of models."""

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
    """Return a model with its links' masses, inertias and densities multiplied by a factor."""

    def scaled(link: Link) -> Link:
        inertial = link.inertial or Inertial()
        inertia = Inertia(*(getattr(inertial.inertia, field.name) * factor for field in fields(Inertia)))
        density = None if inertial.density is None else inertial.density * factor
        return replace(link, inertial=replace(inertial, mass=inertial.mass * factor, inertia=inertia, density=density))

    return _with_changes(model, Link, scaled)


def with_friction(model: Model, coefficient: float) -> Model:
    """Return a model with one coefficient of friction for all its collisions."""

    def scaled(collision: Collision) -> Collision:
        friction = replace(collision.surface.friction or Friction(), mu=coefficient, mu2=coefficient)
        return replace(collision, surface=replace(collision.surface, friction=friction))

    return _with_changes(model, Collision, scaled)


def with_noise(model: Model, factor: float) -> Model:
    """Return a model with all noise and bias multiplied by a factor."""

    def scaled(noise: Noise) -> Noise:
        return replace(noise, **{name: getattr(noise, name) * factor for name in _SCALED_NOISE})

    return _with_changes(model, Noise, scaled)


def _with_changes(value: V, kind: type[Any], change: Callable[[Any], Any]) -> V:
    """Return a copy of a value with `change` applied to all contained instances of a class.

    Parts without such instances are not copied.
    """
    if isinstance(value, kind):
        return cast("V", change(value))
    if isinstance(value, tuple):
        new_items = [_with_changes(item, kind, change) for item in value]
        if all(new is old for new, old in zip(new_items, value, strict=True)):
            return value
        return cast("V", type(value)(*new_items) if hasattr(value, "_fields") else tuple(new_items))
    if not is_dataclass(value) or isinstance(value, type):
        return value
    new_fields = {
        field.name: _with_changes(getattr(value, field.name), kind, change)
        for field in fields(value)
        if field.name != "element"
    }
    new_fields = {
        name: field_value for name, field_value in new_fields.items() if field_value is not getattr(value, name)
    }
    return replace(value, **new_fields) if new_fields else value
