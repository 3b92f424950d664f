"""Expansions that would be endless or fill the memory end with a clear error."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.xacro import Limits, expand
from linkwright.xacro.faults import Fault
from tests.places import REPOSITORY
from tests.work import ends

from .cases import ROOT
from .evaluating import evaluate


def error_codes(text: str, limits: Limits | None = None) -> list[str]:
    """Return the codes of the errors in a text, and check that none takes long to find."""
    with ends(), pytest.raises(LinkwrightError) as caught:
        expand("m.xacro", text=text, limits=limits)
    return [diagnostic.code for diagnostic in caught.value.diagnostics]


HUGE_NUMBERS = [
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
    "(10**19)**(10**19)",
    "pow(10, 10**10)",
    "pow(2, 10**9, 10**9)",
    "pow(10**5000, 10**5000, 10**5000)",
    "math.pow(10, 10000)",
    "exp(10**6)",
    "10.0**1000",
    "int('9'*10**5)",
    "int('9'*5000)",
    "int('f'*100000, 16)",
    "str(10**6000)",
    "'%d' % 10**6000",
    "'%x' % 10**6000",
    "10**6000",
    "-10**6000",
    "[10**6000]",
    "'%s' % [10**6000]",
    "10**6000 == 10**6000 + 1",
    "1 << 20000",
    "1 << 10**10",
    "1 << -1",
    "~(1<<30000)",
    "(1<<19000)*(1<<19000)",
    "'a'*10**9",
    "10**9*'a'",
    "b'a'*10**9",
    "[0]*10**10",
    "(0,)*10**10",
    "[[0]*1000]*1000*1000",
    "python.sum(python.range(10**12))",
    "python.sum([[1]*10**5]*10**5, [])",
    "python.sum([10**6000]*1000)",
    "python.range(-10**12, 10**12)",
    "list(python.range(10**6))",
    "list(python.range(10**6))*2",
    "[x for x in python.range(10**6)]",
    "[x for x in python.range(10**6) for y in python.range(10**6)]",
    "python.sorted(python.range(10**6), key=lambda x: -x)",
    "python.sorted(python.range(10**6))",
    "list(map(lambda x: x, python.range(10**6)))",
    "python.all(x < 10**9 for x in python.range(10**6))",
    "max(python.range(10**6), key=lambda v: v)",
    "python.tuple(python.range(10**6))",
    "python.set(python.range(10**6))",
    "python.dict(python.enumerate(python.range(10**6)))",
    "'x'.center(10**10, 'y')",
    "'x'.rjust(10**9)",
    "('\\t'*10**5).expandtabs(10**5)",
    "('x'*10**6).join(['a']*10**6)",
    "('a'*10**6).replace('a','b'*10**6)",
    "('a'*10**5).replace('','b'*10**5)",
    "('a'*10**6).replace('a','bb')",
    "('a'*10**6).split('a')",
    "('a'*10**6).encode('utf-32')",
    "('ß'*10**6).upper()",
    "('\\ufb03'*10**6).upper()",
    "('a'*10**5).encode('idna')",
    "('é'*10**6).encode('unicode_escape')",
    "'a'.encode('rot13')",
    "'a'.encode('zlib')",
    "b'x'.decode('zip')",
    "b'x'.decode('hex')",
    "'a'.encode('undefined')",
    "'a'.encode('x'*10**5)",
    "'%.*f' % (10**9, 1)",
    "'%(a)1000000000d' % dict(a=1)",
    "('%s'*1000) % (('a'*10**5,)*1000)",
    "b'%1000000000d' % 1",
    "prod([10**1000]*10**5)",
    "prod(python.range(1,10**6))",
    "gcd(10**6000, 7**6000)",
    "lcm(*list(python.range(1,10**5)))",
    "isqrt(10**6000)",
    "math.ldexp(1.0, 10**10)",
    "math.dist([1]*10**6,[2]*10**6)",
    "round(10**6000, -5000)",
    "[items.append(1) for x in items]",
    "[items.extend(items) for x in python.range(100)]",
    "[data.update(python.dict([(str(i), i)])) for i in python.range(10**6)]",
    "[(items.append(items[-1]*2)) for x in python.range(10**5)]",
    "[(items.append('x'*10**6)) for x in python.range(10**4)]",
    "[('x'*10**6) for x in python.range(10**4)]",
    "[('x'*10**6).upper() for x in python.range(10**5)]",
    "[python.sorted(python.range(10**6)) for x in python.range(10**3)]",
    "[python.sum(python.range(10**6)) for x in python.range(10**3)]",
    "[list(python.range(10**6)) for x in python.range(10**3)]",
    "python.sum(python.sum(python.range(10**6)) for x in python.range(10**3))",
    "python.sum([len(list(python.range(10**6))) for x in python.range(10**3)])",
    "list(map(python.sorted, [python.range(10**6)]*1000))",
    "list(map(python.sum, [python.range(10**6)]*1000))",
    "list(map(len, map(list, [python.range(10**6)]*1000)))",
    "list(map(str.upper, ['x'*10**6]*1000))",
    "list(map(str.count, ['x'*10**6]*1000, ['y']*1000))",
    "max(map(python.sum, [python.range(10**6)]*1000))",
    "python.all(map(list, [python.range(10**6)]*1000))",
    "list(map(factorial, [2000]*10**5))",
    "list(python.zip(*[python.range(10**6)]*100))",
    "python.sorted([[1]*10**5]*10**5)",
    "[[1]*10**5]*10**5 == [[1]*10**5]*10**5",
    "list(python.range(10**6)) == list(python.range(10**6))",
    "(lambda a: [a for i in python.range(1000) for j in a])(list(python.range(10**5)))",
    "[y for y in python.range(10**6) if y in list(python.range(10**5))]",
    "python.range(10**6).index(999999.5)",
    "[1.5 in python.range(10**6) for i in python.range(10**4)]",
    "[python.range(10**6).count(1.5) for i in python.range(10**4)]",
    "items * items",
]


@pytest.mark.parametrize("source", HUGE_NUMBERS, ids=lambda source: source[:40])
def test_unbounded_expressions_are_stopped(source: str) -> None:
    with ends(), pytest.raises(Fault):
        evaluate("${" + source + "}", items=[1], data={"a": 1})


def test_growth_over_many_properties_is_stopped() -> None:
    for first, step in (("ab", "${p{0}}${p{0}}"), ("ab", "${p{0} + p{0}}"), ("${[1]}", "${[p{0}, p{0}]}")):
        chain = "".join(
            f'<xacro:property name="p{number + 1}" value="{step.replace("{0}", str(number))}"/>' for number in range(60)
        )
        with pytest.raises(LinkwrightError) as caught:
            expand("m.xacro", text=f'{ROOT}<xacro:property name="p0" value="{first}"/>{chain}<a v="${{p60}}"/></robot>')
        assert caught.value.diagnostics[0].code in ("XAC202", "XAC204")


def test_total_text_length_is_limited() -> None:
    text = f'{ROOT}<xacro:property name="p" value="${{"a" * 100000}}"/>'.replace('"a"', "'a'")
    with pytest.raises(LinkwrightError) as caught:
        expand("m.xacro", text=text + '<a v="${p}"/>' * 20 + "</robot>", limits=Limits(characters=1_000_000))
    assert caught.value.diagnostics[0].code == "XAC605"


def test_exponential_macro_calls_are_stopped() -> None:
    macros = "".join(
        f'<xacro:macro name="m{number}"><xacro:m{number + 1}/><xacro:m{number + 1}/></xacro:macro>'
        for number in range(60)
    )
    text = f'{ROOT}{macros}<xacro:macro name="m60"/><xacro:m0/></robot>'
    with pytest.raises(LinkwrightError) as caught:
        expand("m.xacro", text=text, limits=Limits(elements=10_000))
    assert caught.value.diagnostics[0].code == "XAC602"


RECURSIVE_MACROS = (
    '<xacro:macro name="r" params="n"><l><k><xacro:if value="${n>1}"><xacro:r n="${n-1}"/></xacro:if></k></l>'
    '</xacro:macro><xacro:r n="%d"/>'
)


@pytest.mark.parametrize("levels", [1, 150, 200])
def test_deep_macro_recursion_is_expanded(levels: int) -> None:
    limit = sys.getrecursionlimit()
    text = str(expand("m.xacro", text=f"{ROOT}{RECURSIVE_MACROS % levels}</robot>"))
    assert text.count("<l>") == levels
    assert sys.getrecursionlimit() == limit


@pytest.mark.parametrize("levels", [201, 100_000])
def test_too_deep_macro_recursion_is_one_error(levels: int) -> None:
    with pytest.raises(LinkwrightError) as caught:
        expand("m.xacro", text=f"{ROOT}{RECURSIVE_MACROS % levels}</robot>")
    (diagnostic,) = caught.value.diagnostics
    assert diagnostic.code == "XAC601"
    assert "more than 200 levels deep" in diagnostic.message


def test_too_deep_element_nesting_is_an_error() -> None:
    with pytest.raises(LinkwrightError) as caught:
        expand("m.xacro", text=f"{ROOT}{'<a>' * 5000}{'</a>' * 5000}</robot>")
    assert [diagnostic.code for diagnostic in caught.value.diagnostics] == ["XAC601"]


def test_long_chain_of_lazy_properties_is_an_error() -> None:
    chain = "".join(f'<xacro:property name="p{n}" value="${{p{n + 1} + 1}}"/>' for n in range(5000))
    with pytest.raises(LinkwrightError) as caught:
        expand("m.xacro", text=f'{ROOT}{chain}<a v="${{p0}}"/></robot>')
    assert caught.value.diagnostics[0].code == "XAC601"


def test_nested_map_iterators_are_evaluated() -> None:
    chain = "".join(
        f'<xacro:property name="p{n + 1}" value="${{map(str, p{n})}}" lazy_eval="false"/>' for n in range(5000)
    )
    text = f'{ROOT}<xacro:property name="p0" value="${{[1]}}"/>{chain}<a v="${{list(p5000)}}"/></robot>'
    assert "['1']" in str(expand("m.xacro", text=text))


LARGE_BUT_ALLOWED = [
    "2**-10**10",
    "python.divmod(10**5000, 3)",
    "(-8)**(1/3)",
    "'9'*4000",
    "float('9'*10**5)",
    "python.sum(python.range(10**6))",
    "fsum(python.range(10**6))",
    "python.max(python.range(10**6))",
    "('a'*10**6).count('a')",
    "('a'*5*10**5 + 'b').find('a'*10**5 + 'c')",
    "('ab'*10**5) in ('ab'*4*10**5+'c')",
    "('a b '*10**5).title()",
    "'a'.encode('idna')",
    "('a.'*10**5).encode('idna')",
    "('é'*10**4).encode('punycode')",
    "'%s'*10**5 % ((10**6,)*10**5)",
    "'%999d'*10**4 % ((1,)*10**4)",
    "'%r' % ('a'*10**6)",
    "factorial(2000)",
    "comb(2000, 10**9)",
    "lcm(*python.range(1, 2000))",
    "hypot(*[1]*10**6)",
    "round(5.5, 10**9)",
    "[items.insert(0, items) for x in python.range(100)]",
    "[items.append(items) for x in python.range(100)] and items",
    "[d.update(dict(d=d)) for d in [dict(a=1)]]",
    "[python.range(10**6)]*10**4 == 1",
    "10**9 in python.range(10**6)",
    "1.5 in python.range(10**6)",
    "[[]]*1000000",
]


@pytest.mark.parametrize("source", LARGE_BUT_ALLOWED, ids=lambda source: source[:40])
def test_large_allowed_expressions_are_fast(source: str) -> None:
    with ends():
        evaluate("${" + source + "}", items=[1], data={"a": 1})


def make_nested_macros(count: int, body: str) -> str:
    """Return macros that each call the next one twice."""
    macros = "".join(
        f'<xacro:macro name="m{number}">{body.format(call=f"<xacro:m{number + 1}/>")}</xacro:macro>'
        for number in range(count)
    )
    return f'{ROOT}{macros}<xacro:macro name="m{count}"/><xacro:m0/></robot>'


@pytest.mark.parametrize("body", ["{call}{call}", "<a>{call}</a><b>{call}</b>"])
def test_macros_that_double_are_stopped_by_default(body: str) -> None:
    assert error_codes(make_nested_macros(60, body)) == ["XAC602"]


@pytest.mark.parametrize(
    ("body", "calls"),
    [
        ('<xacro:if value="${1}"/>', 10_000),
        ('<xacro:property name="b" value="${1}"/>', 10_000),
        ('x<xacro:if value="1"/>', 10_000),
        ('<a v="1"/>', 10_000),
        ('<xacro:arg name="a" default="1"/>', 10_000),
    ],
)
def test_tags_without_output_count_toward_limit(body: str, calls: int) -> None:
    text = f'{ROOT}<xacro:macro name="m">{body * 1_000}</xacro:macro>{"<xacro:m/>" * calls}</robot>'
    with pytest.raises(LinkwrightError) as caught:
        expand("m.xacro", text=text)
    assert caught.value.diagnostics[0].code == "XAC602"


def test_blocks_that_double_are_stopped() -> None:
    blocks = "".join(
        f'<xacro:property name="b{n}">{f"""<xacro:insert_block name="b{n - 1}"/>""" * 2}</xacro:property>'
        for n in range(1, 60)
    )
    first = '<xacro:property name="b0"><a/></xacro:property>'
    with pytest.raises(LinkwrightError) as caught:
        expand("m.xacro", text=f'{ROOT}{first}{blocks}<xacro:insert_block name="b59"/></robot>')
    assert caught.value.diagnostics[0].code == "XAC602"


def test_time_limit_is_enforced() -> None:
    text = make_nested_macros(60, "{call}{call}")
    assert error_codes(text, Limits(elements=10**9, seconds=0.1)) == ["XAC606"]
    with pytest.raises(Fault) as caught:
        evaluate("${[x for x in python.range(1000000)]}", Limits(steps=10**9, seconds=0.05))
    assert caught.value.code == "XAC606"


def test_lists_growing_across_macro_calls_are_stopped() -> None:
    body = (
        '<xacro:macro name="r" params="items:=^ n"><a v="${items.append(items[-1] * 2)}"/>'
        '<xacro:r n="${n-1}"/></xacro:macro>'
    )
    for first in ("'ab'", "3", "[1]"):
        first_list = f'<xacro:property name="items" value="${{[{first}]}}"/>'
        assert error_codes(f'{ROOT}{body}{first_list}<xacro:r n="100"/></robot>')[0] in ("XAC204", "XAC601")


@pytest.mark.parametrize(
    "body",
    [
        '<xacro:property name="b"><xacro:insert_block name="b"/></xacro:property><xacro:insert_block name="b"/>',
        '<xacro:macro name="m"><xacro:m/></xacro:macro><xacro:m/>',
        '<xacro:macro name="m"><xacro:k/></xacro:macro><xacro:macro name="k"><xacro:m/></xacro:macro><xacro:m/>',
        '<xacro:macro name="m"><xacro:call macro="m"/></xacro:macro><xacro:m/>',
        "<a v='${1}'>" * 100_000 + "</a>" * 100_000,
        "<xacro:if value='1'>" * 100_000 + "</xacro:if>" * 100_000,
        "<a>" * 100_000 + "</a>" * 100_000,
    ],
    ids=lambda body: body[:40],
)
def test_infinite_recursion_is_an_error(body: str) -> None:
    assert error_codes(f"{ROOT}{body}</robot>") == ["XAC601"]


def test_file_that_includes_itself_is_an_error(tmp_path: Path) -> None:
    file = tmp_path / "m.xacro"
    file.write_text(f'{ROOT}<xacro:include filename="m.xacro"/><xacro:include filename="m.xacro"/></robot>')
    with ends(), pytest.raises(LinkwrightError) as caught:
        expand(file)
    assert caught.value.diagnostics[0].code == "XAC601"


@pytest.mark.skipif(not Path("/dev/zero").exists(), reason="this system has no /dev/zero")
@pytest.mark.parametrize("use", ['<xacro:include filename="/dev/zero"/>', "<a v=\"${xacro.load_yaml('/dev/zero')}\"/>"])
def test_endless_file_is_an_error(use: str) -> None:
    assert error_codes(f"{ROOT}{use}</robot>")[0] in ("XML103", "XAC506")


@pytest.mark.parametrize("written", ["'\\x00'", "'\\x01'", "'\\ud800'", "'\\uffff'", "'%c' % 2"])
def test_characters_invalid_in_xml_are_an_error(written: str) -> None:
    assert error_codes(f'{ROOT}<a v="${{{written}}}"/></robot>') == ["XAC206"]


BILLION_LAUGHS = "a0: &a0 [x, x, x, x, x, x, x, x, x, x]\n" + "".join(
    f"a{n}: &a{n} [{', '.join([f'*a{n - 1}'] * 10)}]\n" for n in range(1, 10)
)
MERGES = "a0: &a0 {x: 1}\n" + "".join(f"a{n}: &a{n}\n  <<: [{', '.join([f'*a{n - 1}'] * 10)}]\n" for n in range(1, 12))
BOMBS = {
    "aliases": BILLION_LAUGHS,
    "merges": MERGES,
    "a list in itself": "&a [*a]",
    "a mapping as its own key": "&a {*a : 1}",
    "brackets": "[" * 100_000 + "]" * 100_000,
    "braces": "{a: " * 5_000 + "}" * 5_000,
    "blocks": "\n".join(" " * n + "a:" for n in range(1_500)),
    "dashes": "- " * 20_000 + "a",
    "digits": f"a: {'9' * 100_000}",
    "no date": "a: 2001-13-45",
    "no timestamp": "a: !!timestamp x",
    "no number": "a: !!int x",
    "a number of degrees without end": "a: !degrees 10**10**10",
    "a number of degrees too large": "a: !degrees 10**400",
    "a unit of itself": "a: !degrees xacro.load_yaml('d.yaml').a",
    "a call": "a: !!python/object/apply:os.system ['true']",
    "a new object": "a: !!python/object/new:os.system ['true']",
    "a name": "a: !!python/name:os.system",
    "a module": "a: !!python/module:os",
    "an object": "a: !!python/object:argparse.Namespace {b: 1}",
    "a tuple": "a: !!python/tuple [1]",
}


@pytest.mark.parametrize("text", BOMBS.values(), ids=BOMBS.keys())
def test_yaml_bomb_is_an_error(text: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("d.yaml").write_text(text)
    diagnostic_codes = error_codes(
        f'{ROOT}<xacro:property name="d" value="${{xacro.load_yaml(\'d.yaml\')}}"/><a v="${{len(d)}}"/></robot>'
    )
    assert diagnostic_codes[0] in ("XAC506", "XAC204", "XAC202")


@pytest.mark.parametrize("page", ["docs/xacro.md", "docs/zh/xacro.md"])
def test_every_limit_is_documented_with_its_default(page: str) -> None:
    text = (REPOSITORY / page).read_text(encoding="utf-8")
    for name, default in Limits()._asdict().items():
        assert f"| `{name}` | {default} |" in text
