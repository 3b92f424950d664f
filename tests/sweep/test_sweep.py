"""Sweeps in this process: tables, summaries, and resuming."""

import csv
import io
import json
from html.parser import HTMLParser

import pyarrow.parquet as pq
import pytest

from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase
from linkwright.sweep.execution import Outcome, run_once
from linkwright.sweep.plan import plan_runs
from linkwright.sweep.sweep import Sweep
from linkwright.sweep.table import Table, check_format, encode_table
from tests.full_disk import full_disk, needs_limits
from tests.sweep.scenarios import HEAD, SQUARES, load_scenario_text, write_scenario

MIXED = f"""{HEAD}
@scenario(world=['maze', 'a,"b"'], n=[1, 2])
def mixed(world, n):
    if n == 2 and world == 'maze':
        raise RuntimeError('<no> way')
    return {{"float_or_int": n / 2 if n == 1 else n, "text": world, "late": None, "truth": n == 1, "nan": float('nan')}}
"""


def make_reverse_runner(scenario, should_stop=None):
    """Return a runner in this process that starts with the last row.

    It is interrupted before a row.
    """

    def run(runs, report):
        for planned_run in reversed(runs):
            if planned_run.row == should_stop:
                raise KeyboardInterrupt
            report(run_once(scenario, planned_run))

    return run


DRIVEN = f"""{HEAD}
@scenario(n=[1, 2], seeds=2)
def driven(n, seed):
    return {{"n_and_seed": n + seed, "track": [(0.5 * step, n * step, seed) for step in range(5)]}}
"""


def read_rows(path):
    return list(csv.DictReader(io.StringIO(path.read_text())))


def run_sweep(tmp_path, text=SQUARES, name="out.csv", should_stop=None, resume=False, paths=None):
    scenario = load_scenario_text(tmp_path, text)
    sweep = Sweep(scenario, tmp_path / name, ["linkwright", "sweep", "squares.py"], paths and tmp_path / paths)
    messages = []
    table = sweep.run(
        make_reverse_runner(scenario, should_stop), resume=resume, progress=lambda *state: messages.append(state)
    )
    return table, messages


def test_table_rows_are_sorted_regardless_of_completion_order(tmp_path):
    table, result = run_sweep(tmp_path)
    assert result[-1] == (6, 6, 0)
    rows = read_rows(tmp_path / "out.csv")
    assert [row["row"] for row in rows] == ["1", "2", "3", "4", "5", "6"]
    assert list(rows[0]) == ["row", "n", "drawn", "seed", "square", "big", "sum", "error"]
    assert [row["square"] for row in rows] == ["1", "1", "4", "4", "9", "9"]
    assert rows[5]["big"] == "true"
    assert [float(row["sum"]) for row in rows] == table.columns["sum"], "numbers are written with all digits"
    assert sorted(path.name for path in tmp_path.iterdir() if path.is_file()) == ["out.csv", "out.html", "squares.py"]


def test_failed_run_is_a_row_with_error(tmp_path):
    table, result = run_sweep(tmp_path, MIXED)
    assert result[-1] == (4, 4, 1)
    assert table.failed_rows == [1]
    rows = read_rows(tmp_path / "out.csv")
    assert rows[1]["error"] == "RuntimeError: <no> way (squares.py:6)"
    assert rows[1]["text"] == ""
    assert rows[2]["world"] == 'a,"b"'


def test_paths_are_in_a_file_and_not_in_the_table(tmp_path):
    run_sweep(tmp_path, DRIVEN, paths="paths.json")
    assert list(read_rows(tmp_path / "out.csv")[0]) == ["row", "n", "seed", "n_and_seed", "error"]
    runs = json.loads((tmp_path / "paths.json").read_text())["runs"]
    assert [(run["row"], run["parameters"], run["seed"]) for run in runs[1:3]] == [(2, {"n": 1}, 1), (3, {"n": 2}, 0)]
    assert runs[3]["paths"] == {
        "track": [[0.0, 0.0, 1.0], [0.5, 2.0, 1.0], [1.0, 4.0, 1.0], [1.5, 6.0, 1.0], [2.0, 8.0, 1.0]]
    }


def test_interrupted_sweep_keeps_its_paths(tmp_path):
    run_sweep(tmp_path, DRIVEN, paths="whole.json")
    (tmp_path / "out.csv").unlink()
    run_sweep(tmp_path, DRIVEN, should_stop=2, paths="paths.json")
    with pytest.raises(LinkwrightError, match="differ from the runs of this one"):
        run_sweep(tmp_path, DRIVEN, resume=True)
    run_sweep(tmp_path, DRIVEN, resume=True, paths="paths.json")
    assert (tmp_path / "paths.json").read_bytes() == (tmp_path / "whole.json").read_bytes()


def test_parquet_table_has_same_values_and_types(tmp_path):
    table, _ = run_sweep(tmp_path, MIXED, "out.parquet")
    read = pq.read_table(tmp_path / "out.parquet").to_pydict()
    assert read["row"] == [1, 2, 3, 4]
    assert read["float_or_int"] == [0.5, None, 0.5, 2.0]
    assert read["truth"] == [True, None, True, False]
    assert read["late"] == [None] * 4
    assert list(read) == list(table.columns)


def test_resumed_sweep_writes_identical_files(tmp_path):
    uninterrupted, interrupted = tmp_path / "whole", tmp_path / "interrupted"
    uninterrupted.mkdir()
    interrupted.mkdir()
    run_sweep(uninterrupted)
    table, _ = run_sweep(interrupted, should_stop=3)
    assert table.columns["row"] == [4, 5, 6]
    assert "3 runs remain" in (interrupted / "out.html").read_text()
    journal = interrupted / "out.csv.unfinished"
    with journal.open("a") as file:
        file.write('{"row": 3, "resul')  # a row that a power failure truncated
    table, output = run_sweep(interrupted, resume=True)
    assert output[0] == (4, 6, 0)
    assert not journal.exists()
    for name in ("out.csv", "out.html"):
        assert (interrupted / name).read_bytes() == (uninterrupted / name).read_bytes()


def test_unfinished_sweep_is_neither_lost_nor_mixed_with_another(tmp_path):
    with pytest.raises(LinkwrightError) as raised:
        run_sweep(tmp_path, resume=True)
    assert raised.value.diagnostics[0].code == "SWEEP109"
    run_sweep(tmp_path, should_stop=3)
    before = (tmp_path / "out.csv.unfinished").read_bytes()
    for resume, text, code in ((False, SQUARES, "SWEEP107"), (True, SQUARES.replace("seeds=2", "seeds=3"), "SWEEP108")):
        with pytest.raises(LinkwrightError) as raised:
            run_sweep(tmp_path, text, resume=resume)
        assert raised.value.diagnostics[0].code == code
    assert (tmp_path / "out.csv.unfinished").read_bytes() == before


@needs_limits
def test_full_disk_keeps_previous_table(tmp_path):
    (tmp_path / "out.csv").write_text("old")
    scenario = load_scenario_text(tmp_path)
    sweep = Sweep(scenario, tmp_path / "out.csv", ["linkwright"])
    with full_disk(200), pytest.raises(LinkwrightError, match="too large") as raised:
        sweep.run(make_reverse_runner(scenario), resume=False, progress=lambda *_: None)
    assert raised.value.diagnostics[0].code == "SWEEP110"
    assert (tmp_path / "out.csv").read_text() == "old"
    table = sweep.run(make_reverse_runner(scenario), resume=True, progress=lambda *_: None)
    assert table.columns["row"] == [1, 2, 3, 4, 5, 6]


def test_sweep_failing_before_first_row_leaves_no_files(tmp_path):
    def refused(runs, report):
        raise LinkwrightError(Diagnostic("SWEEP114", phrase("there is no cluster")))

    with pytest.raises(LinkwrightError):
        Sweep(load_scenario_text(tmp_path), tmp_path / "out.csv", []).run(
            refused, resume=False, progress=lambda *_: None
        )
    assert [path.name for path in tmp_path.iterdir() if path.is_file()] == ["squares.py"]


class Page(HTMLParser):
    """The content of a page."""

    def __init__(self, text):
        super().__init__()
        self.tags, self.addresses, self.text = [], [], io.StringIO()
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        self.tags.append((tag, dict(attrs)))

    def handle_data(self, data):
        self.text.write(data)

    def count(self, tag, **attributes):
        return sum(name == tag and attributes.items() <= tag_attributes.items() for name, tag_attributes in self.tags)


def test_summary_has_plots_and_no_external_resources(tmp_path):
    run_sweep(tmp_path)
    page = Page((tmp_path / "out.html").read_text())
    assert page.count("svg") == 3 + 2 * 3, "each result has a plot, and a plot for each varied parameter"
    assert page.count("circle") == 6 * 6
    assert page.count("tr", id="row-6") == 1
    assert page.count("a", href="#row-6") == 6
    assert not [tag_attributes for _, tag_attributes in page.tags if {"src", "action"} & tag_attributes.keys()]
    assert page.count("link") == page.count("script") == 0
    assert "6 runs" in page.text.getvalue()


def test_summary_lists_failures_with_rerun_command(tmp_path):
    run_sweep(tmp_path, MIXED)
    text = (tmp_path / "out.html").read_text()
    assert "&lt;no&gt; way" in text
    assert "linkwright sweep squares.py --rerun 2" in text
    assert "1 failed" in text


def test_summary_exists_for_sweep_of_only_errors(tmp_path):
    table, _ = run_sweep(tmp_path, f"{HEAD}@scenario(n=[1])\ndef f(n): return {{'x': 1 / 0}}\n")
    assert table.failed_rows == [0]
    assert Page((tmp_path / "out.html").read_text()).count("svg") == 0


@pytest.mark.parametrize("values", [[1.0, 1.0], [0.0, 1e-12], [-5.0, 1e9], [1e-300, 2e-300]])
def test_summary_plots_extreme_values(tmp_path, values):
    text = f"{HEAD}@scenario(n=[0, 1])\ndef f(n): return {{'x': {values}[n]}}\n"
    run_sweep(tmp_path, text)
    page = (tmp_path / "out.html").read_text()
    assert "nan" not in page.lower().replace("standard", "")
    assert Page(page).count("circle") == 2


def test_table_format_must_be_csv_or_parquet(tmp_path):
    with pytest.raises(LinkwrightError) as raised:
        check_format(tmp_path / "out.xlsx")
    assert raised.value.diagnostics[0].code == "SWEEP110"
    for name in ("out.csv", "out.parquet"):
        check_format(tmp_path / name)


def test_missing_results_are_empty_cells(tmp_path):
    runs = plan_runs(load_scenario_text(tmp_path))[:2]
    table = Table.of(runs, {1: Outcome(1, {"a": 1}), 2: Outcome(2, {"b": "x"})})
    lines = encode_table(table, tmp_path / "out.csv").decode().splitlines()
    assert [line.split(",")[4:] for line in lines] == [["a", "b", "error"], ["1", "", ""], ["", "x", ""]]
    assert write_scenario(tmp_path).exists()
