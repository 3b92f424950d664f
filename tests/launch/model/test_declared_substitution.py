"""Substitutions that are declared by a class with typed arguments."""

from __future__ import annotations

import inspect

import pytest
from launch.frontend.parse_substitution import parse_substitution
from launch.substitutions import EnvironmentVariable, LaunchConfiguration, PathJoinSubstitution

from launch import LaunchContext
from launch.frontend import expose_substitution
from linkwright.diagnostics import LinkwrightError
from linkwright.launch.model.declared_substitution import DeclaredSubstitution, OptionalTexts, TextLists, Texts


class Between(DeclaredSubstitution, tag="between/in-between", shown="{kind}<{ends}|{text}>"):
    """A text between two others."""

    text: Texts = Texts()
    ends: OptionalTexts = OptionalTexts(default=None, kw_only=True)

    def perform(self, context: LaunchContext) -> str:
        end = "" if self.ends is None else context.perform_substitution(self.ends[0])
        return end + context.perform_substitution(self.text[0]) + end


def test_constructor_signature_follows_declaration() -> None:
    assert str(inspect.signature(Between)) == "(text, *, ends=None)"
    with pytest.raises(TypeError, match=r"Between.__init__\(\) missing 1 required positional argument: 'text'"):
        Between()  # type: ignore[call-arg]
    with pytest.raises(TypeError, match="takes 2 positional arguments but 3 were given"):
        Between("a", "b")  # type: ignore[misc]
    with pytest.raises(TypeError, match="expected a text"):
        Between(3)  # type: ignore[arg-type]


def test_arguments_are_normalized_properties() -> None:
    between = Between("a", ends=LaunchConfiguration("b"))
    assert [substitution.describe() for substitution in between.text] == ["'a'"]
    assert between.ends is not None
    assert Between("a").ends is None


def test_all_tag_names_are_parsed(context: LaunchContext) -> None:
    assert context.perform_substitution(parse_substitution("$(between a |)")[0]) == "|a|"
    assert context.perform_substitution(parse_substitution("$(in-between a)")[0]) == "a"
    with pytest.raises(LinkwrightError, match="between substitution expects 1 or 2 arguments"):
        parse_substitution("$(between)")


def test_describe_uses_declared_format() -> None:
    assert Between(["a", "b"]).describe() == "Between<|'a' + 'b'>"
    assert EnvironmentVariable("HOME").describe() == "EnvVar('HOME')"
    assert PathJoinSubstitution(["a", ["b", "c"]]).describe() == "PathJoin('a', 'b' + 'c')"


def test_subclass_can_define_its_own_constructor(context: LaunchContext) -> None:
    @expose_substitution("twice-between")
    class Twice(Between):
        def __init__(self, text: str) -> None:
            super().__init__(text + text, ends="-")

        @classmethod
        def parse(cls, data: list[object]) -> tuple[type, dict[str, object]]:
            return cls, {"text": "x"}

    assert context.perform_substitution(Twice("a")) == "-aa-"
    assert context.perform_substitution(parse_substitution("$(twice-between)")[0]) == "-xx-"


def test_text_lists_are_normalized() -> None:
    class Row(DeclaredSubstitution):
        parts: TextLists = TextLists()

    row = Row(["a", ["b", LaunchConfiguration("c")]])
    assert [len(part) for part in row.parts] == [1, 2]
    assert row.describe() == "Row('a', 'b' + LaunchConfig('c'))"


@pytest.fixture
def context() -> LaunchContext:
    return LaunchContext()
