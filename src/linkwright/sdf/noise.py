"""The element ``<noise>`` of sensors.

Source of the elements and defaults: the SDFormat specification 1.12, ``noise.sdf``.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from linkwright.schema import AttributeRule, ElementRule
from linkwright.sdf.values import NUMBER, TEXT, never_written, object_rule, value


@dataclass(frozen=True, slots=True)
class Noise:
    """The noise on a measured value, in the unit of the value.

    Attributes:
        type: ``none``, ``gaussian`` or ``gaussian_quantized``.
        mean: the mean of the noise.
        stddev: the standard deviation of the noise.
        bias_mean: the mean of a constant bias, which is drawn once.
        bias_stddev: the standard deviation of the constant bias.
        dynamic_bias_stddev: the standard deviation of a bias that drifts.
        dynamic_bias_correlation_time: the correlation time of the drift, in seconds.
        precision: the step to which values with quantized noise are rounded.
    """

    type: str = "none"
    mean: float = 0.0
    stddev: float = 0.0
    bias_mean: float = 0.0
    bias_stddev: float = 0.0
    dynamic_bias_stddev: float = 0.0
    dynamic_bias_correlation_time: float = 0.0
    precision: float = 0.0


NO_NOISE = Noise()


@dataclass(frozen=True, slots=True)
class NoiseXyz:
    """Noise on the three components of a vector."""

    x: Noise = NO_NOISE
    y: Noise = NO_NOISE
    z: Noise = NO_NOISE


NO_NOISE_XYZ = NoiseXyz()

_NOISE_RULES = (
    value("mean", NUMBER, "the mean", default="0"),
    value("stddev", NUMBER, "the standard deviation", default="0"),
    value("bias_mean", NUMBER, "the mean of a constant bias", default="0"),
    value("bias_stddev", NUMBER, "the standard deviation of the constant bias", default="0"),
    value("dynamic_bias_stddev", NUMBER, "the standard deviation of a drifting bias", default="0"),
    value("dynamic_bias_correlation_time", NUMBER, "the correlation time of the drift", "s", default="0"),
    value("precision", NUMBER, "the step to which values are rounded", default="0"),
)


def _make_noise(type: str, old_type: str, **parameters: float) -> Noise:  # noqa: A002 - the attribute's name
    """Return the noise for the values in a ``<noise>`` element of any SDF version.

    In older files, the type is a child element, `old_type`. Numbers without a type mean Gaussian noise, as in Gazebo.
    """
    return Noise(old_type or type or ("gaussian" if any(parameters.values()) else "none"), **parameters)


def make_noise_rule() -> ElementRule:
    """Return the rule of the element ``<noise>``."""
    return ElementRule(
        "noise",
        "noise on the value",
        (AttributeRule("type", TEXT, "the type: none, gaussian or gaussian_quantized", default=""),),
        (
            value("type", TEXT, "the type of noise, up to SDF 1.4", default="", field="old_type", get=never_written),
            *_NOISE_RULES,
        ),
        make=_make_noise,
        keeps_element=True,
        default=NO_NOISE,
        field="noise",
    )


def make_wrapped_noise_rule(tag: str, meaning: str, target: str = "") -> ElementRule:
    """Return the rule of an element that contains only ``<noise>``, such as ``<x>``."""
    inner_rule = replace(make_noise_rule(), get=_same_noise)
    return object_rule(_same_noise, tag, meaning, inner_rule, default=NO_NOISE, field=target or tag)


def _same_noise(noise: Noise) -> Noise:
    return noise


def make_noise_xyz_rule(tag: str, meaning: str, default_noise: NoiseXyz | None = NO_NOISE_XYZ) -> ElementRule:
    """Return the rule of an element with noise for x, y and z.

    `default_noise` is the value of a missing element.
    """
    axis_rules = (
        make_wrapped_noise_rule("x", "along x"),
        make_wrapped_noise_rule("y", "along y"),
        make_wrapped_noise_rule("z", "along z"),
    )
    return object_rule(NoiseXyz, tag, meaning, *axis_rules, default=default_noise)
