"""Generated worlds and models, from the types of the fields of their classes."""

from __future__ import annotations

import dataclasses
import types
from functools import cache
from typing import Any, Union, get_args, get_origin, get_type_hints

from hypothesis import strategies as st
from hypothesis.strategies import SearchStrategy

from linkwright.geometry.single import Pose, normalized, rpy_from_quaternion
from linkwright.sdf.joints import JOINT_TYPES, AxisLimit, Joint
from linkwright.sdf.lights import Light
from linkwright.sdf.materials import Pbr, Workflow
from linkwright.sdf.models import Model
from linkwright.sdf.noise import Noise
from linkwright.sdf.populations import KINDS, Distribution
from linkwright.sdf.shapes import Polyline
from linkwright.sdf.states import ModelState
from linkwright.sdf.worlds import Sdf
from linkwright.xmltree import Element

NUMBERS = st.floats(-1e12, 1e12, allow_nan=False)
WORDS = st.text(st.sampled_from("abz_ é<>&\"'0"), min_size=1, max_size=6).filter(lambda text: text == text.strip())
QUATERNIONS = st.tuples(*[st.floats(-1.0, 1.0)] * 4).filter(
    lambda q: sum(component * component for component in q) > 0.01
)
_METAL = ("roughness_map", "metalness_map", "roughness", "metalness")
_SPECULAR = ("specular_map", "glossiness_map", "glossiness")


@st.composite
def poses(draw) -> Pose:
    """Generate poses with angles or a quaternion."""
    xyz = draw(st.tuples(NUMBERS, NUMBERS, NUMBERS))
    if draw(st.booleans()):
        return Pose(xyz, draw(st.tuples(NUMBERS, NUMBERS, NUMBERS)))
    x, y, z, w = normalized(*draw(QUATERNIONS))
    quaternion = (x + 0.0, y + 0.0, z + 0.0, w + 0.0)  # -0 is written as 0, which would change pi to -pi
    return Pose(xyz, rpy_from_quaternion(quaternion), quaternion)


def _workflow(other_objects: tuple[str, ...]) -> SearchStrategy[Workflow | None]:
    fields = {name: values_of(Workflow, name) for name in Workflow.__slots__ if name not in other_objects}
    return st.none() | st.builds(Workflow, **fields)


_SPECIAL: dict[tuple[type, str], SearchStrategy[Any]] = {
    (Joint, "type"): st.sampled_from(JOINT_TYPES),
    (Light, "type"): st.sampled_from(("point", "directional", "spot")),
    (Noise, "type"): st.sampled_from(("none", "gaussian", "gaussian_quantized")),
    (Distribution, "type"): st.sampled_from(KINDS),
    (AxisLimit, "effort"): st.floats(0, 1e12),
    (AxisLimit, "velocity"): st.floats(0, 1e12) | st.just(float("inf")),
    (Sdf, "version"): st.just("1.11"),
    (Model, "models"): st.just(()),
    (ModelState, "models"): st.just(()),
}


@cache
def _field_hints(kind: type) -> dict[str, Any]:
    return get_type_hints(kind)


def values_of(kind: type, name: str) -> SearchStrategy[Any]:
    """Generate the values of a field; usual values are frequent."""
    if (kind, name) in _SPECIAL:
        return _SPECIAL[kind, name]
    hint = _field_hints(kind)[name]
    if Element in (hint, *get_args(hint)):
        return st.none()
    usual = next(field.default for field in dataclasses.fields(kind) if field.name == name)
    strategy = _values(hint)
    return strategy if usual is dataclasses.MISSING else st.just(usual) | strategy


def _values(hint: Any) -> SearchStrategy[Any]:
    simple = {float: NUMBERS, int: st.integers(0, 2**32), bool: st.booleans(), str: WORDS, type(None): st.none()}
    if hint in simple:
        return simple[hint]
    arguments = get_args(hint)
    if get_origin(hint) in (Union, types.UnionType):
        return st.one_of(*(_values(argument) for argument in arguments if argument is not Polyline))
    if get_origin(hint) is tuple:
        if arguments[-1] is Ellipsis:
            min_count = 1 if arguments[0] is Polyline else 0
            return st.lists(_values(arguments[0]), min_size=min_count, max_size=2).map(tuple)
        return st.tuples(*map(_values, arguments))
    return objects(hint)


def objects(kind: type) -> SearchStrategy[Any]:
    """Generate objects of a class."""
    if kind is Pose:
        return poses()
    if kind is Pbr:
        return st.builds(Pbr, metal=_workflow(_SPECULAR), specular=_workflow(_METAL))
    return st.deferred(
        lambda: st.builds(kind, **{field.name: values_of(kind, field.name) for field in dataclasses.fields(kind)})
    )
