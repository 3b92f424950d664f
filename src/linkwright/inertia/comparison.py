"""Comparison of a file's mass properties with those computed from the shapes."""

from __future__ import annotations

from math import isfinite

import numpy as np

from linkwright.geometry.mass import MassProperties
from linkwright.geometry.validity import find_problems
from linkwright.loading.lean_dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Comparison:
    """The result of comparing a file's mass properties with those computed from the shapes.

    Attributes:
        mass: the mass in the file, in kg.
        mass_ratio: the mass in the file divided by the computed mass; None if one of them is not positive.
        center_distance: the distance between the centers of mass in m.
        moment_ratios: the principal moments per kg in the file divided by the computed ones, in the order of the
            moments, smallest first; None if they cannot be divided.
        find_problems: the reasons why no body can have the file's values.
    """

    mass: float
    mass_ratio: float | None
    center_distance: float
    moment_ratios: tuple[float, float, float] | None
    find_problems: tuple[str, ...]


def compare(file_properties: MassProperties, computed: MassProperties) -> Comparison:
    """Compare the mass properties of a file with computed ones, both in the link frame.

    The moments are compared per kg, so that a difference in mass is not reported twice.
    """
    mass_ratio = file_properties.mass / computed.mass if file_properties.mass > 0 and computed.mass > 0 else None
    ratios = None
    if mass_ratio is not None:
        computed_moments = computed.principal().moments
        present_moments = file_properties.principal().moments
        if computed_moments[0] > 0:
            with np.errstate(all="ignore"):  # Values beyond the range of doubles cannot be compared.
                first, second, third = (float(ratio) for ratio in present_moments / computed_moments / mass_ratio)
            ratios = (first, second, third) if all(map(isfinite, (first, second, third))) else None
    distance = float(np.linalg.norm(file_properties.center - computed.center))
    return Comparison(float(file_properties.mass), mass_ratio, distance, ratios, tuple(find_problems(file_properties)))
