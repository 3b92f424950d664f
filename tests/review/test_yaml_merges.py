"""The lines of a review about YAML files with merge keys."""

from __future__ import annotations

from linkwright.review.files.parameters.yaml_values import read_yaml_values
from tests.review.conftest import sentences, subject

BASE = """base: &base
  rate: 50
  gains: {p: 1.0, i: 0.5}
"""
PATH = "arm_description/config/arms.yaml"


def read(text: str) -> dict[str, str]:
    return {path: value.text for path, value in read_yaml_values(text).items() if not path.startswith("base")}


def test_merged_values_belong_to_the_mapping_and_its_own_go_first():
    text = f"{BASE}left:\n  <<: *base\n  gains: {{p: 2.0}}\n"
    assert read(text) == {"left.gains.p": "2.0", "left.rate": "50"}


def test_first_of_several_merged_mappings_goes_first():
    text = f"{BASE}base2: &other\n  rate: 9\n  port: 1\nleft:\n  <<: [*base, *other]\n"
    assert read(text) == {"left.rate": "50", "left.gains.p": "1.0", "left.gains.i": "0.5", "left.port": "1"}


def test_mappings_that_are_merged_many_times_end():
    levels = "".join(f"base{n}: &n{n}\n  <<: [*n{n - 1}, *n{n - 1}, *n{n}]\n" for n in range(1, 60))
    text = f"base0: &n0\n  rate: 50\n{levels}left:\n  <<: *n59\n"
    assert read(text) == {"left.rate": "50"}


def test_parts_with_equal_values_are_shown_once(package, compare):
    package.write({PATH: f"{BASE}left:\n  <<: *base\nright:\n  <<: *base\n  rate: 10\n"})
    (line,) = sentences(subject(compare(package), PATH))
    base = "base (rate 50, gains.p 1.0, gains.i 0.5)"
    assert line == f"parameter file added: {base}, left (as base), right (rate 10, gains.p 1.0, gains.i 0.5)"


def test_changed_default_is_overridden_by_own_values(package, compare):
    text = f"{BASE}left:\n  <<: *base\n  rate: 10\n"
    package.commit({PATH: text})
    package.write({PATH: text.replace("rate: 50", "rate: 60")})
    lines = sentences(subject(compare(package), PATH))
    assert lines == ["base.rate 50 -> 60"]
