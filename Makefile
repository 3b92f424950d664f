# Every target sets up what it needs below this folder and leaves the system as it is.
#
#   make demo    see the robot of the tutorial in a browser
#   make test    all tests, those of the page in a real Chromium (fetched below .build/ where there is none)
#   make check   ruff, mypy, import-linter, the page's type check, generated files current
#   make bench   the figures the project promises, measured on this machine
#   make soak    an hour of processes over DDS: does anything grow, get lost or hang?
#   make docs    the documentation site in site/
#   make fuzz    a million hostile inputs for everything that reads files; see fuzz/README.md

PYTHON ?= python3
VERSION ?=
VENV := .venv$(if $(VERSION),-$(VERSION))
BIN := $(VENV)/bin
UV ?= $(shell command -v uv || echo .build/uv/bin/uv)
export UV

LOCKED := .build/constraints.txt
PAGE_SOURCES := $(shell find frontend -path frontend/node_modules -prune -o -type f -print)

.PHONY: demo test test-quick test-browser check bench soak fuzz docs page lock format clean

demo: $(VENV)/.ready
	$(BIN)/linkwright launch my_robot_description display_xacro.launch.py $(ARGS)

test: $(VENV)/.dev page
	$(BIN)/python tools/build_page.py test
	LINKWRIGHT_CHROMIUM=$$($(BIN)/python tools/chromium.py) $(BIN)/pytest -n 2 --dist loadfile $(ARGS)

test-quick: $(VENV)/.dev
	$(BIN)/pytest -n 2 --dist loadfile -m "not browser and not slow" $(ARGS)

test-browser: $(VENV)/.dev page
	LINKWRIGHT_CHROMIUM=$$($(BIN)/python tools/chromium.py) $(BIN)/pytest -m browser $(ARGS)

check: $(VENV)/.dev
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	MYPYPATH=src $(BIN)/mypy
	$(BIN)/lint-imports
	$(BIN)/python tools/lock.py check
	$(BIN)/python tools/protocol_types.py --check
	$(BIN)/python tools/message_stubs.py --check
	$(BIN)/python tools/command_reference.py --check
	$(BIN)/python tools/messages.py --check
	$(BIN)/python tools/rule_reference.py --check
	$(BIN)/python tools/build_page.py run check

bench: $(VENV)/.dev page
	$(BIN)/python -m benchmarks.peers
	LINKWRIGHT_CHROMIUM=$$($(BIN)/python tools/chromium.py) $(BIN)/python -m benchmarks $(ARGS)

soak: $(VENV)/.dev page
	$(BIN)/python -m benchmarks.soak $(ARGS)

fuzz: .build/fuzz/venv/.ready
	PYTHONPATH=src:. nice -n 15 .build/fuzz/venv/bin/python -m fuzz $(ARGS)

.build/fuzz/venv/.ready: | $(UV)
	$(UV) venv --quiet --clear --python $(or $(VERSION),3.11) .build/fuzz/venv
	$(UV) pip install --quiet --python .build/fuzz/venv/bin/python atheris numpy pyyaml
	touch $@

docs: $(VENV)/.dev
	NO_MKDOCS_2_WARNING=1 $(BIN)/mkdocs build --strict --quiet

page: $(VENV)/.dev
	$(BIN)/python tools/build_page.py

lock: | $(UV)
	$(PYTHON) tools/lock.py update $(ARGS)

format: $(VENV)/.dev
	$(BIN)/ruff check --fix
	$(BIN)/ruff format

clean:
	rm -rf .venv .venv-* .build dist site frontend/node_modules src/linkwright/viewer/page

.build/uv/bin/uv:
	$(PYTHON) -m venv .build/uv
	.build/uv/bin/python -m pip install --quiet uv

$(LOCKED): uv.lock tools/lock.py
	mkdir -p .build
	$(PYTHON) tools/lock.py constraints > $@

# The program alone, installed so that changes to the sources count at once; the build makes the page.
$(VENV)/.ready: pyproject.toml hatch_build.py $(LOCKED) $(PAGE_SOURCES) | $(UV)
	test -x $(BIN)/python || $(UV) venv --quiet --python $(or $(VERSION),$(PYTHON)) $(VENV)
	$(UV) pip install --quiet --compile-bytecode --python $(BIN)/python --constraints $(LOCKED) \
		--reinstall-package linkwright --editable .
	$(BIN)/python -m compileall -q src
	touch $@

$(VENV)/.dev: $(VENV)/.ready
	$(UV) pip install --quiet --compile-bytecode --python $(BIN)/python --constraints $(LOCKED) --group dev
	touch $@
