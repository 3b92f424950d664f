"""No rule, comment or setting makes the check of any description raise an exception."""

from __future__ import annotations

import random
import re
import warnings

import pytest
from hypothesis import given
from hypothesis import strategies as st

from linkwright.diagnostics import SourceText
from linkwright.lint import Settings, examine
from linkwright.lint.suppression import find_directives
from tests.lint.cases import load_cases
from tests.work import lines_run

ODD_VALUES = [
    "",
    " ",
    "nan",
    "1e308",
    "-1e308",
    "1e-320",
    "-0",
    "0",
    "x",
    "${a}",
    "1 2",
    "0 0 0",
    "1e308 1e308 1e308",
    "ä",
    "../..",
    "a b",
    "<",
]
VALUE_PATTERN = re.compile(r'="([^"]*)"')
DESCRIPTIONS = [
    case for case in load_cases() if next(iter(case.files)).endswith((".urdf", ".xacro")) and len(case.files) == 1
]


@pytest.mark.parametrize("seed", range(60))
def test_lint_survives_odd_attribute_values(tmp_path, monkeypatch, seed):
    monkeypatch.chdir(tmp_path)
    rng = random.Random(seed)
    for number, case in enumerate(rng.sample(DESCRIPTIONS, 6)):
        text = next(iter(case.files.values()))
        for _ in range(rng.randint(1, 4)):
            places = [match.span(1) for match in VALUE_PATTERN.finditer(text)]
            if not places:
                break
            start, end = rng.choice(places)
            text = text[:start] + rng.choice(ODD_VALUES).replace("<", "&lt;") + text[end:]
        path = tmp_path / f"{number}.urdf"
        path.write_text(text, encoding="utf-8")
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            examine(path, settings=Settings(select=("ALL",)))


@pytest.mark.parametrize("seed", range(40))
def test_lint_survives_missing_and_duplicate_lines(tmp_path, monkeypatch, seed):
    monkeypatch.chdir(tmp_path)
    rng = random.Random(seed)
    for number, case in enumerate(rng.sample(DESCRIPTIONS, 6)):
        lines = next(iter(case.files.values())).splitlines()
        for _ in range(rng.randint(1, 3)):
            line_index = rng.randrange(len(lines))
            lines[line_index : line_index + 1] = rng.choice([[], [lines[line_index], lines[line_index]]])
            if not lines:
                break
        path = tmp_path / f"{number}.urdf"
        path.write_text("\n".join(lines), encoding="utf-8")
        examine(path, settings=Settings(select=("ALL",)))


@given(st.text(st.sampled_from("<>!-/ab \n#,()\"'=?[]"), max_size=60), st.text(max_size=40))
def test_suppression_ranges_stay_within_arbitrary_text(before, after):
    text = f"<r>{before}<!-- linkwright: ignore {after}-->{before}<a>{after}"
    for directive in find_directives(SourceText("f", text)):
        assert 0 <= directive.start < directive.end <= len(text)
        for start, end in directive.ranges or ():
            assert 0 <= start <= end <= len(text)


def chain_of_links(count: int, mimic: str = "", disconnected_links: str = "") -> str:
    """Return a robot with a chain of links; `mimic` is the content of each joint."""
    parts = (
        f'<link name="l{i}"/><joint name="j{i}" type="continuous"><parent link="l{i - 1}"/><child link="l{i}"/>'
        f"{mimic.format(before=i - 1)}</joint>\n"
        for i in range(1, count)
    )
    return f'<robot name="r"><link name="l0"/>{"".join(parts)}{disconnected_links}</robot>'


@pytest.mark.parametrize(
    ("mimic", "disconnected_links"),
    [
        ("", '<link name="a"/><link name="b"/>'),
        ('<mimic joint="j{before}"/>', '<joint name="j0" type="fixed"/>'),
        ('<mimic joint="j{before}"/>', '<joint name="j0" type="continuous"><mimic joint="j1"/></joint>'),
    ],
)
def test_lint_effort_is_linear_in_robot_size(tmp_path, mimic, disconnected_links):
    settings = Settings(select=("ALL",))

    def work(count: int) -> int:
        path = tmp_path / "r.urdf"
        path.write_text(chain_of_links(count, mimic, disconnected_links), encoding="utf-8")
        return lines_run(lambda: examine(path, settings=settings))

    work(5)  # fills caches
    assert work(400) < 5 * work(100)
