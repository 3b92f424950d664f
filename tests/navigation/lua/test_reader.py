"""Configuration files in Lua: values, tables, includes, and errors with places."""

from __future__ import annotations

import math
from contextlib import suppress
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from linkwright.diagnostics import LinkwrightError, SourceText
from linkwright.navigation.lua.reader import Environment, evaluate
from linkwright.navigation.lua.tables import Table


def run(text: str, **files: str) -> Any:
    environment = Environment(lambda name, _: SourceText(name, files[name.removesuffix(".lua")]))
    return evaluate(SourceText("robot.lua", text), environment)


@pytest.mark.parametrize(
    ("expression", "value"),
    [
        ("1.", 1.0),
        (".5e1", 5.0),
        ("0x1F", 31.0),
        ("2^3^2", 512.0),
        ("-2^2", -4.0),
        ("2 ^ -1", 0.5),
        ("7 // 2 + 7 % 2", 4.0),
        ("-7 // 2", -4.0),
        ("1 + 2 * 3 - (4 - 1)", 4.0),
        ("math.rad(180.)", math.pi),
        ("math.max(1, 3, 2)", 3.0),
        ("math.pi / 2", math.pi / 2),
        ("math.huge", math.inf),
        ("1 .. 'a' .. 2.5", "1a2.5"),
        ("'a\\tb\\65\\x42'", "a\tbAB"),
        ("[[\nlong]]", "long"),
        ("[==[a]]b]==]", "a]]b"),
        ("not nil", True),
        ("not 1 == 2", False),
        ("1 < 2 and 'yes' or 'no'", "yes"),
        ("nil or false", False),
        ("1 == 1.0", True),
        ("1 ~= 'a'", True),
        ("choose(false, 1, 2)", 2.0),
        ("#{4, 5, 6}", 3.0),
        ("#'abc'", 3.0),
        ("({a = {b = 4}}).a.b", 4.0),
        ("({'x', [2] = 'y'})[2]", "y"),
        ("nothing", None),
    ],
)
def test_expressions_have_their_values_of_lua(expression, value):
    assert run(f"return {expression}") == value


@given(st.floats(allow_nan=False, allow_infinity=False, min_value=0.0))
def test_numbers_are_read_exactly(number):
    assert run(f"return {number!r}") == number


def test_tables_are_shared_and_later_assignments_win():
    options = run("A = { b = { c = 1; d = 2, }, }\nlocal x = { a = A, 'first' }\n A.b.c = 5\nA['b'].d = nil\nreturn x")
    assert isinstance(options, Table)
    table = options.values["a"].values["b"]
    assert table.values == {"c": 5.0}
    assert options.values[1] == "first"
    assert (table.places["c"].span.line, table.places["c"].span.column) == (3, 2)


def test_comments_are_no_values():
    assert run("-- one\nx = 1 --[[ two\nx = 2 ]] --[==[ ]] ]==] y = x + 1\nreturn y") == 2.0


def test_files_are_included_once_in_the_same_environment():
    files = {"a": 'include "b.lua" A = B + 1', "b": "B = (B or 0) + 1"}
    assert run('include "a.lua" include("b.lua") return A', **files) == 2.0


@pytest.mark.parametrize(
    ("text", "line", "column", "message"),
    [
        ("x = ", 1, 5, "a value is missing here"),
        ("x = { 1, 2", 1, 11, "'}' is missing at the end of the file"),
        ("x = (1 2)", 1, 8, "')' is missing before '2'"),
        ("x = 1\ny.z = 2", 2, 1, "'y' does not exist"),
        ("x = 1\nx.z = 2", 2, 1, "'x' is not a table"),
        ("x = nothing.at.all", 1, 5, "'nothing' does not exist"),
        ("x = 'a\ny = 1", 1, 5, "the string that begins here does not end"),
        ("x = 1 + 'a'", 1, 7, "'+' needs numbers"),
        ("x = 1 / 0", 1, 7, "the result is not a finite number"),
        ("x = math.sqrt(-1)", 1, 10, "'math.sqrt' cannot be computed"),
        ("x = math.radd(1)", 1, 10, "'math.radd' does not exist"),
        ("x = read('file')", 1, 5, "the function 'read' is not supported"),
        ("x = choose(1)", 1, 11, "choose needs a condition and two values"),
        ("x = 1 ? 2", 1, 7, "'?' is not part of Lua"),
        ("return 1 x = 2", 1, 10, "'return' must be the last statement"),
        ("if x then y = 1 end", 1, 1, "'if' is not supported in configurations"),
        ("f = function() end", 1, 5, "'function' is not supported in configurations"),
        ("include 4", 1, 9, "the name of the included file is missing"),
        ("x[{}] = 1", 1, 1, "'x' does not exist"),
        ("= 1", 1, 1, "a name is missing here"),
    ],
)
def test_errors_tell_the_place(text, line, column, message):
    with pytest.raises(LinkwrightError) as error:
        run(text)
    diagnostic = error.value.diagnostics[0]
    assert (diagnostic.code, diagnostic.message) == ("NAV601", message)
    assert (diagnostic.span.line, diagnostic.span.column) == (line, column)


def test_deep_nesting_is_an_error_and_no_crash():
    with pytest.raises(LinkwrightError, match="nested too deep"):
        run("x = " + "(" * 5000)
    with pytest.raises(LinkwrightError, match="nested too deep"):
        run("x = " + "not " * 5000 + "1")


@given(st.text(alphabet="abx=.,;{}()[]'\"-+*/ \n019#~<>", max_size=40))
def test_any_text_is_read_or_refused(text):
    with suppress(LinkwrightError):
        run(text)
