"""Known attacks on sandboxes of expressions fail."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from linkwright.xacro.faults import Fault

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
    "''.__class__.__base__",
    "[].__class__.__mro__",
    "(lambda x=(lambda: 0).__globals__: x)()",
    "(lambda: (yield))()",
    "[(yield 1)]",
    "(await 1)",
    "(x for x in [1]).gi_frame.f_back.f_globals",
    "(x for x in [1]).send",
    "(x for x in [1]).throw(1)",
    "(x for x in [1]).close",
    "(x for x in [1]).gi_yieldfrom",
    "python.reversed([1]).__reduce__",
    "python.enumerate([1]).__class__",
    "python.type(python.type)",
    "python.type('').format",
    "python.type('').join",
    "python.type([]).extend",
    "python.type(xacro)",
    "python.type(print)",
    "python.type(None)",
    "list(map(python.type, [math]))",
    "min(['a'], key=str.format_map)",
    "python.vars(math)['sin'].__module__",
    "vars(math)",
    "python.vars(python)['type'](1).mro",
    "python.filter(str.format, ['x'])",
    "str.format_map",
    "str.maketrans",
    "str.translate",
    "bytes.fromhex('00')",
    "int.from_bytes(b'a', 'big')",
    "int.to_bytes(1, 10**9, 'big')",
    "(1).to_bytes(10**9, 'big')",
    "python.hash('a').to_bytes",
    "float.fromhex('1')",
    "dict.fromkeys([1])",
    "dict.fromkeys(python.range(10**6), [1])",
    "python.set.__init__",
    "data.__class__",
    "data.__init__.__globals__",
    "data._x",
    "xacro.dotify(dict(__class__=1)).__class__",
    "(a := ''.__class__)",
    "[a := 1, a.__class__]",
    "(__x := 1)",
    "[__x for __x in [1]]",
    "(lambda __x: __x)(1)",
    "(lambda x, *, __y=1: 0)()",
    "(lambda: __import__('os'))()",
    "[__import__ for i in [1]]",
    "sin.__self__",
    "math.__spec__",
    "math.sys",
    "math._",
    "python.__builtins__",
    "python['__builtins__']",
    "xacro['__class__']",
    "math['__loader__']",
    "python.getattr",
    "python.object",
    "python.eval",
    "python.open",
    "python.globals",
    "python.super",
    "python.memoryview",
    "python.property",
    "python.staticmethod",
    "python.iter",
    "python.next",
    "python.print",
    "python.format",
    "python.input",
    "xacro.abs_filename(1)",
    "xacro.arg.__closure__",
    "1 .__class__",
    "1..real.__class__",
    "''.join.__self__",
    "''.join.__name__",
    "[].append.__self__",
    "[].sort(key=str.format)",
    "'a'.upper.__call__",
    "list(map(list, [[1]]*10**6))",
    "python.vars(xacro)['load_yaml'].__self__",
    "xacro.load_yaml.__func__",
    "python['type'].__subclasses__()",
    "data.get.__self__",
    "items.append.__self__",
    "items.__iter__",
    "items.__class__.__init__.__globals__",
    "python.dict(__class__=1).__class__",
    "python.zip([1])._",
    "(lambda x: x.__class__)(1)",
    "[(lambda: x.__class__)() for x in [1]]",
    "[a.__class__ := 1]",
    "(lambda *, x=''.__class__: x)()",
    "python.all(x.__class__ for x in [1])",
    "list(map(lambda x: x.__class__, [1]))",
    "python.sorted([1], key=lambda x: x.__class__)",
    "python.filter(lambda x: x.__class__, [1])",
    "1 if ''.__class__ else 2",
    "''.__class__ and 1",
    "[''.__class__]",
    "dict(a=''.__class__)",
    "a[''.__class__]",
    "-''.__class__",
    "f'{1'",
    "(yield)",
    "lambda: (yield)",
    "[await x for x in []]",
    "[x async for x in []]",
    "a = 1",
    "del a",
    "import os",
    "assert a",
    "raise a",
    "@a",
    "class A: pass",
    "print 1",
]


@pytest.mark.parametrize("source", ESCAPES)
def test_sandbox_escape_is_rejected(source: str) -> None:
    with pytest.raises(Fault):
        evaluate("${" + source + "}", items=[1], data={"a": 1}, a=1)


@given(
    st.sampled_from(dir(object) + dir(str) + dir(list) + ["gi_frame", "f_globals", "tb_frame", "co_code", "cr_frame"])
)
def test_attributes_give_only_plain_values_and_methods(name: str) -> None:
    for value in ("'s'", "[1]", "1", "1.5", "len", "math", "(lambda: 0)", "python.range(3)", "None", "xacro.arg"):
        try:
            result = evaluate("${" + f"({value}).{name}" + "}")
        except Fault:
            continue
        assert not name.startswith("_")
        assert not isinstance(result, type)
        assert name != "format_map"


FIELDS = [
    "{0.__class__}",
    "{0.__class__.__mro__}",
    "{0._x}",
    "{name.__self__}",
    "{1.__globals__}",
    "{0:{name.__class__}}",
    "{0.real.__class__!r}",
    "{2.__init__}",
    "{2.values}",
    "{0:>99999}",
    "{0}" * 2000,
]


@pytest.mark.parametrize("text", FIELDS)
def test_fields_of_format_reach_no_more_than_expressions(text: str) -> None:
    with pytest.raises(Fault):
        evaluate("${pattern.format(1, lambda: 0, math, name=len)}", pattern=text)


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("link{}", "link7"),
        ("{0}_{0}", "7_7"),
        ("{name:.2f}", "1.50"),
        ("{0.real}", "7"),
        ("{1[1]}", "b"),
        ("{2[key]:>3}", "  9"),
        ("{1[0]!r}", "'a'"),
        ("{0:{3}}", "   7"),
        ("{{}}", "{}"),
    ],
)
def test_format_returns_the_text_that_python_returns(text: str, value: str) -> None:
    assert evaluate("${pattern.format(7, ['a', 'b'], dict(key=9), 4, name=1.5)}", pattern=text) == value


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("{1}", "the call of 'format' has no value for the field '1'"),
        ("{far}", "the call of 'format' has no value for the field 'far'"),
        ("{0.}", "'0.' does not name a field"),
    ],
)
def test_wrong_field_of_format_is_named(text: str, reason: str) -> None:
    with pytest.raises(Fault, match=reason):
        evaluate("${pattern.format(1)}", pattern=text)


def test_yaml_file_cannot_execute_code() -> None:
    from linkwright.xacro.expressions.yaml_data import YamlError, load

    for text in (
        "!!python/object/apply:os.system ['true']",
        "!!python/name:os.system",
        "a: !degrees '1'\nb: !!python/x y",
    ):
        with pytest.raises(YamlError):
            load(text, float)


@pytest.mark.parametrize(
    ("source", "code"),
    [
        ("f'{items.__class__}'", "XAC204"),
        ("f'{str.mro}'", "XAC204"),
        ("f'{1:{items.__len__}}'", "XAC204"),
        ("f'{1:>99999999999}'", "XAC204"),
        ("f'{1:>{99999}}'", "XAC204"),
        ("f'{1.5:.1001f}'", "XAC204"),
        ("f'{items:>5}'", "XAC202"),
        ("f'{1:Q}'", "XAC202"),
        ("f'{nope}'", "XAC201"),
    ],
)
def test_f_string_fields_are_sandboxed(source: str, code: str) -> None:
    with pytest.raises(Fault) as caught:
        evaluate(f"$(eval {source})".replace("items", "list"))
    assert caught.value.code == code
    assert caught.value.start is not None
