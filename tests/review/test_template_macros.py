"""Macros of templates for SDF in a review: their parameters and calls."""

from __future__ import annotations

import pytest

from tests.review.conftest import breaking, sentences, subject

PATH = "arm/models/arm.sdf.jinja"
MACRO = """<sdf version="1.9">{%% macro lidar(%s) %%}
<link name="{{ name }}"><pose>{{ x }} 0 0 0 0 0</pose></link>
{%% endmacro %%}
</sdf>
"""
MODEL = """{%% import 'parts.sdf.jinja' as parts %%}
<sdf version="1.9"><model name="arm">
  <link name="base"/>
  {{ parts.lidar(name='front', rate=%s) }}
  {{ parts.lidar(
     name='back', rate=%s) }}
  {{ other(%s) }}
</model></sdf>
"""


@pytest.mark.parametrize(
    ("new", "reason"),
    [
        ("name, rate=10, x=0", "calls that pass 'x' by position set another parameter"),
        ("name, y=0", "calls that pass 'x' by name fail"),
        ("name, x=[0, 1], rate=10", None),
        ("name, x=1", None),
    ],
)
def test_parameters_of_a_macro_are_compared_as_calls_pass_them(repository, compare, new, reason):
    repository.commit({PATH: MACRO % "name, x=0"})
    repository.write({PATH: MACRO % new})
    ((_, change),) = [(each, change) for each in compare(repository).subjects for change in each.changes]
    assert (None if change.reason is None else str(change.reason)) == reason


def test_calls_of_macros_are_compared_by_their_arguments(repository, compare):
    repository.commit({PATH: MODEL % (10, 20, 1)})
    repository.write({PATH: MODEL % (10, 40, 1)})
    result = compare(repository)
    assert sentences(subject(result, PATH)) == ["model arm call parts.lidar 2 rate: 20 -> 40"]
    (change,) = subject(result, PATH).changes
    assert change.location.line == 5


def test_expression_that_gives_a_name_is_not_called_a_name(repository, compare):
    text = (
        '<sdf version="1.9"><model name="arm"><plugin name="p" filename="p.so"><frame>%s</frame></plugin></model></sdf>'
    )
    repository.commit({PATH: text % "{{ frame }}"})
    repository.write({PATH: text % "{{ camera_frame }}"})
    result = compare(repository)
    assert sentences(subject(result, PATH)) == ["model arm plugin p frame: {{ frame }} -> {{ camera_frame }}"]
    assert breaking(result) == []
