from __future__ import annotations

from linkwright.xacro import expand, sources
from linkwright.xacro.kept import Kept


def test_what_is_kept_stays_below_the_bound() -> None:
    kept: Kept[int, str] = Kept(100, lambda _, text: len(text))
    for number in range(1000):
        kept.keep(number, "x" * (number % 7))
        assert sum(map(len, kept.values.values())) <= 100
        assert number in kept.values


def test_a_round_through_more_than_is_kept_finds_a_part_of_it_again() -> None:
    kept: Kept[int, int] = Kept(100, lambda *_: 1)
    found = 0
    for _ in range(10):
        for number in range(150):
            found += number in kept.values
            if number not in kept.values:
                kept.keep(number, number)
    assert found > 9 * 50


def test_one_in_the_place_of_another_counts_once() -> None:
    kept: Kept[str, int] = Kept(100, lambda _, size: size)
    kept.keep("first", 40)
    for _ in range(50):
        kept.keep("edited", 50)
    assert kept.values == {"first": 40, "edited": 50}


def test_more_files_than_a_package_has_are_parsed_once(tmp_path) -> None:
    for number in range(600):
        (tmp_path / f"{number}.urdf").write_text(f'<robot name="r{number}"><link name="base"/></robot>')
    robots = [tmp_path / f"{number}.urdf" for number in range(600)]
    for robot in robots:
        expand(robot)
    assert {str(robot) for robot in robots} <= {path for path, _ in sources.kept.values}
