"""Ways out of an expression that are known from other sandboxes, and ways to make it never end. None works."""

from __future__ import annotations

import sys
import time

import pytest
from hypothesis import given
from hypothesis import strategies as st

from linkwright.diagnostics import LinkwrightError
from linkwright.xacro import Limits, expand
from linkwright.xacro.faults import Fault

from .cases import ROOT
from .evaluating import evaluate

ESCAPES = [
    "''.__class__",
    "''.__class__.__mro__[1].__subclasses__()",
    "[x.__class__ for x in [1]]",
    "(lambda: 0).__globals__",
    "(lambda: 0).__code__",
    "[f.__self__ for f in [len]]",
    "len.__self__",
    "math.__loader__",
    "math.__dict__",
    "xacro.__class__",
    "python.__init__",
    "python._values",
    "python.values",
    "xacro.load_yaml.__globals__",
    "xacro.load_yaml.__self__",
    "xacro.message.__closure__",
    "(x for x in [1]).gi_frame",
    "[g.gi_frame.f_back for g in [(x for x in [1])]]",
    "(x for x in [1]).gi_code",
    "(lambda: 0)._body",
    "(lambda: 0)._around",
    "'{0.__class__}'.format(1)",
    "'x'.format",
    "'x'.format_map(1)",
    "str.format('{0.__class__}', 1)",
    "str.join",
    "list(map(str.format, ['{0.__class__}'], [1]))",
    "int.mro()",
    "int.__subclasses__()",
    "python.type(1).mro",
    "python.type(python.type(1))",
    "python.type('X', (list,), dict())",
    "python.type(math)",
    "python.type(lambda: 0)",
    "python.vars()",
    "python.vars(1)",
    "python.vars(lambda: 0)",
    "__import__('os')",
    "__builtins__",
    "open('/etc/passwd')",
    "eval('1')",
    "exec('1')",
    "getattr(1, 'real')",
    "globals()",
    "locals()",
    "compile('1', '', 'eval')",
    "dict.fromkeys",
    "[].__reduce_ex__(2)",
    "(1).__class__.__base__",
    "b''.maketrans",
    "python.frozenset.__class__",
    "[y for y in [1] if [x for x in [y.__class__]]]",
    "(a:=1).__class__",
    "xacro.arg.__func__",
    "xacro.dotify(dict(a=1)).__class__",
    "xacro.dotify(dict(a=1)).__init__",
    "'x'.encode().translate",
    "python.slice(1).indices",
    "math.sin.__module__",
    "python.map(1, 2)._x",
]


@pytest.mark.parametrize("source", ESCAPES)
def test_escape_is_refused(source: str) -> None:
    with pytest.raises(Fault):
        evaluate("${" + source + "}")


@given(
    st.sampled_from(dir(object) + dir(str) + dir(list) + ["gi_frame", "f_globals", "tb_frame", "co_code", "cr_frame"])
)
def test_no_attribute_gives_anything_but_plain_values_and_methods(name: str) -> None:
    for value in ("'s'", "[1]", "1", "1.5", "len", "math", "(lambda: 0)", "python.range(3)", "None", "xacro.arg"):
        try:
            result = evaluate("${" + f"({value}).{name}" + "}")
        except Fault:
            continue
        assert not name.startswith("_")
        assert not isinstance(result, type)
        assert name not in ("format", "format_map")


HUGE = [
    "10**10**10",
    "2**20000**2",
    "'a' * 10**9",
    "10**9 * 'a'",
    "[0] * 10**10",
    "(0,) * 10**10",
    "1 << 10**9",
    "'%1000000000d' % 1",
    "'%.1000000000f' % 1",
    "'%*d' % (10**9, 1)",
    "'x'.ljust(10**10)",
    "'x'.zfill(10**10)",
    "'x'.center(10**10)",
    "'\\t'.expandtabs(10**10)",
    "('x' * 10**6).join(['a'] * 10**6)",
    "('a' * 10**6).replace('a', 'b' * 10**6)",
    "python.range(10**12)",
    "list(python.range(10**8))",
    "factorial(10**7)",
    "comb(10**7, 10**6)",
    "perm(10**7)",
    "prod([10**1000] * 10**5)",
    "round(5, -10**9)",
    "[1 for a in python.range(10**6) for b in python.range(10**6)]",
    "python.sum(1 for a in python.range(10**6) for b in python.range(10**6))",
    "python.sum([[1]] * 10**6, [])",
    "(lambda f: f(f))(lambda f: f(f))",
    "(lambda f, n: f(f, n-1) + f(f, n-1) if n else 1)(lambda f, n: f(f, n-1) + f(f, n-1) if n else 1, 45)",
    "+".join(["1"] * 5000),
    "(" * 5000 + "1" + ")" * 5000,
    "-" * 9000 + "1",
    "not " * 4000 + "1",
    "1**" * 4000 + "1",
    "x." * 4000 + "y",
    "'" + "a" * 30000 + "'",
]


@pytest.mark.parametrize("source", HUGE, ids=lambda source: source[:40])
def test_what_would_grow_or_never_end_is_stopped(source: str) -> None:
    started = time.perf_counter()
    with pytest.raises(Fault):
        evaluate("${" + source + "}", Limits(steps=20_000))
    assert time.perf_counter() - started < 5


def test_growth_over_many_properties_is_stopped() -> None:
    for first, step in (("ab", "${p{0}}${p{0}}"), ("ab", "${p{0} + p{0}}"), ("${[1]}", "${[p{0}, p{0}]}")):
        chain = "".join(
            f'<xacro:property name="p{number + 1}" value="{step.replace("{0}", str(number))}"/>' for number in range(60)
        )
        with pytest.raises(LinkwrightError) as caught:
            expand("m.xacro", text=f'{ROOT}<xacro:property name="p0" value="{first}"/>{chain}<a v="${{p60}}"/></robot>')
        assert caught.value.diagnostics[0].code in ("XAC202", "XAC204")


def test_long_texts_are_counted() -> None:
    text = f'{ROOT}<xacro:property name="p" value="${{"a" * 100000}}"/>'.replace('"a"', "'a'")
    with pytest.raises(LinkwrightError) as caught:
        expand("m.xacro", text=text + '<a v="${p}"/>' * 20 + "</robot>", limits=Limits(characters=1_000_000))
    assert caught.value.diagnostics[0].code == "XAC605"


def test_macros_that_multiply_are_stopped() -> None:
    macros = "".join(
        f'<xacro:macro name="m{number}"><xacro:m{number + 1}/><xacro:m{number + 1}/></xacro:macro>'
        for number in range(60)
    )
    text = f'{ROOT}{macros}<xacro:macro name="m60"/><xacro:m0/></robot>'
    with pytest.raises(LinkwrightError) as caught:
        expand("m.xacro", text=text, limits=Limits(elements=10_000))
    assert caught.value.diagnostics[0].code == "XAC602"


RECURSIVE = (
    '<xacro:macro name="r" params="n"><l><k><xacro:if value="${n>1}"><xacro:r n="${n-1}"/></xacro:if></k></l>'
    '</xacro:macro><xacro:r n="%d"/>'
)


@pytest.mark.parametrize("levels", [1, 150, 200])
def test_deep_recursion_of_macros_works(levels: int) -> None:
    limit = sys.getrecursionlimit()
    text = str(expand("m.xacro", text=f"{ROOT}{RECURSIVE % levels}</robot>"))
    assert text.count("<l>") == levels
    assert sys.getrecursionlimit() == limit


@pytest.mark.parametrize("levels", [201, 100_000])
def test_too_deep_recursion_is_one_clear_error(levels: int) -> None:
    with pytest.raises(LinkwrightError) as caught:
        expand("m.xacro", text=f"{ROOT}{RECURSIVE % levels}</robot>")
    (diagnostic,) = caught.value.diagnostics
    assert diagnostic.code == "XAC601"
    assert "more than 200 deep" in diagnostic.message


def test_too_deep_nesting_of_elements_is_an_error() -> None:
    with pytest.raises(LinkwrightError) as caught:
        expand("m.xacro", text=f"{ROOT}{'<a>' * 5000}{'</a>' * 5000}</robot>")
    assert [diagnostic.code for diagnostic in caught.value.diagnostics] == ["XAC601"]


def test_a_long_chain_of_lazy_properties_is_an_error() -> None:
    chain = "".join(f'<xacro:property name="p{n}" value="${{p{n + 1} + 1}}"/>' for n in range(5000))
    with pytest.raises(LinkwrightError) as caught:
        expand("m.xacro", text=f'{ROOT}{chain}<a v="${{p0}}"/></robot>')
    assert caught.value.diagnostics[0].code == "XAC601"


def test_iterators_do_not_pile_up() -> None:
    chain = "".join(
        f'<xacro:property name="p{n + 1}" value="${{map(str, p{n})}}" lazy_eval="false"/>' for n in range(5000)
    )
    text = f'{ROOT}<xacro:property name="p0" value="${{[1]}}"/>{chain}<a v="${{list(p5000)}}"/></robot>'
    assert "['1']" in str(expand("m.xacro", text=text))


def test_a_yaml_file_cannot_run_code() -> None:
    from linkwright.xacro.yamldata import YamlError, load

    for text in (
        "!!python/object/apply:os.system ['true']",
        "!!python/name:os.system",
        "a: !degrees '1'\nb: !!python/x y",
    ):
        with pytest.raises(YamlError):
            load(text, float)
