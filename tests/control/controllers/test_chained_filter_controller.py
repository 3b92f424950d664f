"""Chains of filters for states."""

from __future__ import annotations

from math import exp, isnan, nan, pi

import pytest

from linkwright.control.controllers.chained_filter_controller import ChainedFilterController
from linkwright.control.controllers.controller import ControllerError
from linkwright.control.controllers.registry import controller_class
from linkwright.control.controllers.value_filters import FILTERS
from linkwright.diagnostics import LinkwrightError

MEAN = {"name": "mean", "type": "filters/MeanFilterDouble", "params": {"number_of_observations": 2}}
INTERFACES = {"input_interfaces": ["wheel/position"], "output_interfaces": ["wheel/filtered"]}


def test_controller_is_found_by_type():
    assert controller_class("chained_filter_controller/ChainedFilter") is ChainedFilterController


EXPONENTIAL = "control_filters/ExponentialFilterDouble"
LIMITS = {"sampling_interval": 0.1, "max_value": 2.0, "min_value": 3.0}
EXPONENTIAL_WEIGHT = exp(-2.0 * pi * 20.5 / (1000.0 * 10.0**-0.125))


@pytest.mark.parametrize(
    ("kind", "parameters", "values", "expected"),
    [
        ("filters/MeanFilterDouble", {"number_of_observations": 2}, [1.0, 3.0, 5.0], [1.0, 2.0, 4.0]),
        ("filters/MedianFilterDouble", {"number_of_observations": 3}, [4.0, 1.0, 9.0, 0.0], [4.0, 1.0, 4.0, 1.0]),
        ("filters/TransferFunctionFilterDouble", {"a": (2.0, -1.0), "b": (0.5, 0.5)}, [2.0, 4.0], [2.0, 2.5]),
        (EXPONENTIAL, {"alpha": 0.25}, [4.0, 8.0, 8.0], [4.0, 5.0, 5.75]),
        (
            "control_filters/LowPassFilterDouble",
            {"sampling_frequency": 1000.0, "damping_frequency": 20.5, "damping_intensity": 1.25},
            [1.0, 2.0, 2.0],
            [1.0, 1.0, EXPONENTIAL_WEIGHT + 2.0 * (1.0 - EXPONENTIAL_WEIGHT)],
        ),
        (
            "control_filters/RateLimiterDouble",
            {"sampling_interval": 0.5, "max_value": 2.0, "max_first_derivative_pos": 3.0},
            [5.0, 5.0, -5.0],
            [1.5, 2.0, 0.5],
        ),
    ],
)
def test_filters_follow_their_formulas(kind, parameters, values, expected):
    value_filter = FILTERS[kind](**parameters).create()
    assert [value_filter(value) for value in values] == pytest.approx(expected)


async def test_states_are_filtered_and_exported(bench):
    bench.joint("wheel", position=1.0)
    controller = bench.start(ChainedFilterController, **INTERFACES, filter_chain={"filter1": MEAN, "filter2": MEAN})
    (result,) = controller.exported
    assert result.name == "controller/wheel/filtered"
    assert isnan(result.value)
    for value, expected in ((1.0, 1.0), (3.0, 1.5), (nan, 1.5), (5.0, 3.0)):
        bench.states["wheel/position"].value = value
        await bench.step(controller)
        assert result.value == expected
    assert not bench.log


async def test_each_state_can_have_its_own_chain(bench):
    bench.joint("wheel", position=1.0, velocity=1.0)
    single_value_mean = {**MEAN, "params": {"number_of_observations": 1}}
    controller = bench.start(
        ChainedFilterController,
        input_interfaces=["wheel/position", "wheel/velocity"],
        output_interfaces=["position", "velocity"],
        **{
            "wheel/position": {"filter_chain": {"filter1": MEAN}},
            "wheel/velocity": {"filter_chain": {"filter1": single_value_mean}},
        },
    )
    await bench.step(controller)
    bench.states["wheel/position"].value = bench.states["wheel/velocity"].value = 3.0
    await bench.step(controller)
    assert [state.value for state in controller.exported] == [2.0, 3.0]


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({}, "Failed to configure filter chain for interfaces wheel/position"),
        ({"output_interfaces": ["a", "b"]}, "Input and output interfaces have to have the same size"),
        (
            {"filter_chain": {"filter1": {"type": "filters/MeanFilterDoubl"}}},
            "there is no filter 'filters/MeanFilterDoubl'.*did you mean 'filters/MeanFilterDouble'",
        ),
        (
            {"filter_chain": {"filter1": {**MEAN, "params": {"number_of_observations": 0}}}},
            "'filter_chain.filter1.params.number_of_observations' with the value 0 must be above 0",
        ),
        (
            {"filter_chain": {"filter1": {"type": "filters/TransferFunctionFilterDouble", "params": {"a": [0.0]}}}},
            "'filter_chain.filter1.params.a' must begin with a number other than 0",
        ),
        (
            {
                "filter_chain": {
                    "filter1": {"type": "control_filters/ExponentialFilterDouble", "params": {"alpha": 2.0}}
                }
            },
            "'filter_chain.filter1.params.alpha' must be from 0 to 1, but it is 2",
        ),
    ],
)
async def test_invalid_chains_are_rejected(bench, settings, message):
    with pytest.raises((ControllerError, LinkwrightError), match=message):
        bench.make(ChainedFilterController, **INTERFACES | settings).on_configure()
