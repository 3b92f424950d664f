"""Diagnostics as shown in a terminal."""

from __future__ import annotations

import io

import pytest

from linkwright.diagnostics import (
    Diagnostic,
    Note,
    Severity,
    SourceText,
    display_path,
    print_diagnostics,
    render,
    wants_color,
)


def render_excerpt(text: str, marked: str, **arguments) -> list[str]:
    source = SourceText("<test>", text)
    start = text.index(marked)
    diagnostic = Diagnostic("URDF121", "message", source.span(start, start + len(marked)), source=source, **arguments)
    return render(diagnostic).splitlines()


def test_full_diagnostic_is_rendered():
    assert render_excerpt('<a>\n  <mass value="1,5"/>\n</a>', "1,5", notes=(Note("a note"),), hint="a hint") == [
        "error[URDF121]: message",
        "  --> <test>:2:16",
        "  |",
        '2 |   <mass value="1,5"/>',
        "  |                ^^^",
        "   = note: a note",
        "   = hint: a hint",
    ]


@pytest.mark.parametrize(
    ("line", "marked", "carets"),
    [
        ("\t<a b='x'/>", "x", "          ^"),
        ("\ta\tb", "b", "         ^"),
        ("a\tb", "\t", " ^^^^"),
        ("底盘 x", "x", "     ^"),
        ("x 底盘 y", "底盘", "  ^^^^"),
    ],
)
def test_carets_mark_the_span(line, marked, carets):
    assert render_excerpt(line, marked)[-1] == f"  | {carets}"


def test_tabs_are_expanded():
    assert render_excerpt("\t<a/>", "<a/>")[3] == "1 |     <a/>"


def test_multiline_span_is_marked_to_end_of_first_line():
    assert render_excerpt("<a\n  b='c'\n/>", "<a\n  b")[-2:] == ["1 | <a", "  | ^^"]


def test_empty_span_has_one_caret():
    source = SourceText("<test>", 'value=""')
    assert render(Diagnostic("X1", "m", source.span(7, 7), source=source)).splitlines()[-1] == "  |        ^"


def test_gutter_width_follows_line_number():
    lines = render_excerpt("\n" * 99 + "x", "x")
    assert lines[2:] == ["    |", "100 | x", "    | ^"]


def test_excerpt_is_omitted_without_matching_source_or_for_blank_line():
    source = SourceText("<a>", "   \nx")
    for diagnostic in (
        Diagnostic("X1", "m", source.span(4, 5)),
        Diagnostic("X1", "m", source.span(4, 5), source=SourceText("<b>", "x\nx")),
        Diagnostic("X1", "m", source.span(1, 2), source=source),
    ):
        assert len(render(diagnostic).splitlines()) == 2


def test_diagnostic_without_span_has_no_excerpt():
    assert render(Diagnostic("X1", "no such file", hint="look elsewhere")) == (
        "error[X1]: no such file\n   = hint: look elsewhere"
    )


@pytest.mark.parametrize("severity", list(Severity))
def test_severity_is_rendered(severity):
    assert render(Diagnostic("X1", "m", severity=severity)) == f"{severity.value}[X1]: m"


def test_multiline_note_is_indented_and_followed_by_location():
    source = SourceText("<test>", "a\nb")
    note = Note("called here\nand so on", source.span(2, 3))
    assert render(Diagnostic("X1", "m", notes=(note,))) == (
        "error[X1]: m\n   = note: called here\n     and so on (<test>:2:1)"
    )


def test_color_adds_only_escape_sequences():
    source = SourceText("<test>", "<a/>")
    diagnostic = Diagnostic("X1", "m", source.span(1, 2), notes=(Note("n"),), hint="h", source=source)
    colored = render(diagnostic, color=True)
    assert colored != render(diagnostic)
    for code in ("31;1", "31", "34", "32", "1", "0"):
        colored = colored.replace(f"\x1b[{code}m", "")
    assert colored == render(diagnostic)


class Terminal(io.StringIO):
    def isatty(self):
        return True


def test_color_is_used_for_terminals_unless_disabled(monkeypatch):
    monkeypatch.setenv("TERM", "xterm")
    assert wants_color(Terminal())
    assert not wants_color(io.StringIO())
    monkeypatch.setenv("NO_COLOR", "1")
    assert not wants_color(Terminal())
    monkeypatch.delenv("NO_COLOR")
    monkeypatch.setenv("TERM", "dumb")
    assert not wants_color(Terminal())


def test_diagnostics_are_printed_with_color_only_on_terminal(monkeypatch):
    monkeypatch.setenv("TERM", "xterm")
    stream = io.StringIO()
    print_diagnostics([Diagnostic("X1", "first"), Diagnostic("X2", "second")], stream)
    assert stream.getvalue() == "error[X1]: first\nerror[X2]: second\n"
    terminal = Terminal()
    print_diagnostics([Diagnostic("X1", "first")], terminal)
    assert "\x1b[" in terminal.getvalue()


def test_paths_below_current_folder_are_relative(tmp_path, monkeypatch):
    (tmp_path / "here").mkdir()
    monkeypatch.chdir(tmp_path / "here")
    assert display_path(tmp_path / "here" / "urdf" / "a.urdf") == "urdf/a.urdf"
    assert display_path(tmp_path / "other" / "a.urdf") == str(tmp_path / "other" / "a.urdf")
    source = SourceText(str(tmp_path / "here" / "a.urdf"), "x")
    assert "--> a.urdf:1:1" in render(Diagnostic("X1", "m", source.span(0), source=source))


def test_long_line_is_shortened_around_span() -> None:
    source = SourceText("robot.urdf", f"{'a' * 1000}HERE{'b' * 1000}")
    lines = render(Diagnostic("XML206", "it is wrong", source.span(1000, 1004), source=source)).splitlines()
    assert lines[3] == f"1 | ...{'a' * 80}HERE{'b' * 76}..."
    assert lines[4] == f"  | {' ' * 83}^^^^"


def test_long_line_is_shortened_if_span_is_at_end() -> None:
    source = SourceText("robot.urdf", f"{'a' * 1000}HERE")
    lines = render(Diagnostic("XML206", "it is wrong", source.span(1000, 1004), source=source)).splitlines()
    assert lines[3] == f"1 | ...{'a' * 80}HERE"


def test_control_characters_are_replaced():
    head, place, _, excerpt, carets, note, hint, rest = render_excerpt(
        'a\x1b[2J\x07\x9b1m\u202e="x"', "x", notes=(Note("\x1b]0;title\x07"),), hint="two\nlines\x08"
    )
    assert excerpt == '1 | a␛[2J␇\ufffd1m\ufffd="x"'
    assert carets.index("^") == excerpt.index("x")
    assert note == "   = note: ␛]0;title␇"
    assert [hint, rest] == ["   = hint: two", "     lines␈"]
    assert (head, place) == ("error[URDF121]: message", "  --> <test>:1:13")
